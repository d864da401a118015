#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "reference/exposure.h"
#include "reference/separable_filter.h"
#include "shared/color.h"
#include "verdure/compare.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// The sum of term(i) over [0, count), in an order that does not depend on threads.
template <class Term>
double orderedSum(std::size_t count, const Term& term) {
  constexpr std::size_t kGrain = 16384;
  std::vector<double> sums((count + kGrain - 1) / kGrain);
  parallelChunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    sums[begin / kGrain] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double decibels(double mean_square, double peak) {
  if (mean_square == 0.0) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(peak * peak / mean_square);
}

// In double: a variance is the small difference of two large squares.
using Luma = Channel<double>;

double lumaOf(const glm::dvec3& srgb) {
  return glm::dot(srgb, glm::dvec3(0.299, 0.587, 0.114));
}

/// Mean SSIM of two planes of values in [0, 255].
double meanSimilarity(const Luma& a, const Luma& b) {
  constexpr int kReach = 5;
  constexpr double kDeviation = 1.5, kC1 = (0.01 * 255) * (0.01 * 255),
                   kC2 = (0.03 * 255) * (0.03 * 255);
  if (a.width <= 2 * kReach || a.height <= 2 * kReach)
    throw Error("SSIM", "the images are smaller than its window of 11 x 11 pixels");
  std::vector<double> window;
  for (int k = -kReach; k <= kReach; ++k)
    window.push_back(std::exp(-k * k / (2.0 * kDeviation * kDeviation)));
  const double sum = std::accumulate(window.begin(), window.end(), 0.0);
  for (double& w : window) w /= sum;

  const auto smoothedProduct = [&window](const Luma& p, const Luma& q) {
    Luma product = p;
    for (std::size_t i = 0; i < product.values.size(); ++i) product.values[i] *= q.values[i];
    return filtered(product, window, window);
  };
  const Luma mean_a = filtered(a, window, window), mean_b = filtered(b, window, window);
  const Luma aa = smoothedProduct(a, a), bb = smoothedProduct(b, b), ab = smoothedProduct(a, b);
  double total = 0.0;
  for (int y = kReach; y < a.height - kReach; ++y)
    for (int x = kReach; x < a.width - kReach; ++x) {
      const double ma = mean_a.row(y)[x], mb = mean_b.row(y)[x];
      const double va = aa.row(y)[x] - ma * ma, vb = bb.row(y)[x] - mb * mb;
      const double covariance = ab.row(y)[x] - ma * mb;
      total += (2.0 * ma * mb + kC1) * (2.0 * covariance + kC2) /
               ((ma * ma + mb * mb + kC1) * (va + vb + kC2));
    }
  return total /
         (static_cast<double>(a.width - 2 * kReach) * static_cast<double>(a.height - 2 * kReach));
}

}  // namespace

double ErrorMap::mean() const {
  const double sum = orderedSum(values.size(), [this](std::size_t i) { return double{values[i]}; });
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

double psnr(const Image& a, const Image& b) {
  checkComparable(a, b);
  const double sum = orderedSum(a.rgba.size() / 4, [&](std::size_t i) {
    double squares = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = static_cast<double>(a.rgba[4 * i + c]) - b.rgba[4 * i + c];
      squares += d * d;
    }
    return squares;
  });
  return decibels(sum / (3.0 * static_cast<double>(a.rgba.size() / 4)), 255.0);
}

double psnr(const HdrImage& reference, const HdrImage& test, std::optional<float> peak) {
  checkComparable(reference, test);
  if (peak && !(*peak > 0.0f)) throw Error("PSNR", "the peak must be above 0");
  const double sum = orderedSum(reference.rgb.size(), [&](std::size_t i) {
    const glm::dvec3 d = glm::dvec3(reference.rgb[i]) - glm::dvec3(test.rgb[i]);
    return glm::dot(d, d);
  });
  float most = 0.0f;
  for (const glm::vec3& c : reference.rgb) most = std::max({most, c.x, c.y, c.z});
  return decibels(sum / (3.0 * static_cast<double>(reference.rgb.size())), peak.value_or(most));
}

double ssim(const Image& a, const Image& b) {
  checkComparable(a, b);
  const auto luma = [](const Image& image) {
    Luma out(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.at(x, y);
        out.row(y)[x] = lumaOf({p[0], p[1], p[2]});
      }
    return out;
  };
  return meanSimilarity(luma(a), luma(b));
}

double ssim(const HdrImage& reference, const HdrImage& test) {
  checkComparable(reference, test);
  const float median = luminanceRange(reference).median;
  const float factor = median > 0.0f ? acesInverse(0.18f) / median : 1.0f;
  const auto luma = [factor](const HdrImage& image) {
    Luma out(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const glm::vec3 shown = aces(image.at(x, y) * factor);
        out.row(y)[x] = lumaOf(255.0 * glm::dvec3(shared::srgbFromLinear(shown.x),
                                                  shared::srgbFromLinear(shown.y),
                                                  shared::srgbFromLinear(shown.z)));
      }
    return out;
  };
  return meanSimilarity(luma(reference), luma(test));
}

Image heatmap(const ErrorMap& map) {
  // "magma" at ninths of its range, sRGB.
  constexpr std::array<std::uint32_t, 10> kStops = {0x000004, 0x180f3e, 0x451077, 0x721f81,
                                                    0x9f2f7f, 0xcd4071, 0xf1605d, 0xfd9567,
                                                    0xfec98d, 0xfcfdbf};
  Image image(map.width, map.height);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const float at = 9.0f * std::clamp(map.values[i], 0.0f, 1.0f);
    const std::size_t low = std::min(static_cast<std::size_t>(at), std::size_t{8});
    for (std::size_t c = 0; c < 3; ++c) {
      const auto stop = [c](std::uint32_t rgb) {
        return static_cast<float>((rgb >> (16 - 8 * c)) & 0xff);
      };
      image.rgba[4 * i + c] = static_cast<std::uint8_t>(std::lround(
          glm::mix(stop(kStops[low]), stop(kStops[low + 1]), at - static_cast<float>(low))));
    }
    image.rgba[4 * i + 3] = 255;
  }
  return image;
}

}  // namespace verdure
