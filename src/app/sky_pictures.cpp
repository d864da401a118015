#include "app/sky_pictures.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shared/color.h"

namespace verdure::app {
namespace {

constexpr glm::vec3 kPhotometric(0.2126f, 0.7152f, 0.0722f);

}  // namespace

HdrImage drawFisheye(const Light& light, int size) {
  HdrImage image(size, size);
  parallelFor(static_cast<std::size_t>(size), 8, [&](std::size_t row) {
    const auto middle = [size](int i) {
      return 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(size) - 1.0f;
    };
    const float south = middle(static_cast<int>(row));
    for (int x = 0; x < size; ++x) {
      const float east = -middle(x), radius = std::hypot(east, south);
      if (radius > 1.0f) continue;
      const float zenith = radius * glm::half_pi<float>();
      const float s = radius > 0.0f ? std::sin(zenith) / radius : 0.0f;
      image.at(x, static_cast<int>(row)) =
          light({s * east, std::max(std::cos(zenith), 0.0f), s * south});
    }
  });
  return image;
}

HdrImage drawPanorama(const Light& light, int height) {
  HdrImage image(2 * height, height);
  parallelFor(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
    const float step = glm::pi<float>() / static_cast<float>(height);
    const float zenith = (static_cast<float>(row) + 0.5f) * step;
    for (int x = 0; x < image.width; ++x) {
      const float from_north = (static_cast<float>(x - height) + 0.5f) * step;
      image.at(x, static_cast<int>(row)) =
          light({std::sin(zenith) * std::sin(from_north), std::cos(zenith),
                 -std::sin(zenith) * std::cos(from_north)});
    }
  });
  return image;
}

float meanLuminance(const HdrImage& image) {
  double sum = 0.0, count = 0.0;
  for (const glm::vec3& p : image.rgb) {
    const float y = glm::dot(p, kPhotometric);
    if (y <= 0.0f) continue;
    sum += double{y};
    count += 1.0;
  }
  return count > 0.0 ? static_cast<float>(sum / count) : 1.0f;
}

Image toneMapped(const HdrImage& image, float mean) {
  constexpr float kKey = 0.6f;
  Image out(image.width, image.height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const glm::vec3 color = glm::max(image.rgb[i], glm::vec3(0.0f)) * (kKey / mean);
    const glm::vec3 mapped = color / (1.0f + glm::dot(color, kPhotometric));
    for (int c = 0; c < 3; ++c)
      out.rgba[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(
          255.0f * shared::srgbFromLinear(std::min(mapped[c], 1.0f)) + 0.5f);
    out.rgba[4 * i + 3] = 255;
  }
  return out;
}

}  // namespace verdure::app
