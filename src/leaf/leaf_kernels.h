#ifndef VERDURE_LEAF_LEAF_KERNELS_H_
#define VERDURE_LEAF_LEAF_KERNELS_H_

#include <cstddef>
#include <span>

namespace verdure {

/// Rows of planes are padded with zeros to a multiple of this, so that no loop has a rest.
inline constexpr std::size_t kPlaneLanes = 64;

/// A direction of light between two azimuths whose horizons are known.
struct LitDirection {
  float x = 0.0f, y = 0.0f, z = 1.0f;
  float share = 0.0f;                     ///< of the second azimuth, [0, 1]
  float slope = 0.0f;                     ///< rise over run: lit where the horizon's is not above
  float weights[3] = {0.0f, 0.0f, 0.0f};  ///< what of its light each sum gets
};

/// What light meets: arrays of as many values as there are texels, a multiple of kPlaneLanes.
struct LitTexels {
  const float *x, *y, *z;       ///< normals
  const float* entering;        ///< share of light that enters
  const float *first, *second;  ///< slope of the horizon at both azimuths
};

/// sums[i][t] += weights[i] E(t, w), summed over the directions w: (3.13), for `count` texels.
void addDirections(std::span<const LitDirection> directions, const LitTexels& texels,
                   std::size_t begin, std::size_t count, float* const sums[3]);

/// to[x] = sum over |k| < taps of taps[|k|] from[x + k]; `from` has that many readable values on
/// both sides. `count`: a multiple of kPlaneLanes.
void convolveRow(const float* from, float* to, std::size_t count, std::span<const float> taps);

/// to[x] += the same down the columns: rows[k] is the row k - (taps - 1) away.
void addColumns(const float* const* rows, float* to, std::size_t count,
                std::span<const float> taps);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_KERNELS_H_
