#ifndef VERDURE_SHARED_SH_H_
#define VERDURE_SHARED_SH_H_

#include "portable.h"

// Real spherical harmonics: the one place that states the convention.
// - Orthonormal over the sphere, without the Condon-Shortley phase: Y_1,-1, Y_1,0, Y_1,1 are
//   sqrt(3 / 4 pi) times y, z, x of the harmonics' own frame.
// - Index of (l, m): l * l + l + m; N bands are N * N coefficients.
// - The harmonics' frame has z at the zenith; x, y, z of it are the world's +Z (south), +X (east)
//   and +Y (up): azimuths from +Z towards +X are the harmonics' azimuths.

SHARED_BEGIN

/// The harmonics' frame from the world's (+Y up), and back.
SHARED_FUNCTION vec3 shFromWorld(vec3 world) {
  return vec3(world.z, world.x, world.y);
}
SHARED_FUNCTION vec3 worldFromSh(vec3 sh) {
  return vec3(sh.y, sh.z, sh.x);
}

/// Irradiance (klx) of a surface facing a unit direction of the world, from the first nine weights
/// of irradiance (kcd/m^2 convolved with the cosine: irradianceHarmonics()), colour in x, y, z of
/// each. Never negative.
SHARED_FUNCTION vec3 shIrradiance(vec3 normal, vec4 weights[9]) {
  vec3 d = shFromWorld(normal);
  vec4 sum = weights[0] * 0.28209479f;
  sum += (weights[1] * d.y + weights[2] * d.z + weights[3] * d.x) * 0.48860251f;
  sum += (weights[4] * (d.x * d.y) + weights[5] * (d.y * d.z) + weights[7] * (d.x * d.z)) *
         1.09254843f;
  sum += weights[6] * (0.94617470f * d.z * d.z - 0.31539157f);
  sum += weights[8] * (0.54627422f * (d.x * d.x - d.y * d.y));
  return max(vec3(sum.x, sum.y, sum.z), vec3(0.0f));
}

/// The integral of luminance times dot(q, w) over the directions w of the hemisphere around a unit
/// direction, klx for a unit q; from the same weights as shIrradiance(), of which it is what is
/// left for q = normal: irradiance grows along q by it when the normal turns there. Never negative.
SHARED_FUNCTION vec3 shIrradianceAlong(vec3 normal, vec3 q, vec4 weights[9]) {
  // q's part along the normal times shIrradiance(), and the slope along the rest.
  vec3 d = shFromWorld(normal), t = shFromWorld(q);
  float out_of = dot(d, t);
  vec3 rest = t - d * (0.5f * out_of);  // both products with d then make 2 d t - out_of d d
  vec4 sum = weights[0] * (0.28209479f * out_of) - weights[6] * (0.31539157f * out_of);
  sum += (weights[1] * t.y + weights[2] * t.z + weights[3] * t.x) * 0.48860251f;
  sum += (weights[4] * (rest.x * d.y + d.x * rest.y) + weights[5] * (rest.y * d.z + d.y * rest.z) +
          weights[7] * (rest.x * d.z + d.x * rest.z) + weights[8] * (d.x * rest.x - d.y * rest.y)) *
         1.09254843f;
  sum += weights[6] * (1.89234939f * d.z * rest.z);
  return max(vec3(sum.x, sum.y, sum.z), vec3(0.0f));
}

SHARED_END

#endif  // VERDURE_SHARED_SH_H_
