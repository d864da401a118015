#include "bake/field.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/block_lattice.h"
#include "bake/field_kernels.h"
#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

// Points are taken this many at a time and sorted in place into bins; meshes come in spatially
// coherent order, so that a batch fills few bins and no global sort is needed.
constexpr std::size_t kBatch = 8192;
// Bins of a third of a radius: small enough that most gathered generators reach most points.
constexpr float kBinsPerRadius = 3.0f;

/// Runs evaluate(generators, point indices, arrays) for groups of neighbouring points.
class BatchedPoints {
 public:
  explicit BatchedPoints(const GeneratorGrid& grid)
      : grid_(grid), bin_(std::max(grid.maxRadius(), 1e-30f) / kBinsPerRadius) {}

  template <class Evaluate>
  void run(std::span<const glm::vec3> points, std::size_t begin, std::size_t end,
           const Evaluate& evaluate) {
    order_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 bin = glm::clamp(glm::floor((points[i] - grid_.origin()) / bin_),
                                       glm::vec3(-1048576.0f), glm::vec3(1048575.0f));
      std::uint64_t key = 0;
      for (int a = 2; a >= 0; --a)
        key = key << 21 | static_cast<std::uint64_t>(static_cast<std::int64_t>(bin[a]) + 1048576);
      order_.push_back({key, static_cast<std::uint32_t>(i - begin)});
    }
    std::sort(order_.begin(), order_.end());
    for (std::size_t first = 0; first < order_.size();) {
      std::size_t last = first;
      while (last < order_.size() && order_[last].first == order_[first].first) ++last;
      load(points, begin, first, last);
      grid_.gather(low_, high_, generators_);
      evaluate(
          generators_, PointArrays{x_.data(), y_.data(), z_.data(), x_.size()},
          [&](std::size_t k) { return begin + order_[first + k].second; }, last - first);
      first = last;
    }
  }

 private:
  void load(std::span<const glm::vec3> points, std::size_t begin, std::size_t first,
            std::size_t last) {
    const std::size_t padded = (last - first + kPointLanes - 1) / kPointLanes * kPointLanes;
    x_.resize(padded);
    y_.resize(padded);
    z_.resize(padded);
    low_ = high_ = points[begin + order_[first].second] - grid_.origin();
    for (std::size_t k = 0; k < padded; ++k) {
      const std::size_t from = std::min(first + k, last - 1);  // the padding repeats the last point
      const glm::vec3 p = points[begin + order_[from].second] - grid_.origin();
      x_[k] = p.x;
      y_[k] = p.y;
      z_[k] = p.z;
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
  }

  const GeneratorGrid& grid_;
  float bin_;
  glm::vec3 low_{0.0f}, high_{0.0f};
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order_;
  GeneratorList generators_;
  std::vector<float> x_, y_, z_;
};

}  // namespace

DensityField::DensityField(std::span<const Generator> generators, const Norm& norm, float weight)
    : state_(std::make_unique<State>()) {
  if (norm.kind == Norm::Kind::kLp && !(norm.p >= 1.0f && std::isfinite(norm.p)))
    throw Error("density field", "the norm's exponent must be at least 1");
  state_->grid = GeneratorGrid(generators, norm.kind);
  state_->norm = norm;
  state_->weight = weight;
}
DensityField::~DensityField() = default;
DensityField::DensityField(DensityField&&) noexcept = default;
DensityField& DensityField::operator=(DensityField&&) noexcept = default;

std::size_t DensityField::generatorCount() const {
  return state_->grid.count();
}
float DensityField::maxRadius() const {
  return state_->grid.maxRadius();
}

void DensityField::sumAt(std::span<const glm::vec3> points, std::span<float> sums) const {
  parallelChunks(points.size(), kBatch, [&](std::size_t begin, std::size_t end) {
    BatchedPoints batch(state_->grid);
    std::vector<float> lanes;
    batch.run(points, begin, end,
              [&](const GeneratorList& generators, const PointArrays& arrays, const auto& index,
                  std::size_t count) {
                lanes.resize(arrays.count);
                sumAtPoints(state_->norm, generators, arrays, lanes.data());
                for (std::size_t k = 0; k < count; ++k) sums[index(k)] = state_->weight * lanes[k];
              });
  });
}

void DensityField::gradientAt(std::span<const glm::vec3> points, std::span<float> sums,
                              std::span<glm::vec3> gradients) const {
  parallelChunks(points.size(), kBatch, [&](std::size_t begin, std::size_t end) {
    BatchedPoints batch(state_->grid);
    std::vector<float> lanes;
    batch.run(points, begin, end,
              [&](const GeneratorList& generators, const PointArrays& arrays, const auto& index,
                  std::size_t count) {
                const std::size_t n = arrays.count;
                lanes.resize(4 * n);
                float* const l = lanes.data();
                gradientAtPoints(state_->norm, generators, arrays, l, l + n, l + 2 * n, l + 3 * n);
                for (std::size_t k = 0; k < count; ++k) {
                  sums[index(k)] = state_->weight * l[k];
                  gradients[index(k)] =
                      state_->weight * glm::vec3(l[n + k], l[2 * n + k], l[3 * n + k]);
                }
              });
  });
}

Lattice DensityField::lattice(int cells, float cell_extent) const {
  if (cells < 1) throw Error("density field", "the grid needs at least one cell", "raise --grid");
  const GeneratorGrid& grid = state_->grid;
  if (grid.count() == 0) throw Error("density field", "there are no generators");
  const glm::vec3 size = grid.extent() + 2.0f * grid.maxRadius();
  const float longest = std::max(size.x, std::max(size.y, size.z));
  Lattice lattice;
  lattice.spacing = (cell_extent > 0.0f ? cell_extent : longest) / static_cast<float>(cells);
  // One cell of margin: the outermost points are outside all influence, so the surface closes.
  lattice.origin = grid.origin() - grid.maxRadius() - lattice.spacing;
  for (int a = 0; a < 3; ++a) {
    const double steps = std::ceil(double{size[a]} / double{lattice.spacing});
    if (steps > 1e6)
      throw Error("density field", "the grid would have more than a million cells along one axis",
                  "use a coarser --grid");
    lattice.points[a] = static_cast<int>(steps) + 3;
  }
  return lattice;
}

std::vector<float> DensityField::sumOn(const Lattice& lattice) const {
  BlockLattice blocks(lattice);
  blocks.markReach(state_->grid);
  blocks.evaluate(*state_);
  const auto nx = static_cast<std::size_t>(lattice.points.x),
             ny = static_cast<std::size_t>(lattice.points.y),
             nz = static_cast<std::size_t>(lattice.points.z);
  std::vector<float> sums(nx * ny * nz);
  parallelFor(nz, 1, [&](std::size_t z) {
    for (std::size_t y = 0; y < ny; ++y)
      for (std::size_t x = 0; x < nx; ++x)
        sums[(z * ny + y) * nx + x] = blocks.valueOrZero(glm::ivec3(x, y, z));
  });
  return sums;
}

}  // namespace verdure
