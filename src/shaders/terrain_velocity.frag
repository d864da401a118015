#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "grass_set.glsl"
// How far the ground, or the upper side of the grass on it, has come since the last frame, in pixels,
// x right, y down: as velocity_pass.frag. Grass stands still in it.
layout(location = 0) centroid in vec3 from_eye;
layout(location = 0) out vec2 out_way;

void main() {
  vec4 now = clipFromEye(from_eye);
  vec4 last = frame.last_clip_from_world * vec4(frame.eye.xyz + from_eye, 1.0);
  vec2 way = last.w > 0.0 ? now.xy / now.w - last.xy / last.w : vec2(0.0);
  out_way = way / vec2(frame.ray_right.w, frame.ray_down.w);
}
