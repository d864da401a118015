#ifndef VERDURE_COMPARE_H_
#define VERDURE_COMPARE_H_

#include "verdure/image.h"

namespace verdure {

/// Mean of the FLIP difference map of two sRGB images of equal size: 0 = the same, 1 = as different
/// as can be, as a viewer sees it who flips between them. `pixels_per_degree`: of the display as
/// seen; 67 is a 0.7 m wide monitor of 3840 pixels at 0.7 m. Alpha is ignored.
/// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator
/// for Alternating Images", HPG 2020 (the LDR variant). Throws Error if the sizes differ or are 0.
double meanFlip(const Image& a, const Image& b, float pixels_per_degree = 67.0f);

}  // namespace verdure

#endif  // VERDURE_COMPARE_H_
