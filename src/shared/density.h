#ifndef VERDURE_SHARED_DENSITY_H_
#define VERDURE_SHARED_DENSITY_H_

#include "portable.h"

// Density field of foliage: Luft, Balzer, Deussen, "Expressive Illumination of Foliage Based on
// Implicit Surfaces", 2007. Equation numbers are that paper's.

SHARED_BEGIN

/// (2): influence of a generator at squared relative distance s2 = (|q - p| / r)^2.
SHARED_FUNCTION float metaball(float s2) {
  float w = max(1.0f - s2, 0.0f);
  return w * w;
}

/// (4): ambient coefficient of a point with field value d = F(q), tau already subtracted.
/// d_min > 0, k_min in [0, 1], n > 0.
SHARED_FUNCTION float ambientCoefficient(float d, float d_min, float k_min, float n) {
  if (d <= 0.0f) {
    return 1.0f;
  }
  if (d >= d_min) {
    return k_min;
  }
  return k_min + (1.0f - k_min) * pow(1.0f - d / d_min, n);
}

/// The paper's encoding: the ambient coefficient as the length of the normal. k is kept at or above
/// 1/255, because a length of 0 would lose the direction.
SHARED_FUNCTION vec3 encodeNormal(vec3 unit_normal, float k) {
  return unit_normal * max(k, 1.0f / 255.0f);
}

/// Inverse of encodeNormal: x, y, z = unit normal, w = k.
SHARED_FUNCTION vec4 decodeNormal(vec3 encoded) {
  float k = length(encoded);
  return vec4(encoded / max(k, 1e-6f), min(k, 1.0f));
}

SHARED_END

#endif  // VERDURE_SHARED_DENSITY_H_
