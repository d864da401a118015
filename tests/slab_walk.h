#ifndef VERDURE_TESTS_SLAB_WALK_H_
#define VERDURE_TESTS_SLAB_WALK_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/random.h"
#include "verdure/leaf.h"

/// Light through a slab by random walks, with nothing of diffusion theory in it: what the multipole
/// is measured against.
namespace verdure::test {

struct SlabLight {
  double through = 0, back = 0, absorbed = 0, mirrored = 0;  ///< shares of what arrives
  static constexpr int kRings = 40;
  static constexpr double kRing = 0.05;  ///< mm
  std::array<double, kRings> rings{};    ///< what goes through, by distance from where it entered
  /// Share of what goes through that leaves within `r` mm, a multiple of kRing.
  double within(double r) const {
    double sum = 0;
    for (int k = 0; k < kRings && (k + 0.5) * kRing < r; ++k)
      sum += rings[static_cast<std::size_t>(k)];
    return sum / through;
  }
};

/// Unpolarised reflectance at a plane; `eta` = index behind over index in front.
inline double fresnel(double cosine, double eta) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  const double c = std::sqrt(1 - sine2);
  const double s = (cosine - eta * c) / (cosine + eta * c);
  const double p = (eta * cosine - c) / (eta * cosine + c);
  return 0.5 * (s * s + p * p);
}

/// How light enters: straight down, or from all sides of the hemisphere by the cosine.
enum class SlabBeam { kStraight, kDiffuse };

/// `index` of the slab; 1: nothing is thrown back at its surfaces. Light that is mirrored before it
/// enters is counted apart and not followed.
inline SlabLight walkThroughSlab(const LeafOptics& optics, double thickness, double index,
                                 SlabBeam beam, int walks, std::uint64_t seed) {
  const double scattering = double{optics.scattering_per_mm};
  const double extinction = scattering + double{optics.absorption_per_mm};
  const double g = double{optics.anisotropy};
  Random random(seed);
  const auto uniform = [&random] { return (static_cast<double>(random.next()) + 0.5) * 0x1p-32; };
  SlabLight light;
  const double one = 1.0 / walks;
  for (int walk = 0; walk < walks; ++walk) {
    double x = 0, y = 0, z = 0, weight = 1;
    double u = 0, v = 0, w = 1;
    if (beam == SlabBeam::kDiffuse) {
      const double outside = std::sqrt(1 - uniform());  // cosine
      if (uniform() < fresnel(outside, index)) {
        light.mirrored += one;
        continue;
      }
      const double sine = std::sqrt(1 - outside * outside) / index;
      w = std::sqrt(1 - sine * sine);
      u = sine;
    }
    for (;;) {
      const double step = -std::log(uniform()) / extinction;
      const double to_surface = w > 0 ? (thickness - z) / w : w < 0 ? -z / w : 1e30;
      if (step < to_surface) {
        x += step * u;
        y += step * v;
        z += step * w;
        light.absorbed += one * weight * (1 - scattering / extinction);
        weight *= scattering / extinction;
        if (weight < 0.05) {  // Russian roulette
          if (uniform() < 0.5) {
            light.absorbed += one * weight;
            break;
          }
          light.absorbed -= one * weight;
          weight *= 2;
        }
        // Henyey and Greenstein's phase function.
        const double f = (1 - g * g) / (1 - g + 2 * g * uniform());
        const double cosine =
            std::abs(g) < 1e-6 ? 2 * uniform() - 1 : (1 + g * g - f * f) / (2 * g);
        const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        const double phi = 2 * std::numbers::pi * uniform();
        const double sign = w >= 0 ? 1.0 : -1.0;  // a frame around (u, v, w): Duff et al. 2017
        const double a = -1 / (sign + w), b = u * v * a;
        const double tx = 1 + sign * u * u * a, ty = sign * b, tz = -sign * u;
        const double bx = b, by = sign + v * v * a, bz = -v;
        const double c = sine * std::cos(phi), s = sine * std::sin(phi);
        const double nu = c * tx + s * bx + cosine * u, nv = c * ty + s * by + cosine * v,
                     nw = c * tz + s * bz + cosine * w;
        const double length = std::sqrt(nu * nu + nv * nv + nw * nw);
        u = nu / length;
        v = nv / length;
        w = nw / length;
        continue;
      }
      x += to_surface * u;
      y += to_surface * v;
      z = w > 0 ? thickness : 0;
      if (uniform() < fresnel(std::abs(w), 1 / index)) {
        w = -w;
        continue;
      }
      if (w > 0) {
        light.through += one * weight;
        const auto ring = static_cast<std::size_t>(std::hypot(x, y) / SlabLight::kRing);
        if (ring < light.rings.size()) light.rings[ring] += one * weight;
      } else {
        light.back += one * weight;
      }
      break;
    }
  }
  return light;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_SLAB_WALK_H_
