#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tone.h"
// From what the tiles found to the log-average luminance (Reinhard's (1)) and the bright luminance;
// 0 if there is nothing but background.
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) uniform sampler2D color;
layout(set = 0, binding = 1, std430) readonly buffer Work {
  uint bins[kLuminanceBins];
  vec2 tiles[];
};
layout(set = 0, binding = 2, std430) writeonly buffer Result { float average, bright; };
shared vec2 sums[256];

float brightLuminance() {
  uint total = 0u, above = 0u;
  for (int b = 0; b < kLuminanceBins; ++b) total += bins[b];
  float need = kBrightShare * float(total);
  for (int b = kLuminanceBins - 1; b >= 0; --b) {
    uint count = bins[b];
    if (count > 0u && float(above + count) >= need)
      return luminanceInBin(b, (need - float(above)) / float(count));
    above += count;
  }
  return 0.0;
}

void main() {
  ivec2 size = (textureSize(color, 0) + 63) / 64;
  uint count = uint(size.x * size.y), i = gl_LocalInvocationIndex;
  vec2 sum = vec2(0.0);
  for (uint t = i; t < count; t += 256u) sum += tiles[t];
  sums[i] = sum;
  for (uint half_size = 128u; half_size > 0u; half_size /= 2u) {
    barrier();
    if (i < half_size) sums[i] += sums[i + half_size];
  }
  if (i != 0u) return;
  average = sums[0].y > 0.0 ? exp2(sums[0].x / sums[0].y) : 0.0;
  bright = brightLuminance();
}
