#ifndef VERDURE_SHARED_SKY_H_
#define VERDURE_SHARED_SKY_H_

#include "portable.h"

// A plain gradient sky, and the haze that lets the ground end in it.

SHARED_BEGIN

/// Colour of the sky towards a unit direction: the horizon's at and below it, the zenith's
/// overhead, with a bright band above the horizon as on a clear day.
SHARED_FUNCTION vec3 skyColor(vec3 direction, vec3 horizon, vec3 zenith) {
  float down = 1.0f - clamp(direction.y, 0.0f, 1.0f);
  float down2 = down * down;
  return mix(zenith, horizon, down2 * down2);
}

/// Share of haze in front of something at `distance`: 0 at the eye, 0.5 at `half_distance`, towards
/// 1 far away; flat at first, so that the scene itself stays clear.
SHARED_FUNCTION float hazeShare(float distance, float half_distance) {
  float relative = distance / half_distance;
  return 1.0f - 1.0f / (1.0f + relative * relative);
}

/// Mean colour of the ground's texture (grass in summer).
SHARED_FUNCTION vec3 groundMeanColor() {
  return vec3(0.080f, 0.135f, 0.032f);
}

SHARED_END

#endif  // VERDURE_SHARED_SKY_H_
