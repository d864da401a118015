#ifndef VERDURE_SHARED_ILLUMINATION_H_
#define VERDURE_SHARED_ILLUMINATION_H_

#include "portable.h"

// Illumination model (1) of Luft, Balzer, Deussen, "Expressive Illumination of Foliage Based on
// Implicit Surfaces", 2007, for one light, the sun:
//   I = I_a k_a + I_s S [ k_d (N.L) + k_s (V.R)^n ]
// in physical units: I_a and I_s are irradiance / pi, k_a and k_d reflectances, so that I is a
// luminance. Leaves add k_t (-N.L): the sun on the far side, through the leaf.
// All vectors are unit; l points to the light, v to the viewer.

SHARED_BEGIN

/// (N.L), 0 behind the surface.
SHARED_FUNCTION float diffuseFactor(vec3 n, vec3 l) {
  return max(dot(n, l), 0.0f);
}

/// (V.R)^exponent with R = l mirrored at n, 0 where the light is behind the surface. exponent > 0.
SHARED_FUNCTION float specularFactor(vec3 n, vec3 l, vec3 v, float exponent) {
  float n_l = dot(n, l);
  vec3 r = n * (2.0f * n_l) - l;
  float v_r = dot(v, r);
  return n_l > 0.0f && v_r > 0.0f ? pow(v_r, exponent) : 0.0f;
}

/// The sum (1). `ambient` is I_a k_a; `diffuse` is k_d (N.L) + k_t (-N.L), one of which is 0.
SHARED_FUNCTION vec3 illumination(vec3 ambient, vec3 sun_light, vec3 visibility, vec3 diffuse,
                                  float k_s, float specular) {
  return ambient + sun_light * visibility * (diffuse + vec3(k_s * specular));
}

SHARED_END

#endif  // VERDURE_SHARED_ILLUMINATION_H_
