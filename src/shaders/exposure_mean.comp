#version 460
// The tiles' sums to one: average_and_weight.x = log-average luminance (Reinhard's (1)), 0 if there
// is nothing but background.
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) uniform sampler2D color;
layout(set = 0, binding = 1, std430) buffer Sums { vec2 average_and_weight; vec2 tiles[]; };
shared vec2 sums[256];

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
  if (i == 0u)
    average_and_weight = vec2(sums[0].y > 0.0 ? exp2(sums[0].x / sums[0].y) : 0.0, sums[0].y);
}
