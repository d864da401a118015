#ifndef VERDURE_BAKE_FIELD_KERNELS_H_
#define VERDURE_BAKE_FIELD_KERNELS_H_

#include <cstddef>

#include "bake/generator_grid.h"

/// The inner loops of the density field, in SIMD with dispatch at run time. Each lane is one point
/// and runs over the generators in order, so a sum does not depend on the width of the vectors.
namespace verdure {

/// Points of a lattice come in blocks of this many.
inline constexpr int kBlockX = 8;
inline constexpr int kBlockY = 4;
inline constexpr int kBlockZ = 4;
inline constexpr int kBlockPoints = kBlockX * kBlockY * kBlockZ;

/// Appends those generators of list[begin, end) to `found` that reach the box [low, high]:
/// Euclidean distance, or (a superset for every other norm) the largest component.
void appendInReach(const GeneratorList& list, std::size_t begin, std::size_t end,
                   const glm::vec3& low, const glm::vec3& high, bool euclidean,
                   GeneratorList& found);

/// `weight` times the kernel sums (2), (3) at one block of lattice points, x fastest; `low` is its
/// first point. Returns the least and the largest of them.
glm::vec2 sumOnBlock(const Norm& norm, float weight, const GeneratorList& generators,
                     const glm::vec3& low, float spacing, float* sums);

/// For each of a block's points, a bound of the second derivatives over the lattice cell whose
/// lowest corner it is: sum over generators of sup |Hessian|_2, so that inside the cell the field
/// is within 3/8 spacing^2 bound of the trilinear interpolation of its corners (Taylor's theorem
/// about the point, its first-order terms cancel). Euclidean norm.
void curvatureOnBlock(const GeneratorList& generators, const glm::vec3& low, float spacing,
                      float* bounds);

/// Points in structure-of-arrays form; `count` is a multiple of kPointLanes.
inline constexpr std::size_t kPointLanes = 16;
struct PointArrays {
  const float* x;
  const float* y;
  const float* z;
  std::size_t count;
};

void sumAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                 float* sums);

/// Also the gradient with respect to the point.
void gradientAtPoints(const Norm& norm, const GeneratorList& generators, const PointArrays& points,
                      float* sums, float* gx, float* gy, float* gz);

}  // namespace verdure

#endif  // VERDURE_BAKE_FIELD_KERNELS_H_
