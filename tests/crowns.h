#ifndef VERDURE_TESTS_CROWNS_H_
#define VERDURE_TESTS_CROWNS_H_

#include <cmath>

#include "base/random.h"
#include "verdure/plant.h"

namespace verdure {

/// `count` quads of side `leaf`, at random directions in a ball (or as `place` puts a unit-ball
/// point), over a square trunk. Leaves are filled in.
template <class Place>
Plant makeCrown(std::size_t count, float leaf, std::uint64_t seed, const Place& place) {
  Random random(seed);
  const auto inBall = [&] {
    for (;;) {
      const glm::vec3 p(random.vary(1), random.vary(1), random.vary(1));
      const float l2 = glm::dot(p, p);
      if (l2 <= 1.0f && l2 > 1e-4f) return p;
    }
  };
  Plant plant;
  plant.name = "test crown";
  plant.materials = {Material{.name = "bark"}, Material{.name = "leaf", .double_sided = true}};
  Mesh trunk;
  trunk.name = "trunk";
  for (int i = 0; i < 8; ++i) {
    const float x = (i & 1) != 0 ? 0.05f : -0.05f, z = (i & 2) != 0 ? 0.05f : -0.05f;
    trunk.positions.push_back({x, (i & 4) != 0 ? 0.0f : -2.0f, z});
    trunk.normals.push_back(glm::normalize(glm::vec3(x, 0, z)));
  }
  trunk.indices = {0, 4, 1, 1, 4, 5, 1, 5, 3, 3, 5, 7, 3, 7, 2, 2, 7, 6, 2, 6, 0, 0, 6, 4};
  plant.meshes.push_back(std::move(trunk));

  Mesh foliage;
  foliage.name = "leaves";
  foliage.kind = PartKind::kFoliage;
  foliage.material = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 center = place(inBall());
    const glm::vec3 normal = glm::normalize(inBall());
    const glm::vec3 u = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(normal, u);
    const auto first = static_cast<std::uint32_t>(foliage.positions.size());
    const auto triangle = static_cast<std::uint32_t>(foliage.indices.size() / 3);
    for (int k = 0; k < 4; ++k) {
      const float a = k == 1 || k == 2 ? 0.5f : -0.5f, b = k >= 2 ? 0.5f : -0.5f;
      foliage.positions.push_back(center + leaf * (a * u + b * v));
      foliage.normals.push_back(normal);
      foliage.uvs.push_back({a + 0.5f, 0.5f - b});
    }
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) foliage.indices.push_back(first + k);
    plant.leaves.push_back({1, static_cast<std::uint32_t>(plant.leaf_triangles.size()), 2, kNone,
                            center, leaf * leaf, center - 0.5f * leaf * v});
    plant.leaf_triangles.push_back(triangle);
    plant.leaf_triangles.push_back(triangle + 1);
  }
  plant.meshes.push_back(std::move(foliage));
  return plant;
}

inline Plant makeBallCrown(std::size_t count, float leaf = 0.1f, std::uint64_t seed = 1) {
  return makeCrown(count, leaf, seed, [](const glm::vec3& p) { return p; });
}

}  // namespace verdure

#endif  // VERDURE_TESTS_CROWNS_H_
