#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tone.h"
// Over tiles of 64 x 64 pixels: sums of log luminance, in a fixed order and so the same each time,
// and counts of the luminances.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) uniform sampler2D color;  // alpha: share that is not background
layout(set = 0, binding = 1, std430) buffer Work { uint bins[kLuminanceBins]; vec2 tiles[]; };
layout(push_constant) uniform Smallest { float smallest; };  // delta of Reinhard's (1)
shared vec2 sums[256];
shared uint counts[kLuminanceBins];

void main() {
  uint i = gl_LocalInvocationIndex;
  for (uint b = i; b < kLuminanceBins; b += 256u) counts[b] = 0u;
  barrier();
  ivec2 size = textureSize(color, 0);
  vec2 sum = vec2(0.0);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      ivec2 at = ivec2(gl_WorkGroupID.xy) * 64 + ivec2(gl_LocalInvocationID.xy) * 4 + ivec2(x, y);
      if (at.x >= size.x || at.y >= size.y) continue;
      vec4 c = texelFetch(color, at, 0);
      if (c.a <= 0.0) continue;
      float l = luminanceOf(c.rgb / c.a);
      sum += c.a * vec2(log2(smallest + l), 1.0);
      atomicAdd(counts[luminanceBin(l)], uint(4.0 * c.a + 0.5));
    }
  sums[i] = sum;
  for (uint half_size = 128u; half_size > 0u; half_size /= 2u) {
    barrier();
    if (i < half_size) sums[i] += sums[i + half_size];
  }
  if (i == 0u) tiles[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sums[0];
  for (uint b = i; b < kLuminanceBins; b += 256u)
    if (counts[b] > 0u) atomicAdd(bins[b], counts[b]);
}
