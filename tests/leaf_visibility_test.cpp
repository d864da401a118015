// How much of leaf faces is seen, against cases that are known and against the paper's own method:
// pictures along each direction in which every pixel knows the nearest leaf.
#include "verdure/leaf_visibility.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <map>

#include "base/parallel.h"
#include "crowns.h"
#include "rays/ray_scene.h"
#include "verdure/error.h"
#include "verdure/grow.h"

namespace verdure {
namespace {

/// Horizontal squares of given heights and half sides, each a leaf, fronts up.
Plant stack(const std::vector<std::pair<float, float>>& squares) {
  Plant plant;
  plant.name = "stack";
  plant.materials = {Material{.name = "leaf", .double_sided = true}};
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  for (const auto& [height, half] : squares) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec2 at : {glm::vec2(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
      mesh.positions.push_back({half * at.x, height, half * at.y});
      mesh.normals.push_back({0, 1, 0});
    }
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    const auto t = static_cast<std::uint32_t>(plant.leaf_triangles.size());
    plant.leaves.push_back({0, t, 2, kNone, {0, height, 0}, 4 * half * half, {0, height, 0}});
    plant.leaf_triangles.insert(plant.leaf_triangles.end(), {t, t + 1});
  }
  plant.meshes.push_back(std::move(mesh));
  return plant;
}

LeafVisibilityOptions looks(int directions, int rays) {
  LeafVisibilityOptions options;
  options.directions = directions;
  options.rays = rays;
  return options;
}

TEST(LeafVisibility, ALoneLeafIsSeenFromBothSides) {
  for (const int directions : {6, 7, 64})
    EXPECT_EQ(leafVisibility(stack({{1.0f, 0.1f}}), looks(directions, 128))[0], glm::vec2(1.0f));
}

TEST(LeafVisibility, BetweenTwoLargeLeavesNothingIsSeen) {
  const auto seen = leafVisibility(stack({{0, 0.1f}, {0.05f, 10}, {-0.05f, 10}}), looks(6, 256));
  EXPECT_EQ(seen[0], glm::vec2(0.0f));
  // They hide each other as well: of their inner sides only the edges see out.
  EXPECT_EQ(seen[1], glm::vec2(1.0f, 0.0f));
  EXPECT_EQ(seen[2], glm::vec2(0.0f, 1.0f));
}

TEST(LeafVisibility, ALeafOverHalfOfAnotherHidesHalfOfIt) {
  // From above and below along the axes: a square over a quarter of the lower one.
  const auto seen = leafVisibility(stack({{0, 1}, {0.5f, 0.5f}}), looks(6, 60000));
  EXPECT_NEAR(seen[0].x, 0.75f, 0.01f);
  EXPECT_EQ(seen[0].y, 1.0f);
  EXPECT_EQ(seen[1].x, 1.0f);
  EXPECT_EQ(seen[1].y, 0.0f);
}

/// The paper's: orthographic pictures of `size`^2 pixels along the axes, of all and of each leaf
/// alone.
std::vector<glm::vec2> byPictures(const Plant& plant, int size) {
  const RayScene all(plant);
  std::vector<std::vector<double>> seen(plant.leaves.size(), {0.0, 0.0}), alone = seen;
  const Bounds box = bounds(plant);
  const float half = 0.51f * glm::length(box.size());
  std::vector<std::uint32_t> leaf_of(plant.meshes[1].triangleCount());
  for (std::uint32_t l = 0; l < plant.leaves.size(); ++l)
    for (std::uint32_t t = 0; t < plant.leaves[l].triangle_count; ++t)
      leaf_of[plant.leaf_triangles[plant.leaves[l].first_triangle + t]] = l;
  const auto draw = [&](const RayScene& scene, std::uint32_t only,
                        std::vector<std::vector<double>>& counts) {
    for (int axis = 0; axis < 3; ++axis)
      for (const float sign : {1.0f, -1.0f})
        for (int y = 0; y < size; ++y)
          for (int x = 0; x < size; ++x) {
            const glm::vec2 at =
                (glm::vec2(x, y) + 0.5f) / static_cast<float>(size) * 2.0f * half - half;
            Ray ray;
            ray.origin = ray.direction = glm::vec3(0.0f);
            ray.direction[axis] = -sign;
            ray.origin[axis] = sign * half;
            ray.origin[(axis + 1) % 3] = at.x;
            ray.origin[(axis + 2) % 3] = at.y;
            ray.origin += box.center();
            const auto hit = scene.trace(ray);
            if (!hit) continue;
            const std::uint32_t mesh = only == kNone ? 1 : 0;
            if (hit->mesh != mesh) continue;
            counts[only == kNone ? leaf_of[hit->triangle] : only][hit->front ? 0 : 1] += 1.0;
          }
  };
  draw(all, kNone, seen);
  for (std::uint32_t l = 0; l < plant.leaves.size(); ++l) {
    Plant one;
    one.materials = plant.materials;
    Mesh mesh = plant.meshes[1];
    mesh.indices.clear();
    for (std::uint32_t t = 0; t < plant.leaves[l].triangle_count; ++t)
      for (std::uint32_t c = 0; c < 3; ++c)
        mesh.indices.push_back(
            plant.meshes[1]
                .indices[3 * plant.leaf_triangles[plant.leaves[l].first_triangle + t] + c]);
    one.meshes.push_back(std::move(mesh));
    draw(RayScene(one), l, alone);
  }
  std::vector<glm::vec2> result;
  for (std::size_t l = 0; l < seen.size(); ++l)
    result.push_back({alone[l][0] > 0 ? seen[l][0] / alone[l][0] : 1.0,
                      alone[l][1] > 0 ? seen[l][1] / alone[l][1] : 1.0});
  return result;
}

TEST(LeafVisibility, IsTheSharesOfPixels) {
  // Few large leaves, so that the pictures resolve them.
  const Plant plant = makeCrown(24, 0.9f, 5, [](const glm::vec3& p) { return p; });
  const auto expected = byPictures(plant, 400);
  const auto seen = leafVisibility(plant, looks(6, 12000));
  float least = 1.0f, most = 0.0f;
  for (std::size_t l = 0; l < seen.size(); ++l)
    for (int side = 0; side < 2; ++side) {
      EXPECT_NEAR(seen[l][side], expected[l][side], 0.04f) << l;
      least = std::min(least, expected[l][side]);
      most = std::max(most, expected[l][side]);
    }
  EXPECT_LT(least, 0.2f);  // the crown does hide leaves
  EXPECT_GT(most, 0.9f);
}

TEST(LeafVisibility, CutAwayPartsCountNeitherWay) {
  // The upper leaf's texture leaves its half of positive u; the lower is hidden by that half alone.
  Plant plant = stack({{0, 1}, {0.5f, 1}});
  Mesh upper = plant.meshes[0];
  Texture texture;
  texture.image = Image(64, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 4; ++c) texture.image.at(x, y)[c] = c == 3 && x < 32 ? 0 : 255;
  plant.textures.push_back(texture);
  Material cut{.name = "cut", .base_color_texture = 0, .alpha_mode = AlphaMode::kMask};
  plant.materials.push_back(cut);
  upper.material = 1;
  upper.positions.erase(upper.positions.begin(), upper.positions.begin() + 4);
  upper.normals.resize(4);
  upper.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  upper.indices.resize(6);
  plant.meshes[0].positions.resize(4);
  plant.meshes[0].normals.resize(4);
  plant.meshes[0].indices.resize(6);
  plant.meshes.push_back(upper);
  plant.leaves[1].mesh = 1;
  plant.leaf_triangles = {0, 1, 0, 1};
  const auto seen = leafVisibility(plant, looks(6, 30000));
  EXPECT_NEAR(seen[0].x, 0.5f, 0.02f);
  EXPECT_EQ(seen[1].x, 1.0f);
  EXPECT_EQ(seen[1].y, 0.0f);
}

TEST(LeafVisibility, IsTheSameForAnyNumberOfThreads) {
  const Plant plant = makeBallCrown(300);
  setThreadCount(1);
  const auto one = leafVisibility(plant, looks(16, 64));
  setThreadCount(0);
  EXPECT_EQ(one, leafVisibility(plant, looks(16, 64)));
}

TEST(LeafVisibility, GoesToTheVerticesOfLeavesAlone) {
  const Plant plant = makeBallCrown(40);
  std::vector<glm::vec2> visibility;
  for (std::size_t l = 0; l < plant.leaves.size(); ++l)
    visibility.push_back({static_cast<float>(l) / 40.0f, 0.0f});
  CrownLight light;
  for (const Mesh& mesh : plant.meshes)
    light.meshes.push_back({mesh.normals, std::vector<float>(mesh.positions.size(), 0.3f)});
  setLeafVisibility(plant, visibility, light);
  EXPECT_TRUE(light.meshes[0].visibility.empty());
  EXPECT_EQ(light.meshes[0].ambient[0], 0.3f);
  for (std::size_t l = 0; l < plant.leaves.size(); ++l)
    for (std::size_t v = 4 * l; v < 4 * l + 4; ++v) {
      EXPECT_EQ(light.meshes[1].visibility[v], visibility[l]);
      EXPECT_EQ(light.meshes[1].ambient[v], std::max(0.5f * visibility[l].x, 1.0f / 255.0f));
    }
}

TEST(LeafVisibility, RefusesWhatItCannotLookAt) {
  EXPECT_THROW(leafVisibility(stack({{0, 1}}), looks(1, 64)), Error);
  EXPECT_THROW(leafVisibility(stack({{0, 1}}), looks(6, 0)), Error);
  EXPECT_THROW(leafVisibility(Plant{}, looks(6, 64)), Error);
  LeafVisibilityOptions cancelled = looks(6, 64);
  cancelled.progress = [](double) { return false; };
  EXPECT_THROW(leafVisibility(makeBallCrown(5000), cancelled), Error);
}

}  // namespace
}  // namespace verdure
