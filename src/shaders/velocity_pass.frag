#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "terms.glsl"
#include "velocity.glsl"
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 now;
layout(location = 2) in vec3 last;
layout(location = 0) out vec2 out_way;

void main() {
  if (kAlphaTest && texture(base_color, uv).a < draw.surface.x) discard;
  out_way = wayOf(now, last);
}
