#include "reference/exposure.h"

#include <algorithm>
#include <cmath>

#include "verdure/error.h"

namespace verdure {
namespace {

// (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5)
constexpr float kBefore = 0.6f;
constexpr float k0 = kBefore * kBefore * 2.51f, k1 = kBefore * 0.03f,
                k3 = kBefore * kBefore * 2.43f, k4 = kBefore * 0.59f, k5 = 0.14f;

template <class AnyImage>
void checkSizes(const AnyImage& a, const AnyImage& b) {
  if (a.empty() || b.empty()) throw Error("compare", "an image has no pixels");
  if (a.width != b.width || a.height != b.height)
    throw Error("compare",
                "the images have different sizes, " + std::to_string(a.width) + "x" +
                    std::to_string(a.height) + " and " + std::to_string(b.width) + "x" +
                    std::to_string(b.height),
                "compare pictures of one size");
}

}  // namespace

glm::vec3 aces(const glm::vec3& linear) {
  const glm::vec3 x = glm::clamp(linear, 0.0f, 1e6f);  // its square stays finite
  return glm::min((x * (k0 * x + k1)) / (x * (k3 * x + k4) + k5), 1.0f);
}

float acesInverse(float tone) {
  const float a = k0 - k3 * tone, b = k1 - k4 * tone, c = -k5 * tone;
  return (-b + std::sqrt(b * b - 4.0f * a * c)) / (2.0f * a);
}

LuminanceRange luminanceRange(const HdrImage& image) {
  std::vector<float> y(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), y.begin(), [](const glm::vec3& c) {
    return std::max(glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)), 0.0f);
  });
  const auto median = [&y](std::size_t first) {  // of y[first], ...; the lower one of two
    const auto begin = y.begin() + static_cast<std::ptrdiff_t>(first);
    const auto middle = begin + (y.end() - begin - 1) / 2;
    std::nth_element(begin, middle, y.end());
    return *middle;
  };
  LuminanceRange range{*std::max_element(y.begin(), y.end()), median(0)};
  if (range.most > 0.0f && range.median <= 0.0f) {
    const auto lit = std::partition(y.begin(), y.end(), [](float v) { return v <= 0.0f; });
    range.median = median(static_cast<std::size_t>(lit - y.begin()));
  }
  return range;
}

void checkComparable(const Image& a, const Image& b) {
  checkSizes(a, b);
}
void checkComparable(const HdrImage& a, const HdrImage& b) {
  checkSizes(a, b);
}

}  // namespace verdure
