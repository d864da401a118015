#include "plant/weld.h"

#include <cmath>

#include "base/parallel.h"

namespace verdure {
namespace {

/// Vertices closer than this share of the mesh's size (the diagonal of its bounds) are one.
constexpr double kWeldTolerance = 1e-6;

/// Points of one grid cell, sorted[begin, end).
struct Cell {
  std::int64_t x = 0, y = 0, z = 0;
  double along = 0.0;  ///< of the cell's corner on the sweep axis
  std::uint32_t begin = 0, end = 0;
};

}  // namespace

// Cells have a diagonal of at most epsilon, so that the vertices of one cell are one without a
// test; cells near each other are found by a sweep along an axis askew to the coordinate planes
// (flat and gridded meshes would pile up on others).
void weld(const std::vector<glm::vec3>& positions, DisjointSets& sets) {
  if (positions.empty()) return;
  glm::dvec3 low(positions[0]), high(positions[0]);
  for (const glm::vec3& p : positions) {
    low = glm::min(low, glm::dvec3(p));
    high = glm::max(high, glm::dvec3(p));
  }
  const double size = glm::length(high - low);
  const double epsilon = kWeldTolerance * size;
  if (!(epsilon > 0.0)) {
    for (std::uint32_t i = 1; i < positions.size(); ++i) sets.join(0, i);
    return;
  }
  const double side = 0.577 * epsilon;  // below 1 / sqrt(3)
  // At most 1.74e6 cells an axis: 21 bits each.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted(positions.size());
  parallelFor(positions.size(), 8192, [&](std::size_t i) {
    const glm::dvec3 cell = glm::floor((glm::dvec3(positions[i]) - low) / side);
    sorted[i] = {(static_cast<std::uint64_t>(cell.x) << 42) |
                     (static_cast<std::uint64_t>(cell.y) << 21) |
                     static_cast<std::uint64_t>(cell.z),
                 static_cast<std::uint32_t>(i)};
  });
  std::sort(sorted.begin(), sorted.end());
  const glm::dvec3 axis(0.5341, 0.3717, 0.7593);  // unit to four digits, askew
  std::vector<Cell> cells;
  cells.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i > 0 && sorted[i].first == sorted[i - 1].first) {
      sets.join(sorted[i].second, sorted[i - 1].second);
      cells.back().end = static_cast<std::uint32_t>(i + 1);
      continue;
    }
    Cell cell;
    cell.x = static_cast<std::int64_t>(sorted[i].first >> 42);
    cell.y = static_cast<std::int64_t>((sorted[i].first >> 21) & 0x1fffff);
    cell.z = static_cast<std::int64_t>(sorted[i].first & 0x1fffff);
    cell.along = glm::dot(axis, glm::dvec3(cell.x, cell.y, cell.z)) * side;
    cell.begin = static_cast<std::uint32_t>(i);
    cell.end = cell.begin + 1;
    cells.push_back(cell);
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.along < b.along; });
  const double reach = 2.0 * 1.001 * epsilon + epsilon;
  const auto joinIfNear = [&](const Cell& a, const Cell& b) {
    if (sets.find(sorted[a.begin].second) == sets.find(sorted[b.begin].second)) return;
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t j = b.begin; j < b.end; ++j) {
        const glm::dvec3 d =
            glm::dvec3(positions[sorted[i].second]) - glm::dvec3(positions[sorted[j].second]);
        if (glm::dot(d, d) > epsilon * epsilon) continue;
        sets.join(sorted[i].second, sorted[j].second);
        return;
      }
  };
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = a + 1; b < cells.size() && cells[b].along - cells[a].along <= reach; ++b)
      if (std::abs(cells[a].x - cells[b].x) <= 2 && std::abs(cells[a].y - cells[b].y) <= 2 &&
          std::abs(cells[a].z - cells[b].z) <= 2)
        joinIfNear(cells[a], cells[b]);
}

}  // namespace verdure
