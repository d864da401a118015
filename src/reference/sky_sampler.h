#ifndef VERDURE_REFERENCE_SKY_SAMPLER_H_
#define VERDURE_REFERENCE_SKY_SAMPLER_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/sky.h"

namespace verdure {

/// Directions drawn as a sky's luminance is distributed: a table of cells of equal solid angle over
/// the whole sphere (Pharr, Jakob, Humphreys, "Physically Based Rendering", 2016, 14.2.4). Every
/// direction has a density above 0, so that nothing is missed between the table's points.
class SkySampler {
 public:
  explicit SkySampler(const Sky& sky);

  /// Black everywhere: nothing to sample.
  bool empty() const { return rows_ == 0; }
  /// A unit direction from two numbers in [0, 1).
  glm::vec3 sample(float u, float v) const;
  /// Density per steradian of sample().
  float density(const glm::vec3& direction) const;

 private:
  int rows_ = 0, columns_ = 0;
  std::vector<float> row_ends_;   ///< cumulative shares of rows
  std::vector<float> cell_ends_;  ///< cumulative shares of cells in their row
};

}  // namespace verdure

#endif  // VERDURE_REFERENCE_SKY_SAMPLER_H_
