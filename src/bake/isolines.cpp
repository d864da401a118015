#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "shared/density.h"
#include "verdure/error.h"
#include "verdure/field.h"

namespace verdure {

float sumAt(std::span<const Generator2> generators, glm::vec2 point) {
  float sum = 0.0f;
  for (const Generator2& g : generators) {
    const glm::vec2 d = (point - g.position) / g.radius;
    sum += shared::metaball(glm::dot(d, d));
  }
  return sum;
}

std::vector<Polyline> isolines(std::span<const Generator2> generators, float tau, int cells) {
  if (cells < 1) throw Error("isolines", "the grid needs at least one cell");
  if (generators.empty()) return {};
  glm::vec2 low(1e30f), high(-1e30f);
  for (const Generator2& g : generators) {
    if (!std::isfinite(g.position.x + g.position.y) || !std::isfinite(g.radius) ||
        !(g.radius > 0.0f))
      throw Error("isolines", "a generator is not finite or has no positive radius");
    low = glm::min(low, g.position - g.radius);
    high = glm::max(high, g.position + g.radius);
  }
  const glm::vec2 size = high - low;
  const float h = std::max(size.x, size.y) / static_cast<float>(cells);
  const glm::ivec2 points = glm::ivec2(glm::ceil(size / h)) + 3;
  const glm::vec2 origin = low - h;
  const auto at = [&](int x, int y) { return origin + h * glm::vec2(x, y); };
  std::vector<float> value(static_cast<std::size_t>(points.x) * static_cast<std::size_t>(points.y));
  const auto valueAt = [&](int x, int y) -> float& {
    return value[static_cast<std::size_t>(y) * static_cast<std::size_t>(points.x) +
                 static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < points.y; ++y)
    for (int x = 0; x < points.x; ++x) valueAt(x, y) = sumAt(generators, at(x, y));

  // An edge of the grid: its lower point and its axis. Each cell links the edge where the line
  // enters to the one where it leaves, with the inside on the left; ambiguous cells separate the
  // inside corners, as marching_cubes.cpp does.
  using Edge = std::array<int, 3>;
  std::map<Edge, Edge> next;
  for (int y = 0; y + 1 < points.y; ++y)
    for (int x = 0; x + 1 < points.x; ++x) {
      const glm::ivec2 corner[4] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
      const Edge edge[4] = {{x, y, 0}, {x + 1, y, 1}, {x, y + 1, 0}, {x, y, 1}};  // i: i to i + 1
      const auto inside = [&](int i) { return valueAt(corner[i & 3].x, corner[i & 3].y) > tau; };
      for (int i = 0; i < 4; ++i) {
        if (!inside(i) || inside(i + 1)) continue;
        int first = i + 4;
        while (inside(first - 1)) --first;
        next[edge[i]] = edge[(first - 1) & 3];
      }
    }
  const auto position = [&](const Edge& e) {
    const glm::ivec2 from(e[0], e[1]),
        to = from + (e[2] == 0 ? glm::ivec2(1, 0) : glm::ivec2(0, 1));
    const float v0 = valueAt(from.x, from.y), v1 = valueAt(to.x, to.y);
    return glm::mix(at(from.x, from.y), at(to.x, to.y), (tau - v0) / (v1 - v0));
  };
  std::vector<Polyline> lines;
  while (!next.empty()) {
    // The field is zero on the border, so every line is closed.
    Polyline line;
    for (auto link = next.begin(); link != next.end();) {
      line.push_back(position(link->first));
      const Edge to = link->second;
      next.erase(link);
      link = next.find(to);
    }
    line.push_back(line.front());
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace verdure
