// CIE standard general skies: ISO 15469:2004 / CIE S 011.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "sky/formula_sky.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"

namespace verdure {
namespace {

/// Table 1 of the standard: a, b of the gradation, c, d, e of the indicatrix.
struct CieType {
  float a, b, c, d, e;
};
constexpr CieType kTypes[15] = {
    {4.0f, -0.70f, 0.0f, -1.0f, 0.00f},    // 1 overcast, steep gradation
    {4.0f, -0.70f, 2.0f, -1.5f, 0.15f},    // 2 ... and brighter towards the sun
    {1.1f, -0.80f, 0.0f, -1.0f, 0.00f},    // 3 overcast, moderate gradation
    {1.1f, -0.80f, 2.0f, -1.5f, 0.15f},    // 4 ... and brighter towards the sun
    {0.0f, -1.00f, 0.0f, -1.0f, 0.00f},    // 5 uniform
    {0.0f, -1.00f, 2.0f, -1.5f, 0.15f},    // 6 partly cloudy, brighter towards the sun
    {0.0f, -1.00f, 5.0f, -2.5f, 0.30f},    // 7 ... with a brighter surrounding of the sun
    {0.0f, -1.00f, 10.0f, -3.0f, 0.45f},   // 8 ... with a corona
    {-1.0f, -0.55f, 2.0f, -1.5f, 0.15f},   // 9 partly cloudy, obscured sun
    {-1.0f, -0.55f, 5.0f, -2.5f, 0.30f},   // 10 ... with a brighter surrounding
    {-1.0f, -0.55f, 10.0f, -3.0f, 0.45f},  // 11 white-blue, with a corona
    {-1.0f, -0.32f, 10.0f, -3.0f, 0.45f},  // 12 clear, low turbidity
    {-1.0f, -0.32f, 16.0f, -3.0f, 0.30f},  // 13 clear, polluted
    {-1.0f, -0.15f, 16.0f, -3.0f, 0.30f},  // 14 cloudless turbid, broad corona
    {-1.0f, -0.15f, 24.0f, -2.8f, 0.15f},  // 15 white-blue turbid, broad corona
};

}  // namespace

float cieIlluminance(int type, float sun_elevation) {
  const float s = std::max(std::sin(sun_elevation), 0.0f);
  if (type <= 5) return 0.3f + 21.0f * s;
  if (type <= 10) return 0.3f + 45.0f * s;
  return 0.8f + 15.5f * std::sqrt(s);
}

std::shared_ptr<const Sky> cieSky(int type, const glm::vec3& to_sun,
                                  std::optional<float> illuminance) {
  if (type < 1 || type > 15)
    throw Error("CIE sky", fmt::format("there is no type {}", type),
                "1 is overcast, 5 uniform, 12 clear, 15 the last");
  if (illuminance && !(*illuminance >= 0.0f && std::isfinite(*illuminance)))
    throw Error("CIE sky", fmt::format("an illuminance of {:g} klx is none", *illuminance),
                "an overcast noon has 20");
  const glm::vec3 sun = unitDirection(to_sun);
  const CieType& t = kTypes[type - 1];
  const float one = 1.0f - t.c * std::exp(t.d * glm::half_pi<float>());
  // The standard gives no colour: that of D65 (Y, x, y).
  const auto luminanceOnly = [](float y) { return glm::vec4(y, 0.0f, 0.0f, 0.0f); };
  shared::SkyFormula formula{glm::vec4(raisedToHorizon(sun), 0.0f),
                             luminanceOnly(t.a),
                             glm::vec4(t.b, -1.0f, -1.0f, 0.0f),
                             luminanceOnly(t.c),
                             luminanceOnly(t.d),
                             luminanceOnly(t.e),
                             glm::vec4(one, 1.0f, 1.0f, 0.0f),
                             glm::vec4(1.0f, 0.3127f, 0.3290f, 0.0f)};
  const float wanted =
      illuminance.value_or(cieIlluminance(type, std::asin(std::clamp(sun.y, -1.0f, 1.0f))));
  const float unscaled = levelIlluminance(projectSky(*formulaSky(formula), 2)).g;
  formula.scale.x = wanted / unscaled;
  return formulaSky(formula);
}

}  // namespace verdure
