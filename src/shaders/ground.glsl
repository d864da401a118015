// The painted ground: reflectance at a place. Needs frame_set.glsl.
#include "shared/ground.h"

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

vec3 paintedGround(vec2 p) {
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
