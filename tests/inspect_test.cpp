#include "render/inspect_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/frame.h"
#include "render_fixture.h"

namespace verdure {
namespace {

using namespace test;

/// The pixel in the middle of a picture of a 2 m quad, as the display's values.
class Inspect : public ::testing::Test {
 protected:
  glm::vec3 middle(const Scene& scene, Inspection what, float distance = 6.0f,
                   NormalSource normals = NormalSource::kCrown) {
    View view;
    view.width = view.height = 64;
    view.camera = {{0, 0, distance}, {0, 0, 0}, 0.5f};
    view.shadow_map_size = 64;
    view.terms.normal = normals;
    GpuScene packed(device_, packScene(scene), drawer_.sceneLayouts());
    drawer_.forgetScene();
    drawer_.inspect(what);
    const Image image = drawer_.draw(packed, inspectedView(view, what)).image;
    const std::uint8_t* texel = image.at(32, 32);
    EXPECT_EQ(device_.validationMessages(), 0);
    return glm::vec3(texel[0], texel[1], texel[2]);
  }
  void expectNear(const glm::vec3& seen, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen[i], 255.0f * expected[i], 1.01f) << i;
  }

  gpu::Device device_{"", true};
  FrameDrawer drawer_{device_};
};

TEST_F(Inspect, ShowsCoefficientsAndNormalsAsTheyAre) {
  const Plant plant = whiteQuad();
  for (const float k : {0.05f, 0.25f, 0.5f, 1.0f}) {
    const glm::vec3 n = glm::normalize(glm::vec3(0.3f, 0.8f, -0.4f));
    const CrownLight light = uniformLight(plant, n, k);
    Scene scene = itemScene(plant, &light);
    scene.ground = false;
    expectNear(middle(scene, Inspection::kCoefficient), glm::vec3(k));
    expectNear(middle(scene, Inspection::kNormals), 0.5f + 0.5f * n);
  }
}

TEST_F(Inspect, TurnsLeafNormalsToTheEyeButNotCrownNormals) {
  const Plant plant = whiteQuad();  // faces +Z
  const CrownLight light = uniformLight(plant, {0, 0, 1}, 1.0f);
  Scene scene = itemScene(plant, &light);
  scene.ground = false;
  expectNear(middle(scene, Inspection::kNormals, 6.0f, NormalSource::kLeaf), {0.5f, 0.5f, 1.0f});
  expectNear(middle(scene, Inspection::kNormals, -6.0f, NormalSource::kLeaf), {0.5f, 0.5f, 0.0f});
  expectNear(middle(scene, Inspection::kNormals, -6.0f, NormalSource::kCrown), {0.5f, 0.5f, 1.0f});
}

TEST_F(Inspect, ShowsTheBaseColourUnlit) {
  const glm::vec3 linear(0.5f, 0.1f, 0.02f);
  const Plant plant = whiteQuad(glm::vec4(linear, 1.0f));
  Scene scene = itemScene(plant, nullptr);
  scene.ground = false;
  glm::vec3 expected;
  for (int i = 0; i < 3; ++i) expected[i] = shared::srgbFromLinear(linear[i]);
  expectNear(middle(scene, Inspection::kColor), expected);
}

TEST_F(Inspect, TellsTexelsAPixel) {
  // 2 m of quad take `pixels` pixels: white where they are as many as the texture's texels.
  Plant plant = whiteQuad();
  const float distance = 6.0f;
  const float pixels = 64.0f * 2.0f / (2.0f * distance * std::tan(0.25f));
  const auto seen = [&](float share) {
    const int size = static_cast<int>(std::lround(share * pixels));
    Image image(size, size);
    image.rgba.assign(image.rgba.size(), 255);
    plant.textures = {{"even", image, true, true}};
    plant.materials[0].base_color_texture = 0;
    Scene scene = itemScene(plant, nullptr);
    scene.ground = false;
    return middle(scene, Inspection::kTexels, distance);
  };
  const glm::vec3 even = seen(1.0f), many = seen(6.0f), few = seen(1.0f / 6.0f);
  EXPECT_GT(std::min({even.x, even.y, even.z}), 225.0f);
  EXPECT_GT(many.x, 180.0f);
  EXPECT_LT(many.y, 60.0f);
  EXPECT_GT(few.z, 180.0f);
  EXPECT_LT(few.x, 60.0f);
}

TEST_F(Inspect, CountsLeavesBeforeTheSun) {
  // Three cards over each other under a sun in the zenith; the lowest is seen from the side.
  Plant plant = horizontalCard(0.0f, 2.0f);
  const Plant upper = horizontalCard(1.5f, 2.0f), highest = horizontalCard(2.0f, 2.0f);
  Scene one = itemScene(plant, nullptr), three = one;
  three.items.push_back({&upper, nullptr});
  three.items.push_back({&highest, nullptr});
  one.ground = three.ground = false;
  const auto seen = [&](const Scene& scene) {
    View view;
    view.width = view.height = 64;
    view.camera = {{0, 0.6f, 5}, {0, 0, 0}, 0.4f};
    view.daylight = preethamDaylight(3.0f, {0, 1, 0});
    view.shadow_map_size = 256;
    GpuScene packed(device_, packScene(scene), drawer_.sceneLayouts());
    drawer_.forgetScene();
    drawer_.inspect(Inspection::kLayers);
    const Image image = drawer_.draw(packed, inspectedView(view, Inspection::kLayers)).image;
    return glm::vec3(image.at(32, 32)[0], image.at(32, 32)[1], image.at(32, 32)[2]);
  };
  // More layers: from blue towards white.
  const glm::vec3 alone = seen(one), below = seen(three);
  EXPECT_GT(below.x, alone.x + 20.0f);
  EXPECT_GT(alone.z, alone.x);
}

}  // namespace
}  // namespace verdure
