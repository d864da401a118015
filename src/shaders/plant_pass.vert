#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "instance.glsl"
#include "shared/density.h"
#include "shared/leaf_visibility.h"
#include "terms.glsl"
#include "motion.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 encoded_normal;  // w = packVisibility() / 32767
layout(location = 2) in vec2 uv;
layout(location = 6) in vec3 front_light;
layout(location = 7) in vec3 back_light;
layout(location = 0) out vec3 out_position;
layout(location = 1) centroid out vec4 out_normal;  // w = ambient coefficient
layout(location = 2) out vec2 out_uv;
layout(location = 3) centroid out vec2 out_covered_uv;
layout(location = 4) centroid out vec3 out_front_light;
layout(location = 5) centroid out vec3 out_back_light;
layout(location = 6) flat out uint out_seed;
layout(location = 7) centroid out vec2 out_visibility;  // by gl_FrontFacing: of true, of false
layout(location = 8) flat out uint out_mirrored;
layout(location = 9) flat out uvec2 out_seat;

void main() {
  vec4 decoded = decodeNormal(encoded_normal.xyz);
  MovedVertex moved = movedVertex(position, decoded.xyz, false);
  out_position = worldFromPlant(moved.position);
  vec3 normal = worldNormal(moved.normal, kFlipNormal);
  out_normal = vec4(normal * inversesqrt(max(dot(normal, normal), 1e-30)), decoded.w);
  bool mirrored = isMirrored();
  vec2 visibility = unpackVisibility(encoded_normal.w * 32767.0);
  out_visibility = mirrored ? visibility.yx : visibility;
  out_mirrored = mirrored ? 1u : 0u;
  out_seat = seat_motion.zw;
  out_seed = uint(gl_VertexIndex) + seat_motion.z * 0x9e3779b9u;
  out_uv = uv;
  out_covered_uv = uv;
  out_front_light = front_light;
  out_back_light = back_light;
  gl_Position = frame.clip_from_world * vec4(out_position, 1.0);
}
