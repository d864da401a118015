#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/color.h"
#include "shared/frame.h"
#include "shared/tone.h"

layout(constant_id = 0) const int kSamples = 4;
layout(set = 0, binding = 0) uniform sampler2DMS color;
layout(set = 0, binding = 1) uniform sampler2D bloom;
layout(set = 0, binding = 2, std430) readonly buffer Measured { vec2 average_and_bright; };
layout(push_constant) uniform ToneBlock { ToneUniforms tone; };
layout(location = 0) out vec4 out_color;

void main() {
  float average = tone.average > 0.0 ? tone.average : average_and_bright.x;
  float exposure = average > 0.0 ? tone.key / average : 0.0;
  float white = tone.white > 0.0 ? tone.white : automaticWhite(average_and_bright.y * exposure);
  vec3 glow = vec3(0.0);
  if (tone.bloom > 0.0) {
    vec4 spread = textureLod(bloom, gl_FragCoord.xy / vec2(textureSize(color)), 0.0);
    glow = spread.rgb / max(spread.a, 1e-4);
  }
  // Each sample is tone-mapped and the display's light averaged: averaged before, one sample of
  // bright sky would hide three of a dark leaf, and edges would be as jagged as without samples.
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kSamples; ++i) {
    vec4 c = texelFetch(color, ivec2(gl_FragCoord.xy), i);
    vec3 lit = c.a > 0.0 ? mix(c.rgb / c.a, glow, tone.bloom) : vec3(0.0);
    sum += mix(tone.background.rgb, toneMapped(lit * exposure, white), c.a);
  }
  vec3 linear = sum / float(kSamples);
  vec3 level;
  for (int i = 0; i < 3; ++i)
    level[i] = ditheredLevel(srgbFromLinear(clamp(linear[i], 0.0, 1.0)),
                             ditherThreshold(floor(gl_FragCoord.x), floor(gl_FragCoord.y), float(i)));
  out_color = vec4(level / 255.0, 1.0);
}
