// The skylight model of Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999.
#include "sky/preetham.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "sky/formula_sky.h"
#include "verdure/error.h"

namespace verdure {

namespace {

/// Zenith luminance, kcd/m^2, and chromaticity x, y (appendix 1).
glm::dvec3 zenith(double t, double theta) {
  const double chi = (4.0 / 9.0 - t / 120.0) * (glm::pi<double>() - 2.0 * theta);
  const glm::dvec4 powers(theta * theta * theta, theta * theta, theta, 1.0);
  const glm::dvec3 by_turbidity(t * t, t, 1.0);
  const glm::dvec3 x(glm::dot(powers, {0.00166, -0.00375, 0.00209, 0.0}),
                     glm::dot(powers, {-0.02903, 0.06377, -0.03202, 0.00394}),
                     glm::dot(powers, {0.11693, -0.21196, 0.06052, 0.25886}));
  const glm::dvec3 y(glm::dot(powers, {0.00275, -0.00610, 0.00317, 0.0}),
                     glm::dot(powers, {-0.04214, 0.08970, -0.04153, 0.00516}),
                     glm::dot(powers, {0.15346, -0.26756, 0.06670, 0.26688}));
  return {(4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192, glm::dot(x, by_turbidity),
          glm::dot(y, by_turbidity)};
}

}  // namespace

float twilight(float elevation) {
  return elevation >= 0.0f ? 1.0f : std::pow(10.0f, 0.4f * glm::degrees(elevation));
}

shared::SkyFormula preethamFormula(float turbidity, const glm::vec3& to_sun) {
  const glm::vec3 sun = raisedToHorizon(to_sun);
  const double t = turbidity;
  // Perez coefficients of Y, x, y (appendix 1).
  const glm::dvec3 a(0.1787 * t - 1.4630, -0.0193 * t - 0.2592, -0.0167 * t - 0.2608);
  const glm::dvec3 b(-0.3554 * t + 0.4275, -0.0665 * t + 0.0008, -0.0950 * t + 0.0092);
  const glm::dvec3 c(-0.0227 * t + 5.3251, -0.0004 * t + 0.2125, -0.0079 * t + 0.2102);
  const glm::dvec3 d(0.1206 * t - 2.5771, -0.0641 * t - 0.8989, -0.0441 * t - 1.6537);
  const glm::dvec3 e(-0.0670 * t + 0.3703, -0.0033 * t + 0.0452, -0.0109 * t + 0.0529);
  const double theta = std::atan2(std::hypot(double{sun.x}, double{sun.z}), double{sun.y});
  const double cos_theta = std::cos(theta);
  const glm::dvec3 at_zenith =
      (1.0 + a * glm::exp(b)) * (1.0 + c * glm::exp(d * theta) + e * (cos_theta * cos_theta));
  glm::dvec3 scale = zenith(t, theta) / at_zenith;
  scale.x *= double{twilight(std::asin(std::clamp(to_sun.y, -1.0f, 1.0f)))};
  const auto pack = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
  return {glm::vec4(sun, 0.0f), pack(a),    pack(b), pack(c), pack(d), pack(e),
          glm::vec4(1.0f),      pack(scale)};
}

Daylight preethamDaylight(float turbidity, const glm::vec3& to_sun) {
  if (!(turbidity >= 2.0f && turbidity <= 10.0f))
    throw Error("turbidity", fmt::format("{:g} is outside of [2, 10]", turbidity),
                "2.5 is very clear air, 6 is haze");
  const glm::vec3 sun = unitDirection(to_sun);
  Daylight light;
  light.sky = formulaSky(preethamFormula(turbidity, sun));
  light.sun.direction = sun;
  light.sun.luminance =
      sunLuminance(turbidity, std::asin(std::clamp(sun.y, -1.0f, 1.0f)), light.sun.angular_radius);
  return light;
}

}  // namespace verdure
