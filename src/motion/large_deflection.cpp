#include "motion/large_deflection.h"

#include <algorithm>
#include <cmath>

#include "motion/beam.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// The beam under load `q`, in E I of the root: angles are found from bending moments and moments
/// from angles until both stay.
std::vector<glm::dvec2> underLoad(double taper, double q, int count) {
  const double step = 1.0 / count;
  const auto n = static_cast<std::size_t>(count);
  std::vector<double> angle(n + 1, 0.0);
  std::vector<glm::dvec2> points(n + 1);
  for (int round = 0; round < 400; ++round) {
    for (std::size_t i = 0; i < n; ++i) {
      const double middle = 0.5 * (angle[i] + angle[i + 1]);
      points[i + 1] = points[i] + step * glm::dvec2(std::cos(middle), std::sin(middle));
    }
    // Load beyond a point, and its arm along the axis at rest.
    std::vector<double> moment(n + 1, 0.0);
    double beyond = 0.0;  // integral of x over the rest of the beam
    for (std::size_t i = n; i-- > 0;) {
      beyond += 0.5 * step * (points[i].x + points[i + 1].x);
      moment[i] = q * (beyond - points[i].x * (1.0 - static_cast<double>(i) * step));
    }
    double change = 0.0, sum = 0.0;
    for (std::size_t i = 0; i <= n; ++i) {
      const auto curvature = [&](std::size_t k) {
        const double radius = 1.0 + (taper - 1.0) * static_cast<double>(k) * step;
        return moment[k] / (radius * radius * radius * radius);
      };
      if (i > 0) sum += 0.5 * step * (curvature(i - 1) + curvature(i));
      const double next = 0.5 * (angle[i] + sum);  // damped: strong loads would swing
      change = std::max(change, std::abs(next - angle[i]));
      angle[i] = next;
    }
    if (change < 1e-11) break;
  }
  return points;
}

}  // namespace

std::vector<glm::dvec2> bentBeam(double taper, double tip, int count) {
  if (!(tip >= 0.0 && tip <= 0.8))
    throw Error("beam", "its deflection is out of range", "0 to 0.8");
  if (!(taper > 0.0) || !std::isfinite(taper))
    throw Error("beam", "its taper is out of range", "choose one above 0");
  if (count < 2) throw Error("beam", "has too few points", "choose 2 or more");
  taper = std::max(taper, kLeastTaper);
  double low = 0.0, high = 1.0;
  while (underLoad(taper, high, count).back().y < tip) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (underLoad(taper, middle, count).back().y < tip ? low : high) = middle;
  }
  return underLoad(taper, high, count);
}

}  // namespace verdure
