#include <gtest/gtest.h>

#include "render/cascades.h"
#include "render/mipmaps.h"
#include "render_fixture.h"
#include "scene/ground_texture.h"
#include "shared/density.h"
#include "shared/sky.h"

// The parts of the renderer that need no device.

namespace verdure {
namespace {

using namespace test;

constexpr float kSharp = std::numeric_limits<float>::infinity();

TEST(Mipmaps, KeepTheCoverageOfAlphaCutTextures) {
  const Image image = leafImage(128);
  const MipChain chain = buildColorMips(image, 0.5f);
  ASSERT_EQ(chain.levels.size(), 8u);
  EXPECT_EQ(chain.levels[0].rgba.size(), image.rgba.size());
  const double truth = alphaCoverage(chain.levels[0], 0.5f, kSharp);
  for (const gpu::MipLevel& level : chain.levels)
    EXPECT_NEAR(alphaCoverage(level, 0.5f, kCoverageSlope), truth, 0.02) << level.width;
}

TEST(Mipmaps, ThinThingsDoNotVanish) {
  // Needles: one opaque column in sixteen. A plain box filter loses them at the second level.
  Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; x += 16) image.at(x, y)[3] = 255;
  const MipChain chain = buildColorMips(image, 0.5f);
  const double truth = alphaCoverage(chain.levels[0], 0.5f, kSharp);
  EXPECT_GT(truth, 0.05);
  for (const gpu::MipLevel& level : chain.levels)
    EXPECT_NEAR(alphaCoverage(level, 0.5f, kCoverageSlope), truth, 0.03) << level.width;
}

TEST(Mipmaps, CoverageIsThatOfWhatTheMeshReads) {
  // A thin opaque leaf, one texel in sixteen, and a mesh that hugs it: however far away, nothing of
  // it may become transparent, although the texture as a whole nearly is.
  Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 30; x < 34; ++x) image.at(x, y)[3] = 255;
  Mesh mesh;
  mesh.uvs = {{30 / 64.0f, 0}, {34 / 64.0f, 0}, {34 / 64.0f, 1}, {30 / 64.0f, 1}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  UsedTexels used;
  used.add(mesh);
  EXPECT_TRUE(used.at(0.5f, 0.5f));
  EXPECT_FALSE(used.at(0.25f, 0.5f));
  const MipChain chain = buildColorMips(image, 0.5f, used);
  for (const gpu::MipLevel& level : chain.levels)
    EXPECT_GT(alphaCoverage(level, 0.5f, kCoverageSlope, 1.0f, used), 0.9) << level.width;
}

TEST(Mipmaps, HaveNoHalo) {
  // The leaf image is magenta where it is transparent: no level may show it.
  const MipChain chain = buildColorMips(leafImage(128), 0.5f);
  for (const gpu::MipLevel& level : chain.levels)
    for (std::size_t i = 0; i < level.rgba.size(); i += 4)
      if (level.width < 128 || level.rgba[i + 3] == 0) {
        ASSERT_GT(level.rgba[i + 1], level.rgba[i]) << level.width;
      }
  EXPECT_GT(chain.mean_color.y, chain.mean_color.x);
}

TEST(Mipmaps, AverageLinearLightOfAnySize) {
  // Black and white columns average to half the light, sRGB 188, not 128.
  Image image(6, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 6; ++x)
      for (int c = 0; c < 4; ++c) image.at(x, y)[c] = c == 3 || x % 2 == 0 ? 255 : 0;
  const MipChain chain = buildColorMips(image, {});
  EXPECT_EQ(chain.levels[1].width, 3u);
  EXPECT_EQ(chain.levels[1].height, 1u);
  EXPECT_EQ(chain.levels.back().width, 1u);
  for (const gpu::MipLevel& level : chain.levels)
    if (level.width < 6) {
      EXPECT_EQ(level.rgba[0], 188);
    }
  EXPECT_NEAR(chain.mean_color.x, 0.5f, 1e-5f);
  EXPECT_EQ(buildLinearMips(image).levels[1].rgba[0], 128);
}

TEST(Packing, KeepsNormalsAndCoefficients) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 n = glm::normalize(
        glm::vec3(random.vary(1.0f), random.vary(1.0f), random.vary(1.0f)) + glm::vec3(1e-3f));
    const float k = std::max(random.uniform(), 1.0f / 255.0f);
    const PackedNormal packed = packNormal(n, k);
    const glm::vec3 back = glm::vec3(packed[0], packed[1], packed[2]) / 32767.0f;
    const glm::vec4 decoded = shared::decodeNormal(back);
    EXPECT_NEAR(decoded.w, k, 5e-5f);
    // Half a step of 1/32767 at length k.
    EXPECT_LT(glm::length(glm::vec3(decoded) - n), 3e-5f / k + 1e-6f);
  }
}

TEST(Packing, BakedLightAddsNoBytesToAVertex) {
  const Plant tree = ballTree(20);
  const CrownLight light = ballTreeLight(tree);
  const PackedScene plain = packScene(itemScene(tree, nullptr));
  const PackedScene baked = packScene(itemScene(tree, &light));
  EXPECT_EQ(sizeof(PackedNormal), 8u);
  EXPECT_EQ(baked.crown_normals.size(), baked.positions.size());
  EXPECT_EQ(plain.leaf_normals.size(), plain.positions.size());
  EXPECT_TRUE(plain.crown_normals.empty());
  EXPECT_EQ(plain.textures.size(), baked.textures.size());
}

TEST(Ground, TextureHasTheStatedMeanAndNoSeam) {
  const Image image = makeGroundTexture(256);
  const glm::vec3 mean = buildColorMips(image, {}).mean_color;
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean[c], shared::groundMeanColor()[c], 0.03f * shared::groundMeanColor()[c]);
  // Across the seam neighbours differ no more than elsewhere.
  for (const Image& tile : {image, makeGroundNoise(128)}) {
    double seam = 0.0, inner = 0.0;
    for (int y = 0; y < tile.height; ++y) {
      seam += std::abs(int{tile.at(0, y)[1]} - int{tile.at(tile.width - 1, y)[1]});
      inner +=
          std::abs(int{tile.at(tile.width / 2, y)[1]} - int{tile.at(tile.width / 2 - 1, y)[1]});
    }
    EXPECT_LT(seam, 1.5 * inner + 64.0);
  }
}

TEST(Shadow, FitCoversTheBoundsWithSquareTexels) {
  const Bounds box{{-2, 0, -1}, {3, 6, 4}};
  for (const float elevation : {0.05f, 0.8f, 1.5707963f}) {
    const glm::vec3 to_sun = directionOf(1.1f, elevation);
    const ShadowFit fit = fitShadow(box, to_sun, 512);
    glm::vec3 low(2.0f), high(-2.0f);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec4 p((corner & 1) != 0 ? box.max.x : box.min.x,
                        (corner & 2) != 0 ? box.max.y : box.min.y,
                        (corner & 4) != 0 ? box.max.z : box.min.z, 1.0f);
      const glm::vec3 q(fit.shadow_from_world * p);
      low = glm::min(low, q);
      high = glm::max(high, q);
    }
    EXPECT_GE(std::min({low.x, low.y, low.z}), 0.0f);
    EXPECT_LE(std::max({high.x, high.y, high.z}), 1.0f);
    EXPECT_GT(std::max(high.x - low.x, high.y - low.y), 0.95f);  // not wasteful
    // A step of one texel's size aside moves by one texel; one towards the sun comes nearer to it.
    const glm::vec3 aside = glm::normalize(glm::cross(to_sun, glm::vec3(0.3f, 0.2f, 0.9f)));
    const glm::vec3 moved(fit.shadow_from_world * glm::vec4(aside * fit.texel_m, 0.0f));
    EXPECT_NEAR(glm::length(glm::vec2(moved)) * 512.0f, 1.0f, 1e-3f);
    EXPECT_LT((fit.shadow_from_world * glm::vec4(to_sun, 0.0f)).z, 0.0f);
  }
}

TEST(AutomaticCamera, ShowsAllOfPlantsOfAnySize) {
  for (const float scale : {0.06f, 1.0f, 20.0f})
    for (const float azimuth : {0.0f, 2.1f})
      for (const float elevation : {0.0f, 0.5f}) {
        const Plant tree = ballTree(200);
        Scene scene = itemScene(tree, nullptr);
        glm::mat4 placed(scale);
        placed[3] = glm::vec4(7, -3, 2, 1);
        scene.items[0].world_from_plant = {placed};
        const float aspect = 1.5f;
        const Camera camera = automaticCamera(scene, azimuth, elevation, aspect);
        shared::FrameUniforms u{};
        u.clip_from_world = clipFromWorld(camera, aspect);
        float reach = 0.0f, low = 1e9f, high = -1e9f;
        for (const Mesh& mesh : tree.meshes)
          for (const glm::vec3& p : mesh.positions) {
            const glm::vec3 world(placed * glm::vec4(p, 1.0f));
            const glm::vec4 clip = u.clip_from_world * glm::vec4(world, 1.0f);
            ASSERT_GT(clip.w, 0.0f);
            reach = std::max({reach, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
            low = std::min(low, world.y);
            high = std::max(high, world.y);
          }
        EXPECT_LE(reach, 0.99f);
        EXPECT_GE(reach, 0.8f);
        if (elevation == 0.0f) {
          EXPECT_LE(camera.eye.y - low, (high - low) / 3.0f * 1.02f);
          EXPECT_GE(camera.eye.y - low, std::min(1.7f, (high - low) / 3.0f) * 0.98f);
        }
        const glm::vec3 aside = camera.eye - glm::vec3(7, camera.eye.y, 2);
        EXPECT_NEAR(std::atan2(aside.x, aside.z), azimuth, 0.1f);
      }
}

}  // namespace
}  // namespace verdure
