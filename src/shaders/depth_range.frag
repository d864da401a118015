#version 460
// The nearest and the farthest depth of a pixel's samples (1 = near, 0 = never).
layout(set = 0, binding = 0) uniform sampler2DMS depth_samples;
layout(location = 0) out vec2 range;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  range = vec2(0.0, 1.0);
  for (int i = 0; i < 4; ++i) {
    float depth = texelFetch(depth_samples, at, i).r;
    range = vec2(max(range.x, depth), min(range.y, depth));
  }
}
