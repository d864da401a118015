#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "render/frame_light.h"
#include "render/packed_transfer.h"
#include "render_fixture.h"
#include "scene/display.h"
#include "shared/leaf.h"
#include "shared/sky.h"
#include "verdure/reference.h"

// Light in physical units, and the way from it to the display.

namespace verdure {
namespace {

using namespace test;

constexpr float kPi = glm::pi<float>();

TEST(Tone, CurveIsThePapers) {
  for (const float white : {0.5f, 1.0f, 3.0f, 50.0f}) {
    EXPECT_FLOAT_EQ(shared::reinhard(white, white), 1.0f);
    EXPECT_NEAR(shared::reinhard(1e-4f, white), 1e-4f, 2e-8f + 1e-8f / (white * white));
    float before = -1.0f;
    for (float l = 0.0f; l < 2.0f * white; l += 0.01f * white) {
      const float d = shared::reinhard(l, white);
      EXPECT_GT(d, before);
      before = d;
      // Inverse: l^2 / white^2 + l (1 - d) - d = 0.
      const double a = 1.0 / (double{white} * white), b = 1.0 - d;
      EXPECT_NEAR((-b + std::sqrt(b * b + 4.0 * a * d)) / (2.0 * a), l, 1e-4 * (l + white));
    }
  }
  EXPECT_NEAR(shared::reinhard(1.0f, 1e6f), 0.5f, 1e-6f);  // without a white point, (3)
}

TEST(Tone, TheAutomaticWhiteShowsWhatIsBright) {
  float before = 0.0f;
  for (float bright = 0.0f; bright < 30.0f; bright += 0.01f) {
    const float white = shared::automaticWhite(bright);
    EXPECT_GE(white, std::max(before, 2.0f));
    EXPECT_LE(white, 10.0f);
    if (white == 2.0f) {
      EXPECT_LE(shared::reinhard(bright, white), 0.8001f);
    } else if (white < 10.0f) {
      EXPECT_NEAR(shared::reinhard(bright, white), 0.8f, 1e-4f);
    }
    before = white;
  }
  EXPECT_EQ(before, 10.0f);
  // Every luminance lies in its bin, and the next bin starts where it ends.
  for (float l = 1e-9f; l < 4e9f; l *= 1.37f) {
    const int bin = shared::luminanceBin(l);
    EXPECT_GE(shared::luminanceInBin(bin, 0.0f), 0.9999f * l);
    EXPECT_LE(shared::luminanceInBin(bin, 1.0f), 1.0001f * l);
    EXPECT_EQ(shared::luminanceInBin(bin, 0.0f), shared::luminanceInBin(bin + 1, 1.0f));
  }
  EXPECT_EQ(shared::luminanceBin(0.0f), 0);
}

TEST(Tone, KeepsLuminanceAndHueInTheDisplaysGamut) {
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 c = glm::vec3(random.uniform(), random.uniform(), random.uniform()) *
                        std::exp2(random.vary(6.0f));
    const float white = 0.5f + 4.0f * random.uniform();
    const glm::vec3 d = shared::toneMapped(c, white);
    const float l = shared::luminanceOf(c);
    EXPECT_NEAR(shared::luminanceOf(d), std::min(shared::reinhard(l, white), 1.0f), 1e-5f);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(d[k], -1e-6f);
      EXPECT_LE(d[k], 1.0f + 1e-6f);
    }
    // On the line from grey through the colour.
    const glm::vec3 hue = c - glm::vec3(l), shown = d - glm::vec3(shared::luminanceOf(d));
    EXPECT_LT(glm::length(glm::cross(hue, shown)), 1e-4f * glm::length(hue) + 1e-6f);
    EXPECT_GE(glm::dot(hue, shown), -1e-6f);
  }
  EXPECT_EQ(shared::toneMapped(glm::vec3(0.0f), 2.0f), glm::vec3(0.0f));
}

TEST(Tone, DitheringKeepsTheMeanAndExactLevels) {
  for (int level = 0; level <= 255; ++level)
    for (const float threshold : {0.0f, 0.3f, 0.999999f})
      EXPECT_EQ(shared::ditheredLevel(static_cast<float>(level) / 255.0f, threshold),
                static_cast<float>(level));
  for (const float s : {0.1f, 0.5f, 0.7123f, 0.99f}) {
    double exact = 0.0;
    for (int i = 0; i < 4096; ++i)
      exact += shared::ditheredLevel(s, (static_cast<float>(i) + 0.5f) / 4096.0f) / 4096.0;
    EXPECT_NEAR(exact, 255.0 * s, 5e-3);
    // Over the pixels of a picture, and already of a small square of it.
    for (int channel = 0; channel < 3; ++channel)
      for (const int size : {8, 128}) {
        double mean = 0.0;
        for (int y = 0; y < size; ++y)
          for (int x = 0; x < size; ++x)
            mean += shared::ditheredLevel(
                s, shared::ditherThreshold(static_cast<float>(x + 40), static_cast<float>(y + 7),
                                           static_cast<float>(channel)));
        EXPECT_NEAR(mean / (size * size), 255.0 * s, size == 8 ? 0.06 : 0.01);
      }
  }
}

TEST(FrameLight, UnitsFitTheBrightestIntoAHalf) {
  EXPECT_EQ(frameUnits(0.0f), 1.0f);
  for (const float brightest : {1.6e6f, 30.0f, 1.0f, 1e-5f}) {
    const float scaled = brightest * frameUnits(brightest);
    EXPECT_GE(scaled, 16384.0f);
    EXPECT_LE(scaled, 32768.0f);
    int exponent = 0;
    EXPECT_EQ(std::frexp(frameUnits(brightest), &exponent), 0.5f);  // a power of two
  }
}

/// What a surface sees of the sky: luminance = the share of cosine / pi where it is not blocked.
class Receiver final : public Sky {
 public:
  Receiver(const glm::vec3& normal, float from, float to) : n_(normal), from_(from), to_(to) {}
  glm::vec3 luminance(const glm::vec3& d) const override {
    return glm::vec3(d.y >= from_ && d.y < to_ ? std::max(glm::dot(n_, d), 0.0f) / kPi : 0.0f);
  }
  int rows() const override { return 256; }

 private:
  glm::vec3 n_;
  float from_, to_;  ///< of the sine of the elevation
};

double product(const Harmonics& a, const Harmonics& b, int bands) {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(bands * bands); ++i)
    sum += double{a.weights[i].g} * b.weights[i].g;
  return sum;
}

TEST(FrameLight, MirroredSkiesLightAsTheyAre) {
  // Against the exact integral (many bands of fine quadrature are none: it is taken directly).
  const glm::vec3 side = glm::normalize(glm::vec3(0.8f, 0.3f, 0.2f));
  double plain = 0.0, filtered = 0.0, mirrored = 0.0;
  for (const float sun_elevation : {0.2f, 0.7f, 1.2f}) {
    const Daylight day = preethamDaylight(3.0f, directionOf(1.0f, sun_elevation));
    const Harmonics sky = projectSky(*day.sky, 5);
    const double open = levelIlluminance(sky).g / kPi;
    for (const Receiver& receiver :
         {Receiver({0, 1, 0}, 0.0f, 1.1f), Receiver({0, 1, 0}, 0.3f, 1.1f),
          Receiver(side, 0.0f, 1.1f), Receiver(side, 0.0f, 0.5f), Receiver(side, 0.5f, 1.1f)}) {
      double truth = 0.0;
      constexpr int kRows = 400;
      for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < 2 * kRows; ++j) {
          const float y = (static_cast<float>(i) + 0.5f) / kRows, r = std::sqrt(1.0f - y * y);
          const float a = (static_cast<float>(j) + 0.5f) * kPi / kRows;
          const glm::vec3 d(r * std::sin(a), y, r * std::cos(a));
          truth += double{receiver.luminance(d).g} * day.sky->luminance(d).g *
                   (double{kPi} / kRows / kRows);
        }
      const Harmonics seen = projectSky(receiver, 5);
      plain += std::pow((product(seen, sky, 5) - truth) / open, 2.0);
      filtered += std::pow((product(seen, withoutRinging(sky), 5) - truth) / open, 2.0);
      mirrored += std::pow((product(seen, mirroredAtHorizon(sky), 5) - truth) / open, 2.0);
    }
  }
  EXPECT_LT(std::sqrt(mirrored / 15.0), 0.05);
  EXPECT_LT(mirrored, 0.1 * plain);
  EXPECT_LT(mirrored, 0.1 * filtered);
  std::printf("rms error as it is %.3f, with (5.5) %.3f, mirrored %.3f\n", std::sqrt(plain / 15.0),
              std::sqrt(filtered / 15.0), std::sqrt(mirrored / 15.0));
}

class HdrRender : public RenderTest {};

/// Transfer vectors of an unblocked quad whose two sides see `front` and `back` of the upper sky.
PlantTransfer quadTransfer(const Plant& quad, int bands, const glm::vec3& normal) {
  PlantTransfer transfer;
  transfer.bands = bands;
  transfer.bounce_bands = 2;
  const auto pack = [&](const Harmonics& h, int n, float scale, std::size_t points) {
    std::vector<std::uint16_t> halves;
    for (std::size_t v = 0; v < points; ++v)
      for (int i = 0; i < n * n; ++i)
        for (int c = 0; c < 3; ++c)
          halves.push_back(glm::packHalf1x16(h.weights[static_cast<std::size_t>(i)][c] * scale));
    return halves;
  };
  const Harmonics front = projectSky(Receiver(normal, 0.0f, 1.1f), bands);
  const Harmonics back = projectSky(Receiver(-normal, 0.0f, 1.1f), bands);
  const std::size_t count = quad.meshes[0].positions.size();
  transfer.meshes.push_back({pack(front, bands, 1.0f, count), pack(back, bands, 1.0f, count),
                             pack(front, 2, 0.0f, count), pack(back, 2, 0.0f, count)});
  const Harmonics up = projectSky(Receiver({0, 1, 0}, 0.0f, 1.1f), bands);
  transfer.ground = {4,
                     glm::vec2(-2.0f),
                     4.0f / 3.0f,
                     0.0f,
                     {pack(up, bands, 0.25f, 16), {}, pack(up, 2, 0.0f, 16), {}}};
  return transfer;
}

TEST_F(HdrRender, AWhiteFurnaceIsWhite) {
  const Plant quad = whiteQuad();
  const CrownLight light = uniformLight(quad, glm::normalize(glm::vec3(0.3f, 0.5f, 0.8f)), 1.0f);
  setItem(quad, &light);
  View view = quadView();
  view.daylight = {uniformSky(glm::vec3(1.0f), glm::vec3(1.0f)), {}};
  view.background.reset();
  for (const NormalSource normal : {NormalSource::kLeaf, NormalSource::kCrown})
    for (const AmbientSource source : {AmbientSource::kConstant, AmbientSource::kSky,
                                       AmbientSource::kBaked, AmbientSource::kTransfer})
      for (const bool transmission : {false, true}) {
        view.terms.normal = normal;
        view.terms.ambient_source = source;
        view.terms.transmission = view.terms.gloss = transmission;
        const HdrImage image = renderer().render(view).hdr;
        for (int y = 0; y < view.height / 2; ++y)  // above the horizon, quad or sky
          for (int x = 0; x < view.width; ++x) expectPixel(image, x, y, glm::vec3(1.0f));
      }
}

TEST_F(HdrRender, BlackLeavesShowTheirGlossAlone) {
  const Plant quad = whiteQuad(glm::vec4(0, 0, 0, 1));
  const float k_a = 0.6f;
  const CrownLight light = uniformLight(quad, {0, 0, 1}, k_a);
  setItem(quad, &light);
  View view = quadView();
  view.daylight = {uniformSky(glm::vec3(1.0f, 2.0f, 3.0f), glm::vec3(1.0f, 2.0f, 3.0f)), {}};
  view.terms.gloss = true;
  for (const AmbientSource source :
       {AmbientSource::kConstant, AmbientSource::kSky, AmbientSource::kBaked})
    for (const float aside : {0.0f, 3.0f, 9.0f}) {
      view.terms.ambient_source = source;
      view.camera.eye = {aside, 0.0f, 5.0f};
      const float mirrored =
          shared::glossReflected(look::kLeafGlossWidth, -pixelRay(view, 32, 24).z);
      expectPixel(
          renderer().render(view).hdr, 32, 24,
          glm::vec3(1.0f, 2.0f, 3.0f) * mirrored * (source == AmbientSource::kBaked ? k_a : 1.0f),
          2e-3f);
    }
}

TEST_F(HdrRender, TransferVectorsOfOpenLeavesAreTheSkysLight) {
  const glm::vec3 green(0.1f, 0.3f, 0.05f);
  const Plant quad = whiteQuad(glm::vec4(green, 1.0f));
  View view = quadView();
  view.terms = presetTerms("transfer");
  view.terms.diffuse = view.terms.specular = view.terms.shadow = view.terms.gloss = false;
  for (const int bands : {2, 3, 5, 6}) {
    const PlantTransfer transfer = quadTransfer(quad, bands, {0, 0, 1});
    Scene scene = itemScene(quad, nullptr);
    scene.items[0].transfer = &transfer;
    renderer().setScene(scene);
    for (const int sky_bands : {3, 5, 7})
      for (const float azimuth : {0.4f, 3.0f}) {
        view.sky_bands = sky_bands;
        view.daylight = preethamDaylight(3.0f, directionOf(azimuth, 0.6f));
        // The same product on the CPU.
        const Harmonics sky = mirroredAtHorizon(projectSky(*view.daylight.sky, sky_bands));
        glm::vec3 front(0.0f), back(0.0f);
        const auto& vectors = transfer.meshes[0];
        for (std::size_t i = 0; i < static_cast<std::size_t>(bands * bands); ++i)
          for (int c = 0; c < 3; ++c) {
            const std::size_t at = i * 3 + static_cast<std::size_t>(c);
            front[c] += glm::unpackHalf1x16(vectors.front[at]) * sky.weights[i][c];
            back[c] += glm::unpackHalf1x16(vectors.back[at]) * sky.weights[i][c];
          }
        for (const bool behind : {false, true}) {
          view.camera.eye.z = behind ? -5.0f : 5.0f;
          const glm::vec3 near = behind ? back : front, far = behind ? front : back;
          expectPixel(renderer().render(view).hdr, 32, 24,
                      green * near + shared::leafTransmittance(green) * far, 2e-3f);
        }
        view.camera.eye.z = 5.0f;
        if (bands < 5 || sky_bands < 5) continue;
        // And the light that kSky finds without vectors, but for the bands beyond the third.
        const glm::vec3 by_vectors = renderer().render(view).hdr.at(32, 24);
        view.terms.ambient_source = AmbientSource::kSky;
        expectPixel(renderer().render(view).hdr, 32, 24, by_vectors, 0.04f);
        view.terms.ambient_source = AmbientSource::kTransfer;
      }
  }
}

TEST_F(HdrRender, AnEvenSkyIsTheSameByVectorsAndByNormals) {
  const Plant quad = whiteQuad();
  const PlantTransfer transfer = quadTransfer(quad, 5, {0, 0, 1});
  Scene scene = itemScene(quad, nullptr);
  scene.items[0].transfer = &transfer;
  renderer().setScene(scene);
  View view = quadView();
  view.daylight = {uniformSky(glm::vec3(2.0f)), {}};
  view.terms = {.normal = NormalSource::kLeaf};
  for (const AmbientSource source : {AmbientSource::kSky, AmbientSource::kTransfer}) {
    view.terms.ambient_source = source;  // a vertical wall sees half of the sky
    expectPixel(renderer().render(view).hdr, 32, 24, glm::vec3(1.0f), 2e-3f);
  }
}

TEST_F(HdrRender, BouncedVectorsCarryTheSun) {
  // A vector whose bounced part is constant: irradiance / pi = its weight times that of band 0.
  const Plant quad = whiteQuad();
  PlantTransfer transfer = quadTransfer(quad, 3, {0, 0, 1});
  TransferVectors& v = transfer.meshes[0];
  std::fill(v.front_bounced.begin(), v.front_bounced.end(), std::uint16_t{0});
  for (std::size_t i = 0; i < v.front_bounced.size(); i += 12)
    for (std::size_t c = 0; c < 3; ++c) v.front_bounced[i + c] = glm::packHalf1x16(0.25f);
  Scene scene = itemScene(quad, nullptr);
  scene.items[0].transfer = &transfer;
  renderer().setScene(scene);
  View view = quadView();
  view.daylight.sky = nullptr;
  view.terms = presetTerms("transfer");
  view.terms.diffuse = view.terms.specular = view.terms.transmission = view.terms.gloss = false;
  setSun(view, 0.3f, 0.8f, {3.0f, 2.0f, 1.0f});
  // Twice: light from above, mirrored.
  expectPixel(renderer().render(view).hdr, 32, 24,
              2.0f * 0.25f * 0.28209479f * view.daylight.sun.illuminance(), 2e-3f);
}

TEST_F(HdrRender, GroundVectorsShadeTheGround) {
  const Plant quad = whiteQuad();
  const PlantTransfer transfer = quadTransfer(quad, 5, {0, 0, 1});  // a quarter of the open light
  Scene scene = itemScene(quad, nullptr);
  scene.items[0].transfer = &transfer;
  scene.items[0].world_from_plant = {glm::mat4(1), glm::translate(glm::mat4(1), {20, 0, 0})};
  scene.ground = true;
  renderer().setScene(scene);
  View view = quadView();
  view.background.reset();
  view.terms = presetTerms("transfer");
  view.terms.textures = false;
  view.daylight = {uniformSky(glm::vec3(1.0f)), {}};
  for (const glm::vec2 place : {glm::vec2(0, 1), glm::vec2(20, 1), glm::vec2(10, 1)}) {
    view.camera = {{place.x, 3, place.y}, {place.x, 0, place.y + 0.01f}, 0.2f};
    const float share = place.x == 10.0f ? 1.0f : 0.25f;
    const float haze = shared::hazeShare(3.0f, look::kHazeHalfLeast_m);  // of the sky's 1 kcd/m^2
    expectPixel(renderer().render(view).hdr, 32, 24, glm::vec3(glm::mix(0.18f * share, 1.0f, haze)),
                3e-3f);
  }
  scene.items[0].world_from_plant = {glm::rotate(glm::mat4(1), 1.0f, {0, 1, 0})};
  EXPECT_THROW(renderer().setScene(scene), Error);  // vectors know the directions of the world
  scene.items[0].world_from_plant = {glm::mat4(1)};
  PlantTransfer broken = transfer;
  broken.meshes[0].back.pop_back();
  scene.items[0].transfer = &broken;
  EXPECT_THROW(renderer().setScene(scene), Error);
  broken.bands = 9;
  EXPECT_THROW(renderer().setScene(scene), Error);
}

TEST_F(HdrRender, SkyPixelsAreTheModels) {
  renderer().setScene(Scene{.items = {}, .ground = false});
  View view = smallView(96, 64);
  const std::shared_ptr<const Sky> skies[] = {
      preethamDaylight(2.5f, directionOf(0.5f, 0.3f)).sky,
      preethamDaylight(6.0f, directionOf(0.5f, 1.0f)).sky,
      preethamDaylight(3.0f, directionOf(0.5f, -0.1f)).sky,  // twilight
      uniformSky({0.5f, 1.0f, 2.0f})};
  for (const auto& sky : skies) {
    view.daylight.sky = sky;
    view.daylight.sun.luminance = glm::vec3(0.0f);
    for (const float azimuth : {0.5f, 3.0f}) {
      view.camera = {{0, 0, 0}, directionOf(azimuth, 0.5f), 0.9f};
      const Frame frame = renderer().render(view);
      for (int y = 0; y < view.height; y += 3)
        for (int x = 0; x < view.width; x += 3)
          expectPixel(frame.hdr, x, y, sky->luminance(pixelRay(view, x, y)), 1.5e-3f);
    }
  }
}

TEST_F(HdrRender, TheSunsDiskGivesTheSunsIlluminance) {
  renderer().setScene(Scene{.items = {}, .ground = false});
  View view = smallView(96, 72);
  const glm::vec3 to_sun = directionOf(0.7f, 0.5f);
  setSun(view, to_sun, {30.0f, 25.0f, 20.0f});
  view.daylight.sky = uniformSky(glm::vec3(1.0f));
  // From a disk of 50 pixels to one smaller than a pixel.
  for (const float fov : {0.013f, 0.05f, 0.3f, 1.0f})
    for (const float aside : {0.0f, 0.0021f}) {
      view.camera = {{0, 0, 0}, to_sun + aside * glm::vec3(0.3f, 0.5f, -0.2f), fov};
      const HdrImage image = renderer().render(view).hdr;
      glm::dvec3 sum(0.0);
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          // Solid angle of the pixel, and the cosine to the sun.
          const glm::vec3 ray = pixelRay(view, x, y);
          const double c = glm::dot(ray, glm::normalize(view.camera.target));
          const double pixel = 2.0 * std::tan(0.5 * fov) / view.height;
          sum += glm::dvec3(image.at(x, y) - glm::vec3(1.0f)) * (pixel * pixel * c * c * c) *
                 double{glm::dot(ray, to_sun)};
        }
      const glm::vec3 expected = view.daylight.sun.illuminance();
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], expected[c], 0.02 * expected[c]) << "field of view " << fov;
    }
  // Below the horizon there is none.
  view.daylight.sun.direction = directionOf(0.7f, -0.2f);
  view.camera = {{0, 0, 0}, view.daylight.sun.direction, 0.05f};
  for (const glm::vec3& pixel : renderer().render(view).hdr.rgb) EXPECT_LE(pixel.r, 1.001f);
}

TEST_F(HdrRender, ExposureIsTheLogAverage) {
  const Plant quad = whiteQuad();
  setItem(quad, nullptr);
  View view = quadView();
  view.width = 150;  // more than one tile, and parts of tiles
  view.height = 70;
  view.background.reset();
  view.daylight = preethamDaylight(3.0f, directionOf(0.3f, 0.7f));
  const Frame frame = renderer().render(view);
  double sum = 0.0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x)
      sum += std::log(double{luminanceAt(frame.hdr, x, y)} + 1e-9);
  const double average = std::exp(sum / (150.0 * 70.0));
  EXPECT_NEAR(frame.average_luminance, average, 2e-3 * average);
  EXPECT_EQ(renderer().render(view).average_luminance, frame.average_luminance);
  // Background is not of the scene: a furnace's quad alone counts.
  view.background = glm::vec3(1.0f);
  view.daylight = {uniformSky(glm::vec3(3.0f), glm::vec3(3.0f)), {}};
  EXPECT_NEAR(renderer().render(view).average_luminance, 3.0f, 0.01f);
  // A full sun by the meter: EV 15 is 4096 cd/m^2.
  view.exposure.ev = 15.0f;
  EXPECT_NEAR(renderer().render(view).average_luminance, 4.096f, 1e-5f);
}

TEST_F(HdrRender, PicturesAreTheToneMappedLight) {
  renderer().setScene(Scene{.items = {}, .ground = false});
  View view = smallView(96, 64);
  view.daylight = preethamDaylight(4.0f, directionOf(0.5f, 0.6f));
  view.camera = {{0, 0, 0}, directionOf(0.5f, 0.5f), 1.2f};  // with the sun
  view.bloom = 0.0f;
  view.exposure.key = 0.25f;
  for (const bool fixed : {false, true}) {
    if (fixed) view.exposure.ev = 13.0f;
    const Frame frame = renderer().render(view);
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const glm::vec3 shown = shared::toneMapped(
            frame.hdr.at(x, y) * (view.exposure.key / frame.average_luminance), frame.white);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(frame.image.at(x, y)[c], 255.0f * shared::srgbFromLinear(shown[c]), 1.6f)
              << x << " " << y;
      }
  }
}

TEST_F(HdrRender, TheWhitePointFollowsTheBrightSky) {
  const Plant quad = whiteQuad();
  Scene scene = itemScene(quad, nullptr);
  scene.ground = true;
  renderer().setScene(scene);
  View view = quadView();
  view.width = 150;
  view.height = 70;
  view.background.reset();
  view.bloom = 0.0f;
  view.terms.diffuse = view.terms.specular = false;  // what the disk lights is not in question
  float towards_low_sun = 0.0f;
  for (const float elevation : {-0.05f, 0.03f, 0.3f, 1.0f})
    for (const bool facing : {true, false}) {
      view.camera = {{0, 1, 5}, {0, 0.5f, 0}, 1.0f};
      view.daylight = preethamDaylight(3.0f, directionOf(facing ? 3.3f : 0.0f, elevation));
      const Frame frame = renderer().render(view);
      // The same on the CPU; and near the definition, counted without bins.
      EXPECT_NEAR(frame.white,
                  automaticWhite(frame.hdr, frame.average_luminance, view.exposure.key),
                  2e-3f * frame.white);
      std::vector<float> all;
      for (const glm::vec3& c : frame.hdr.rgb) all.push_back(shared::luminanceOf(c));
      std::sort(all.begin(), all.end());
      const float bright = all[all.size() - all.size() / 100 - 1] / frame.average_luminance;
      EXPECT_GE(frame.white, shared::automaticWhite(0.93f * bright * view.exposure.key));
      EXPECT_LE(frame.white, shared::automaticWhite(1.07f * bright * view.exposure.key));
      EXPECT_EQ(renderer().render(view).white, frame.white);
      if (elevation == 1.0f) {
        EXPECT_EQ(frame.white, 2.0f);  // noon
      }
      if (elevation == 0.03f && facing) towards_low_sun = frame.white;
      // The sun's disk is not what it follows.
      View no_disk = view;
      no_disk.daylight.sun.luminance = glm::vec3(0.0f);
      no_disk.exposure.ev = std::log2(frame.average_luminance / 0.125e-3f);
      EXPECT_NEAR(renderer().render(no_disk).white, frame.white, 0.05f * frame.white) << elevation;
    }
  EXPECT_GT(towards_low_sun, 2.5f);
  setItem(quad, nullptr);
  // Background is not of the scene, and a given white point is the given one.
  view.background = glm::vec3(1.0f);
  view.daylight = {uniformSky(glm::vec3(3.0f), glm::vec3(3.0f)), {}};
  view.terms = {.diffuse = false, .specular = false, .shadow = false};
  view.exposure = {.ev = std::log2(1.0f / 0.125e-3f), .key = 1.0f, .white = {}};  // the quad: 3
  EXPECT_NEAR(renderer().render(view).white, shared::automaticWhite(3.0f), 1.0f);
  view.exposure.white = 7.5f;
  EXPECT_EQ(renderer().render(view).white, 7.5f);
}

TEST_F(HdrRender, BrightSkyDoesNotEatLeaves) {
  // A dark card half over a pixel before a bright sky: the display's light is averaged, so that the
  // pixel is about half as bright as the sky, not white.
  const Plant quad = whiteQuad(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  setItem(quad, nullptr);
  View view = quadView();
  view.background.reset();
  view.terms.specular = false;
  view.daylight = {uniformSky(glm::vec3(1.0f)), {}};
  view.exposure = {.ev = 3.0f, .key = 0.18f, .white = 2.0f};  // 0.001 kcd/m^2: the sky is far over
  view.bloom = 0.0f;
  // The quad's right edge, x = 1, through the middle of a column.
  const float pixel = 2.0f * std::tan(0.15f) * 5.0f / 48.0f;
  view.camera.eye.x = view.camera.target.x = 1.0f - 0.5f * pixel;
  const Frame frame = renderer().render(view);
  EXPECT_NEAR(frame.hdr.at(32, 20).g, 0.5f, 0.26f);
  const float edge = shared::linearFromSrgb(static_cast<float>(frame.image.at(32, 20)[1]) / 255.0f);
  EXPECT_NEAR(edge, frame.hdr.at(32, 20).g, 0.02f);  // the share that the sky covers, of white
  EXPECT_EQ(frame.image.at(31, 20)[1], 0);
  EXPECT_EQ(frame.image.at(33, 20)[1], 255);
}

TEST_F(HdrRender, BloomSpreadsLightAndKeepsIt) {
  // A small bright card before black: light around it, the same light in all.
  const Plant quad = whiteQuad();
  Scene scene = itemScene(quad, nullptr);
  scene.items[0].world_from_plant = {glm::scale(glm::mat4(1), glm::vec3(0.2f))};
  renderer().setScene(scene);
  View view = quadView();
  view.width = view.height = 128;
  view.camera = {{0, 0, 5}, {0, 0, 0}, 0.4f};
  view.background.reset();
  view.terms = {.normal = NormalSource::kLeaf, .ambient = false, .specular = false};
  view.daylight = {nullptr, {}};
  setSun(view, 0.0f, 0.1f, glm::vec3(1.0f));  // behind the camera
  view.exposure = {.ev = std::log2(1.0f / 0.125e-3f), .key = 0.05f, .white = 1e4f};  // near linear
  const auto total = [&](float bloom, float* halo) {
    view.bloom = bloom;
    const Image image = renderer().render(view).image;
    double sum = 0.0;
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x)
        sum += shared::linearFromSrgb(static_cast<float>(image.at(x, y)[1]) / 255.0f);
    *halo = static_cast<float>(image.at(64 + 14, 64)[1]);
    return sum;
  };
  float none = 0.0f, some = 0.0f;
  const double before = total(0.0f, &none), after = total(0.4f, &some);
  EXPECT_EQ(none, 0.0f);
  EXPECT_GT(some, 1.0f);
  EXPECT_NEAR(after / before, 1.0, 0.1);  // what leaves the picture's edge comes back in
}

TEST_F(HdrRender, NightFallsWithoutNonsense) {
  const Plant tree = ballTree(60, 0.5f, true);
  const CrownLight light = ballTreeLight(tree);
  Scene scene = itemScene(tree, &light);
  scene.ground = true;
  renderer().setScene(scene);
  View view = smallView(64, 48);
  view.camera = automaticCamera(scene, 0.3f, 0.1f, 4.0f / 3.0f);
  float before = 1e9f;
  for (const float elevation : {0.5f, 0.1f, 0.0f, -0.004f, -0.1f, -0.2f, -0.4f, -1.5f}) {
    view.daylight = preethamDaylight(3.0f, directionOf(0.5f, elevation));
    const Frame frame = renderer().render(view);
    for (const glm::vec3& pixel : frame.hdr.rgb)
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(pixel[c])) << elevation;
        ASSERT_GE(pixel[c], 0.0f);
      }
    EXPECT_LE(frame.average_luminance, before) << elevation;
    before = frame.average_luminance;
  }
}

/// Looks over open ground from `height`, the horizon a third of a field of view above the middle.
View horizonView(float height, float azimuth, float fov) {
  View view = smallView(32, 120);
  view.bloom = 0.0f;
  view.terms = presetTerms("standard");
  const glm::vec3 eye(0.0f, height, 0.0f);
  view.camera = {eye, eye + 15.0f * directionOf(azimuth, -0.113f * fov), fov};
  return view;
}

TEST_F(HdrRender, NoRowStandsOutAlongTheHorizon) {
  renderer().setScene(Scene{.items = {}, .ground = true});
  for (const float fov : {0.02f, 0.2f, 0.6f, 1.2f})
    for (const float sun : {-0.02f, 0.005f, 0.1f, 0.9f})
      for (const float height : {0.3f, 1.7f, 20.0f})
        for (const float azimuth : {0.36f, 1.8f, 3.4f}) {  // towards the sun, aside, away from it
          View view = horizonView(height, azimuth, fov);
          view.terms.textures = false;
          view.daylight = preethamDaylight(3.0f, directionOf(0.3f, sun));
          view.daylight.sun.luminance = glm::vec3(0.0f);
          const HdrImage image = renderer().render(view).hdr;
          const float pixel = 2.0f * std::tan(0.5f * fov) / static_cast<float>(view.height);
          for (const int x : {2, 20})
            for (int y = 1; y + 1 < view.height; ++y) {
              if (std::abs(pixelRay(view, x, y).y) > 4.0f * pixel) continue;
              const float above = luminanceAt(image, x, y - 1), here = luminanceAt(image, x, y),
                          below = luminanceAt(image, x, y + 1);
              EXPECT_LE(here, 1.03f * std::max(above, below));
              EXPECT_GE(here, 0.97f * std::min(above, below))
                  << "row " << y << ", column " << x << ", field of view " << fov << ", sun " << sun
                  << ", eye " << height << " m, azimuth " << azimuth;
            }
        }
}

TEST_F(HdrRender, TheHorizonIsTheReferences) {
  Scene scene{.items = {}, .ground = true};
  renderer().setScene(scene);
  // A sky that falls steeply around a sun on the horizon, through a long lens.
  View view = horizonView(1.7f, 0.3f, 0.02f);
  view.daylight = {cieSky(15, directionOf(0.3f, 0.002f)), {}};
  ReferenceOptions options;
  options.width = view.width;
  options.height = view.height;
  options.camera = view.camera;
  options.samples = 64;
  const HdrImage frame = renderer().render(view).hdr;
  const HdrImage truth = renderReference(scene, view.daylight, options).image;
  for (int y = 0; y < view.height; ++y) {
    const float height = pixelRay(view, 16, y).y;
    if (height < -0.002f) break;  // the grass is seen, and the path tracer's noise
    const bool sky = height > 2e-4f;
    for (const int x : {2, 16, 30}) expectPixel(frame, x, y, truth.at(x, y), sky ? 0.002f : 0.02f);
  }
}

}  // namespace
}  // namespace verdure
