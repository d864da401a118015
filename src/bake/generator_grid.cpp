#include "bake/generator_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

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
  float min_radius = generators[0].radius;
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const Generator& g = generators[i];
    const float sum = g.position.x + g.position.y + g.position.z;
    if (!std::isfinite(sum) || !std::isfinite(g.radius) || !(g.radius > 0.0f))
      throw Error("density field",
                  "generator " + std::to_string(i) + " is not finite or has no positive radius",
                  "check the leaves and rho");
    low = glm::min(low, g.position);
    high = glm::max(high, g.position);
    max_radius_ = std::max(max_radius_, g.radius);
    min_radius = std::min(min_radius, g.radius);
  }
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
  packed_.resize(generators.size());
  for (std::size_t i = 0; i < generators.size(); ++i) {
    const glm::vec3 p = generators[i].position - origin_;
    packed_[next[cell_of[i]]++] = {p.x, p.y, p.z, 1.0f / generators[i].radius};
  }
}

glm::ivec3 GeneratorGrid::cellOf(const glm::vec3& relative) const {
  // Clamped as floats: a box far outside must not overflow the conversion.
  const glm::vec3 last = glm::vec3(cells_ - 1);
  return glm::ivec3(glm::clamp(glm::floor(relative / cell_), glm::vec3(0.0f), last));
}

void GeneratorGrid::gather(const glm::vec3& low, const glm::vec3& high,
                           std::vector<PackedGenerator>& found) const {
  found.clear();
  if (packed_.empty()) return;
  const glm::vec3 reach_low = low - max_radius_, reach_high = high + max_radius_;
  for (int a = 0; a < 3; ++a)
    if (reach_high[a] < 0.0f || reach_low[a] > extent_[a]) return;
  const glm::ivec3 from = cellOf(reach_low), to = cellOf(reach_high);
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y) {
      const std::size_t row = static_cast<std::size_t>((z * cells_.y + y) * cells_.x);
      const std::uint32_t begin = first_[row + static_cast<std::size_t>(from.x)];
      const std::uint32_t end = first_[row + static_cast<std::size_t>(to.x) + 1];
      std::size_t n = found.size();
      found.resize(n + (end - begin));  // trimmed below: appending without a branch
      for (std::uint32_t i = begin; i < end; ++i) {
        const PackedGenerator& g = packed_[i];
        const float dx = std::max(std::max(low.x - g.x, g.x - high.x), 0.0f);
        const float dy = std::max(std::max(low.y - g.y, g.y - high.y), 0.0f);
        const float dz = std::max(std::max(low.z - g.z, g.z - high.z), 0.0f);
        // Every Lp ball lies in the cube of the same radius.
        const float d2 = euclidean_ ? dx * dx + dy * dy + dz * dz
                                    : std::max(dx * dx, std::max(dy * dy, dz * dz));
        found[n] = g;
        n += d2 * g.inverse_radius * g.inverse_radius < 1.0f ? 1 : 0;
      }
      found.resize(n);
    }
}

}  // namespace verdure
