#include "motion/beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace verdure {

double beamDeflectionExact(double taper, double x) {
  const double alpha = std::max(taper, kLeastTaper), k = alpha - 1.0;
  if (std::abs(k) < 0.05) {
    // u'' = 2 (1 - t)^2 / (pi (1 + k t)^4), integrated twice by Gauss and Legendre's five points.
    constexpr std::array<std::pair<double, double>, 5> kGauss{
        {{-0.906179845938664, 0.236926885056189},
         {-0.538469310105683, 0.478628670499366},
         {0.0, 0.568888888888889},
         {0.538469310105683, 0.478628670499366},
         {0.906179845938664, 0.236926885056189}}};
    double sum = 0.0;
    for (const auto& [node, weight] : kGauss) {
      const double t = 0.5 * x * (1.0 + node);
      sum += weight * (x - t) * (1.0 - t) * (1.0 - t) / std::pow(1.0 + k * t, 4.0);
    }
    return 0.5 * x * sum * 2.0 / glm::pi<double>();
  }
  const double r = 1.0 + x * k;  // radius at x, by the root's
  const double polynomial =
      x * k *
      (6.0 +
       x * k * (2.0 * x * k * (3.0 + (alpha - 3.0) * alpha) + 3.0 * (4.0 + (alpha - 2.0) * alpha)));
  return (polynomial - 6.0 * r * r * std::log(r)) /
         (3.0 * glm::pi<double>() * r * r * k * k * k * k);
}

glm::dvec2 fitBeam(double taper) {
  // Normal equations of x^2 and x^4.
  double s4 = 0.0, s6 = 0.0, s8 = 0.0, u2 = 0.0, u4 = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double x = i / 100.0, x2 = x * x, x4 = x2 * x2;
    const double u = beamDeflectionExact(taper, x);
    s4 += x4;
    s6 += x4 * x2;
    s8 += x4 * x4;
    u2 += x2 * u;
    u4 += x4 * u;
  }
  const double determinant = s4 * s8 - s6 * s6;
  return {(s8 * u2 - s6 * u4) / determinant, (s4 * u4 - s6 * u2) / determinant};
}

}  // namespace verdure
