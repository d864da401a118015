#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "render_fixture.h"
#include "scene/display.h"
#include "shared/sky.h"
#include "verdure/reference.h"

// The sky as it is seen, and the way of its light to the display.

namespace verdure {
namespace {

using namespace test;

constexpr float kPi = glm::pi<float>();

class SkyRender : public RenderTest {};

TEST_F(SkyRender, SkyPixelsAreTheModels) {
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

TEST_F(SkyRender, TheSunsDiskGivesTheSunsIlluminance) {
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

TEST_F(SkyRender, ExposureIsTheLogAverage) {
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

TEST_F(SkyRender, PicturesAreTheToneMappedLight) {
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

TEST_F(SkyRender, TheWhitePointFollowsTheBrightSky) {
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

TEST_F(SkyRender, BrightSkyDoesNotEatLeaves) {
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

TEST_F(SkyRender, BloomSpreadsLightAndKeepsIt) {
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

TEST_F(SkyRender, NightFallsWithoutNonsense) {
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

TEST_F(SkyRender, NoRowStandsOutAlongTheHorizon) {
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

TEST_F(SkyRender, TheHorizonIsTheReferences) {
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
