#ifndef VERDURE_BAKE_CROWN_PARAMETERS_H_
#define VERDURE_BAKE_CROWN_PARAMETERS_H_

#include <vector>

#include "verdure/density.h"

namespace verdure {

/// Centres of a plant's foliage primitives, each at its area-weighted centroid: one for each leaf,
/// but one for each triangle of a "leaf" so large (a welded crown, say) that its centroid would
/// say nothing. Leaves without area are left out and counted.
std::vector<glm::vec3> foliageCenters(const Plant& plant, std::size_t& skipped);

/// A random part of `centers`, round(fraction * count) of them but at least one, in their order.
std::vector<glm::vec3> randomFraction(const std::vector<glm::vec3>& centers, float fraction,
                                      std::uint32_t seed);

/// The radius of influence that suits a crown: a share of its size, but never so small that a leaf
/// inside lacks neighbours.
float defaultRho(const std::vector<glm::vec3>& centers);

struct CrownThresholds {
  float tau = 0.0f;
  float d_min = 0.0f;
};

/// Thresholds from the kernel sums at the generators: tau a share of their median, so that the
/// surface runs where the crown is about that share as dense as in its middle; d_min where the
/// densest tenth of the leaves begins. Either may be given.
CrownThresholds defaultThresholds(std::vector<float> sums, const DensityOptions& options);

}  // namespace verdure

#endif  // VERDURE_BAKE_CROWN_PARAMETERS_H_
