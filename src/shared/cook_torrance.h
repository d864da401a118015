#ifndef VERDURE_SHARED_COOK_TORRANCE_H_
#define VERDURE_SHARED_COOK_TORRANCE_H_

#include "portable.h"

// The gloss of a leaf's surface: Cook, Torrance, "A Reflectance Model for Computer Graphics", 1982,
// with the parameters that Bousquet et al. 2005 measured on leaves.

SHARED_BEGIN

/// Share of unpolarised light that a smooth dielectric of refractive index `index` >= 1 reflects;
/// `cosine` in [0, 1] with its normal.
SHARED_FUNCTION float fresnelReflected(float index, float cosine) {
  float g = sqrt(max(index * index + cosine * cosine - 1.0f, 1e-8f));
  float side = (g - cosine) / (g + cosine);
  float along = (cosine * (g + cosine) - 1.0f) / (cosine * (g - cosine) + 1.0f);
  return 0.5f * side * side * (1.0f + along * along);
}

/// Beckmann's density of facets whose normal has this cosine in (0, 1] with the surface's, 1 / sr;
/// `roughness`: root-mean-square slope m, above 0. Its integral with the cosine is 1.
SHARED_FUNCTION float facetDensity(float roughness, float cosine) {
  float c2 = cosine * cosine, m2 = roughness * roughness;
  return exp((c2 - 1.0f) / (c2 * m2)) / (3.14159265f * m2 * c2 * c2);
}

/// pi f_s (N.L): the luminance of the highlight where a white diffuse surface that faces the sun
/// has
/// 1. All vectors are unit. (Printed with 1 / pi, the model gains light; the facets' geometry makes
/// 1 / 4.)
SHARED_FUNCTION float cookTorrance(vec3 n, vec3 l, vec3 v, float roughness, float index) {
  float n_l = dot(n, l), n_v = max(dot(n, v), 1e-3f);
  vec3 sum = l + v;
  float length_2 = dot(sum, sum);
  if (n_l <= 0.0f || length_2 < 1e-12f) {
    return 0.0f;
  }
  vec3 h = sum * (1.0f / sqrt(length_2));
  float n_h = max(dot(n, h), 1e-3f), v_h = max(dot(v, h), 1e-3f);
  float unmasked = min(1.0f, 2.0f * n_h * min(n_v, n_l) / v_h);
  return 3.14159265f * fresnelReflected(index, v_h) * facetDensity(roughness, n_h) * unmasked /
         (4.0f * n_v);
}

SHARED_END

#endif  // VERDURE_SHARED_COOK_TORRANCE_H_
