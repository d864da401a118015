#include "plant/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace verdure {
namespace {

constexpr float kFar = std::numeric_limits<float>::max();

/// Where a straight front that passes a at `from_a` and b at `from_b` reaches c; kFar if it would
/// come from outside of the triangle.
float acrossTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, float from_a,
                     float from_b) {
  const glm::vec3 ab = b - a, ac = c - a;
  const float base = glm::length(ab);
  if (!(base > 0.0f)) return kFar;
  const float gx = (from_b - from_a) / base;
  if (!(std::abs(gx) < 0.999f)) return kFar;
  const float gy = std::sqrt(1.0f - gx * gx);
  const float x = glm::dot(ac, ab) / base;
  const float y = std::sqrt(std::max(glm::dot(ac, ac) - x * x, 0.0f));
  const float entry = x - y * gx / gy;
  if (entry < 0.0f || entry > base) return kFar;
  return from_a + gx * x + gy * y;
}

}  // namespace

PatchGraph::PatchGraph(const WoodPatch& patch) {
  const std::size_t points = patch.points.size();
  first_triangle_.assign(points + 1, 0);
  // Both ways of each triangle's edges, by their first point; then each point's by themselves.
  std::vector<std::uint32_t> first(points + 2, 0);
  const auto proper = [](const auto& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
  for (const auto& t : patch.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c], b = t[(c + 1) % 3];
      if (a == b) continue;
      ++first[a + 2];
      ++first[b + 2];
    }
    if (proper(t))
      for (const std::uint32_t p : t) ++first_triangle_[p + 1];
  }
  for (std::size_t p = 2; p < first.size(); ++p) first[p] += first[p - 1];
  std::vector<std::uint32_t> ends(first.back());
  for (const auto& t : patch.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c], b = t[(c + 1) % 3];
      if (a == b) continue;
      ends[first[a + 1]++] = b;
      ends[first[b + 1]++] = a;
    }
  first_neighbour_.assign(points + 1, 0);
  for (std::size_t p = 0; p < points; ++p) {
    const auto begin = ends.begin() + first[p], last = ends.begin() + first[p + 1];
    std::sort(begin, last);
    for (auto i = begin; i != last;) {
      const auto next = std::find_if(i, last, [i](std::uint32_t e) { return e != *i; });
      neighbours_.push_back(*i);
      rim_.push_back(next - i == 1);
      ++first_neighbour_[p + 1];
      i = next;
    }
  }
  for (std::size_t p = 0; p < points; ++p) {
    first_neighbour_[p + 1] += first_neighbour_[p];
    first_triangle_[p + 1] += first_triangle_[p];
  }
  triangles_.resize(first_triangle_.back());
  std::vector<std::uint32_t> next(first_triangle_.begin(), first_triangle_.end() - 1);
  for (std::uint32_t t = 0; t < patch.triangles.size(); ++t)
    if (proper(patch.triangles[t]))
      for (const std::uint32_t p : patch.triangles[t]) triangles_[next[p]++] = t;
}

std::vector<std::uint32_t> PatchGraph::rimThrough(std::uint32_t point) const {
  std::vector<std::uint32_t> rim{point};
  std::vector<bool> in(first_triangle_.size() - 1, false);
  in[point] = true;
  for (std::size_t i = 0; i < rim.size(); ++i)
    for (std::uint32_t k = first_neighbour_[rim[i]]; k < first_neighbour_[rim[i] + 1]; ++k)
      if (rim_[k] && !in[neighbours_[k]]) {
        in[neighbours_[k]] = true;
        rim.push_back(neighbours_[k]);
      }
  return rim;
}

std::vector<float> surfaceDistance(const WoodPatch& patch, const PatchGraph& graph,
                                   std::span<const std::uint32_t> sources) {
  std::vector<float> distance(patch.points.size(), kFar);
  std::vector<bool> done(patch.points.size(), false);
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](std::uint32_t point, float value) {
    if (!(value < distance[point])) return;
    distance[point] = value;
    queue.emplace(value, point);
  };
  for (const std::uint32_t s : sources) offer(s, 0.0f);
  while (!queue.empty()) {
    const auto [value, u] = queue.top();
    queue.pop();
    if (done[u]) continue;
    done[u] = true;
    for (const std::uint32_t v : graph.neighbours(u))
      if (!done[v]) offer(v, value + glm::length(patch.points[v] - patch.points[u]));
    for (const std::uint32_t t : graph.triangles(u)) {
      const auto& corners = patch.triangles[t];
      const std::size_t at = corners[0] == u ? 0 : corners[1] == u ? 1 : 2;
      std::uint32_t a = corners[(at + 1) % 3], c = corners[(at + 2) % 3];
      if (done[c]) std::swap(a, c);
      if (!done[a] || done[c]) continue;
      const float reached =
          acrossTriangle(patch.points[a], patch.points[u], patch.points[c], distance[a], value);
      if (reached < kFar) offer(c, std::max(reached, value));
    }
  }
  return distance;
}

}  // namespace verdure
