#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "verdure/error.h"
#include "verdure/sky.h"

namespace verdure {
namespace {

class ImageSky final : public Sky {
 public:
  ImageSky(HdrImage image, float turn) : image_(std::move(image)), turn_(turn) {}

  glm::vec3 luminance(const glm::vec3& d) const override {
    if (d.y < 0.0f) return glm::vec3(0.0f);
    const float across = std::hypot(d.x, d.z);
    // The middle of the picture is north (-Z), its right half east (+X), seen from inside.
    const float azimuth = std::atan2(d.x, d.z) - turn_;
    const float u = 1.0f - azimuth / glm::two_pi<float>();
    const float v = std::atan2(across, d.y) / glm::pi<float>();
    return bilinear((u - std::floor(u)) * static_cast<float>(image_.width) - 0.5f,
                    v * static_cast<float>(image_.height) - 0.5f);
  }
  /// Four rows to a pixel: one bright pixel is missed by a few percent at most.
  int rows() const override { return std::max(2 * image_.height, Sky::rows()); }

 private:
  glm::vec3 bilinear(float x, float y) const {
    const float fx = std::floor(x), fy = std::floor(y);
    const auto column = [&](int i) { return (i + image_.width) % image_.width; };
    const auto row = [&](int i) { return std::clamp(i, 0, image_.height - 1); };
    const int x0 = column(static_cast<int>(fx)), x1 = column(static_cast<int>(fx) + 1);
    const int y0 = row(static_cast<int>(fy)), y1 = row(static_cast<int>(fy) + 1);
    return glm::mix(glm::mix(image_.at(x0, y0), image_.at(x1, y0), x - fx),
                    glm::mix(image_.at(x0, y1), image_.at(x1, y1), x - fx), y - fy);
  }

  HdrImage image_;
  float turn_;
};

}  // namespace

std::shared_ptr<const Sky> imageSky(HdrImage image, float turn, float scale) {
  if (image.width < 2 || image.width != 2 * image.height)
    throw Error("sky image",
                fmt::format("{} x {} pixels are no panorama", image.width, image.height),
                "give one that is twice as wide as high (latitude and longitude)");
  if (!(scale >= 0.0f && std::isfinite(scale) && std::isfinite(turn)))
    throw Error("sky image", "its scale or turn is not finite", "use 1 and 0");
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::vec3& p = image.at(x, y);
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(p[c]))
          throw Error("sky image", fmt::format("the pixel at {}, {} is not finite", x, y),
                      "mend it, or save the picture again");
      p = glm::max(p, glm::vec3(0.0f)) * scale;
    }
  return std::make_shared<ImageSky>(std::move(image), turn);
}

}  // namespace verdure
