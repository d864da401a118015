#ifndef VERDURE_SHARED_CASCADE_H_
#define VERDURE_SHARED_CASCADE_H_

#include "portable.h"

// How the sun's maps of several scales (render/cascades.h) follow each other.

SHARED_BEGIN

const int kMostCascades = 4;
/// The texel of a point is counted from the world's origin, modulo this.
const int kCascadeWrap = 16384;
/// Texels along a map's border that only a filter reads: its radius, the distance by which points
/// are moved off their surfaces, and the half texel by which the map is off its place.
const float kCascadeBorder = 10.0f;
/// Width of the band inside of that border in which a map fades into the next, as a share of the
/// map's side: a tenth of the way from its centre.
const float kCascadeFade = 0.05f;

/// Share of a map's side, of `size` texels, in which it is the only one that is read.
SHARED_FUNCTION float cascadeInnerShare(float size) {
  return 1.0f - 2.0f * (kCascadeFade + kCascadeBorder / size);
}

/// Share of a map in what is seen at (x, y) of it, in [0, 1]^2; the rest is the next map's.
SHARED_FUNCTION float cascadeShare(vec2 at, float size) {
  float from_border = 0.5f - max(abs(at.x - 0.5f), abs(at.y - 0.5f)) - kCascadeBorder / size;
  return clamp(from_border / kCascadeFade, 0.0f, 1.0f);
}

SHARED_END

#endif  // VERDURE_SHARED_CASCADE_H_
