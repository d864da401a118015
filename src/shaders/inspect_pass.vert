#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "instance.glsl"
#include "shared/density.h"
#include "shared/leaf_visibility.h"
#include "terms.glsl"
#include "motion.glsl"
// As plant_pass.vert, with what an inspection shows.
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 encoded_normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec3 out_position;
layout(location = 1) centroid out vec4 out_normal;  // w = ambient coefficient
layout(location = 2) out vec2 out_uv;
layout(location = 3) flat out uint out_seed;
layout(location = 4) flat out int out_level;  // of its branch, -1 if it hangs on none
layout(location = 5) flat out uvec2 out_seat;

int branchLevel() {
  if (!kMoving) return -1;
  uint beam = hangs[gl_VertexIndex].x;
  if (beam == kHangsOnNothing) return -1;
  if ((beam & kHangsOnLeaf) != 0u) beam = leaves[beam & ~kHangsOnLeaf].beam;
  if (beam == kHangsOnNothing) return -1;
  uvec3 carriers = beams[beam].carriers.xyz;
  int level = 0;
  for (int i = 0; i < 3; ++i) level += carriers[i] != kHangsOnNothing ? 1 : 0;
  return level;
}

void main() {
  vec4 decoded = decodeNormal(encoded_normal.xyz);
  MovedVertex moved = movedVertex(position, decoded.xyz, false);
  out_position = worldFromPlant(moved.position);
  vec3 normal = worldNormal(moved.normal, kFlipNormal);
  out_normal = vec4(normal * inversesqrt(max(dot(normal, normal), 1e-30)), decoded.w);
  out_uv = uv;
  out_seed = uint(gl_VertexIndex) + seat_motion.z * 0x9e3779b9u;
  out_level = branchLevel();
  out_seat = seat_motion.zw;
  gl_Position = frame.clip_from_world * vec4(out_position, 1.0);
}
