#ifndef VERDURE_SHARED_MOTION_H_
#define VERDURE_SHARED_MOTION_H_

#include "portable.h"
#include "random.h"

// Where a branch reads its motion texture: Habel, "Real-time Rendering and Animation of
// Vegetation", dissertation, TU Wien 2009, 4.5.3. A function of time alone: no state is kept, and
// the same time gives the same bits whatever came before.

SHARED_BEGIN

/// A straight way through a texture that repeats. Both in 2^-32 of the texture, so that whole
/// seconds multiply and wrap without rounding: no precision is lost, in 136 years.
struct MotionTrajectory {
  uvec2 offset;    ///< at time 0
  uvec2 velocity;  ///< a second
};
SHARED_SIZE(MotionTrajectory, 16);

/// What keeps a plant out of unison with others: 0 for the first.
SHARED_FUNCTION uvec2 motionPhase(uint plant) {
  if (plant == 0u) return uvec2(0u, 0u);
  uint first = scrambled(plant);
  return uvec2(first, scrambled(first));
}

/// Where the trajectory is after whole + fraction seconds, fraction in [0, 1]: in [0, 2), to be
/// read with repetition, exact within 2^-22 of the texture.
SHARED_FUNCTION vec2 motionUv(MotionTrajectory trajectory, uint whole, float fraction) {
  uint u = trajectory.offset.x + trajectory.velocity.x * whole;
  uint v = trajectory.offset.y + trajectory.velocity.y * whole;
  // 24 bits are what a float holds.
  return vec2(float(u >> 8), float(v >> 8)) * 5.9604644775390625e-8f +
         vec2(float(trajectory.velocity.x), float(trajectory.velocity.y)) *
             (2.3283064365386963e-10f * fraction);
}

/// The four texels that bilinear filtering with repetition reads, and how near the high ones are.
/// What Vulkan prescribes, but with the shares in full: most hardware rounds them to 1/256.
struct MotionTexels {
  uvec2 low;
  uvec2 high;
  vec2 share;
};
SHARED_FUNCTION MotionTexels motionTexels(vec2 uv, uvec2 size) {
  vec2 place = (uv - floor(uv)) * vec2(float(size.x), float(size.y)) - vec2(0.5f, 0.5f);
  vec2 cell = floor(place);
  MotionTexels texels;
  texels.low =
      uvec2(uint(int(cell.x) + int(size.x)) % size.x, uint(int(cell.y) + int(size.y)) % size.y);
  texels.high = uvec2((texels.low.x + 1u) % size.x, (texels.low.y + 1u) % size.y);
  texels.share = place - cell;
  return texels;
}
/// Their mean, from the texels at (low, low), (high, low), (low, high) and (high, high).
SHARED_FUNCTION float motionValue(vec4 texels, vec2 share) {
  return mix(mix(texels.x, texels.y, share.x), mix(texels.z, texels.w, share.x), share.y);
}

SHARED_END

#endif  // VERDURE_SHARED_MOTION_H_
