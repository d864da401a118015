#ifndef VERDURE_LEAF_TEXEL_KERNEL_H_
#define VERDURE_LEAF_TEXEL_KERNEL_H_

#include <vector>

#include "leaf/multipole.h"

namespace verdure {

/// Share of the light on a texel that leaves the other side's point `dx`, `dy` texels from its
/// middle, times the texel's area: the mean of T over the texel, not T at its middle. Sums to
/// Multipole::total() over all offsets. `texel`: width in mm.
double texelShare(const Multipole& multipole, double texel, int dx, int dy, double thickness);

/// Where a leaf's thicknesses are tabulated: evenly in ln(d - l), because T has its pole near l.
class ThicknessGrid {
 public:
  /// Both at least multipole.leastThickness().
  ThicknessGrid(const Multipole& multipole, double least, double most);

  int size() const { return size_; }
  double thickness(int index) const;
  /// Place of a thickness between the grid's: in [0, size - 1].
  float place(float thickness_mm) const;

 private:
  double free_path_, start_, step_;
  int size_;
};

/// Radius in mm beyond which |T| stays below 1e-6 / mm^2, Habel's threshold, at the least thickness
/// and at the largest (of which either may reach farther); or below a thousandth of what leaves
/// right opposite at the least, where a leaf is so thick that this is less.
double kernelRadius(const Multipole& multipole, double least, double most);

}  // namespace verdure

#endif  // VERDURE_LEAF_TEXEL_KERNEL_H_
