#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/ground.h"
#include "shared/illumination.h"
#include "terms.glsl"
#include "dome.glsl"
#include "sun_visibility.glsl"

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

/// Light on the ground from the sky and from what stands on it; open where the map ends.
vec3 mappedLight(vec3 p) {
  vec2 at = (p.xz - frame.ground_map.xy) * frame.ground_map.z;
  bool open = any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)));
  return open ? frame.open_sky.rgb : textureLod(ground_light, at, 0.0).rgb;
}

void main() {
  vec3 direction = pixelDirection();
  float distance = (frame.ground.x - frame.eye.y) / direction.y;
  // A centre beyond the horizon sees the disc's end.
  if (!(distance > 0.0 && distance < frame.ground.y)) distance = frame.ground.y;
  vec3 position = frame.eye.xyz + distance * direction;
  vec3 n = vec3(0.0, 1.0, 0.0);
  vec3 color = kTextures ? grass(position.xz) : vec3(0.18);
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
