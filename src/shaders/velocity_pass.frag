#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "terms.glsl"
// How far what is seen in a pixel has come since the last frame, in pixels, x right, y down.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 now;
layout(location = 2) in vec3 last;
layout(location = 0) out vec2 out_way;

void main() {
  if (kAlphaTest && texture(base_color, uv).a < draw.surface.x) discard;
  // What was behind the eye came from nowhere.
  vec2 way = last.z > 0.0 ? now.xy / now.z - last.xy / last.z : vec2(0.0);
  out_way = way / vec2(frame.ray_right.w, frame.ray_down.w);
}
