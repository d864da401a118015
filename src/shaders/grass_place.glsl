// Where grass is looked up, and what it is like there. Needs frame_set.glsl and grass_set.glsl; fit for
// vertex shaders, too.
#include "shared/ground.h"
#include "shared/sh.h"

vec3 axisOf(bool v) {
  return v ? vec3(grass.rows.z, 0.0, grass.rows.w) : vec3(grass.rows.x, 0.0, grass.rows.y);
}

/// Where a slice's picture is read, in its first layer: `along` it past the eye's tile, m, and at a
/// height at rest.
vec3 slicePicture(bool across_u, uint number, float along, float at_rest) {
  float tiles = along / grass.shell.w, tile = floor(tiles);
  uint first_tile = across_u ? grass.eye_cell.w : grass.eye_cell.z, salt = across_u ? 0u : 1u;
  float x = wangPlace(number, first_tile + uint(int(tile)), tiles - tile, kBorderOfU + salt);
  uint kind = sliceKind(number, uint(grass.limits.w), kSliceKindOfU + salt);
  return vec3(x, 1.0 - at_rest / grass.shell.x, float(kind));
}

/// The level of a slice's picture at a distance, for rays that go `across` its plane by this share.
float sliceLod(float distance, float across) {
  float texels = max(grass.texels.x, grass.texels.y) * grass.texels.w;
  return max(log2(texels * distance) - 0.5 * log2(max(across, 0.1)), 0.0);
}

/// u, v of the ground's picture.
vec2 groundPlace(vec2 past_tile) {
  vec2 tile = floor(past_tile / grass.shell.w);
  vec2 share = past_tile / grass.shell.w - tile;
  uvec2 number = grass.eye_cell.zw + uvec2(ivec2(tile));
  return vec2(wangPlace(number.y, number.x, share.x, kBorderOfGround),
              wangPlace(number.x, number.y, share.y, kBorderOfGround + 1u));
}

vec3 terrainNormal(vec2 place) {
  if (grass.terrain_range.w > 0.0) return vec3(0.0, 1.0, 0.0);
  vec2 step = grass.terrain.zw;
  float x = groundHeight(place + vec2(step.x, 0.0)) - groundHeight(place - vec2(step.x, 0.0));
  float z = groundHeight(place + vec2(0.0, step.y)) - groundHeight(place - vec2(0.0, step.y));
  return normalize(vec3(-x / (2.0 * step.x), 1.0, -z / (2.0 * step.y)));
}

/// Noise of wind in [-1, 1] at two sizes, that goes with it.
vec2 windNoise(vec3 place) {
  if (grass.moment.toward.w == 0.0) return vec2(0.0);
  vec2 broad = place.xz / kWindNoise_m - grass.scroll.xy;
  vec2 fine = place.xz / kWindRipple_m - grass.scroll.zw;
  vec2 waves = vec2(textureLod(ground_noise, broad, 0.0).r, textureLod(ground_noise, broad.yx + 0.37, 0.0).r);
  vec2 ripples = vec2(textureLod(ground_noise, fine, 0.0).r, textureLod(ground_noise, fine.yx + 0.61, 0.0).r);
  return 2.0 * mix(waves, ripples, 0.4) - 1.0;
}

/// Patches of tones at x, z, seen from a distance, m.
vec3 grassTint(vec2 place, float distance) {
  if (grass.cover_size.w == 0.0) return vec3(1.0);
  GroundLookup tones = groundLookup(place, frame.ground.w);
  float far_lod = log2(max(distance * grass.texels.w * 50.0, 1.0));
  vec3 tint = groundTone(textureLod(ground_noise, tones.fine, far_lod - 2.0).r,
                         textureLod(ground_noise, tones.middle, max(far_lod - 5.0, 0.0)).r,
                         textureLod(ground_noise, tones.broad, 0.0).r, 0.35);
  return mix(vec3(1.0), tint, grass.cover_size.w);
}

/// Irradiance / pi of what faces the horizon, on the mean, either way, across a direction; open.
vec3 sidewaysLight(vec3 direction) {
  vec3 aside = normalize(vec3(-direction.z, 1e-4, direction.x));
  return 0.5 * (shIrradiance(aside, frame.open_light) + shIrradiance(-aside, frame.open_light));
}
