#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/style.h"
// A Gaussian along one direction.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(push_constant) uniform BlurBlock { BlurUniforms blur; };
layout(location = 0) out vec4 out_value;

void main() {
  vec2 at = gl_FragCoord.xy * blur.texel;
  vec4 sum = textureLod(source, at, 0.0);
  float weights = 1.0;
  for (int i = 1; i <= blur.reach; ++i) {
    float x = float(i) / blur.sigma;
    float weight = exp(-0.5 * x * x);
    vec2 off = float(i) * blur.step;
    sum += weight * (textureLod(source, at - off, 0.0) + textureLod(source, at + off, 0.0));
    weights += 2.0 * weight;
  }
  out_value = sum / weights;
}
