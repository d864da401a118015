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

SHARED_END

#endif  // VERDURE_SHARED_SH_H_
