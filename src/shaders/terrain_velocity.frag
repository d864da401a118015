#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "grass_set.glsl"
#include "velocity.glsl"
// How far the ground, or the upper side of the grass on it, has come since the last frame. Grass stands still in it.
layout(location = 0) centroid in vec3 from_eye;
layout(location = 0) out vec2 out_way;

void main() {
  vec4 now = clipFromEye(from_eye);
  vec4 last = frame.last_clip_from_world * vec4(frame.eye.xyz + from_eye, 1.0);
  out_way = wayOf(now.xyw, last.xyw);
}
