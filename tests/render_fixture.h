#ifndef VERDURE_TESTS_RENDER_FIXTURE_H_
#define VERDURE_TESTS_RENDER_FIXTURE_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <memory>

#include "render/look.h"
#include "render/scene.h"
#include "scene/camera.h"
#include "shared/color.h"
#include "shared/gloss.h"
#include "shared/illumination.h"
#include "shared/tone.h"
#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/render.h"

/// What the renderer's tests share: plants of one surface, a view of them, expected colours.
namespace verdure::test {

/// A 2 m x 2 m foliage quad in z = 0 that faces +Z, without textures.
inline Plant whiteQuad(const glm::vec4& color = glm::vec4(1.0f)) {
  Plant plant;
  plant.name = "quad";
  Material material;
  material.base_color = color;
  plant.materials = {material};
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  addQuad(mesh, {0, -1, 0}, {2, 0, 0}, {0, 2, 0});
  plant.meshes = {mesh};
  return plant;
}

/// A card of side `side` at y = `height`, facing up.
inline Plant horizontalCard(float height, float side) {
  Plant plant = whiteQuad();
  plant.meshes[0] = {};
  plant.meshes[0].kind = PartKind::kFoliage;
  addQuad(plant.meshes[0], {0, height, 0.5f * side}, {side, 0, 0}, {0, 0, -side});
  return plant;
}

inline Plant standingTube(float radius, float low, float high) {
  Plant plant = whiteQuad();
  plant.meshes[0] = {};
  addTube(plant.meshes[0], {0, low, 0}, {0, high, 0}, radius, radius, 64);
  return plant;
}

/// A 1 m card in z = 0 with the test leaf's alpha and white colour.
inline Plant leafCard() {
  Plant plant = whiteQuad();
  Image image = leafImage(128);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) image.rgba[i] = 255;
  plant.textures = {{"leaf", image, true, true}};
  plant.materials[0].base_color_texture = 0;
  plant.materials[0].alpha_mode = AlphaMode::kMask;
  plant.meshes[0] = {};
  plant.meshes[0].kind = PartKind::kFoliage;
  addQuad(plant.meshes[0], {0, -0.5f, 0}, {1, 0, 0}, {0, 1, 0});
  return plant;
}

inline CrownLight uniformLight(const Plant& plant, const glm::vec3& normal, float ambient) {
  CrownLight light;
  for (const Mesh& mesh : plant.meshes)
    light.meshes.push_back({std::vector<glm::vec3>(mesh.positions.size(), normal),
                            std::vector<float>(mesh.positions.size(), ambient)});
  return light;
}

inline Scene itemScene(const Plant& plant, const CrownLight* light) {
  Scene scene;
  scene.items.push_back({&plant, light});
  scene.ground = false;
  return scene;
}

/// The sun in a direction, with irradiance / pi `light` on what faces it.
inline void setSun(View& view, const glm::vec3& direction, const glm::vec3& light) {
  Sun& sun = view.daylight.sun;
  sun.direction = direction;
  sun.luminance = light / std::pow(std::sin(sun.angular_radius), 2.0f);
}
inline void setSun(View& view, float azimuth, float elevation, const glm::vec3& light) {
  setSun(view, directionOf(azimuth, elevation), light);
}
inline void turnSun(View& view, float azimuth, float elevation) {
  view.daylight.sun.direction = directionOf(azimuth, elevation);
}

/// Irradiance / pi of a surface that faces the sun.
inline glm::vec3 sunLight(const View& view) {
  return view.daylight.sun.illuminance() / glm::pi<float>();
}

/// The same luminance from all directions, also from below: irradiance / pi everywhere.
inline void setFurnace(View& view, const glm::vec3& luminance) {
  view.daylight.sky = uniformSky(luminance, luminance);
}

/// The default day.
inline View smallView(int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.shadow_map_size = 256;
  view.hdr = true;
  return view;
}

/// Looks at whiteQuad(), which fills the middle, in the light of a sun and a dim furnace.
inline View quadView() {
  View view = smallView(64, 48);
  view.camera = {{0, 0, 5}, {0, 0, 0}, 0.3f};
  setSun(view, 0.9f, 0.75f, {0.9f, 0.8f, 0.6f});
  setFurnace(view, {0.1f, 0.2f, 0.3f});
  view.background = glm::vec3(0.0f);
  return view;
}

/// How many pixels differ by more than `levels` of 255.
inline int differing(const Image& a, const Image& b, int levels) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    count += most > levels ? 1 : 0;
  }
  return count;
}

/// Direction through the centre of a pixel.
inline glm::vec3 pixelRay(const View& view, int x, int y) {
  const glm::vec3 forward = glm::normalize(view.camera.target - view.camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward);
  const float tan_half = std::tan(0.5f * view.camera.vertical_fov);
  const float h = static_cast<float>(view.height), w = static_cast<float>(view.width);
  const float right_by = (2.0f * (static_cast<float>(x) + 0.5f) - w) / h * tan_half;
  const float up_by = (h - 2.0f * (static_cast<float>(y) + 0.5f)) / h * tan_half;
  return glm::normalize(forward + right * right_by + up * up_by);
}

inline glm::ivec2 pixelOf(const View& view, const glm::vec3& point) {
  const glm::vec3 forward = glm::normalize(view.camera.target - view.camera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward);
  const glm::vec3 d = point - view.camera.eye;
  const float scale = 0.5f * static_cast<float>(view.height) /
                      std::tan(0.5f * view.camera.vertical_fov) / glm::dot(d, forward);
  return {static_cast<int>(0.5f * static_cast<float>(view.width) + glm::dot(d, right) * scale),
          static_cast<int>(0.5f * static_cast<float>(view.height) - glm::dot(d, up) * scale)};
}

/// (1) with the renderer's coefficients for foliage in a furnace, from the shared formula.
inline glm::vec3 expectedLeafColor(const View& view, const glm::vec3& color, float k,
                                   const glm::vec3& normal, const glm::vec3& point) {
  const glm::vec3 l = view.daylight.sun.direction;
  const glm::vec3 v = glm::normalize(view.camera.eye - point);
  return shared::illumination(
      view.daylight.sky->luminance({0, 1, 0}) * color * k, sunLight(view), glm::vec3(1.0f),
      color * shared::diffuseFactor(normal, l),
      shared::highlightStrength(shared::glossWidth(true), 0.04f),
      shared::specularFactor(normal, l, v, shared::highlightExponent(true)));
}

/// kcd/m^2, to the precision of half floats.
inline void expectPixel(const HdrImage& image, int x, int y, const glm::vec3& luminance,
                        float relative = 1e-3f) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(image.at(x, y)[c], luminance[c], relative * luminance[c] + 1e-6f)
        << "pixel " << x << ", " << y << ", channel " << c;
}

/// Luminance, kcd/m^2.
inline float luminanceAt(const HdrImage& image, int x, int y) {
  return shared::luminanceOf(image.at(x, y));
}

/// Pixels that differ by more than `most` (a share) in luminance.
inline int countDifferent(const HdrImage& a, const HdrImage& b, float most) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      count += std::abs(luminanceAt(a, x, y) - luminanceAt(b, x, y)) >
                       most * std::max(luminanceAt(a, x, y), luminanceAt(b, x, y))
                   ? 1
                   : 0;
  return count;
}

/// One renderer with the validation layer for all tests of the process; each test must leave the
/// layer silent.
class RenderTest : public testing::Test {
 protected:
  static Renderer& renderer() {
    static Renderer instance({.device = "", .validation = true});
    return instance;
  }
  void TearDown() override { EXPECT_EQ(renderer().validationMessages(), 0); }

  static void setItem(const Plant& plant, const CrownLight* light) {
    renderer().setScene(itemScene(plant, light));
  }
  static void expectCenter(const View& view, const glm::vec3& luminance) {
    expectPixel(renderer().render(view).hdr, view.width / 2, view.height / 2, luminance);
  }
};

}  // namespace verdure::test

#endif  // VERDURE_TESTS_RENDER_FIXTURE_H_
