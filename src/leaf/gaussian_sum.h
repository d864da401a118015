#ifndef VERDURE_LEAF_GAUSSIAN_SUM_H_
#define VERDURE_LEAF_GAUSSIAN_SUM_H_

#include <vector>

#include "leaf/texel_kernel.h"

namespace verdure {

/// One Gaussian, averaged over texels: its share of the texel at (i, j) is taps[|i|] taps[|j|].
struct GaussianTerm {
  double sigma_mm = 0.0;
  std::vector<float> taps;     ///< of texels 0 to its radius; all of them, both ways, sum to 1
  std::vector<float> weights;  ///< by thickness: ThicknessGrid::size()
};

/// T(r, d) as a sum over k of weight_k(d) times a Gaussian of r: a low rank in which every term is
/// also separable. T is a mixture of Gaussians, so a few widths in a geometric series do.
struct GaussianSum {
  std::vector<GaussianTerm> terms;
  double residual =
      0.0;  ///< largest over the thicknesses: sum of |error| over that of T, by texels
};

GaussianSum fitGaussians(const Multipole& multipole, double texel, const ThicknessGrid& grid,
                         double radius_mm);

}  // namespace verdure

#endif  // VERDURE_LEAF_GAUSSIAN_SUM_H_
