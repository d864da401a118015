#include "leaf/multipole.h"

#include <cmath>
#include <numbers>

namespace verdure {

double insideReflection(double index) {
  // From outside there is no critical angle, and no kink; the way through is the same both ways.
  constexpr int kSteps = 2000;
  double outside = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    const double inner = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double s = (cosine - index * inner) / (cosine + index * inner);
    const double p = (index * cosine - inner) / (index * cosine + inner);
    outside += (s * s + p * p) * cosine / kSteps;
  }
  return 1.0 - (1.0 - outside) / (index * index);
}

Multipole::Multipole(const LeafOptics& optics, double reflection, int pairs) : pairs_(pairs) {
  const double absorption = double{optics.absorption_per_mm};
  const double scattering = (1.0 - double{optics.anisotropy}) * double{optics.scattering_per_mm};
  const double extinction = absorption + scattering;
  albedo_ = scattering / extinction;
  decay_ = std::sqrt(3.0 * absorption * extinction);
  mean_free_path_ = 1.0 / extinction;
  const double diffusion = 1.0 / (3.0 * extinction);
  extrapolation_ = 2.0 * (1.0 + reflection) / (1.0 - reflection) * diffusion;
}

/// Sum of term(d - z) over the real poles less that over the virtual ones.
template <typename Term>
double Multipole::sumOverPoles(double d, const Term& term) const {
  double sum = 0.0;
  for (int j = -pairs_; j <= pairs_; ++j) {
    const double middle = 2.0 * j * (d + 2.0 * extrapolation_);
    sum += term(d - (middle + mean_free_path_));
    sum -= term(d - (middle - mean_free_path_ - 2.0 * extrapolation_));
  }
  return sum;
}

double Multipole::transmittance(double r, double d) const {
  return albedo_ / (4.0 * std::numbers::pi) * sumOverPoles(d, [&](double z) {
           const double distance = std::sqrt(r * r + z * z);
           const double path = decay_ * distance;
           return z * (1.0 + path) * std::exp(-path) / (distance * distance * distance);
         });
}

double Multipole::beyond(double r, double d) const {
  // d/dr of exp(-s R) / R, R^2 = r^2 + z^2, is -r (1 + s R) exp(-s R) / R^3.
  return 0.5 * albedo_ * sumOverPoles(d, [&](double z) {
           const double distance = std::sqrt(r * r + z * z);
           return z * std::exp(-decay_ * distance) / distance;
         });
}

}  // namespace verdure
