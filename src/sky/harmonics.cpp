#include "verdure/harmonics.h"

#include <fmt/format.h>

#include <vector>

#include "base/parallel.h"
#include "shared/sh.h"
#include "sky/harmonic_basis.h"
#include "sky/projection.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// Integral of the Legendre polynomial P_l over [from, 1].
double capIntegral(int l, double from) {
  if (l == 0) return 1.0 - from;
  double before = 1.0, now = from;  // P_0, P_1
  for (int k = 1; k < l; ++k) {
    const double next = ((2 * k + 1) * from * now - k * before) / (k + 1);
    before = now;
    now = next;
  }
  const double after = ((2 * l + 1) * from * now - l * before) / (l + 1);
  return (before - after) / (2 * l + 1);
}

/// Integral of Y_l0 over a cap around the zenith.
double zonalCap(int l, double from) {
  return 2.0 * glm::pi<double>() * std::sqrt((2 * l + 1) / (4.0 * glm::pi<double>())) *
         capIntegral(l, from);
}

Harmonics withBands(int bands) {
  checkBands(bands);
  Harmonics h;
  h.bands = bands;
  return h;
}

/// Multiplies the weights of each band by factor(l).
template <class Factor>
Harmonics scaled(Harmonics h, const Factor& factor) {
  for (int l = 0; l < h.bands; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      h.weights[static_cast<std::size_t>(i)] *= static_cast<float>(factor(l));
  return h;
}

}  // namespace

void checkBands(int bands) {
  if (bands < 1 || bands > kMaxBands)
    throw Error("bands", fmt::format("{} is outside of [1, {}]", bands, kMaxBands),
                "the paper uses 4 to 7");
}

void harmonicsAt(const glm::vec3& direction, int bands, float* values) {
  const glm::vec3 d = shared::shFromWorld(direction);
  harmonicsOf(d.x, d.y, d.z, bands, values);
}

glm::vec3 valueAt(const Harmonics& function, const glm::vec3& direction) {
  std::array<float, kMaxBands * kMaxBands> values;
  harmonicsAt(direction, function.bands, values.data());
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < static_cast<std::size_t>(function.count()); ++i)
    sum += function.weights[i] * values[i];
  return sum;
}

Harmonics projectSky(const Sky& sky, int bands) {
  Harmonics h = withBands(bands);
  const SkyProjection projection(bands, sky.rows());
  std::vector<HarmonicSums> row_sums(projection.rows());
  parallelFor(row_sums.size(), 8,
              [&](std::size_t row) { projection.addRow(sky, row, row_sums[row]); });
  for (std::size_t i = 0; i < static_cast<std::size_t>(h.count()); ++i) {
    glm::dvec3 sum(0.0);
    for (const HarmonicSums& sums : row_sums) sum += sums[i];
    h.weights[i] = glm::vec3(sum);
  }
  return h;
}

Harmonics diskHarmonics(const glm::vec3& direction, float angular_radius,
                        const glm::vec3& luminance, int bands) {
  Harmonics h = withBands(bands);
  std::array<double, kMaxBands * kMaxBands> values{};
  const glm::dvec3 d(shared::shFromWorld(direction));
  harmonicsOf(d.x, d.y, d.z, bands, values.data());
  for (int l = 0; l < bands; ++l) {
    const double factor = std::sqrt(4.0 * glm::pi<double>() / (2 * l + 1)) *
                          zonalCap(l, std::cos(double{angular_radius}));
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      h.weights[static_cast<std::size_t>(i)] =
          luminance * static_cast<float>(factor * values[static_cast<std::size_t>(i)]);
  }
  return h;
}

Harmonics groundHarmonics(const glm::vec3& luminance, int bands) {
  Harmonics h = withBands(bands);
  for (int l = 0; l < bands; ++l) {
    const double weight = (l == 0 ? std::sqrt(4.0 * glm::pi<double>()) : 0.0) - zonalCap(l, 0.0);
    h.weights[static_cast<std::size_t>(l * l + l)] = luminance * static_cast<float>(weight);
  }
  return h;
}

Harmonics turned(const Harmonics& function, float azimuth) {
  Harmonics h = function;
  const float c1 = std::cos(azimuth), s1 = std::sin(azimuth);
  float c = 1.0f, s = 0.0f;
  for (int m = 1; m < h.bands; ++m) {
    const float before = c;
    c = c * c1 - s * s1;
    s = s * c1 + before * s1;
    for (int l = m; l < h.bands; ++l) {
      const auto with = static_cast<std::size_t>(l * l + l + m);
      const auto against = static_cast<std::size_t>(l * l + l - m);
      h.weights[with] = function.weights[with] * c - function.weights[against] * s;
      h.weights[against] = function.weights[against] * c + function.weights[with] * s;
    }
  }
  return h;
}

double ringingFactor(int l, int bands) {
  if (l == 0) return 1.0;
  const double x = glm::pi<double>() * l / bands;
  return std::sin(x) / x;
}

Harmonics withoutRinging(const Harmonics& function) {
  Harmonics h = function;
  for (int l = 0; l < h.bands; ++l)
    h.weights[static_cast<std::size_t>(l * l + l)] *= static_cast<float>(ringingFactor(l, h.bands));
  return h;
}

Harmonics irradianceHarmonics(const Harmonics& luminance) {
  return scaled(luminance, [](int l) {
    if (l == 1) return 2.0 * glm::pi<double>() / 3.0;
    if (l % 2 == 1) return 0.0;
    // pi for l = 0; pi / 4; -pi / 24; ...
    double factor = 2.0 * glm::pi<double>() * (l % 4 == 0 ? -1.0 : 1.0) / ((l + 2.0) * (l - 1.0));
    for (int k = 1; k <= l / 2; ++k) factor *= (l / 2 + k) / (4.0 * k);  // l! / (2^l (l/2)!^2)
    return factor;
  });
}

glm::vec3 levelIlluminance(const Harmonics& luminance) {
  if (luminance.bands < 2) return glm::vec3(0.0f);
  return luminance.weights[2] * static_cast<float>(std::sqrt(4.0 * glm::pi<double>() / 3.0));
}

}  // namespace verdure
