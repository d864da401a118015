#ifndef VERDURE_BAKE_DEPTH_KERNEL_H_
#define VERDURE_BAKE_DEPTH_KERNEL_H_

#include <cstddef>
#include <vector>

/// The inner loop of the optical-depth field, in SIMD with dispatch at run time. Each lane is one
/// point and runs over the terms in order, so a sum does not depend on the width of the vectors.
namespace verdure {

/// Surfels and nodes of the tree, both of the form
///   w = half_area / (4 pi r^2 + softening).
struct DepthTerms {
  std::vector<float> x, y, z, half_area, softening;
  std::size_t count = 0;

  void clear() { count = 0; }
  void add(float px, float py, float pz, float half, float soft) {
    if (count == x.size()) {
      const std::size_t size = 2 * count + 64;
      for (std::vector<float>* v : {&x, &y, &z, &half_area, &softening}) v->resize(size);
    }
    x[count] = px;
    y[count] = py;
    z[count] = pz;
    half_area[count] = half;
    softening[count] = soft;
    ++count;
  }
};

/// Points in structure-of-arrays form; `count` is a multiple of kDepthLanes.
inline constexpr std::size_t kDepthLanes = 16;
struct DepthPoints {
  const float *x, *y, *z;
  const float *nx, *ny, *nz;
  std::size_t count;
};

/// The weight 1 + gain R^2 / (R^2 + r^2) of each term as (a + r^2) / (b + r^2).
struct NearWeight {
  float a = 1.0f;
  float b = 1.0f;
};

/// out[j * points.count + i] = component j of point i: depth, toward x, y, z, hemisphere.
void sumDepthTerms(const DepthTerms& terms, const DepthPoints& points, const NearWeight& near,
                   float* out);

}  // namespace verdure

#endif  // VERDURE_BAKE_DEPTH_KERNEL_H_
