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

/// (6) of Gumbau et al. 2008, after Franzke and Deussen 2003: 1 + e^-s_i e^-s_o, how much light
/// leaves a leaf for each that it would reflect without depth. Optical distances: s_i, the leaf's
/// thickness, and s_o in [0, s_i], from where the light was scattered to where it leaves.
SHARED_FUNCTION float scatteredLight(float s_i, float s_o) {
  return 1.0f + exp(-s_i - s_o);
}

/// Its mean over all s_o, for surfaces too far away to tell them apart.
SHARED_FUNCTION float meanScatteredLight(float s_i) {
  float s = max(s_i, 1e-3f);
  return 1.0f + exp(-s) * (1.0f - exp(-s)) / s;
}

SHARED_END

#endif  // VERDURE_SHARED_LEAF_H_
