#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "impostor_set.glsl"
#include "impostor.glsl"
#include "coverage.glsl"
// A card in the light depth map, as light_depth_pass.frag has leaves.
layout(location = 0) out vec4 out_texel;

vec2 roundedDown(vec2 value) {
  return uintBitsToFloat(floatBitsToUint(value) & 0xffffe000u);
}

void main() {
  ImpostorKind kind = kinds[job.kind];
  if (coveredInNearest(kind) <= pixelThreshold(scrambled(seat.x))) discard;
  out_texel = vec4(roundedDown(vec2(1.0 - gl_FragCoord.z, gl_FragCoord.z)), 1.0, kind.leaf.w);
}
