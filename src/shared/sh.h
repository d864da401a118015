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
  float out_of = dot(q, normal);
  vec3 d = shFromWorld(normal), t = shFromWorld(q - normal * out_of);
  vec4 slope = (weights[1] * t.y + weights[2] * t.z + weights[3] * t.x) * 0.48860251f;
  slope += (weights[4] * (t.x * d.y + d.x * t.y) + weights[5] * (t.y * d.z + d.y * t.z) +
            weights[7] * (t.x * d.z + d.x * t.z)) *
           1.09254843f;
  slope += weights[6] * (1.89234939f * d.z * t.z);
  slope += weights[8] * (1.09254843f * (d.x * t.x - d.y * t.y));
  return max(shIrradiance(normal, weights) * out_of + vec3(slope.x, slope.y, slope.z), vec3(0.0f));
}

SHARED_END

#endif  // VERDURE_SHARED_SH_H_
