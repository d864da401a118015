#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "shared/foliage_shadow.h"
#include "shared/leaf_basis.h"
#include "terms.glsl"
#include "leaf_maps.glsl"
// One leaf in the light depth map; blending keeps the largest of the first three and adds the last.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint mirrored;
layout(location = 0) out vec4 out_texel;

/// As halves hold it, rounded down: the nearest leaf is then never nearer than it is, and shades no
/// part of itself. Left to the device, some would round up.
vec2 roundedDown(vec2 value) {
  return uintBitsToFloat(floatBitsToUint(value) & 0xffffe000u);
}

/// What leaves the side of the leaf that the sun does not light.
vec3 transmittance(vec3 color) {
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  if (kLeafModel != kLeafColor) {
    // The map is a mirror image: its fronts are the leaves' backs.
    float layer = gl_FrontFacing == (mirrored == 0u) ? 1.0 : 2.0;
    vec3 h = lightCoefficients(layer, draw.leaf_light, uv, uv_x, uv_y);
    return lightColor(layer, uv, uv_x, uv_y) * max(leafEvenDirection(h).z, 0.0);
  }
  if (kStatedTransmission)
    return statedShare(draw.transmission.w, uv, uv_x, uv_y) *
           statedColor(draw.transmission.rgb, uv, uv_x, uv_y);
  return leafTransmittance(color);
}

void main() {
  vec4 texel = vec4(1.0);
  if (kTextures || kAlphaTest) texel = texture(base_color, uv, -1.0);  // as shadow_pass.frag
  // Matt leaves let through what they do on the mean.
  float depth = draw.leaf.w;
  if (kTextures) depth = leafOpticalDepth(transmittance(texel.rgb * draw.color.rgb));
  if (kAlphaTest && texel.a < draw.surface.x) discard;
  out_texel = vec4(roundedDown(vec2(1.0 - gl_FragCoord.z, gl_FragCoord.z)), 1.0, depth);
}
