#ifndef VERDURE_SHARED_HORIZON_H_
#define VERDURE_SHARED_HORIZON_H_

#include "portable.h"

// How high the ground rises around an eye: for each of many directions the steepest line of sight
// to the ground up to each of many distances. What stands farther and lower is hidden.

SHARED_BEGIN

const uint kHorizonTurns = 1024u;
const uint kHorizonRings = 80u;
const float kHorizonNear_m = 6.0f;
/// Each ring is so many times as far as the one before: 80 reach 10 km.
const float kHorizonGrowth = 1.0984f;

SHARED_FUNCTION float horizonDistance(uint ring) {
  return kHorizonNear_m * pow(kHorizonGrowth, float(ring));
}

/// Which entries tell whether a sphere is hidden: turns `first` to `first` + `count` - 1 (modulo
/// kHorizonTurns) of a ring. It is if all are above `tangent`. Count 0: it cannot be hidden.
struct HorizonLookup {
  uint first;
  uint count;
  uint ring;
  float tangent;  ///< of the line of sight over the sphere
};

/// `from_eye`: to the sphere's middle.
SHARED_FUNCTION HorizonLookup horizonLookup(vec3 from_eye, float radius) {
  const float kTurn = 6.2831853f;
  HorizonLookup lookup;
  lookup.first = 0u;
  lookup.count = 0u;
  lookup.ring = 0u;
  lookup.tangent = 0.0f;
  float aside = sqrt(from_eye.x * from_eye.x + from_eye.z * from_eye.z);
  float near = aside - radius;
  if (near <= kHorizonNear_m) return lookup;
  lookup.ring =
      min(uint(floor(log(near / kHorizonNear_m) / log(kHorizonGrowth))), kHorizonRings - 1u);
  float top = from_eye.y + radius;
  lookup.tangent = top > 0.0f ? top / near : top / (aside + radius);
  float middle = atan(from_eye.x, from_eye.z) / kTurn;
  float half_width = asin(min(radius / aside, 1.0f)) / kTurn;
  float low = floor((middle - half_width) * float(kHorizonTurns));
  float high = floor((middle + half_width) * float(kHorizonTurns)) + 1.0f;
  lookup.count = uint(high - low) + 1u;
  lookup.first = uint(int(low) + 4 * int(kHorizonTurns)) % kHorizonTurns;
  return lookup;
}

SHARED_END

#endif  // VERDURE_SHARED_HORIZON_H_
