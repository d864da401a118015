#ifndef VERDURE_SKY_HARMONIC_BASIS_H_
#define VERDURE_SKY_HARMONIC_BASIS_H_

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "verdure/harmonics.h"

namespace verdure {

/// Factors of the recurrence over l of the normalised associated Legendre functions, without
/// Condon and Shortley's phase and divided by sin^m:
///   Q(l, m) = a(l, m) (z Q(l - 1, m) - b(l, m) Q(l - 2, m)).
struct LegendreFactors {
  std::array<std::array<double, kMaxBands>, kMaxBands> a{}, b{};
  std::array<double, kMaxBands> diagonal{};  ///< Q(m, m), sqrt(2) of the real basis included

  LegendreFactors() {
    double product = 1.0 / (4.0 * glm::pi<double>());
    for (std::size_t m = 0; m < kMaxBands; ++m) {
      const auto dm = static_cast<double>(m);
      if (m > 0) product *= (2.0 * dm + 1.0) / (2.0 * dm);
      diagonal[m] = std::sqrt(m > 0 ? 2.0 * product : product);
      for (std::size_t l = m + 1; l < kMaxBands; ++l) {
        const auto dl = static_cast<double>(l);
        a[l][m] = std::sqrt((4.0 * dl * dl - 1.0) / (dl * dl - dm * dm));
        b[l][m] =
            std::sqrt(((dl - 1.0) * (dl - 1.0) - dm * dm) / (4.0 * (dl - 1.0) * (dl - 1.0) - 1.0));
      }
    }
  }
};
inline const LegendreFactors kLegendre;

/// Calls put(l, m, value) with each Q(l, m), m >= 0: times sin^m cos(m azimuth) it is the harmonic
/// (l, m), times sin^m sin(m azimuth) the harmonic (l, -m).
template <class T, class Put>
void forEachLegendre(T z, int bands, const Put& put) {
  for (int m = 0; m < bands; ++m) {
    const auto sm = static_cast<std::size_t>(m);
    T before = T(0), now = static_cast<T>(kLegendre.diagonal[sm]);
    put(m, m, now);
    for (int l = m + 1; l < bands; ++l) {
      const auto sl = static_cast<std::size_t>(l);
      const T next = static_cast<T>(kLegendre.a[sl][sm]) *
                     (z * now - static_cast<T>(kLegendre.b[sl][sm]) * before);
      before = now;
      now = next;
      put(l, m, now);
    }
  }
}

/// The values of the harmonics at x, y, z of their own frame.
template <class T>
void harmonicsOf(T x, T y, T z, int bands, T* values) {
  // sin^m times cos and sin of m azimuths.
  std::array<T, kMaxBands> cosines{T(1)}, sines{T(0)};
  for (std::size_t m = 1; m < static_cast<std::size_t>(bands); ++m) {
    cosines[m] = x * cosines[m - 1] - y * sines[m - 1];
    sines[m] = x * sines[m - 1] + y * cosines[m - 1];
  }
  forEachLegendre(z, bands, [&](int l, int m, T q) {
    values[l * l + l + m] = q * cosines[static_cast<std::size_t>(m)];
    if (m > 0) values[l * l + l - m] = q * sines[static_cast<std::size_t>(m)];
  });
}

/// (5.5): the factor of the zonal weight of band l.
double ringingFactor(int l, int bands);

/// Throws Error unless 1 <= bands <= kMaxBands.
void checkBands(int bands);

}  // namespace verdure

#endif  // VERDURE_SKY_HARMONIC_BASIS_H_
