#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;

void main() {
  if (texture(base_color, uv).a < draw.surface.x) discard;
}
