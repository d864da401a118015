#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/ground.h"
#include "shared/illumination.h"
#include "shared/sky.h"
#include "sun_visibility.glsl"
#include "terms.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out vec4 out_color;

/// A texture seen at a grazing angle: four taps along the long axis of the pixel's footprint, each
/// filtered by a quarter of it. The same on all drivers; those in software have no anisotropic
/// filter fit for ground that goes to the horizon.
vec3 grazingTexture(vec2 uv) {
  vec2 x = dFdx(uv), y = dFdy(uv);
  bool x_longer = dot(x, x) > dot(y, y);
  vec2 longer = x_longer ? x : y, shorter = x_longer ? y : x;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i)
    sum += textureGrad(ground_texture, uv + longer * (0.25 * float(i) - 0.375), longer * 0.25,
                       shorter).rgb;
  return 0.25 * sum;
}

vec3 grass(vec2 p) {
  GroundLookup at = groundLookup(p, frame.ground.w);
  return groundColor(grazingTexture(at.blades), grazingTexture(at.turned_blades),
                     texture(ground_noise, at.fine).r, texture(ground_noise, at.middle).r,
                     texture(ground_noise, at.broad).r);
}

void main() {
  vec3 to_eye = frame.eye.xyz - position;
  float distance = length(to_eye);
  vec3 n = vec3(0.0, 1.0, 0.0);
  vec3 color = kTextures ? grass(position.xz) : vec3(0.18);
  float visibility = kShadow ? sunVisibility(position, n) : 1.0;
  vec3 lit = illumination(frame.ambient_color.rgb, color * (kAmbient ? 1.0 : 0.0),
                          frame.sun_color.rgb, visibility, color,
                          kDiffuse ? diffuseFactor(n, frame.to_sun.xyz) : 0.0, 0.0, 0.0);
  vec3 horizon = skyColor(-to_eye / distance, frame.sky_horizon.rgb, frame.sky_zenith.rgb);
  out_color = vec4(mix(lit, horizon, hazeShare(distance, frame.ground.z)), 1.0);
}
