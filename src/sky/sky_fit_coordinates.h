#ifndef VERDURE_SKY_SKY_FIT_COORDINATES_H_
#define VERDURE_SKY_SKY_FIT_COORDINATES_H_

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "verdure/sky_fit.h"

// The sky's parameters as the fit's polynomials see them.
namespace verdure {

inline constexpr double kTurbidityPole = 1.66;
inline constexpr double kSunStretch = 0.03;

/// The sun's angle from the zenith, [0, pi / 2], in [-1, 1]: a little stretched towards the zenith,
/// because the model's luminance has a pole 15 degrees beyond it. (By trial.)
template <class T>
T sunCoordinate(T zenith) {
  const T x = zenith * (T(4) / glm::pi<T>()) - T(1);
  return x + static_cast<T>(kSunStretch) * (T(1) - x * x);
}

/// Turbidity in [-1, 1]. The model's zenith has a pole near turbidity 1.66, outside of the range
/// but near enough to spoil a polynomial of turbidity itself; of the logarithm of the distance from
/// there everything is smooth.
struct AirCoordinate {
  double scale, offset;

  AirCoordinate(double s, double o) : scale(s), offset(o) {}
  explicit AirCoordinate(const SkyFitOptions& o) {
    const double low = logarithm(double{o.turbidity_min});
    scale = 2.0 / (logarithm(double{o.turbidity_max}) - low);
    offset = -1.0 - scale * low;
  }
  template <class T>
  T operator()(T turbidity) const {
    return static_cast<T>(scale) * logarithm(turbidity) + static_cast<T>(offset);
  }

 private:
  template <class T>
  static T logarithm(T turbidity) {
    return std::log(turbidity - static_cast<T>(kTurbidityPole));
  }
};

}  // namespace verdure

#endif  // VERDURE_SKY_SKY_FIT_COORDINATES_H_
