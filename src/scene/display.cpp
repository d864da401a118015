#include "scene/display.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "scene/look.h"
#include "shared/color.h"
#include "shared/tone.h"

namespace verdure {

namespace {

/// As exposure_mean.comp finds it, kcd/m^2.
float brightLuminance(const HdrImage& image) {
  std::array<std::uint32_t, shared::kLuminanceBins> bins{};
  for (const glm::vec3& c : image.rgb)
    ++bins[static_cast<std::size_t>(shared::luminanceBin(shared::luminanceOf(c)))];
  const float need = shared::kBrightShare * static_cast<float>(image.rgb.size());
  float above = 0.0f;
  for (int bin = shared::kLuminanceBins - 1; bin >= 0; --bin) {
    const auto count = static_cast<float>(bins[static_cast<std::size_t>(bin)]);
    if (count > 0.0f && above + count >= need)
      return shared::luminanceInBin(bin, (need - above) / count);
    above += count;
  }
  return 0.0f;
}

}  // namespace

float averageLuminance(const HdrImage& image) {
  double sum = 0.0;
  for (const glm::vec3& c : image.rgb)
    sum += std::log(double{look::kLeastLuminance} + double{shared::luminanceOf(c)});
  return static_cast<float>(std::exp(sum / static_cast<double>(image.rgb.size())));
}

float automaticWhite(const HdrImage& image, float average, float key) {
  return shared::automaticWhite(average > 0.0f ? brightLuminance(image) * key / average : 0.0f);
}

Image displayed(const HdrImage& image, float average, float key, float white) {
  const float exposure = average > 0.0f ? key / average : 0.0f;
  Image out(image.width, image.height);
  parallelFor(static_cast<std::size_t>(image.height), 8, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width; ++x) {
      const glm::vec3 shown = shared::toneMapped(image.at(x, y) * exposure, white);
      for (int c = 0; c < 3; ++c) {
        const float threshold = shared::ditherThreshold(
            static_cast<float>(x), static_cast<float>(y), static_cast<float>(c));
        const float level = shared::ditheredLevel(
            shared::srgbFromLinear(std::clamp(shown[c], 0.0f, 1.0f)), threshold);
        out.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(level, 0.0f, 255.0f));
      }
      out.at(x, y)[3] = 255;
    }
  });
  return out;
}

}  // namespace verdure
