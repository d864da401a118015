#ifndef VERDURE_REFERENCE_EXPOSURE_H_
#define VERDURE_REFERENCE_EXPOSURE_H_

#include "verdure/compare.h"

// What comparisons of HDR images share: which exposures show an image, and through which curve.

namespace verdure {

/// Narkowicz's fit of the ACES tone curve, 2016, with its factor of 0.6 before: linear values from
/// 0 up to linear ones in [0, 1]. Negative values count as 0.
glm::vec3 aces(const glm::vec3& linear);

/// The value that aces() maps to `tone`, in (0, 1).
float acesInverse(float tone);

struct LuminanceRange {
  float most = 0.0f;
  float median = 0.0f;  ///< of the pixels that are not black, where half or more are; else of all
};
/// Rec. 709 luminances. All 0 for a black image.
LuminanceRange luminanceRange(const HdrImage& image);

/// Throw Error if the sizes differ or are 0.
void checkComparable(const Image& a, const Image& b);
void checkComparable(const HdrImage& a, const HdrImage& b);

}  // namespace verdure

#endif  // VERDURE_REFERENCE_EXPOSURE_H_
