#include "verdure/leaf_visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/ray_bake.h"
#include "bake/ray_directions.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::uint64_t kLeafStream = 6;

std::vector<glm::vec3> viewDirections(int count) {
  if (count == 6) return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<glm::vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double along = i * 0.61803398874989484820;
    directions.push_back(sphereDirection((static_cast<float>(i) + 0.5f) / static_cast<float>(count),
                                         static_cast<float>(along - std::floor(along))));
  }
  return directions;
}

/// The leaf of each triangle of each mesh, kNone in wood.
std::vector<std::vector<std::uint32_t>> leavesOfTriangles(const Plant& plant) {
  std::vector<std::vector<std::uint32_t>> leaf_of;
  for (const Mesh& mesh : plant.meshes) leaf_of.emplace_back(mesh.triangleCount(), kNone);
  for (std::uint32_t l = 0; l < plant.leaves.size(); ++l) {
    const Leaf& leaf = plant.leaves[l];
    for (std::uint32_t t = 0; t < leaf.triangle_count; ++t)
      leaf_of[leaf.mesh][plant.leaf_triangles[leaf.first_triangle + t]] = l;
  }
  return leaf_of;
}

/// Looks back from points of one leaf.
class Looker {
 public:
  Looker(const Plant& plant, const RayScene& scene)
      : plant_(plant), scene_(scene), leaf_of_(leavesOfTriangles(plant)) {}

  glm::vec2 visibility(std::uint32_t number, const std::vector<glm::vec3>& directions, int points,
                       Random& random) const {
    const Leaf& leaf = plant_.leaves[number];
    std::vector<float> until;  // sums of the triangles' areas
    float area = 0.0f;
    for (std::uint32_t t = 0; t < leaf.triangle_count; ++t)
      until.push_back(area +=
                      static_cast<float>(areaOf(plant_.meshes[leaf.mesh],
                                                plant_.leaf_triangles[leaf.first_triangle + t])));
    std::array<double, 2> seen{}, alone{};
    if (!(area > 0.0f)) return glm::vec2(1.0f);
    for (const glm::vec3& direction : directions)
      for (int p = 0; p < points; ++p) {
        const std::optional<SurfacePoint> point = pointOn(leaf, until, random);
        if (!point) continue;
        const float cosine = glm::dot(point->normal, direction);
        const std::size_t side = cosine > 0.0f ? 0 : 1;
        Ray ray;
        ray.origin = scene_.originOff(point->position, side == 0 ? point->normal : -point->normal);
        ray.direction = direction;
        const std::optional<RayHit> hit = scene_.trace(ray);
        if (hit && leaf_of_[hit->mesh][hit->triangle] == number) continue;
        const double weight = std::abs(double{cosine});
        alone[side] += weight;
        if (!hit) seen[side] += weight;
      }
    const auto share = [&](std::size_t side) {
      return alone[side] > 0.0 ? static_cast<float>(seen[side] / alone[side]) : 1.0f;
    };
    return {share(0), share(1)};
  }

 private:
  /// A random point that the alpha cut leaves; none of a leaf of which hardly anything is left.
  std::optional<SurfacePoint> pointOn(const Leaf& leaf, const std::vector<float>& until,
                                      Random& random) const {
    constexpr int kTries = 32;
    RayHit at;
    at.item = 0;
    at.mesh = leaf.mesh;
    for (int t = 0; t < kTries; ++t) {
      const float where = random.uniform() * until.back();
      const auto piece = std::min<std::size_t>(
          static_cast<std::size_t>(std::upper_bound(until.begin(), until.end(), where) -
                                   until.begin()),
          until.size() - 1);
      at.triangle = plant_.leaf_triangles[leaf.first_triangle + piece];
      at.barycentric = {random.uniform(), random.uniform()};
      if (at.barycentric.x + at.barycentric.y > 1.0f) at.barycentric = 1.0f - at.barycentric;
      if (!scene_.cutAt(at)) return scene_.surfaceAt(at, {});
    }
    return std::nullopt;
  }

  const Plant& plant_;
  const RayScene& scene_;
  std::vector<std::vector<std::uint32_t>> leaf_of_;
};

}  // namespace

std::vector<glm::vec2> leafVisibility(const Plant& plant, const LeafVisibilityOptions& options) {
  if (options.directions < 2 || options.directions > 4096)
    throw Error("directions", fmt::format("{} is outside of [2, 4096]", options.directions),
                "64 is usual, 6 is the paper's");
  if (plant.leaves.empty())
    throw Error(plant.name, "the plant has no leaves to look at",
                "name its material or mesh with --foliage, or choose another plant");
  RayOptions ray_options;
  ray_options.rays = options.rays;
  ray_options.seed = options.seed;
  ray_options.max_memory_bytes = options.max_memory_bytes;
  ray_options.progress = options.progress;
  const RayBake rays(plant, ray_options);
  const Looker looker(plant, rays.scene);
  const std::vector<glm::vec3> directions = viewDirections(options.directions);
  const int points = std::max(options.rays / options.directions, 1);
  std::vector<glm::vec2> visibility(plant.leaves.size());
  rays.forEach(visibility.size(), kLeafStream, 0.0, 1.0, [&](std::size_t i, Random& random) {
    visibility[i] = looker.visibility(static_cast<std::uint32_t>(i), directions, points, random);
  });
  return visibility;
}

void setLeafVisibility(const Plant& plant, const std::vector<glm::vec2>& visibility,
                       CrownLight& light) {
  for (std::size_t l = 0; l < plant.leaves.size(); ++l) {
    const Leaf& leaf = plant.leaves[l];
    const Mesh& mesh = plant.meshes[leaf.mesh];
    MeshLight& out = light.meshes[leaf.mesh];
    out.ambient.resize(mesh.positions.size(), 1.0f);
    out.visibility.resize(mesh.positions.size(), glm::vec2(1.0f));
    for (std::uint32_t t = 0; t < leaf.triangle_count; ++t)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t v =
            mesh.indices[3 * std::size_t{plant.leaf_triangles[leaf.first_triangle + t]} + c];
        out.visibility[v] = visibility[l];
        out.ambient[v] = std::max(0.5f * (visibility[l].x + visibility[l].y), 1.0f / 255.0f);
      }
  }
}

}  // namespace verdure
