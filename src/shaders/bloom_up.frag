#version 460
// This size mixed with what is spread wider, enlarged by a tent of 3 x 3 texels. Both are averages,
// so light is neither gained nor lost.
layout(set = 0, binding = 0) uniform sampler2D finer;    // of this size
layout(set = 0, binding = 1) uniform sampler2D coarser;  // half of it, spread
layout(location = 0) out vec4 out_color;
const float kSpread = 0.65;  // share of the wider parts

void main() {
  vec2 at = gl_FragCoord.xy / vec2(textureSize(finer, 0));
  vec2 step = 1.0 / vec2(textureSize(coarser, 0));
  vec4 sum = vec4(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += textureLod(coarser, at + step * vec2(x, y), 0.0) *
             (float(2 - abs(x)) * float(2 - abs(y)) / 16.0);
  out_color = mix(textureLod(finer, at, 0.0), sum, kSpread);
}
