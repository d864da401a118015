#ifndef VERDURE_LEAF_PLANE_TRANSFORM_H_
#define VERDURE_LEAF_PLANE_TRANSFORM_H_

#include <complex>
#include <vector>

namespace verdure {

/// Fourier transform of a plane of width x height values, rows first, in parallel; without any
/// factor in both directions. Fast for sizes of small factors, see fastSize().
void transformPlane(std::vector<std::complex<float>>& plane, int width, int height, bool inverse);

/// The least size of factors 2, 3 and 5 that is not below `size`.
int fastSize(int size);

}  // namespace verdure

#endif  // VERDURE_LEAF_PLANE_TRANSFORM_H_
