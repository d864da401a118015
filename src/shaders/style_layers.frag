#version 460
#extension GL_GOOGLE_include_directive : require
#define kGroundSet 3
#include "frame_set.glsl"
#include "style_layer.glsl"
#include "terms.glsl"
#include "coverage.glsl"
#include "sun_visibility.glsl"
// Wood or foliage, as if nothing but the ground were in front of it.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };

layout(location = 0) in vec3 position;
layout(location = 1) centroid in vec4 in_normal;
layout(location = 2) in vec2 uv;
layout(location = 3) centroid in vec2 covered_uv;
layout(location = 6) flat in uint seed;
layout(location = 9) flat in uvec2 seat;  // instance.glsl

void main() {
  // Derivatives come first: behind the discard below they are not defined.
  vec3 p_x = dFdx(position), p_y = dFdy(position);
  vec4 texel = textureGrad(base_color, covered_uv, dFdx(uv), dFdy(uv));
  int mask = maskBeforeGround();
  if (kAlphaTest) mask &= coverageMask(texel.a, draw.surface.x, seed);
  if (kForest) mask &= fadeMask(seat);
  gl_SampleMask[0] = mask;
  if (mask == 0) discard;

  vec3 n = dot(in_normal.xyz, in_normal.xyz) > 1e-12 ? normalize(in_normal.xyz) : vec3(0, 1, 0);
  if (kFlipNormal && !gl_FrontFacing) n = -n;
  vec3 face = cross(p_x, p_y), visible = vec3(1.0);
  if (kShadow && dot(n, frame.to_sun.xyz) > 0.0)
    visible = sunVisibility(position, dot(face, face) > 0.0 ? normalize(face) : n, draw.leaf,
                            false);
  vec3 tint = kForest && kFoliage ? tintOf(seat) : vec3(1.0);
  writeLayer(position, n, kAmbientSource == kBaked ? in_normal.w : 1.0,
             texel.rgb * draw.color.rgb * tint, visible);
}
