#ifndef VERDURE_SHARED_SKY_H_
#define VERDURE_SHARED_SKY_H_

#include "portable.h"

// The horizon, and the haze that lets the ground end in it.

SHARED_BEGIN

/// Where an eye looks the dome up for a unit direction: near and below the horizon, just above it.
/// The sky's last half degree, ground in haze and what lies beyond it so take one luminance.
SHARED_FUNCTION vec3 domeDirection(vec3 direction) {
  return normalize(vec3(direction.x, max(direction.y, 0.01f), direction.z));
}

/// Where the upper half of the dome lies in an image of it: x = azimuth from +Z towards +X over
/// [0, 1), y = 0 at the zenith and 1 at the horizon, proportional to the angle.
SHARED_FUNCTION vec2 domeCoordinates(vec3 direction) {
  float azimuth =
      direction.x == 0.0f && direction.z == 0.0f ? 0.0f : atan(direction.x, direction.z);
  return vec2(azimuth * 0.15915494f, acos(clamp(direction.y, 0.0f, 1.0f)) * 0.63661977f);
}

/// Share of haze in front of something at `distance`: 0 at the eye, 0.5 at `half_distance`, towards
/// 1 far away; flat at first, so that the scene itself stays clear.
SHARED_FUNCTION float hazeShare(float distance, float half_distance) {
  float relative = distance / half_distance;
  return 1.0f - 1.0f / (1.0f + relative * relative);
}

/// Mean reflectance of the ground's texture (grass in summer).
SHARED_FUNCTION vec3 groundMeanColor() {
  return vec3(0.080f, 0.135f, 0.032f);
}

SHARED_END

#endif  // VERDURE_SHARED_SKY_H_
