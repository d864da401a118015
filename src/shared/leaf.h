#ifndef VERDURE_SHARED_LEAF_H_
#define VERDURE_SHARED_LEAF_H_

#include "portable.h"

// Light through leaves, where nothing is known of a leaf but its colour.

SHARED_BEGIN

/// Diffuse transmittance of a leaf of diffuse reflectance `reflectance`, linear RGB, both in [0,
/// 1]; the two never sum to more than 1. In visible light a green leaf transmits about as much as
/// it reflects, a little more green and much less blue (it looks yellower against the light): a
/// rule of thumb for leaves without measured maps.
SHARED_FUNCTION vec3 leafTransmittance(vec3 reflectance) {
  return min(reflectance * vec3(1.05f, 1.15f, 0.55f), vec3(1.0f) - reflectance);
}

SHARED_END

#endif  // VERDURE_SHARED_LEAF_H_
