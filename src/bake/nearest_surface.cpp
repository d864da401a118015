#include "bake/nearest_surface.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <nanoflann.hpp>
#pragma GCC diagnostic pop

#include "base/parallel.h"

namespace verdure {
namespace {

struct Cloud {
  const std::vector<glm::vec3>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// The best so far, by distance, then by index, so that ties do not depend on the tree.
struct LowestIndex {
  using DistanceType = float;
  using IndexType = std::uint32_t;
  float distance2 = std::numeric_limits<float>::max();
  std::uint32_t index = std::numeric_limits<std::uint32_t>::max();

  std::size_t size() const { return 1; }
  bool full() const { return true; }
  // The tree drops what is not nearer than this: one step beyond lets equal distances through.
  float worstDist() const {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(distance2) + 1u);
  }
  bool addPoint(float candidate2, std::uint32_t candidate) {
    if (candidate2 < distance2 || (candidate2 == distance2 && candidate < index)) {
      distance2 = candidate2;
      index = candidate;
    }
    return true;
  }
};

/// Barycentric coordinates of the point of triangle abc nearest to p (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.5).
glm::vec3 closestBarycentric(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                             const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return {1, 0, 0};
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0f && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
    const float v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0f && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
    const float w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const float scale = 1.0f / (va + vb + vc);
  return {1 - (vb + vc) * scale, vb * scale, vc * scale};
}

}  // namespace

struct NearestSurface::Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>,
                                                    Cloud, 3, std::uint32_t>;
  Cloud cloud;
  Index index;
  explicit Tree(const std::vector<glm::vec3>& points)
      : cloud{points}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
  /// `hint` is any vertex; the nearer it is, the less is searched. The result does not depend on
  /// it.
  std::uint32_t search(const glm::vec3& point, std::uint32_t hint) const {
    LowestIndex result;
    const glm::vec3 offset = point - cloud.points[hint];
    // As the tree adds it up, so that the hint does not seem nearer than itself.
    result.addPoint(offset.x * offset.x + offset.y * offset.y + offset.z * offset.z, hint);
    result.distance2 *= 1.0f + 1e-6f;
    result.index = std::numeric_limits<std::uint32_t>::max();
    index.findNeighbors(result, &point.x, nanoflann::SearchParams());
    // Rounding in the tree may hide the hint from itself.
    return result.index < cloud.points.size() ? result.index : hint;
  }
};

NearestSurface::NearestSurface(const Surface& surface)
    : surface_(surface), tree_(std::make_unique<Tree>(surface.positions)) {
  first_.assign(surface.positions.size() + 1, 0);
  for (const std::uint32_t v : surface.indices) ++first_[v + 1];
  for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  triangles_.resize(surface.indices.size());
  for (std::size_t i = 0; i < surface.indices.size(); ++i)
    triangles_[next[surface.indices[i]]++] = static_cast<std::uint32_t>(i / 3);
}
NearestSurface::~NearestSurface() = default;

std::uint32_t NearestSurface::vertex(const glm::vec3& point, std::uint32_t hint) const {
  return tree_->search(point, hint);
}

NearestSurface::Point NearestSurface::point(const glm::vec3& from, std::uint32_t hint) const {
  Point result;
  result.vertex = tree_->search(from, hint);
  float best = std::numeric_limits<float>::max();
  const std::uint32_t* triangle = nullptr;
  glm::vec3 weights(0.0f);
  // The nearest point of the fan around a vertex is one of the surface's as well, unless it lies
  // on the fan's rim: then the fan around a corner there may come nearer still.
  for (std::uint32_t v = result.vertex;;) {
    bool nearer = false;
    for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) {
      const std::uint32_t* corner = &surface_.indices[3 * std::size_t{triangles_[k]}];
      const glm::vec3 &a = surface_.positions[corner[0]], &b = surface_.positions[corner[1]],
                      &c = surface_.positions[corner[2]];
      const glm::vec3 w = closestBarycentric(from, a, b, c);
      const glm::vec3 offset = from - (w.x * a + w.y * b + w.z * c);
      const float distance2 = glm::dot(offset, offset);
      if (distance2 < best) {
        best = distance2;
        triangle = corner;
        weights = w;
        nearer = true;
      }
    }
    if (!nearer) break;
    std::uint32_t next = v;
    float most = 0.0f;
    for (int k = 0; k < 3; ++k) {
      if (triangle[k] == v && weights[k] > 0.0f) most = 2.0f;  // not on the rim
      if (triangle[k] != v && weights[k] > most) {
        most = weights[k];
        next = triangle[k];
      }
    }
    if (next == v || most > 1.0f) break;
    v = next;
  }
  if (triangle == nullptr) {  // all its triangles are degenerate
    result.position = surface_.positions[result.vertex];
    result.normal = surface_.normals[result.vertex];
    return result;
  }
  glm::vec3 normal(0.0f);
  for (int k = 0; k < 3; ++k) {
    result.position += weights[k] * surface_.positions[triangle[k]];
    normal += weights[k] * surface_.normals[triangle[k]];
  }
  const float length = glm::length(normal);
  result.normal = length > 1e-6f ? normal / length : surface_.normals[result.vertex];
  return result;
}

bool NearestSurface::watertight() const {
  std::atomic<bool> closed = true;
  // The triangles around v lead to each neighbour as often as they come from it, namely once.
  parallelChunks(surface_.positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> to, from;
    for (std::size_t v = begin; v < end; ++v) {
      to.clear();
      from.clear();
      for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) {
        const std::uint32_t* corner = &surface_.indices[3 * std::size_t{triangles_[k]}];
        const std::size_t at = corner[0] == v ? 0 : corner[1] == v ? 1 : 2;
        to.push_back(corner[(at + 1) % 3]);
        from.push_back(corner[(at + 2) % 3]);
      }
      std::sort(to.begin(), to.end());
      std::sort(from.begin(), from.end());
      if (to != from || std::adjacent_find(to.begin(), to.end()) != to.end()) closed = false;
    }
  });
  return closed;
}

std::size_t NearestSurface::components() const {
  std::vector<std::uint32_t> parent(surface_.positions.size());
  for (std::size_t v = 0; v < parent.size(); ++v) parent[v] = static_cast<std::uint32_t>(v);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::size_t count = parent.size();
  for (std::size_t i = 0; i + 2 < surface_.indices.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = root(surface_.indices[i]), b = root(surface_.indices[i + k]);
      if (a != b) {
        parent[std::max(a, b)] = std::min(a, b);
        --count;
      }
    }
  return count;
}

}  // namespace verdure
