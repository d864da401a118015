#include "bake/surfel_tree.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace verdure {
namespace {

// Surfels of a leaf of the tree.
constexpr std::size_t kPiece = 8;
// The tree is halved this often before its parts go to threads.
constexpr std::size_t kTopLevels = 4;

/// Carried along, since looking positions up by number takes twice as long.
struct Placed {
  glm::vec3 position;
  std::uint32_t number;
};

/// Puts the lower half along the longest side in front; returns where the upper begins.
std::size_t halve(std::span<Placed> points) {
  glm::vec3 low = points[0].position, high = low;
  for (const Placed& p : points) {
    low = glm::min(low, p.position);
    high = glm::max(high, p.position);
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle),
                   points.end(), [axis](const Placed& a, const Placed& b) {
                     const float u = a.position[axis], v = b.position[axis];
                     return u != v ? u < v : a.number < b.number;
                   });
  return middle;
}

void halveDownTo(std::span<Placed> points, std::size_t piece) {
  if (points.size() <= piece) return;
  const std::size_t middle = halve(points);
  halveDownTo(points.first(middle), piece);
  halveDownTo(points.subspan(middle), piece);
}

}  // namespace

std::vector<std::uint32_t> sortedByMedians(std::span<const glm::vec3> positions,
                                           std::size_t piece) {
  std::vector<Placed> points(positions.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) points[i] = {positions[i], i};
  std::vector<std::span<Placed>> parts{points};
  for (std::size_t level = 0; level < kTopLevels; ++level) {
    std::vector<std::span<Placed>> halves(2 * parts.size());
    parallelFor(parts.size(), 1, [&](std::size_t p) {
      const std::size_t middle = parts[p].size() <= piece ? 0 : halve(parts[p]);
      halves[2 * p] = parts[p].first(middle);
      halves[2 * p + 1] = parts[p].subspan(middle);
    });
    parts = std::move(halves);
  }
  parallelFor(parts.size(), 1, [&](std::size_t p) { halveDownTo(parts[p], piece); });
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[i] = points[i].number;
  return order;
}

SurfelTree::SurfelTree(std::span<const Surfel> surfels) {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> used;
  glm::vec3 low(0.0f), high(0.0f);
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (!(surfels[i].area > 0.0f)) continue;
    const glm::vec3& p = surfels[i].position;
    low = used.empty() ? p : glm::min(low, p);
    high = used.empty() ? p : glm::max(high, p);
    used.push_back(static_cast<std::uint32_t>(i));
    positions.push_back(p);
  }
  count_ = used.size();
  if (count_ == 0) return;
  origin_ = 0.5f * (low + high);
  const glm::vec3 size = high - low;
  float longest = std::max(size.x, std::max(size.y, size.z));
  if (!(longest > 0.0f)) longest = std::sqrt(surfels[used[0]].area);
  scale_ = 1.0f / longest;

  std::size_t parts = 1;
  while ((count_ + parts - 1) / parts > kPiece) parts *= 2, ++levels_;
  const std::vector<std::uint32_t> order = sortedByMedians(positions, kPiece);
  positions_.resize(count_);
  half_areas_.resize(count_);
  extents_.resize(count_);
  parallelFor(count_, 16384, [&](std::size_t i) {
    const Surfel& s = surfels[used[order[i]]];
    positions_[i] = toTree(s.position);
    half_areas_[i] = 0.5f * s.area * scale_ * scale_;
    extents_[i] = s.extent * scale_;
  });
  nodes_.resize(2 * parts - 1);
  nodes_[0].first = 0;
  nodes_[0].last = static_cast<std::uint32_t>(count_);
  for (std::size_t n = 0; n + 1 < parts; ++n) {
    const std::uint32_t first = nodes_[n].first, last = nodes_[n].last;
    const std::uint32_t middle = first + (last - first) / 2;
    nodes_[2 * n + 1].first = first;
    nodes_[2 * n + 1].last = nodes_[2 * n + 2].first = middle;
    nodes_[2 * n + 2].last = last;
  }
  // From the single surfels, not from the children: log n passes, but no error is handed on.
  parallelFor(nodes_.size(), 64,
              [&](std::size_t n) { makeNode(n, nodes_[n].first, nodes_[n].last); });
}

void SurfelTree::makeNode(std::size_t node, std::size_t first, std::size_t last) {
  double half = 0.0, half2 = 0.0, moment2 = 0.0;
  glm::dvec3 moment(0.0);
  for (std::size_t i = first; i < last; ++i) {
    const double h = half_areas_[i];
    const glm::dvec3 p(positions_[i]);
    half += h;
    half2 += h * h;
    moment += h * p;
    moment2 += h * glm::dot(p, p);
  }
  Node& out = nodes_[node];
  if (!(half > 0.0)) return;
  const glm::dvec3 center = moment / half;
  out.center = glm::vec3(center);
  out.half_area = static_cast<float>(half);
  // The mean of 1 / r^2 over a cloud of variance s^2 along each axis is 1 / (r^2 - s^2) to second
  // order, for an isotropic cloud.
  const double variance = std::max(0.0, moment2 / half - glm::dot(center, center)) / 3.0;
  out.softening = static_cast<float>(4.0 * half2 / half - 12.566370614359172 * variance);
  for (std::size_t i = first; i < last; ++i)
    out.radius = std::max(out.radius, glm::length(positions_[i] - out.center) + extents_[i]);
}

void SurfelTree::termsFor(const glm::vec3& low, const glm::vec3& high, float opening,
                          DepthTerms& terms) const {
  if (count_ == 0) return;
  const std::size_t inner = nodes_.size() / 2;
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::size_t n = stack[--depth];
    const Node& node = nodes_[n];
    const glm::vec3 away =
        glm::max(glm::max(low - node.center, node.center - high), glm::vec3(0.0f));
    if (node.radius * node.radius < opening * opening * glm::dot(away, away)) {
      terms.add(node.center.x, node.center.y, node.center.z, node.half_area, node.softening);
    } else if (n < inner) {
      stack[depth++] = 2 * n + 2;
      stack[depth++] = 2 * n + 1;
    } else {
      for (std::size_t i = node.first; i < node.last; ++i)
        terms.add(positions_[i].x, positions_[i].y, positions_[i].z, half_areas_[i],
                  4.0f * half_areas_[i]);
    }
  }
}

}  // namespace verdure
