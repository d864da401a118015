#ifndef VERDURE_BAKE_GENERATOR_GRID_H_
#define VERDURE_BAKE_GENERATOR_GRID_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "verdure/field.h"

namespace verdure {

/// Generators as the kernels read them: structure of arrays, positions relative to
/// GeneratorGrid::origin. The arrays are kPadding longer than `count`.
struct GeneratorList {
  static constexpr std::size_t kPadding = 64;
  std::vector<float> x, y, z, inverse_radius;
  std::size_t count = 0;

  void reserve(std::size_t capacity) {
    if (x.size() >= capacity + kPadding) return;
    for (std::vector<float>* array : {&x, &y, &z, &inverse_radius})
      array->resize(2 * capacity + kPadding);
  }
};

/// Generators sorted into the cells of a uniform grid, so that those in reach of a box are found in
/// a few contiguous runs. Within a cell they keep their order, hence every sum its order of terms.
class GeneratorGrid {
 public:
  GeneratorGrid() = default;
  GeneratorGrid(std::span<const Generator> generators, Norm::Kind norm);

  const glm::vec3& origin() const { return origin_; }
  /// Bounds of the generators' positions, relative to origin().
  const glm::vec3& extent() const { return extent_; }
  float minRadius() const { return min_radius_; }
  float maxRadius() const { return max_radius_; }
  std::size_t count() const { return sorted_.count; }

  /// Replaces `found` by the generators whose influence can reach the box [low, high] (relative to
  /// origin()): exact for the Euclidean norm, a superset for others.
  void gather(const glm::vec3& low, const glm::vec3& high, GeneratorList& found) const;

  /// Calls visit(low, high) with the bounds (relative to origin()) of each cell that holds
  /// generators.
  template <class Visit>
  void forEachOccupiedCell(const Visit& visit) const {
    std::size_t c = 0;
    for (int z = 0; z < cells_.z; ++z)
      for (int y = 0; y < cells_.y; ++y)
        for (int x = 0; x < cells_.x; ++x, ++c)
          if (first_[c] != first_[c + 1]) {
            const glm::vec3 low = glm::vec3(x, y, z) * cell_;
            visit(low, low + cell_);
          }
  }

 private:
  glm::ivec3 cellOf(const glm::vec3& relative) const;

  glm::vec3 origin_{0.0f};
  glm::vec3 extent_{0.0f};
  float min_radius_ = 0.0f;
  float max_radius_ = 0.0f;
  float cell_ = 1.0f;
  glm::ivec3 cells_{0};
  bool euclidean_ = true;
  std::vector<std::uint32_t> first_;  // per cell, and one more
  GeneratorList sorted_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_GENERATOR_GRID_H_
