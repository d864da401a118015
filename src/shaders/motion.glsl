// How a vertex moves in wind: the same for every pass. Needs instance.glsl.
#include "shared/sway.h"
layout(set = 2, binding = 0, std430) readonly buffer Beams { MotionBeam beams[]; };
layout(set = 2, binding = 1, std430) readonly buffer Leaves { MotionLeaf leaves[]; };
layout(set = 2, binding = 2, std430) readonly buffer Hangs { uvec2 hangs[]; };
layout(set = 2, binding = 3, std430) readonly buffer Amplitudes { vec2 amplitudes[]; };
layout(set = 2, binding = 4, std430) readonly buffer Turns { uint turns[]; };
layout(set = 2, binding = 5, std430) readonly buffer LastAmplitudes { vec2 last_amplitudes[]; };
layout(set = 2, binding = 6, std430) readonly buffer LastTurns { uint last_turns[]; };

MovedVertex bentBy(uint beam, float place, bool last, MovedVertex vertex) {
  uint at = seat_motion.x + beam;
  return bentByBeam(beams[beam], place, last ? last_amplitudes[at] : amplitudes[at], vertex);
}

/// In the plant's coordinates; `last`: at the time of the last frame.
MovedVertex movedVertex(vec3 position, vec3 normal, bool last) {
  MovedVertex vertex = MovedVertex(position, normal);
  if (!kMoving) return vertex;
  uvec2 hang = hangs[gl_VertexIndex];
  if (hang.x == kHangsOnNothing) return vertex;
  uint beam = hang.x;
  float place = uintBitsToFloat(hang.y);
  if ((hang.x & kHangsOnLeaf) != 0u) {
    uint index = hang.x & ~kHangsOnLeaf, at = seat_motion.y + index;
    MotionLeaf leaf = leaves[index];
    vertex = turnedLeaf(leaf, unpackHalf2x16(last ? last_turns[at] : turns[at]), vertex);
    beam = leaf.beam;
    place = leaf.place;
  }
  vertex = bentBy(beam, place, last, vertex);
  uvec4 carriers = beams[beam].carriers;
  vec4 places = beams[beam].places;
  if (carriers.x != kHangsOnNothing) vertex = bentBy(carriers.x, places.x, last, vertex);
  if (carriers.y != kHangsOnNothing) vertex = bentBy(carriers.y, places.y, last, vertex);
  if (carriers.z != kHangsOnNothing) vertex = bentBy(carriers.z, places.z, last, vertex);
  return vertex;
}
