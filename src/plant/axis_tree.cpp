#include "plant/axis_tree.h"

#include <algorithm>
#include <array>

namespace verdure {

AxisTree::AxisTree(const std::vector<Branch>& branches) {
  for (std::uint32_t b = 0; b < branches.size(); ++b) {
    const std::vector<BranchPoint>& points = branches[b].points;
    float start = 0.0f;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      segments_.push_back({points[i].position, points[i + 1].position, points[i].radius,
                           points[i + 1].radius, start, b});
      start += glm::length(points[i + 1].position - points[i].position);
    }
  }
  if (!segments_.empty()) build(0, static_cast<std::uint32_t>(segments_.size()));
}

void AxisTree::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t number = nodes_.size();
  Node node;
  node.low = node.high = segments_[begin].a;
  node.begin = begin;
  node.end = end;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Segment& s = segments_[i];
    node.low = glm::min(node.low, glm::min(s.a, s.b));
    node.high = glm::max(node.high, glm::max(s.a, s.b));
    node.radius = std::max({node.radius, s.radius_a, s.radius_b});
  }
  nodes_.push_back(node);
  if (end - begin <= 4) return;
  const glm::vec3 size = node.high - node.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(segments_.begin() + begin, segments_.begin() + middle, segments_.begin() + end,
                   [axis](const Segment& s, const Segment& t) {
                     const float x = s.a[axis] + s.b[axis], y = t.a[axis] + t.b[axis];
                     if (x != y) return x < y;
                     return s.branch != t.branch ? s.branch < t.branch : s.start < t.start;
                   });
  build(begin, middle);
  nodes_[number].right = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

float AxisTree::bound(const Node& node, const glm::vec3& point) const {
  const glm::vec3 off = glm::max(glm::max(node.low - point, point - node.high), glm::vec3(0.0f));
  return AxisHit{0, glm::length(off), node.radius, 0.0f}.gap();
}

AxisHit AxisTree::hit(const Segment& s, const glm::vec3& point) {
  const glm::vec3 ab = s.b - s.a;
  const float square = glm::dot(ab, ab);
  const float t = square > 0.0f ? glm::clamp(glm::dot(point - s.a, ab) / square, 0.0f, 1.0f) : 0.0f;
  return {s.branch, glm::length(point - s.a - t * ab), glm::mix(s.radius_a, s.radius_b, t),
          s.start + t * std::sqrt(square)};
}

AxisHit AxisTree::nearest(const glm::vec3& point,
                          const std::function<bool(std::uint32_t)>& accept) const {
  AxisHit best;
  if (nodes_.empty()) return best;
  float least = std::numeric_limits<float>::max();
  std::array<std::uint32_t, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t n = stack[--depth];
    const Node& node = nodes_[n];
    if (bound(node, point) > least) continue;
    if (node.right != 0) {
      const bool left_first = bound(nodes_[n + 1], point) <= bound(nodes_[node.right], point);
      stack[depth++] = left_first ? node.right : n + 1;
      stack[depth++] = left_first ? n + 1 : node.right;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (accept && !accept(segments_[i].branch)) continue;
      const AxisHit found = hit(segments_[i], point);
      const float gap = found.gap();
      if (gap > least || (gap == least && found.branch >= best.branch)) continue;
      least = gap;
      best = found;
    }
  }
  return best;
}

std::vector<AxisHit> AxisTree::within(const glm::vec3& point, float reach) const {
  std::vector<AxisHit> hits;
  if (nodes_.empty()) return hits;
  std::array<std::uint32_t, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t n = stack[--depth];
    const Node& node = nodes_[n];
    if (bound(node, point) > reach) continue;
    if (node.right != 0) {
      stack[depth++] = node.right;
      stack[depth++] = n + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      if (const AxisHit found = hit(segments_[i], point); found.gap() <= reach)
        hits.push_back(found);
  }
  std::sort(hits.begin(), hits.end(), [](const AxisHit& x, const AxisHit& y) {
    if (x.branch != y.branch) return x.branch < y.branch;
    return x.distance != y.distance ? x.distance < y.distance : x.along < y.along;
  });
  hits.erase(std::unique(hits.begin(), hits.end(),
                         [](const AxisHit& x, const AxisHit& y) { return x.branch == y.branch; }),
             hits.end());
  return hits;
}

}  // namespace verdure
