#include "bake/ray_starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace verdure {

RayStarts::RayStarts(const Plant& plant, const RayScene& scene, std::optional<float> ground_height)
    : plant_(plant), scene_(scene), ground_height_(ground_height) {
  for (const Mesh& mesh : plant.meshes)
    fans_.push_back(mesh.kind == PartKind::kFoliage ? fansOf(mesh) : Fans{});
}

RayStarts::Fans RayStarts::fansOf(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&mesh](std::uint32_t a, std::uint32_t b) {
    const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  };
  std::sort(order.begin(), order.end(), less);
  Fans fans;
  fans.fan_of_vertex.resize(count);
  std::uint32_t fan_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && less(order[i - 1], order[i])) ++fan_count;
    fans.fan_of_vertex[order[i]] = fan_count;
  }
  if (count > 0) ++fan_count;
  fans.first.assign(fan_count + 1, 0);
  for (const std::uint32_t v : mesh.indices) ++fans.first[fans.fan_of_vertex[v] + 1];
  std::partial_sum(fans.first.begin(), fans.first.end(), fans.first.begin());
  fans.normals.resize(fans.first.back());
  std::vector<std::uint32_t> filled(fans.first.begin(), fans.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    const glm::vec3& p = mesh.positions[corner[0]];
    const glm::vec3 n = glm::cross(mesh.positions[corner[1]] - p, mesh.positions[corner[2]] - p);
    const float length = glm::length(n);
    for (int c = 0; c < 3; ++c)
      fans.normals[filled[fans.fan_of_vertex[corner[c]]]++] =
          length > 0.0f ? n / length : glm::vec3(0.0f);
  }
  return fans;
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
    const std::uint32_t fan = fans.fan_of_vertex[id.vertex];
    float least = 1.0f;
    for (std::uint32_t i = fans.first[fan]; i < fans.first[fan + 1]; ++i)
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
