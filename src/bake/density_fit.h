#ifndef VERDURE_BAKE_DENSITY_FIT_H_
#define VERDURE_BAKE_DENSITY_FIT_H_

#include <span>

namespace verdure {

/// Parameters of (4) beside rho.
struct Falloff {
  float tau = 0.0f, d_min = 1.0f, k_min = 0.2f, exponent = 1.0f;
};

/// The falloff whose coefficients of the kernel sums come closest to `target` (RMS, returned).
/// k_min follows from the others by least squares; tau, d_min and the exponent by a coarse search
/// over the sums' quantiles, refined from the best few.
double fitFalloff(std::span<const float> sums, std::span<const float> target, Falloff& best);

}  // namespace verdure

#endif  // VERDURE_BAKE_DENSITY_FIT_H_
