// S of (1): the share of the sun seen from a point, by the shadow maps.
#include "cascades.glsl"

// Twelve points of a disk of radius 1, evenly spread (no two nearer than 0.45) and centred.
const vec2 kPoissonDisk[12] = vec2[](
    vec2(0.1854, 0.4768), vec2(-0.1024, -0.8681), vec2(0.7568, -0.4699), vec2(-0.6557, 0.0262),
    vec2(-0.0339, -0.1492), vec2(0.8430, 0.3558), vec2(-0.7196, -0.5347), vec2(-0.2571, 0.3055),
    vec2(0.4997, -0.0542), vec2(0.0117, 0.9999), vec2(0.2522, -0.5537), vec2(-0.7800, 0.4656));
/// Radius of that disk in texels of a shadow map. With the bilinear comparison of each tap the
/// half-shadow of an edge is about 4 texels wide: 2 cm for a 10 m tree and a map of 2048, the width
/// of the sun's own half-shadow 2 m behind the edge.
const float kPoissonRadius = 1.7;

/// Towards the border of a map the disk grows, by this factor at most, to meet that of the next.
const float kWidestPoisson = 2.0;

/// Share of the sun by one cascade's map. Twelve bilinear comparisons on a disk turned by an angle of
/// its own for each texel of the map (Habel 2009, 5.5). The angle hangs on the world, not on the
/// picture, so nothing swims when the camera moves. The point is moved off its surface, towards the
/// sun's side, by the reach of the filter: in the normal's direction where the sun grazes it, towards
/// the sun where it does not. A surface therefore never shades itself, and the shadow of another is
/// displaced by less than three texels.
float cascadeVisibility(int cascade, vec3 world_position, vec3 geometric_normal) {
  vec3 l = frame.to_sun.xyz;
  float texel_m = frame.cascade[cascade].x;
  vec2 off_center = abs(cascadePosition(cascade, world_position).xy - 0.5);
  float widening = min(frame.cascade[cascade].y, kWidestPoisson) - 1.0;
  float radius =
      kPoissonRadius * (1.0 + widening * smoothstep(0.2, 0.45, max(off_center.x, off_center.y)));
  float n_l = dot(geometric_normal, l);
  vec3 n = n_l < 0.0 ? -geometric_normal : geometric_normal;
  float grazing = sqrt(max(1.0 - n_l * n_l, 0.0));
  vec3 p = world_position + n * ((radius + 0.7) * texel_m * grazing) + l * texel_m;
  vec3 at = cascadePosition(cascade, p);
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;

  vec2 cell = cascadeCell(cascade, at.xy);
  float angle = 6.28318531 * fract(52.9829189 * fract(dot(cell, vec2(0.06711056, 0.00583715))));
  vec2 turn = vec2(cos(angle), sin(angle)) * (radius * frame.sun_light.w);
  float sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    vec2 q = kPoissonDisk[i];
    vec2 tap = at.xy + vec2(turn.x * q.x - turn.y * q.y, turn.y * q.x + turn.x * q.y);
    // Arrays have no textureLod with comparison; a single mip needs no derivatives.
    sum += texture(shadow_map, vec4(tap, float(cascade), at.z));
  }
  return sum / 12.0;
}

/// `geometric_normal` is the triangle's own, on either side.
float sunVisibility(vec3 world_position, vec3 geometric_normal) {
  CascadeChoice choice = chooseCascades(world_position);
  float visibility = cascadeVisibility(choice.fine, world_position, geometric_normal);
  if (choice.share < 1.0)
    visibility = mix(cascadeVisibility(choice.coarse, world_position, geometric_normal), visibility,
                     choice.share);
  return visibility;
}
