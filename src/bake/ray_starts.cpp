#include "bake/ray_starts.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace verdure {

RayStarts::RayStarts(const Plant& plant, const RayScene& scene, std::optional<float> ground_height)
    : plant_(plant), scene_(scene), ground_height_(ground_height) {
  for (const Mesh& mesh : plant.meshes) {
    Fans& fans = fans_.emplace_back();
    if (mesh.kind != PartKind::kFoliage) continue;
    fans.fans = VertexFans(mesh);
    fans.normals.resize(mesh.indices.size());
    parallelFor(mesh.indices.size(), 4096, [&](std::size_t i) {
      const std::uint32_t* corner = &mesh.indices[3 * std::size_t{fans.fans.triangles()[i]}];
      const glm::vec3& p = mesh.positions[corner[0]];
      const glm::vec3 n = glm::cross(mesh.positions[corner[1]] - p, mesh.positions[corner[2]] - p);
      const float length = glm::length(n);
      if (length > 0.0f) fans.normals[i] = n / length;
    });
  }
}

Ray RayStarts::from(VertexId id, const glm::vec3& direction) const {
  const Mesh& mesh = plant_.meshes[id.mesh];
  const glm::vec3& p = mesh.positions[id.vertex];
  const float off = scene_.originOffset(p);
  Ray ray;
  ray.direction = direction;
  if (mesh.kind == PartKind::kFoliage) {
    // Along the ray, until it is off the plane of every triangle that meets here, on whatever side
    // it leaves them; but not far where it runs in one of them.
    const Fans& fans = fans_[id.mesh];
    const std::uint32_t fan = fans.fans.of(id.vertex);
    float least = 1.0f;
    for (std::uint32_t i = fans.fans.first(fan); i < fans.fans.first(fan + 1); ++i)
      if (fans.normals[i] != glm::vec3(0.0f))
        least = std::min(least, std::abs(glm::dot(fans.normals[i], direction)));
    constexpr float kLeastSine = 1.0f / 256.0f;
    ray.origin = p + direction * (off / std::max(least, kLeastSine));
  } else {
    ray.origin = p + mesh.normals[id.vertex] * off;
  }
  if (ground_height_) ray.origin.y = std::max(ray.origin.y, *ground_height_ + off);
  return ray;
}

}  // namespace verdure
