#ifndef VERDURE_TESTS_SKY_CHECKS_H_
#define VERDURE_TESTS_SKY_CHECKS_H_

#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "verdure/sky.h"

// What the tests of the sky share.
namespace verdure {

/// Values of tests/data/sky.json.
inline const nlohmann::json& skyReference() {
  static const nlohmann::json data =
      nlohmann::json::parse(std::ifstream(std::string(VERDURE_TEST_DATA) + "/sky.json"));
  return data;
}

/// Angle from the zenith and azimuth (from +Z towards +X), degrees.
inline glm::vec3 fromAngles(double zenith_deg, double azimuth_deg) {
  const double z = glm::radians(zenith_deg), a = glm::radians(azimuth_deg);
  return {std::sin(z) * std::sin(a), std::cos(z), std::sin(z) * std::cos(a)};
}

inline double photometric(const glm::vec3& rgb) {
  return glm::dot(glm::dvec3(rgb), glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// Sum of body(direction) over the sphere, by the midpoint rule over equal areas; times their area.
template <class Value, class Body>
Value sphereIntegral(int rings, const Body& body) {
  const int sectors = 2 * rings;
  Value sum(0.0);
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double up = 2.0 * (i + 0.5) / rings - 1.0, across = std::sqrt(1.0 - up * up);
      const double a = 2.0 * glm::pi<double>() * (j + 0.5) / sectors;
      sum += body(glm::dvec3(across * std::sin(a), up, across * std::cos(a)));
    }
  return sum * (4.0 * glm::pi<double>() / (rings * sectors));
}

/// klx of a sky on level ground.
inline double skyIlluminance(const Sky& sky) {
  return sphereIntegral<double>(120, [&](const glm::dvec3& d) {
    return std::max(d.y, 0.0) * photometric(sky.luminance(glm::vec3(d)));
  });
}

}  // namespace verdure

#endif  // VERDURE_TESTS_SKY_CHECKS_H_
