#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"

layout(location = 0) out vec3 out_ray;

void main() {
  vec2 corner = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);  // depth 0 = infinitely far
  out_ray = frame.ray_forward.xyz + corner.x * frame.ray_right.xyz + corner.y * frame.ray_down.xyz;
}
