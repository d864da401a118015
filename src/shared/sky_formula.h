#ifndef VERDURE_SHARED_SKY_FORMULA_H_
#define VERDURE_SHARED_SKY_FORMULA_H_

#include "portable.h"

// The closed form of the sky's light, common to
// - Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999 (Perez et
//   al. 1993): one = 1;
// - the CIE standard general sky, ISO 15469 / CIE S 011: one = 1 - c exp(d pi / 2).
// With theta the angle from the zenith and gamma the angle from the sun, each of luminance and
// chromaticity x, y is
//   scale (1 + a exp(b / cos theta)) (one + c exp(d gamma) + e cos^2 gamma).

SHARED_BEGIN

/// Components x, y, z of each vec4 but `sun` are those of luminance Y, chromaticity x and y.
struct SkyFormula {
  vec4 sun;  ///< unit, towards the sun, +Y up; never below the horizon
  vec4 a;
  vec4 b;  ///< negative
  vec4 c;
  vec4 d;
  vec4 e;
  vec4 one;
  vec4 scale;  ///< of Y: kcd/m^2
};
SHARED_SIZE(SkyFormula, 128);

/// Linear sRGB (D65) of a colour in CIE xyY; components outside of the gamut are negative.
SHARED_FUNCTION vec3 linearFromXyY(float x, float y, float luminance) {
  float X = luminance * x / y;
  float Z = luminance * (1.0f - x - y) / y;
  return vec3(3.2406f * X - 1.5372f * luminance - 0.4986f * Z,
              -0.9689f * X + 1.8758f * luminance + 0.0415f * Z,
              0.0557f * X - 0.2040f * luminance + 1.0570f * Z);
}

/// kcd/m^2, linear sRGB, towards a unit direction above the horizon; negative components are
/// colours outside of the gamut.
SHARED_FUNCTION vec3 skyColorUnclamped(vec3 direction, SkyFormula sky) {
  vec3 sun = vec3(sky.sun.x, sky.sun.y, sky.sun.z);
  vec3 chord = direction - sun;
  // acos(dot) would lose half of the digits near the sun, where the sky is brightest.
  float gamma = 2.0f * asin(min(0.5f * length(chord), 1.0f));
  float cos_gamma = dot(direction, sun);
  float up = max(direction.y, 1e-4f);
  vec3 gradation =
      vec3(1.0f) + vec3(sky.a.x, sky.a.y, sky.a.z) * exp(vec3(sky.b.x, sky.b.y, sky.b.z) / up);
  vec3 indicatrix = vec3(sky.one.x, sky.one.y, sky.one.z) +
                    vec3(sky.c.x, sky.c.y, sky.c.z) * exp(vec3(sky.d.x, sky.d.y, sky.d.z) * gamma) +
                    vec3(sky.e.x, sky.e.y, sky.e.z) * (cos_gamma * cos_gamma);
  vec3 v = vec3(sky.scale.x, sky.scale.y, sky.scale.z) * gradation * indicatrix;
  return linearFromXyY(v.y, v.z, v.x);
}

/// kcd/m^2, linear sRGB, never negative; black below the horizon.
SHARED_FUNCTION vec3 skyLuminance(vec3 direction, SkyFormula sky) {
  return direction.y < 0.0f ? vec3(0.0f) : max(skyColorUnclamped(direction, sky), vec3(0.0f));
}

SHARED_END

#endif  // VERDURE_SHARED_SKY_FORMULA_H_
