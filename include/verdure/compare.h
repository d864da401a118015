#ifndef VERDURE_COMPARE_H_
#define VERDURE_COMPARE_H_

#include <optional>
#include <vector>

#include "verdure/image.h"

/// How different two pictures are. All functions throw Error if the sizes differ or are 0; alpha is
/// ignored; results are the same to the bit for any number of threads.
namespace verdure {

/// One value for each pixel, rows from the top.
struct ErrorMap {
  int width = 0, height = 0;
  std::vector<float> values;

  double mean() const;
};

/// Pixels per degree of vision of a 0.7 m wide monitor of 3840 pixels, seen from 0.7 m.
inline constexpr float kPixelsPerDegree = 67.0f;

/// FLIP of two sRGB images: 0 = the same, 1 = as different as can be, as a viewer sees it who flips
/// between them. Symmetric. Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild,
/// "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
ErrorMap flip(const Image& a, const Image& b, float pixels_per_degree = kPixelsPerDegree);

/// Mean of flip().
double meanFlip(const Image& a, const Image& b, float pixels_per_degree = kPixelsPerDegree);

/// HDR-FLIP: at each pixel the largest FLIP over a range of exposures.
struct HdrFlip {
  ErrorMap map;
  float start_exposure = 0.0f, stop_exposure = 0.0f;  ///< log2 of the factors on the pixels
  int exposures = 0;                                  ///< evenly spaced from start to stop
};

/// The range runs from where the brightest pixel of `reference` is mapped to 0.85 by the ACES tone
/// curve (Narkowicz's fit) to where its median is; of an image that is black at the median, the
/// median of the rest. Andersson, Nilsson, Shirley, Akenine-Moeller, "Visualizing Errors in
/// Rendered High Dynamic Range Images", Eurographics 2021. Negative values count as 0.
HdrFlip hdrFlip(const HdrImage& reference, const HdrImage& test,
                float pixels_per_degree = kPixelsPerDegree);

/// Peak signal to noise ratio over R, G and B, dB; infinite for equal images. Of sRGB values, with
/// the peak 255.
double psnr(const Image& a, const Image& b);

/// The same of linear values. `peak`: by default the largest value of `reference`; give one to
/// compare across pictures, or when the sun is in view.
double psnr(const HdrImage& reference, const HdrImage& test, std::optional<float> peak = {});

/// Mean structural similarity of the luma (Rec. 601, of sRGB values): 1 = the same, from -1. Wang,
/// Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
/// Similarity", 2004: Gaussian window of 11 x 11 pixels with a deviation of 1.5, K1 = 0.01, K2 =
/// 0.03, L = 255, over windows inside the image. Throws Error also below 11 x 11 pixels.
double ssim(const Image& a, const Image& b);

/// The same of HDR images, both through the tone curve of hdrFlip() and sRGB's, exposed so that the
/// median of `reference` comes to middle grey (0.18).
double ssim(const HdrImage& reference, const HdrImage& test);

/// A map as colours, 0 = black over purple and orange to 1 = pale yellow: the colour map "magma" of
/// van der Walt and Smith.
Image heatmap(const ErrorMap& map);

}  // namespace verdure

#endif  // VERDURE_COMPARE_H_
