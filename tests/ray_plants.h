#ifndef VERDURE_TESTS_RAY_PLANTS_H_
#define VERDURE_TESTS_RAY_PLANTS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>

#include "base/random.h"
#include "rays/ray_scene.h"
#include "scene/scene.h"
#include "verdure/plant.h"

/// Plants with known light, and rays against all triangles, for tests of what is traced.
namespace verdure::test {

inline glm::vec3 randomDirection(Random& random) {
  const float z = random.vary(1.0f), angle = random.uniform(0.0f, glm::two_pi<float>());
  const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {r * std::cos(angle), z, r * std::sin(angle)};
}

/// A closed ball of triangles around a point, facing outwards.
inline Mesh ball(const glm::vec3& center, float radius, int rings) {
  Mesh mesh;
  const auto columns = static_cast<std::uint32_t>(2 * rings);
  for (int r = 0; r <= rings; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double polar = glm::pi<double>() * r / rings;
      const double angle = glm::two_pi<double>() * (c % columns) / columns;
      glm::dvec3 d(std::sin(polar) * std::cos(angle), std::cos(polar),
                   std::sin(polar) * std::sin(angle));
      if (r % rings == 0) d = {0, r == 0 ? 1 : -1, 0};
      mesh.positions.push_back(center + radius * glm::vec3(d));
      mesh.normals.push_back(glm::vec3(d));
    }
  for (std::uint32_t r = 0; r < static_cast<std::uint32_t>(rings); ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
      const auto add = [&mesh](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        mesh.indices.insert(mesh.indices.end(), {i, j, k});
      };
      if (r > 0) add(a, a + 1, b + 1);
      if (r + 1 < static_cast<std::uint32_t>(rings)) add(a, b + 1, b);
    }
  return mesh;
}

inline void turnOver(Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  for (glm::vec3& n : mesh.normals) n = -n;
}

/// A plant whose mesh 0 is one small flat leaf, white, its vertex 0 at a point; material 1 is
/// plain.
inline Plant probe(const glm::vec3& at, const glm::vec3& normal, float size = 1e-3f) {
  Plant plant;
  plant.name = "probe";
  plant.materials.resize(2);
  const glm::vec3 a = glm::normalize(
      glm::cross(normal, std::abs(normal.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  mesh.positions = {at, at + size * a, at + size * glm::cross(normal, a)};
  mesh.normals.assign(3, normal);
  mesh.indices = {0, 1, 2};
  plant.meshes = {mesh};
  return plant;
}

/// A level square of wood around the y axis, facing up, of material 1.
inline void addSheet(Plant& plant, float side, float height) {
  Mesh mesh;
  mesh.material = 1;
  const float h = 0.5f * side;
  mesh.positions = {{-h, height, -h}, {-h, height, h}, {h, height, h}, {h, height, -h}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  plant.meshes.push_back(mesh);
}

/// Alpha in [0, 1] as GL has it, from the definition, in double.
inline double alphaOf(const Texture& texture, glm::dvec2 uv) {
  const Image& image = texture.image;
  const auto texel = [](long i, int size, bool clamps) {
    if (clamps) return static_cast<int>(std::clamp<long>(i, 0, size - 1));
    return static_cast<int>(((i % size) + size) % size);
  };
  const double x = uv.x * image.width - 0.5, y = uv.y * image.height - 0.5;
  double sum = 0.0;
  for (long j = 0; j < 2; ++j)
    for (long i = 0; i < 2; ++i) {
      const long cx = static_cast<long>(std::floor(x)) + i,
                 cy = static_cast<long>(std::floor(y)) + j;
      const double weight = (1.0 - std::abs(x - static_cast<double>(cx))) *
                            (1.0 - std::abs(y - static_cast<double>(cy)));
      sum += weight * image.at(texel(cx, image.width, texture.clamp_u),
                               texel(cy, image.height, texture.clamp_v))[3];
    }
  return sum / 255.0;
}

struct BruteHit {
  double distance = 1e300;
  std::uint32_t mesh = 0, triangle = 0;
  /// How far the ray passes from an edge or from the border of the cut: a near miss is no error.
  double doubt = 1.0;
};

/// Moeller, Trumbore 1997, over all triangles, in double.
/// Triangles with a corner at `skip`, if given, are left out.
inline BruteHit bruteTrace(const Plant& plant, const Ray& ray, const glm::vec3* skip = nullptr) {
  BruteHit best;
  const glm::dvec3 o(ray.origin), d(ray.direction);
  for (std::uint32_t m = 0; m < plant.meshes.size(); ++m) {
    const Mesh& mesh = plant.meshes[m];
    const Material& material = plant.materials[mesh.material];
    const bool cut = material.alpha_mode != AlphaMode::kOpaque && material.base_color_texture >= 0;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
      const std::uint32_t* c = &mesh.indices[3 * t];
      if (skip != nullptr && (mesh.positions[c[0]] == *skip || mesh.positions[c[1]] == *skip ||
                              mesh.positions[c[2]] == *skip))
        continue;
      const glm::dvec3 p0(mesh.positions[c[0]]), e1 = glm::dvec3(mesh.positions[c[1]]) - p0,
                                                 e2 = glm::dvec3(mesh.positions[c[2]]) - p0;
      const glm::dvec3 h = glm::cross(d, e2);
      const double det = glm::dot(e1, h);
      if (det == 0.0) continue;
      const glm::dvec3 s = o - p0;
      const double u = glm::dot(s, h) / det;
      const glm::dvec3 q = glm::cross(s, e1);
      const double v = glm::dot(d, q) / det;
      const double distance = glm::dot(e2, q) / det;
      const double inside = std::min({u, v, 1.0 - u - v});
      if (distance < -1e-6 || inside < -1e-5) continue;
      double doubt = std::min(std::abs(inside), std::abs(distance));
      bool solid = inside >= 0.0 && distance >= 0.0;
      if (cut) {
        const glm::dvec2 uv = glm::dvec2(mesh.uvs[c[0]]) * (1.0 - u - v) +
                              glm::dvec2(mesh.uvs[c[1]]) * u + glm::dvec2(mesh.uvs[c[2]]) * v;
        const double over =
            alphaOf(plant.textures[static_cast<std::size_t>(material.base_color_texture)], uv) -
            static_cast<double>(textureCutoff(material));
        doubt = std::min(doubt, std::abs(over));
        solid = solid && over >= 0.0;
      }
      if (distance < best.distance) best.doubt = std::min(best.doubt, doubt);
      if (solid && distance < best.distance) {
        best.distance = distance;
        best.mesh = m;
        best.triangle = t;
      }
    }
  }
  return best;
}

/// Whether a triangle stands in the way of a ray from a vertex at `at`; of leaves those that meet
/// there do not count.
inline bool blockedByLoop(const Plant& plant, const Ray& ray, const glm::vec3& at, bool wood) {
  return bruteTrace(plant, ray, wood ? nullptr : &at).distance < 1e300;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_RAY_PLANTS_H_
