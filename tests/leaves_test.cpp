// Leaves against a brute-force weld, and against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "base/random.h"
#include "verdure/plant.h"

namespace verdure {
namespace {

/// Component number of each triangle by comparing every vertex with every other.
std::vector<std::uint32_t> bruteForce(const Mesh& mesh) {
  Plant alone;
  alone.meshes.push_back(mesh);
  const glm::dvec3 size(bounds(alone).size());
  const double epsilon = 1e-6 * glm::length(size);
  const std::size_t n = mesh.positions.size();
  std::vector<std::uint32_t> label(n);
  std::iota(label.begin(), label.end(), 0u);
  const auto merge = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t from = label[a], to = label[b];
    if (from == to) return;
    for (std::uint32_t& l : label)
      if (l == from) l = to;
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < i; ++j)
      if (glm::length(glm::dvec3(mesh.positions[i]) - glm::dvec3(mesh.positions[j])) <= epsilon)
        merge(i, j);
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    merge(mesh.indices[t], mesh.indices[t + 1]);
    merge(mesh.indices[t], mesh.indices[t + 2]);
  }
  std::vector<std::uint32_t> of_triangle;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    of_triangle.push_back(label[mesh.indices[t]]);
  return of_triangle;
}

void addQuad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec3& p : {corner, corner + u, corner + u + v, corner + v})
    mesh.positions.push_back(p);
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(base + i);
}

/// Quads that share corners exactly, nearly, almost nearly, or not at all.
Mesh randomFoliage(std::uint64_t seed, int quads) {
  Random random(seed);
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  addQuad(mesh, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  addQuad(mesh, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0});
  for (int q = 0; q < quads; ++q) {
    glm::vec3 corner(random.vary(1), random.vary(1), random.vary(1));
    if (random.below(2) == 0) {
      corner = mesh.positions[random.below(static_cast<std::uint32_t>(mesh.positions.size()))];
      // The size is about 3.46: these straddle the limit of 3.46e-6.
      const float step = static_cast<float>(random.below(4)) * 1.2e-6f;
      corner[static_cast<int>(random.below(3))] += step;
    }
    const glm::vec3 u(random.vary(0.1f), random.vary(0.1f), random.vary(0.1f));
    const glm::vec3 v(random.vary(0.1f), random.vary(0.1f), random.vary(0.1f));
    addQuad(mesh, corner, u, random.below(10) == 0 ? u : v);
  }
  return mesh;
}

TEST(FindLeaves, AgreesWithBruteForce) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Plant plant;
    plant.meshes.push_back(randomFoliage(seed, 150));
    findLeaves(plant);
    const auto expected = bruteForce(plant.meshes[0]);
    EXPECT_EQ(plant.leaves.size(),
              std::set<std::uint32_t>(expected.begin(), expected.end()).size());
    EXPECT_LT(plant.leaves.size(), 150u);
    std::vector<int> seen(expected.size(), 0);
    for (std::size_t l = 0; l < plant.leaves.size(); ++l) {
      const Leaf& leaf = plant.leaves[l];
      // Ordered by first triangle.
      if (l > 0) {
        EXPECT_GT(plant.leaf_triangles[leaf.first_triangle],
                  plant.leaf_triangles[plant.leaves[l - 1].first_triangle]);
      }
      for (std::uint32_t k = 0; k < leaf.triangle_count; ++k) {
        const std::uint32_t t = plant.leaf_triangles[leaf.first_triangle + k];
        ++seen[t];
        EXPECT_EQ(expected[t], expected[plant.leaf_triangles[leaf.first_triangle]]);
      }
    }
    for (const int s : seen) EXPECT_EQ(s, 1);
  }
}

TEST(FindLeaves, DoesNotChokeOnAnOutlier) {
  // One far vertex makes the tolerance larger than the whole crown: all is one leaf, at once.
  Plant plant;
  Mesh mesh = randomFoliage(3, 20000);
  addQuad(mesh, {1e9f, 0, 0}, {1, 0, 0}, {0, 1, 0});
  plant.meshes.push_back(mesh);
  findLeaves(plant);
  EXPECT_EQ(plant.leaves.size(), 2u);
}

TEST(FindLeaves, MeasuresLeaves) {
  Plant plant;
  Mesh& wood = plant.meshes.emplace_back();
  wood.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 5, 0}};
  wood.indices = {0, 1, 2};
  wood.branch_of_vertex = {0, 0, 7};
  Mesh& mesh = plant.meshes.emplace_back();
  mesh.kind = PartKind::kFoliage;
  addQuad(mesh, {1, 5, 0}, {2, 0, 0}, {0, 0, 3});
  addQuad(mesh, {-4, 0, 0}, {3, 0, 0}, {0, 1, 0});
  addQuad(mesh, {9, 9, 9}, {1, 0, 0}, {2, 0, 0});  // no area
  findLeaves(plant);
  ASSERT_EQ(plant.leaves.size(), 3u);
  EXPECT_FLOAT_EQ(plant.leaves[0].area, 6.0f);
  EXPECT_EQ(plant.leaves[0].centroid, glm::vec3(2, 5, 1.5f));
  EXPECT_EQ(plant.leaves[0].stalk, glm::vec3(1, 5, 0));
  EXPECT_EQ(plant.leaves[0].branch, 7u);
  EXPECT_EQ(plant.leaves[0].mesh, 1u);
  EXPECT_EQ(plant.leaves[1].stalk, glm::vec3(-1, 0, 0));
  EXPECT_EQ(plant.leaves[1].branch, 0u);
  EXPECT_EQ(plant.leaves[2].area, 0.0f);
  // Without wood: towards the plant's axis, the middle of its bounds.
  plant.meshes[0].kind = PartKind::kFoliage;
  plant.meshes.erase(plant.meshes.begin());
  findLeaves(plant);
  EXPECT_EQ(plant.leaves[1].stalk.x, -1.0f);
}

TEST(FindLeaves, IsTheSameForAnyNumberOfThreads) {
  Plant plant;
  plant.meshes.push_back(randomFoliage(11, 3000));
  plant.meshes.push_back(randomFoliage(12, 100));
  plant.meshes[1].kind = PartKind::kWood;
  setThreadCount(1);
  findLeaves(plant);
  const Plant first = plant;
  setThreadCount(0);
  findLeaves(plant);
  ASSERT_EQ(plant.leaves.size(), first.leaves.size());
  EXPECT_EQ(plant.leaf_triangles, first.leaf_triangles);
  for (std::size_t i = 0; i < plant.leaves.size(); ++i) {
    EXPECT_EQ(plant.leaves[i].stalk, first.leaves[i].stalk);
    EXPECT_EQ(plant.leaves[i].area, first.leaves[i].area);
    EXPECT_EQ(plant.leaves[i].centroid, first.leaves[i].centroid);
  }
}

}  // namespace
}  // namespace verdure
