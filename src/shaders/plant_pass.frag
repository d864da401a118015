#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/normal_map.h"
#include "sun_visibility.glsl"
#include "terms.glsl"

layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(set = 1, binding = 1) uniform sampler2D normal_map;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 in_normal;
layout(location = 2) in vec2 uv;
/// Where a covered sample lies: at the edge of a small leaf the pixel's centre is outside, and its
/// texture coordinates lie beyond the leaf, where alpha is 0.
layout(location = 3) centroid in vec2 covered_uv;
layout(location = 0) out vec4 out_color;

/// Which of the four samples an alpha-cut surface covers. Written here rather than left to the
/// fixed alpha-to-coverage, whose rounding differs between drivers: alpha is steepened to an edge
/// about one pixel wide around the cutoff, and a fixed pattern of thresholds over the pixels
/// (Jimenez 2014, interleaved gradient noise) makes the mean coverage of large areas exact.
int coverageMask(float alpha, float cutoff) {
  float coverage = clamp((alpha - cutoff) / max(fwidth(alpha), 0.125) + 0.5, 0.0, 1.0);
  float threshold = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  int count = int(floor(coverage * 4.0 + threshold));
  return (1 << min(count, 4)) - 1;
}

void main() {
  // Derivatives come first: behind the discard below they are not defined.
  vec3 p_x = dFdx(position), p_y = dFdy(position);
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  vec4 texel = vec4(1.0);
  // Derivatives from the centres, which lie in one plane.
  if (kTextures || kAlphaTest)
    texel = textureGrad(base_color, covered_uv, uv_x, uv_y);
  if (kAlphaTest) {
    int mask = coverageMask(texel.a, draw.surface.x);
    gl_SampleMask[0] = mask;
    if (mask == 0) discard;
  } else {
    gl_SampleMask[0] = 15;
  }
  vec3 color = kTextures ? texel.rgb * draw.color.rgb : draw.matt.rgb;

  vec3 n = normalize(in_normal.xyz);
  if (kFlipNormal && !gl_FrontFacing) n = -n;
  if (kNormalMap && kTextures) {
    vec3 texel_n = textureGrad(normal_map, uv, uv_x, uv_y).xyz;
    n = mappedNormal(n, p_x, p_y, uv_x, uv_y, texel_n, draw.surface.y);
  }
  vec3 l = frame.to_sun.xyz;
  vec3 v = normalize(frame.eye.xyz - position);

  float visibility = 1.0;
  if (kShadow) {
    vec3 face = cross(p_x, p_y);
    visibility = sunVisibility(position, dot(face, face) > 0.0 ? normalize(face) : n);
  }
  float k_a = kAmbient ? (kBakedAmbient ? in_normal.w : 1.0) : 0.0;
  float diffuse = kDiffuse ? diffuseFactor(n, l) : 0.0;
  float specular = kSpecular ? specularFactor(n, l, v, draw.surface.w) : 0.0;
  out_color = vec4(illumination(frame.ambient_color.rgb, color * k_a, frame.sun_color.rgb,
                                visibility, color, diffuse, draw.surface.z, specular),
                   1.0);
}
