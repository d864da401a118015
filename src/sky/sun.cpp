// The sun's light after the air: Preetham, Shirley, Smits 1999, appendix 2, with the formulas and
// tables of Iqbal, "An Introduction to Solar Radiation", 1983.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iterator>

#include "shared/sky_formula.h"
#include "sky/preetham.h"
#include "verdure/sky.h"

namespace verdure {
namespace {

constexpr double kFirstNm = 380.0, kStepNm = 10.0;

/// Radiance of the sun outside of the air, W / (m^2 sr nm), 380 to 750 nm (table 2).
constexpr double kSun[] = {16559.0, 16233.7, 21127.5, 25888.2, 25829.1, 24232.3, 26760.5, 29658.3,
                           30545.4, 30057.5, 30663.7, 28830.4, 28712.1, 27825.0, 27100.6, 27233.6,
                           26361.3, 25503.8, 25060.2, 25311.6, 25355.9, 25134.2, 24631.5, 24173.2,
                           23685.3, 23212.1, 22827.7, 22339.8, 21970.2, 21526.7, 21097.9, 20728.3,
                           20240.4, 19870.8, 19427.2, 19072.4, 18628.9, 18259.2};

/// Absorption of ozone, 1/cm, from 450 nm.
constexpr double kOzone[] = {0.003, 0.006, 0.009, 0.014, 0.021, 0.030, 0.040, 0.048,
                             0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125,
                             0.120, 0.105, 0.090, 0.079, 0.067, 0.057, 0.048, 0.036,
                             0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};
/// Absorption of water vapour, 1/cm, from 690 nm. (That of mixed gases begins at 760 nm.)
constexpr double kWater[] = {0.016, 0.024, 0.0125, 1.0, 0.87, 0.061, 0.001};

/// CIE 1931 colour matching functions: Wyman, Sloan, Shirley, "Simple Analytic Approximations to
/// the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, the sums of several lobes.
glm::dvec3 colorMatching(double nm) {
  const auto lobe = [nm](double height, double center, double below, double above) {
    const double t = (nm - center) * (nm < center ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) +
              lobe(-0.065, 501.1, 0.0490, 0.0382),
          lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
          lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

/// Share of the disk above the horizon.
double visibleShare(double elevation, double radius) {
  const double s = std::clamp(elevation / radius, -1.0, 1.0);
  return 0.5 + (std::asin(s) + s * std::sqrt(1.0 - s * s)) / glm::pi<double>();
}

}  // namespace

glm::vec3 sunLuminance(float turbidity, float elevation, float angular_radius) {
  const double visible = visibleShare(double{elevation}, double{angular_radius});
  if (visible <= 0.0) return glm::vec3(0.0f);
  const double up_deg = std::max(glm::degrees(double{elevation}), 0.0);
  // Relative optical mass (Kasten 1966).
  const double mass =
      1.0 / (std::sin(glm::radians(up_deg)) + 0.15 * std::pow(3.885 + up_deg, -1.253));
  constexpr double kOzoneCm = 0.35, kWaterCm = 2.0, kAngstromAlpha = 1.3;
  const double angstrom_beta = 0.04608 * double{turbidity} - 0.04586;
  glm::dvec3 xyz(0.0);
  for (std::size_t i = 0; i < std::size(kSun); ++i) {
    const double nm = kFirstNm + kStepNm * static_cast<double>(i);
    const double um = nm * 1e-3;
    double depth = 0.008735 * std::pow(um, -4.08) + angstrom_beta * std::pow(um, -kAngstromAlpha);
    if (i >= 7) depth += kOzone[i - 7] * kOzoneCm;
    depth *= mass;
    if (i >= 31) {
      const double water = kWater[i - 31] * kWaterCm * mass;
      depth += 0.2385 * water / std::pow(1.0 + 20.07 * water, 0.45);
    }
    xyz += colorMatching(nm) * (kSun[i] * std::exp(-depth) * kStepNm);
  }
  xyz *= 683.0 * 1e-3 * visible;  // lm / W; kcd
  const double sum = xyz.x + xyz.y + xyz.z;
  return glm::max(shared::linearFromXyY(static_cast<float>(xyz.x / sum),
                                        static_cast<float>(xyz.y / sum), static_cast<float>(xyz.y)),
                  glm::vec3(0.0f));
}

glm::vec3 Sun::illuminance() const {
  const float s = std::sin(angular_radius);
  return luminance * (glm::pi<float>() * s * s);
}

}  // namespace verdure
