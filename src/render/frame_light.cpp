#include "render/frame_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "shared/sky.h"

namespace verdure {
namespace {

float largest(const glm::vec3& v) {
  return std::max({v.x, v.y, v.z});
}

}  // namespace

FrameLight makeFrameLight(const View& view, const Harmonics& sky, bool ground) {
  const float pi = glm::pi<float>();
  FrameLight light;
  light.to_sun = view.daylight.sun.direction;
  if (!ground || light.to_sun.y > -std::sin(view.daylight.sun.angular_radius)) {
    light.sun = view.daylight.sun.illuminance() / pi;
    light.sun_disk = view.daylight.sun.luminance;
  }
  light.sky = sky;
  light.open_sky = levelIlluminance(sky) / pi;
  Harmonics all = sky;
  if (ground) {
    const glm::vec3 reflectance = view.terms.textures ? shared::groundMeanColor() : glm::vec3(0.18f);
    const Harmonics below = groundHarmonics(
        reflectance * (light.open_sky + light.sun * std::max(light.to_sun.y, 0.0f)), sky.bands);
    for (std::size_t i = 0; i < all.weights.size(); ++i) all.weights[i] += below.weights[i];
  }
  light.open_light = irradianceHarmonics(all);
  for (glm::vec3& weight : light.open_light.weights) weight /= pi;
  light.brightest = std::max({largest(light.open_sky), largest(light.sun), largest(light.sun_disk)});
  return light;
}

float frameUnits(float brightest) {
  if (!(brightest > 0.0f)) return 1.0f;
  int exponent = 0;
  std::frexp(brightest, &exponent);  // brightest in [2^(e-1), 2^e)
  return std::ldexp(1.0f, std::clamp(15 - exponent, -60, 60));
}

}  // namespace verdure
