#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/sky.h"
#include "sun_visibility.glsl"
#include "terms.glsl"

layout(location = 0) in vec3 position;
layout(location = 0) out vec4 out_color;

/// The grass texture laid over itself at three sizes and angles, so that its repetition is not
/// seen: the nearest gives the blades, the two large ones patches of light and dark, as factors
/// around 1.
vec3 grass(vec2 p) {
  vec3 mean = groundMeanColor();
  vec2 q = p / frame.ground.w;
  vec3 near = texture(ground_texture, q).rgb;
  vec3 middle = texture(ground_texture, mat2(0.8, 0.6, -0.6, 0.8) * q * 0.137).rgb / mean;
  vec3 far = texture(ground_texture, mat2(0.28, -0.96, 0.96, 0.28) * q * 0.0213).rgb / mean;
  return near * mix(vec3(1.0), middle, 0.45) * mix(vec3(1.0), far, 0.4);
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
