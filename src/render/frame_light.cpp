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
  light.open_sky =
      glm::max(valueAt(irradianceHarmonics(sky), {0.0f, 1.0f, 0.0f}), glm::vec3(0.0f)) / pi;
  Harmonics all = sky;
  if (ground) {
    const glm::vec3 reflectance =
        view.terms.textures ? shared::groundMeanColor() : glm::vec3(0.18f);
    const Harmonics below = groundHarmonics(
        reflectance * (light.open_sky + light.sun * std::max(light.to_sun.y, 0.0f)), sky.bands);
    for (std::size_t i = 0; i < all.weights.size(); ++i) all.weights[i] += below.weights[i];
  }
  light.open_light = irradianceHarmonics(all);
  for (glm::vec3& weight : light.open_light.weights) weight /= pi;
  // A disk much smaller than the sun's is cut, lest what it lights sink below the smallest half.
  light.brightest = std::max({largest(light.open_sky), largest(light.sun),
                              std::min(largest(light.sun_disk), 0x1p16f * largest(light.sun))});
  return light;
}

Harmonics mirroredAtHorizon(const Harmonics& light) {
  // Harmonics with even l + m are even in the height, those with odd l + m odd.
  Harmonics mirrored = light;
  for (int l = 0; l < light.bands; ++l)
    for (int m = -l; m <= l; ++m)
      mirrored.weights[static_cast<std::size_t>(l * l + l + m)] *= (l + m) % 2 == 0 ? 2.0f : 0.0f;
  return mirrored;
}

float frameUnits(float brightest) {
  if (!(brightest > 0.0f)) return 1.0f;
  int exponent = 0;
  std::frexp(brightest, &exponent);  // brightest in [2^(e-1), 2^e)
  return std::ldexp(1.0f, std::clamp(15 - exponent, -60, 60));
}

}  // namespace verdure
