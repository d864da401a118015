#include "verdure/occlusion.h"

#include <algorithm>
#include <array>

#include "bake/ray_bake.h"
#include "bake/ray_directions.h"
#include "bake/scene_light.h"
#include "verdure/error.h"

namespace verdure {

std::vector<VertexId> allVertices(const Plant& plant) {
  std::vector<VertexId> vertices;
  vertices.reserve(vertexCount(plant));
  for (std::uint32_t m = 0; m < plant.meshes.size(); ++m)
    for (std::uint32_t v = 0; v < plant.meshes[m].positions.size(); ++v) vertices.push_back({m, v});
  return vertices;
}

std::vector<Openness> traceOpenness(const Plant& plant, std::span<const VertexId> vertices,
                                    const RayOptions& options, std::span<const glm::vec3> normals) {
  if (!normals.empty() && normals.size() != vertices.size())
    throw Error(plant.name, "as many normals as vertices are needed", "give one for each");
  const RayBake bake(plant, options);
  std::vector<Openness> result(vertices.size());
  bake.forEachVertex(vertices, 0.0, 1.0, [&](std::size_t i, Random& random) {
    const ShiftedLattice lattice(options.rays, random);
    std::array<Ray, RayBake::kBatch> rays;
    std::array<std::uint8_t, RayBake::kBatch> free;
    int open = 0;
    glm::vec3 sum(0.0f);
    float facing = 0.0f;
    for (int first = 0; first < options.rays; first += RayBake::kBatch) {
      std::size_t count = 0;
      for (int r = first; r < std::min(first + RayBake::kBatch, options.rays); ++r) {
        const glm::vec2 u = lattice.point(r);
        const glm::vec3 direction = sphereDirection(u.x, u.y);
        if (options.ground_height && direction.y < 0.0f) continue;
        rays[count++] = bake.starts.from(vertices[i], direction);
      }
      bake.scene.visibility({rays.data(), count}, {free.data(), count});
      for (std::size_t r = 0; r < count; ++r) {
        if (free[r] == 0) continue;
        ++open;
        sum += rays[r].direction;
        if (!normals.empty()) facing += std::max(glm::dot(rays[r].direction, normals[i]), 0.0f);
      }
    }
    result[i].share = static_cast<float>(open) / static_cast<float>(options.rays);
    if (!normals.empty())
      result[i].light = std::min(4.0f * facing / static_cast<float>(options.rays), 1.0f);
    if (open > 0) result[i].direction = sum / static_cast<float>(open);
  });
  return result;
}

std::vector<glm::vec3> traceAmbient(const Plant& plant, std::span<const VertexId> vertices,
                                    const RayOptions& options, const CrownLight* normals) {
  const RayBake bake(plant, options, normals);
  SceneLight scene_light(plant, bake, options, 0);
  const double patch_rays = scene_light.rayCount();
  const double share = patch_rays / (patch_rays + static_cast<double>(vertices.size()) *
                                                      static_cast<double>(options.rays));
  scene_light.bounce(share);
  std::vector<glm::vec3> result(vertices.size());
  bake.forEachVertex(vertices, share, 1.0, [&](std::size_t i, Random& random) {
    const ShiftedLattice lattice(options.rays, random);
    const glm::mat3 axes = axesAround(bake.normalOf(vertices[i]));
    float direct = 0.0f;
    glm::vec3 sum(0.0f);
    std::array<SceneLight::Slot, RayBake::kBatch> met;
    for (int first = 0; first < options.rays; first += RayBake::kBatch) {
      std::size_t count = 0;
      for (int r = first; r < std::min(first + RayBake::kBatch, options.rays); ++r) {
        const glm::vec2 u = lattice.point(r);
        met[count++] = scene_light.follow(
            bake.starts.from(vertices[i], axes * cosineDirection(u.x, u.y)), &direct);
      }
      scene_light.gather({met.data(), count}, &sum.x);
    }
    result[i] = (sum + direct) / static_cast<float>(options.rays);
  });
  return result;
}

CrownLight bakeAmbient(const Plant& plant, const RayOptions& options, const CrownLight* normals) {
  const std::vector<glm::vec3> ambient = traceAmbient(plant, allVertices(plant), options, normals);
  CrownLight light;
  std::size_t at = 0;
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    MeshLight& mesh = light.meshes.emplace_back();
    mesh.normals = normals != nullptr ? normals->meshes[m].normals : plant.meshes[m].normals;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v, ++at)
      mesh.ambient.push_back(std::clamp(glm::dot(ambient[at], glm::vec3(0.2126f, 0.7152f, 0.0722f)),
                                        1.0f / 255.0f, 1.0f));
  }
  return light;
}

}  // namespace verdure
