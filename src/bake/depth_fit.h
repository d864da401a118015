#ifndef VERDURE_BAKE_DEPTH_FIT_H_
#define VERDURE_BAKE_DEPTH_FIT_H_

#include <functional>
#include <span>
#include <vector>

#include "verdure/occlusion.h"
#include "verdure/optical_depth.h"

namespace verdure {

/// Vertices of a plant at which openness was traced. Those that see nothing (the base of a leaf
/// inside its twig) are left out: nobody sees them, and their darkness is not their surroundings'.
struct TracedSamples {
  std::vector<VertexId> vertices;
  std::vector<float> openness;
  std::vector<float> light;  ///< on the side of the given normals, see Openness::light
};

/// `count` vertices of each kind of part, taken evenly at random (all, where there are fewer).
TracedSamples traceSamples(const Plant& plant, std::size_t count, int rays, std::uint32_t seed,
                           std::size_t max_memory_bytes,
                           const std::function<glm::vec3(VertexId)>& normalOf = {});

/// Where a leaf's vertex looks: out of the crown, where it is thinnest; `own` in its very middle.
glm::vec3 crownNormalOf(const DepthSums& sums, const glm::vec3& own);

/// Fits a, b and k of all models to traced openness and light. `sums` are those of all vertices.
DepthFit fitDepthModels(const Plant& plant, std::span<const DepthSums> sums, std::uint32_t seed,
                        std::size_t max_memory_bytes);

}  // namespace verdure

#endif  // VERDURE_BAKE_DEPTH_FIT_H_
