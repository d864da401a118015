#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"

// The part of the screen where the ground is seen: two triangles, a rectangle along the horizon;
// no vertex buffers. A disc of the ground's real size would have edges so far away that what they
// cut off from the screen misses it by whole pixels.
void main() {
  // Down (from below: up) and so in view of the ground within its radius is where
  // down + dot(at, gradient) > 0, `at` in clip coordinates x / w and y / w.
  float height = frame.ground.x - frame.eye.y;
  float down = sign(height) * frame.ray_forward.y - abs(height) / frame.ground.y;
  vec2 gradient = sign(height) * vec2(frame.ray_right.y, frame.ray_down.y);
  float steep = max(length(gradient), 1e-20);
  vec2 downwards = gradient.x == 0.0 && gradient.y == 0.0 ? vec2(0.0, 1.0) : gradient / steep;
  // The screen lies within 2 of its middle.
  float horizon = clamp(-down / steep, -2.0, 2.0);
  int corner = gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2;  // 0 1 2, 1 2 3
  vec2 at = (corner & 1) == 0 ? horizon * downwards : 2.0 * downwards;
  at += (corner & 2) == 0 ? 2.0 * vec2(-downwards.y, downwards.x)
                          : 2.0 * vec2(downwards.y, -downwards.x);
  vec3 ray = frame.ray_forward.xyz + at.x * frame.ray_right.xyz + at.y * frame.ray_down.xyz;
  float distance = min(height / ray.y, frame.ground.y);
  if (!(distance > 0.0)) distance = frame.ground.y;  // rounded
  vec4 clip = frame.clip_from_world * vec4(frame.eye.xyz + distance * ray, 1.0);
  gl_Position = vec4(at * clip.w, clip.zw);
}
