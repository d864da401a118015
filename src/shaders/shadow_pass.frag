#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"

layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;

void main() {
  // One mip finer: outlines that are smoothed as wide as a texel would reach over the leaf's mesh,
  // and shade be lost there.
  if (texture(base_color, uv, -1.0).a < draw.surface.x) discard;
}
