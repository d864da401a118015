#ifndef VERDURE_TESTS_TEST_PLANTS_H_
#define VERDURE_TESTS_TEST_PLANTS_H_

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/random.h"
#include "verdure/plant.h"

/// Small plants made by formulas, for tests and benchmarks of the renderer.
namespace verdure::test {

/// A leaf with a pointed oval outline and a midrib; the rest is transparent, its colour magenta so
/// that a halo would show.
inline Image leafImage(int size) {
  Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size) * 2.0f - 1.0f;
      const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
      const float half_width = 0.85f * std::pow(std::sin(v * glm::pi<float>()), 0.8f);
      const float inside = half_width - std::abs(u);
      const float vein =
          std::abs(u) < 0.03f ||
                  std::abs(std::fmod(std::abs(v * 8.0f - std::abs(u) * 2.0f), 1.0f)) < 0.07f
              ? 1.2f
              : 1.0f;
      std::uint8_t* p = image.at(x, y);
      const float alpha = std::clamp(0.5f + inside * static_cast<float>(size) * 0.25f, 0.0f, 1.0f);
      const bool in = alpha > 0.0f;
      p[0] = static_cast<std::uint8_t>(in ? 88.0f * vein : 255.0f);
      p[1] = static_cast<std::uint8_t>(in ? 132.0f * vein : 0.0f);
      p[2] = static_cast<std::uint8_t>(in ? 48.0f * vein : 255.0f);
      p[3] = static_cast<std::uint8_t>(alpha * 255.0f);
    }
  return image;
}

/// Vertical furrows, as a base colour and the matching normal map.
inline Image barkImage(int size, bool normal_map) {
  Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(size) * glm::two_pi<float>();
      const float v = static_cast<float>(y) / static_cast<float>(size) * glm::two_pi<float>();
      const float phase = 6.0f * u + 0.8f * std::sin(2.0f * v) + 0.5f * std::sin(3.0f * u + v);
      const float height = 0.5f + 0.5f * std::sin(phase);
      std::uint8_t* p = image.at(x, y);
      if (normal_map) {
        const glm::vec3 n = glm::normalize(glm::vec3(-0.7f * std::cos(phase), 0.0f, 1.0f));
        for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(128.0f + 127.0f * n[c]);
      } else {
        p[0] = static_cast<std::uint8_t>(70.0f + 60.0f * height);
        p[1] = static_cast<std::uint8_t>(60.0f + 52.0f * height);
        p[2] = static_cast<std::uint8_t>(48.0f + 42.0f * height);
      }
      p[3] = 255;
    }
  return image;
}

inline void addQuad(Mesh& mesh, const glm::vec3& base, const glm::vec3& right,
                    const glm::vec3& up) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(right, up));
  for (int i = 0; i < 4; ++i) {
    const glm::vec2 corner(i == 1 || i == 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f);
    mesh.positions.push_back(base + right * (corner.x - 0.5f) + up * corner.y);
    mesh.normals.push_back(normal);
    mesh.uvs.emplace_back(corner.x, 1.0f - corner.y);
  }
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

inline void addTube(Mesh& mesh, const glm::vec3& from, const glm::vec3& to, float radius_from,
                    float radius_to, int sides = 16) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 axis = glm::normalize(to - from);
  const glm::vec3 a = glm::normalize(
      glm::cross(axis, std::abs(axis.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  const glm::vec3 b = glm::cross(axis, a);
  const float length = glm::length(to - from);
  for (int end = 0; end < 2; ++end)
    for (int s = 0; s <= sides; ++s) {
      const float angle = static_cast<float>(s) / static_cast<float>(sides) * glm::two_pi<float>();
      const glm::vec3 n = a * std::cos(angle) + b * std::sin(angle);
      mesh.positions.push_back((end == 0 ? from : to) + n * (end == 0 ? radius_from : radius_to));
      mesh.normals.push_back(n);
      mesh.uvs.emplace_back(static_cast<float>(s) / static_cast<float>(sides),
                            end == 0 ? length : 0.0f);
    }
  const auto ring = static_cast<std::uint32_t>(sides + 1);
  for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(sides); ++s)
    for (const std::uint32_t i : {s, s + 1, s + ring + 1, s, s + ring + 1, s + ring})
      mesh.indices.push_back(first + i);
}

/// A tree of `leaves` folded or flat leaf cards in a sphere on a trunk, about 5 m high.
inline Plant ballTree(int leaves, float leaf_size_m = 0.22f, bool folded = false) {
  Random random(11);
  Plant plant;
  plant.name = "ball tree";
  plant.textures = {{"leaf", leafImage(128), true, true},
                    {"bark", barkImage(128, false)},
                    {"bark normals", barkImage(128, true)}};
  Material bark;
  bark.name = "bark";
  bark.base_color_texture = 1;
  bark.normal_texture = 2;
  Material leaf;
  leaf.name = "leaf";
  leaf.base_color_texture = 0;
  leaf.alpha_mode = AlphaMode::kMask;
  leaf.double_sided = true;
  plant.materials = {bark, leaf};

  Mesh wood;
  wood.name = "wood";
  wood.kind = PartKind::kWood;
  wood.material = 0;
  const glm::vec3 center(0.0f, 3.4f, 0.0f);
  addTube(wood, {0, 0, 0}, {0, 3.2f, 0}, 0.17f, 0.08f);
  for (int i = 0; i < 9; ++i) {
    const float angle = static_cast<float>(i) * 2.4f;
    const float rise = 1.9f + 0.15f * static_cast<float>(i);
    addTube(
        wood, {0, rise, 0},
        center +
            glm::vec3(std::cos(angle), 0.2f + 0.1f * static_cast<float>(i), std::sin(angle)) * 1.1f,
        0.06f, 0.015f, 8);
  }
  Mesh foliage;
  foliage.name = "foliage";
  foliage.kind = PartKind::kFoliage;
  foliage.material = 1;
  const auto direction = [&random] {
    for (;;) {
      const glm::vec3 d(random.vary(1.0f), random.vary(1.0f), random.vary(1.0f));
      if (const float l = glm::length(d); l > 0.1f && l < 1.0f) return d / l;
    }
  };
  for (int i = 0; i < leaves; ++i) {
    const glm::vec3 out = direction();
    const glm::vec3 at = center + out * (1.6f * std::cbrt(random.uniform(0.05f, 1.0f)));
    const glm::vec3 up = glm::normalize(direction() + out * 0.6f - glm::vec3(0, 0.4f, 0));
    const glm::vec3 right = glm::normalize(glm::cross(up, direction()));
    const float size = leaf_size_m * random.uniform(0.7f, 1.2f);
    if (!folded) {
      addQuad(foliage, at, right * size * 0.7f, up * size);
    } else {  // two halves at an angle along the midrib
      const glm::vec3 n = glm::cross(right, up);
      const auto first = static_cast<std::uint32_t>(foliage.positions.size());
      for (int half = -1; half <= 1; half += 2) {
        const float side = static_cast<float>(half);
        const glm::vec3 edge = (right * side + n * 0.35f) * (size * 0.35f);
        const glm::vec3 normal = glm::normalize(glm::cross(edge, up) * side);
        const glm::vec3 corners[] = {at, at + edge, at + edge + up * size, at + up * size};
        for (int c = 0; c < 4; ++c) {
          foliage.positions.push_back(corners[c]);
          foliage.normals.push_back(normal);
          foliage.uvs.emplace_back(c == 1 || c == 2 ? 0.5f + 0.5f * side : 0.5f,
                                   c >= 2 ? 0.0f : 1.0f);
        }
      }
      for (const std::uint32_t k : {0u, 3u, 2u, 0u, 2u, 1u, 4u, 5u, 6u, 4u, 6u, 7u})
        foliage.indices.push_back(first + k);
    }
  }
  plant.meshes = {std::move(wood), std::move(foliage)};
  return plant;
}

/// The light that a bake would give the ball tree: normals away from the crown's centre, ambient
/// falling with depth.
inline CrownLight ballTreeLight(const Plant& plant) {
  const glm::vec3 center(0.0f, 3.4f, 0.0f);
  CrownLight light;
  for (const Mesh& mesh : plant.meshes) {
    MeshLight& out = light.meshes.emplace_back();
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const glm::vec3 away = mesh.positions[v] - center;
      const float depth = 1.0f - glm::length(away) / 1.6f;
      const bool inside = depth > 0.0f;
      out.normals.push_back(mesh.kind == PartKind::kFoliage ? glm::normalize(away)
                                                            : mesh.normals[v]);
      out.ambient.push_back(inside ? 0.2f + 0.8f * (1.0f - std::min(depth * 1.6f, 1.0f)) : 1.0f);
    }
  }
  return light;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_TEST_PLANTS_H_
