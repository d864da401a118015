// A fit as a C header, for other engines.
#include <fmt/format.h>

#include <glm/gtc/constants.hpp>

#include "sky/sky_fit_coordinates.h"
#include "verdure/sky_fit.h"

namespace verdure {
namespace {

constexpr const char* kIntroduction =
    R"(/* Skylight as weights of real spherical harmonics, written by verdure.
 *
 * The method: Habel, Mustata, Wimmer, "Efficient Spherical Harmonics Lighting with the Preetham
 * Skylight Model", Eurographics 2008. C99; also compiles as C++. Needs <math.h>.
 *
 * Harmonics: orthonormal, without the Condon-Shortley phase; weight (l, m) has index l * l + l + m;
 * the z axis points to the zenith. Weights are luminance in kcd/m^2, linear sRGB; the sky below the
 * horizon is black and the sun's disk is not part of it. Arguments outside of their range are moved
 * to its end.
 */
)";

constexpr const char* kFunction = R"(
/* The weights for a sun `sun_zenith` radians (0 to pi / 2) from the zenith and `sun_azimuth` radians
 * from the harmonics' x axis towards their y axis. filter != 0: zonal weights times
 * sinc(pi l / bands), which suppresses the ringing from the horizon. */
static void verdure_sky_weights(float sun_zenith, float sun_azimuth, float turbidity, int filter,
                                float weights[VERDURE_SKY_BANDS * VERDURE_SKY_BANDS][3]) {
  float x[VERDURE_SKY_SUN_TERMS], y[VERDURE_SKY_AIR_TERMS], sums[VERDURE_SKY_OUTPUTS];
  const float *p = verdure_sky_coefficients;
  float t, u;
  int i, j, k, l, m, c;
  t = sun_zenith < 0.0f ? 0.0f : sun_zenith > 1.57079633f ? 1.57079633f : sun_zenith;
  t = t * 1.27323954f - 1.0f;
  t = t + VERDURE_SKY_STRETCH * (1.0f - t * t);
  u = turbidity < VERDURE_SKY_TURBIDITY_MIN   ? VERDURE_SKY_TURBIDITY_MIN
      : turbidity > VERDURE_SKY_TURBIDITY_MAX ? VERDURE_SKY_TURBIDITY_MAX
                                              : turbidity;
  u = VERDURE_SKY_AIR_SCALE * logf(u - VERDURE_SKY_AIR_POLE) + VERDURE_SKY_AIR_OFFSET;
  x[0] = y[0] = 1.0f;
  x[1] = t;
  y[1] = u;
  for (i = 2; i < VERDURE_SKY_SUN_TERMS; ++i) x[i] = 2.0f * t * x[i - 1] - x[i - 2];
  for (j = 2; j < VERDURE_SKY_AIR_TERMS; ++j) y[j] = 2.0f * u * y[j - 1] - y[j - 2];
  for (k = 0; k < VERDURE_SKY_OUTPUTS; ++k) sums[k] = 0.0f;
  for (i = 0; i < VERDURE_SKY_SUN_TERMS; ++i)
    for (j = 0; j < VERDURE_SKY_AIR_TERMS; ++j, p += VERDURE_SKY_OUTPUTS) {
      const float w = x[i] * y[j];
      for (k = 0; k < VERDURE_SKY_OUTPUTS; ++k) sums[k] += w * p[k];
    }
  for (l = 0, k = 0; l < VERDURE_SKY_BANDS; ++l) {
    const float angle = 3.14159265f * (float)l / (float)VERDURE_SKY_BANDS;
    const float zonal = filter && l > 0 ? sinf(angle) / angle : 1.0f;
    for (c = 0; c < 3; ++c) weights[l * l + l][c] = sums[k + c] * zonal;
    for (m = 1, k += 3; m <= l; ++m, k += 3)
      for (c = 0; c < 3; ++c) {
        weights[l * l + l + m][c] = sums[k + c] * cosf((float)m * sun_azimuth);
        weights[l * l + l - m][c] = sums[k + c] * sinf((float)m * sun_azimuth);
      }
  }
}

#endif
)";

}  // namespace

std::string skyFitHeader(const SkyFit& fit) {
  const SkyFitOptions& o = fit.options();
  const AirCoordinate air(o);
  const int outputs = 3 * o.bands * (o.bands + 1) / 2;
  const int terms = (o.sun_degree + 1) * (o.turbidity_degree + 1);
  std::string out = kIntroduction;
  out += "#ifndef VERDURE_SKY_WEIGHTS_H\n#define VERDURE_SKY_WEIGHTS_H\n\n#include <math.h>\n\n";
  const auto integer = [&](const char* name, int value) {
    out += fmt::format("#define VERDURE_SKY_{} {}\n", name, value);
  };
  const auto real = [&](const char* name, double value) {
    out += fmt::format("#define VERDURE_SKY_{} {:.9e}f\n", name, value);
  };
  integer("BANDS", o.bands);
  integer("SUN_TERMS", o.sun_degree + 1);
  integer("AIR_TERMS", o.turbidity_degree + 1);
  integer("OUTPUTS", outputs);
  real("TURBIDITY_MIN", double{o.turbidity_min});
  real("TURBIDITY_MAX", double{o.turbidity_max});
  real("STRETCH", kSunStretch);
  real("AIR_POLE", kTurbidityPole);
  real("AIR_SCALE", air.scale);
  real("AIR_OFFSET", air.offset);
  out += fmt::format(
      "\n/* Of T_i(sun) T_j(air), i slowest; then the weight (l, m >= 0), then red, green, blue. "
      "*/\n"
      "static const float verdure_sky_coefficients[{}] = {{",
      terms * outputs);
  const std::span<const float> p = fit.coefficients();
  for (int i = 0; i < terms; ++i)
    for (int k = 0; k < outputs; ++k) {
      out += (i * outputs + k) % 6 == 0 ? "\n  " : " ";
      out += fmt::format(
          "{:.8e}f,", p[static_cast<std::size_t>(i) * fit.stride() + static_cast<std::size_t>(k)]);
    }
  return out + "\n};\n" + kFunction;
}

}  // namespace verdure
