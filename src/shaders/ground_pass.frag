#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "ground.glsl"
#include "terms.glsl"
#include "dome.glsl"
#include "sun_visibility.glsl"

layout(location = 0) out vec4 out_color;

void main() {
  vec3 direction = pixelDirection();
  float distance = (frame.ground.x - frame.eye.y) / direction.y;
  // A centre beyond the horizon sees the disc's end.
  if (!(distance > 0.0 && distance < frame.ground.y)) distance = frame.ground.y;
  vec3 position = frame.eye.xyz + distance * direction;
  vec3 n = vec3(0.0, 1.0, 0.0);
  vec3 color = kTextures ? paintedGround(position.xz) : vec3(0.18);
  vec3 visibility = vec3(1.0);
  if (kShadow) visibility = sunVisibility(position, n, vec4(frame.leaf_tint.rgb, 0.0), true);
  vec3 ambient = kAmbientSource == kTransfer && frame.ground_map.z > 0.0 ? mappedLight(position)
                                                                         : frame.open_sky.rgb;
  vec3 lit = illumination(kAmbient ? ambient * color : vec3(0.0), frame.sun_light.rgb, visibility,
                          kDiffuse ? color * diffuseFactor(n, frame.to_sun.xyz) : vec3(0.0), 0.0,
                          0.0);
  // Alpha 0 is the background, where there is one instead of the sky.
  float haze = hazeShare(distance, frame.ground.z);
  vec3 far = kBackground ? vec3(0.0) : domeLuminance(direction);
  out_color = vec4(storable(mix(lit, far, haze)), kBackground ? 1.0 - haze : 1.0);
}
