#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "impostor_set.glsl"
#include "impostor.glsl"
#include "coverage.glsl"
#include "velocity.glsl"
// A far tree of a forest: as its trunk moves. Where it covers a part of a pixel, in as many of such
// pixels.
layout(location = 8) in vec3 now;
layout(location = 9) in vec3 last;
layout(location = 0) out vec2 out_way;

void main() {
  ImpostorKind kind = kinds[job.kind];
  if (shownThere(kind).covered <= pixelThreshold(scrambled(seat.x ^ 0x5bd1e995u))) discard;
  out_way = wayOf(now, last);
}
