#ifndef VERDURE_SHARED_LEAF_VISIBILITY_H_
#define VERDURE_SHARED_LEAF_VISIBILITY_H_

#include "portable.h"

// Ambient light from how much of a leaf's faces is seen from around: Gumbau, Chover, Rebollo,
// Remolar, "Real-Time Illumination of Foliage Using Depth Maps", ICCS 2008, (3):
//   A = C I (V_i / V)^n + alpha C' I' (V'_i / V)^n
// C = colour of the face, alpha C' = transmittance from the other, I and I' = light of the
// surroundings towards the normals of both.

SHARED_BEGIN

/// (V_i / V)^n of the face that is looked at (x) and of the other (y). `visibility` is V_i / V of
/// the front and of the back, clamped to [0, 1]; exponent > 0.
SHARED_FUNCTION vec2 visibilityShares(vec2 visibility, bool front, float exponent) {
  float seen = front ? visibility.x : visibility.y;
  float other = front ? visibility.y : visibility.x;
  return vec2(pow(clamp(seen, 0.0f, 1.0f), exponent), pow(clamp(other, 0.0f, 1.0f), exponent));
}

// Front and back in one signed 16-bit integer, in 255 levels each, among them 0, 1/2 and 1: as
// SNORM, -32768 and -32767 are the same, so that two whole bytes do not fit.

/// -32512 to 32512. `visibility` is clamped to [0, 1].
SHARED_FUNCTION int packVisibility(vec2 visibility) {
  vec2 level = floor(clamp(visibility, vec2(0.0f), vec2(1.0f)) * 254.0f + vec2(0.5f));
  return int(level.x) * 255 + int(level.y) - 32512;
}

/// Inverse of packVisibility(), from its integer as a float.
SHARED_FUNCTION vec2 unpackVisibility(float code_as_float) {
  int code = int(floor(code_as_float + 0.5f)) + 32512;
  int front = code / 255;
  return vec2(float(front), float(code - front * 255)) / 254.0f;
}

SHARED_END

#endif  // VERDURE_SHARED_LEAF_VISIBILITY_H_
