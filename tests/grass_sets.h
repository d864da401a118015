#ifndef VERDURE_TESTS_GRASS_SETS_H_
#define VERDURE_TESTS_GRASS_SETS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "verdure/grass.h"

namespace verdure {

/// A small set of bent tufts and ovals on stalks.
inline GrassSet smallSet(std::uint64_t seed = 3) {
  GrassSpecies species = grassSpecies("clover");
  species.spacing_m = 0.03f;
  species.tile_m = 0.3f;
  GrassGrowOptions options;
  options.seed = seed;
  options.texels_per_m = 160;
  options.kinds = 3;
  return growGrass(species, options);
}

inline glm::dvec4 meanOf(const std::vector<glm::vec4>& values) {
  glm::dvec4 sum(0.0);
  for (const glm::vec4& v : values) sum += glm::dvec4(v);
  return sum / static_cast<double>(values.size());
}

inline double largest(const glm::dvec4& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
}

}  // namespace verdure

#endif  // VERDURE_TESTS_GRASS_SETS_H_
