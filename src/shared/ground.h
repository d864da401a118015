#ifndef VERDURE_SHARED_GROUND_H_
#define VERDURE_SHARED_GROUND_H_

#include "portable.h"

// The grass of the ground plane: where its textures are looked up, and what they make together.

SHARED_BEGIN

/// Grass at its own size, and again a little larger and turned, where the repetition of one hides
/// that of the other; noise at three sizes makes patches, lighter, darker and drier.
struct GroundLookup {
  vec2 blades, turned_blades;  ///< in the grass texture
  vec2 fine, middle, broad;    ///< in the noise
};

/// At p = x, z in metres, for texture tiles of `tile` metres.
SHARED_FUNCTION GroundLookup groundLookup(vec2 p, float tile) {
  vec2 q = p / tile;
  GroundLookup at;
  at.blades = q;
  at.turned_blades = vec2(0.8f * q.x - 0.6f * q.y, 0.6f * q.x + 0.8f * q.y) * 0.618f;
  at.fine = q * 0.211f;
  at.middle = vec2(0.28f * q.x + 0.96f * q.y, 0.28f * q.y - 0.96f * q.x) * 0.0371f;
  at.broad = vec2(0.6f * q.x - 0.8f * q.y, 0.8f * q.x + 0.6f * q.y) * 0.0059f;
  return at;
}

/// Patches, lighter, darker and drier, by noise in [0, 1] at three sizes: brightness goes from 1 -
/// spread to 1 + spread.
SHARED_FUNCTION vec3 groundTone(float fine, float middle, float broad, float spread) {
  float tone = 0.5f * fine + 0.3f * middle + 0.2f * broad;
  vec3 dry = vec3(1.2f, 1.03f, 0.95f);
  return mix(1.0f - spread, 1.0f + spread, tone) * mix(vec3(1.0f), dry, middle * broad);
}

/// Reflectance, linear RGB, of what was found there.
SHARED_FUNCTION vec3 groundColor(vec3 blades, vec3 turned_blades, float fine, float middle,
                                 float broad) {
  return mix(blades, turned_blades, 0.35f) * groundTone(fine, middle, broad, 0.45f);
}

SHARED_END

#endif  // VERDURE_SHARED_GROUND_H_
