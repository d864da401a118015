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

/// Points of the unit square, evenly spread however many are taken: the R2 sequence (Roberts, "The
/// Unreasonable Effectiveness of Quasirandom Sequences", 2018), shifted by a random stream.
class SpreadPoints {
 public:
  explicit SpreadPoints(Random& random) : at_(random.uniform(), random.uniform()) {}
  glm::dvec2 next() {
    at_ += glm::dvec2(0.75487766624669276, 0.56984029099805327);
    return at_ -= glm::floor(at_);
  }

 private:
  glm::dvec2 at_;
};

/// Looks back from points of one leaf.
class Looker {
 public:
  Looker(const Plant& plant, const RayScene& scene)
      : plant_(plant), scene_(scene), leaf_of_(leavesOfTriangles(plant)) {}

  glm::vec2 visibility(std::uint32_t number, const std::vector<glm::vec3>& directions, int points,
                       Random& random) const {
    const Leaf& leaf = plant_.leaves[number];
    const std::vector<Piece> pieces = piecesOf(leaf);
    if (pieces.empty()) return glm::vec2(1.0f);
    const bool flat = isFlat(pieces);
    SpreadPoints spread(random);
    std::array<double, 2> seen{}, alone{};
    for (const glm::vec3& direction : directions)
      for (int p = 0; p < points; ++p) {
        const std::optional<Point> point = pointOn(leaf, pieces, spread);
        if (!point) continue;
        const float cosine = glm::dot(point->normal, direction);
        const std::size_t side = cosine > 0.0f ? 0 : 1;
        Ray ray;
        ray.origin = scene_.originOff(point->position, side == 0 ? point->normal : -point->normal);
        ray.direction = direction;
        bool hidden = false;
        if (flat) {
          hidden = scene_.occluded(ray);
        } else {
          const std::optional<RayHit> hit = scene_.trace(ray);
          if (hit && leaf_of_[hit->mesh][hit->triangle] == number) continue;
          hidden = hit.has_value();
        }
        const double weight = std::abs(double{cosine});
        alone[side] += weight;
        if (!hidden) seen[side] += weight;
      }
    const auto share = [&](std::size_t side) {
      return alone[side] > 0.0 ? static_cast<float>(seen[side] / alone[side]) : 1.0f;
    };
    return {share(0), share(1)};
  }

 private:
  /// A triangle of the leaf that has an area.
  struct Piece {
    std::uint32_t triangle = 0;  ///< of the mesh
    glm::vec3 corner{0.0f}, to_second{0.0f}, to_third{0.0f};
    glm::vec3 normal{0.0f};  ///< unit
    double until = 0.0;      ///< area of this and those before
  };
  struct Point {
    glm::vec3 position, normal;
  };

  std::vector<Piece> piecesOf(const Leaf& leaf) const {
    const Mesh& mesh = plant_.meshes[leaf.mesh];
    std::vector<Piece> pieces;
    double area = 0.0;
    for (std::uint32_t t = 0; t < leaf.triangle_count; ++t) {
      Piece piece;
      piece.triangle = plant_.leaf_triangles[leaf.first_triangle + t];
      const std::uint32_t* corner = &mesh.indices[3 * std::size_t{piece.triangle}];
      piece.corner = mesh.positions[corner[0]];
      piece.to_second = mesh.positions[corner[1]] - piece.corner;
      piece.to_third = mesh.positions[corner[2]] - piece.corner;
      const glm::vec3 cross = glm::cross(piece.to_second, piece.to_third);
      const float length = glm::length(cross);
      if (!(length > 0.0f)) continue;
      piece.normal = cross / length;
      piece.until = area += 0.5 * double{length};
      pieces.push_back(piece);
    }
    return pieces;
  }

  /// Whether no ray that leaves the leaf can meet it again: all corners lie within what rays start
  /// off the surface, and all pieces face the same way.
  bool isFlat(const std::vector<Piece>& pieces) const {
    const Piece& first = pieces[0];
    return std::all_of(pieces.begin(), pieces.end(), [&](const Piece& piece) {
      const float most = 0.5f * scene_.originOffset(piece.corner);
      for (const glm::vec3& edge : {glm::vec3(0.0f), piece.to_second, piece.to_third})
        if (!(std::abs(glm::dot(first.normal, piece.corner + edge - first.corner)) < most))
          return false;
      return glm::dot(first.normal, piece.normal) > 0.0f;
    });
  }

  /// A point that the alpha cut leaves; none of a leaf of which hardly anything is left.
  std::optional<Point> pointOn(const Leaf& leaf, const std::vector<Piece>& pieces,
                               SpreadPoints& spread) const {
    constexpr int kTries = 32;
    RayHit at;
    at.item = 0;
    at.mesh = leaf.mesh;
    for (int t = 0; t < kTries; ++t) {
      const glm::dvec2 u = spread.next();
      const double area = u.x * pieces.back().until;
      std::size_t i = 0;
      while (i + 1 < pieces.size() && pieces[i].until <= area) ++i;
      const Piece& piece = pieces[i];
      // Within the piece the same number is evenly spread again.
      const double begin = i == 0 ? 0.0 : pieces[i - 1].until;
      const double root = std::sqrt(std::clamp((area - begin) / (piece.until - begin), 0.0, 1.0));
      at.triangle = piece.triangle;
      at.barycentric = {root * (1.0 - u.y), root * u.y};
      if (scene_.cutAt(at)) continue;
      return Point{
          piece.corner + piece.to_second * at.barycentric.x + piece.to_third * at.barycentric.y,
          piece.normal};
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
