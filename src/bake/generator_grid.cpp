#include "bake/generator_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/field_kernels.h"
#include "verdure/error.h"

namespace verdure {
namespace {

// Cells of half a radius: fewer generators are looked at in vain than with whole radii, while the
// runs stay long enough to stream.
constexpr float kCellsPerRadius = 2.0f;
// A dense array of cells is the fastest index; beyond this many the cells grow instead.
constexpr double kMaxCells = 1 << 24;

}  // namespace

GeneratorGrid::GeneratorGrid(std::span<const Generator> generators, Norm::Kind norm)
    : euclidean_(norm == Norm::Kind::kL2) {
  if (generators.empty()) return;
  glm::vec3 low = generators[0].position, high = low;
  min_radius_ = generators[0].radius;
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const Generator& g = generators[i];
    const float sum = g.position.x + g.position.y + g.position.z;
    // The kernels square the radius and its inverse.
    if (!std::isfinite(sum) || !(g.radius > 1e-15f) || !(g.radius < 1e15f))
      throw Error(
          "density field",
          "generator " + std::to_string(i) + " is not finite or its radius is not in (1e-15, 1e15)",
          "check the leaves and rho");
    low = glm::min(low, g.position);
    high = glm::max(high, g.position);
    max_radius_ = std::max(max_radius_, g.radius);
    min_radius_ = std::min(min_radius_, g.radius);
  }
  if (!std::isfinite(glm::dot(high - low, glm::vec3(1.0f))))
    throw Error("density field", "the generators are too far apart", "check the leaves");
  origin_ = low;
  extent_ = high - low;
  cell_ = max_radius_ / kCellsPerRadius;
  const auto cellsAt = [&](float size) {
    double total = 1.0;
    for (int a = 0; a < 3; ++a) total *= std::floor(double{extent_[a]} / double{size}) + 1.0;
    return total;
  };
  while (cellsAt(cell_) > kMaxCells) cell_ *= 1.3f;
  for (int a = 0; a < 3; ++a) cells_[a] = static_cast<int>(std::floor(extent_[a] / cell_)) + 1;

  const auto cell_count = static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) *
                          static_cast<std::size_t>(cells_.z);
  std::vector<std::uint32_t> cell_of(generators.size());
  first_.assign(cell_count + 1, 0);
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const glm::ivec3 c = cellOf(generators[i].position - origin_);
    cell_of[i] = static_cast<std::uint32_t>((c.z * cells_.y + c.y) * cells_.x + c.x);
    ++first_[cell_of[i] + 1];
  }
  for (std::size_t c = 0; c < cell_count; ++c) first_[c + 1] += first_[c];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  sorted_.reserve(generators.size());
  sorted_.count = generators.size();
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const glm::vec3 p = generators[i].position - origin_;
    const std::uint32_t at = next[cell_of[i]]++;
    sorted_.x[at] = p.x;
    sorted_.y[at] = p.y;
    sorted_.z[at] = p.z;
    sorted_.inverse_radius[at] = 1.0f / generators[i].radius;
  }
}

glm::ivec3 GeneratorGrid::cellOf(const glm::vec3& relative) const {
  // Clamped as floats: a box far outside must not overflow the conversion.
  const glm::vec3 last = glm::vec3(cells_ - 1);
  return glm::ivec3(glm::clamp(glm::floor(relative / cell_), glm::vec3(0.0f), last));
}

void GeneratorGrid::gather(const glm::vec3& low, const glm::vec3& high,
                           GeneratorList& found) const {
  found.count = 0;
  if (sorted_.count == 0) return;
  const glm::vec3 reach_low = low - max_radius_, reach_high = high + max_radius_;
  for (int a = 0; a < 3; ++a)
    if (reach_high[a] < 0.0f || reach_low[a] > extent_[a]) return;
  const glm::ivec3 from = cellOf(reach_low), to = cellOf(reach_high);
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y) {
      // Cells of a row follow each other, and so do their generators.
      const std::size_t row =
          static_cast<std::size_t>(z * cells_.y + y) * static_cast<std::size_t>(cells_.x);
      appendInReach(sorted_, first_[row + static_cast<std::size_t>(from.x)],
                    first_[row + static_cast<std::size_t>(to.x) + 1], low, high, euclidean_, found);
    }
}

}  // namespace verdure
