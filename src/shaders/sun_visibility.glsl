// S of (1): the share of the sun seen from a point, by the shadow map and the light depth map.
#include "foliage_shadow.glsl"

// Twelve points of a disk of radius 1, evenly spread (no two nearer than 0.45) and centred.
const vec2 kPoissonDisk[12] = vec2[](
    vec2(0.1854, 0.4768), vec2(-0.1024, -0.8681), vec2(0.7568, -0.4699), vec2(-0.6557, 0.0262),
    vec2(-0.0339, -0.1492), vec2(0.8430, 0.3558), vec2(-0.7196, -0.5347), vec2(-0.2571, 0.3055),
    vec2(0.4997, -0.0542), vec2(0.0117, 0.9999), vec2(0.2522, -0.5537), vec2(-0.7800, 0.4656));
// Four points of a circle.
const vec2 kSquare[4] = vec2[](vec2(0.7, 0.0), vec2(0.0, 0.7), vec2(-0.7, 0.0), vec2(0.0, -0.7));
/// Radius of that disk in texels of the shadow map. With the bilinear comparison of each tap the
/// half-shadow of an edge is about 4 texels wide: 2 cm for a 10 m tree and a map of 2048, the width
/// of the sun's own half-shadow 2 m behind the edge.
const float kPoissonRadius = 1.7;

/// Bilinear comparisons on a disk turned by an angle of its own for each texel of the map (Habel
/// 2009, 5.5). The angle hangs on the world, not on the picture, so nothing swims when the camera
/// moves. `geometric_normal` is the triangle's own, on either side. The point is moved off its
/// surface, towards the sun's side, by the reach of the filter: in the normal's direction where the
/// sun grazes it, towards the sun where it does not. A surface therefore never shades itself, and
/// the shadow of another is displaced by less than three texels. `leaf`: as throughLeaves() has it.
/// The map of leaves is so smooth that four taps of each map do.
vec3 sunVisibility(vec3 world_position, vec3 geometric_normal, vec4 leaf) {
  vec3 l = frame.to_sun.xyz;
  float texel_m = frame.to_sun.w;
  float n_l = dot(geometric_normal, l);
  vec3 n = n_l < 0.0 ? -geometric_normal : geometric_normal;
  float grazing = sqrt(max(1.0 - n_l * n_l, 0.0));
  vec3 p = world_position + n * ((kPoissonRadius + 0.7) * texel_m * grazing) + l * texel_m;
  vec3 at = (frame.shadow_from_world * vec4(p, 1.0)).xyz;
  at.z = min(at.z, 1.0);  // beyond the map: behind everything in it
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return vec3(1.0);

  float texel = frame.sun_light.w;
  vec2 cell = floor(at.xy / texel);
  float angle = 6.28318531 * fract(52.9829189 * fract(dot(cell, vec2(0.06711056, 0.00583715))));
  vec2 turn = vec2(cos(angle), sin(angle)) * (kPoissonRadius * texel);
  const bool layered = kShadowSource != kShadowMap;
  const int taps = layered ? 4 : 12;
  float open = 0.0;
  vec3 through = vec3(0.0);
  for (int i = 0; i < taps; ++i) {
    vec2 q = layered ? kSquare[i] : kPoissonDisk[i];
    vec2 tap = at.xy + vec2(turn.x * q.x - turn.y * q.y, turn.y * q.x + turn.x * q.y);
    open += textureLod(shadow_map, vec3(tap, at.z), 0.0);
    if (layered) through += throughLeaves(vec3(tap, at.z), leaf);
  }
  open /= float(taps);
  return layered ? open * through / float(taps) : vec3(open);
}
