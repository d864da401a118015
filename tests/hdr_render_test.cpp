#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "render/frame_light.h"
#include "render/packed_transfer.h"
#include "render_fixture.h"
#include "scene/display.h"
#include "shared/leaf.h"
#include "shared/sky.h"

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
          shared::glossReflected(shared::glossWidth(true), 0.04f, -pixelRay(view, 32, 24).z);
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

}  // namespace
}  // namespace verdure
