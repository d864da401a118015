#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/foliage_shadow.h"
#include "terms.glsl"
// One leaf in the light depth map; blending keeps the largest of the first three and adds the last.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 out_texel;

/// As halves hold it, rounded down: the nearest leaf is then never nearer than it is, and shades no
/// part of itself. Left to the device, some would round up.
vec2 roundedDown(vec2 value) {
  return uintBitsToFloat(floatBitsToUint(value) & 0xffffe000u);
}

void main() {
  vec4 texel = vec4(1.0);
  if (kTextures || kAlphaTest) texel = texture(base_color, uv, -1.0);  // as shadow_pass.frag
  if (kAlphaTest && texel.a < draw.surface.x) discard;
  float depth = leafOpticalDepth(kTextures ? texel.rgb * draw.color.rgb : draw.matt.rgb);
  out_texel = vec4(roundedDown(vec2(1.0 - gl_FragCoord.z, gl_FragCoord.z)), 1.0, depth);
}
