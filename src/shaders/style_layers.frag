#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/sh.h"
#include "shared/style.h"
#include "shared/tone.h"
#include "terms.glsl"
#include "coverage.glsl"
#include "sun_visibility.glsl"
// What drawn styles are made of, one layer (wood or foliage) as if nothing but the ground were in
// front of it. All is multiplied by the share of a pixel that the layer covers: so averages over
// samples, and over pixels, are averages of what is seen.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(set = 3, binding = 0) uniform sampler2DMS ground_depth;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };

layout(location = 0) in vec3 position;
layout(location = 1) centroid in vec4 in_normal;
layout(location = 2) in vec2 uv;
layout(location = 3) centroid in vec2 covered_uv;
layout(location = 6) flat in uint seed;
layout(location = 9) flat in uvec2 seat;  // instance.glsl
layout(location = 0) out vec4 out_normal;  // unit normal times the ambient coefficient
layout(location = 1) out vec4 out_color;   // reflectance
layout(location = 2) out vec4 out_layer;   // 1, lightness, 1 / distance along the view, noise

/// Size of the noise's patches, as a share of the picture's height.
const float kPatch = 1.0 / 24.0;

int maskBeforeGround() {
  int mask = 15;
  for (int i = 0; i < 4; ++i)
    if (gl_FragCoord.z < texelFetch(ground_depth, ivec2(gl_FragCoord.xy), i).r) mask &= ~(1 << i);
  return mask;
}

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
  float k = kAmbientSource == kBaked ? in_normal.w : 1.0;
  vec3 l = frame.to_sun.xyz;
  float sun = luminanceOf(frame.sun_light.rgb), sky = luminanceOf(frame.open_sky.rgb);
  float light = k * luminanceOf(shIrradiance(n, frame.open_light));
  float facing = diffuseFactor(n, l);
  if (facing > 0.0) {
    vec3 face = cross(p_x, p_y);
    vec3 visible = kShadow ? sunVisibility(position, dot(face, face) > 0.0 ? normalize(face) : n,
                                           draw.leaf, false)
                           : vec3(1.0);
    light += sun * facing * luminanceOf(visible);
  }
  float distance = dot(position - frame.eye.xyz, normalize(frame.ray_forward.xyz));
  float height_m = 2.0 * distance * length(frame.ray_down.xyz) / length(frame.ray_forward.xyz);
  out_normal = vec4(n * k, 1.0);
  vec3 tint = kForest && kFoliage ? tintOf(seat) : vec3(1.0);
  out_color = vec4(texel.rgb * draw.color.rgb * tint, 1.0);
  out_layer = vec4(1.0, lightness(light, sun + sky), 1.0 / max(distance, 1e-6),
                   placeNoise(position, max(kPatch * height_m, 1e-6)));
}
