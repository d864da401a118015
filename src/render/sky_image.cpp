#include "render/sky_image.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shared/sky_formula.h"

namespace verdure {
namespace {

constexpr int kWidth = 1024, kHeight = 256;  // a third of a degree: skies are smooth

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

void SkyImage::look(const std::shared_ptr<const Sky>& sky) {
  if (looked_ && sky == sky_) return;
  looked_ = true;
  sky_ = sky;
  units_ = 0.0f;
  brightest_ = 0.0f;
  const bool formula = sky != nullptr && sky->formula() != nullptr;
  width_ = sky == nullptr || formula ? 1 : kWidth;
  height_ = sky == nullptr || formula ? 1 : kHeight;
  luminance_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                    glm::vec3(0.0f));
  if (sky == nullptr) return;
  if (formula) {
    // The brightest are the sun's surroundings, or the horizon's.
    const glm::vec3 sun(sky->formula()->sun);
    for (const glm::vec3& d :
         {sun, glm::normalize(sun * glm::vec3(1, 0, 1) + glm::vec3(0, 1e-3f, 1e-9f)),
          glm::vec3(0, 1, 0)})
      brightest_ = std::max(brightest_, largest(sky->luminance(d)));
    return;
  }
  parallelFor(static_cast<std::size_t>(height_), 4, [&](std::size_t y) {
    const float zenith_angle =
        (static_cast<float>(y) + 0.5f) / static_cast<float>(height_) * glm::half_pi<float>();
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      const float azimuth =
          (static_cast<float>(x) + 0.5f) / static_cast<float>(width_) * glm::two_pi<float>();
      const glm::vec3 direction(std::sin(azimuth) * std::sin(zenith_angle), std::cos(zenith_angle),
                                std::cos(azimuth) * std::sin(zenith_angle));
      luminance_[y * static_cast<std::size_t>(width_) + x] = sky->luminance(direction);
    }
  });
  for (const glm::vec3& l : luminance_) brightest_ = std::max(brightest_, largest(l));
}

bool SkyImage::fill(float units_per_kcd) {
  if (units_ == units_per_kcd) return false;
  units_ = units_per_kcd;
  copied_ = false;
  const bool other = !image_ || image_->width() != width_ || image_->height() != height_;
  if (other) {
    image_.reset();
    image_.emplace(*device_, static_cast<std::uint32_t>(width_),
                   static_cast<std::uint32_t>(height_));
  }
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      image_->set(x, y,
                  luminance_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                             static_cast<std::size_t>(x)] *
                      units_per_kcd);
  return other;
}

void SkyImage::record(const vk::raii::CommandBuffer& commands) {
  if (!copied_) image_->record(commands);
  copied_ = true;
}

}  // namespace verdure
