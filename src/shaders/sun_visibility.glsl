// S of (1): the share of the sun seen from a point, by the shadow maps and the light depth maps.
#include "cascades.glsl"
#include "foliage_shadow.glsl"

// Twelve points of a disk of radius 1, evenly spread (no two nearer than 0.45) and centred.
const vec2 kPoissonDisk[12] = vec2[](
    vec2(0.1854, 0.4768), vec2(-0.1024, -0.8681), vec2(0.7568, -0.4699), vec2(-0.6557, 0.0262),
    vec2(-0.0339, -0.1492), vec2(0.8430, 0.3558), vec2(-0.7196, -0.5347), vec2(-0.2571, 0.3055),
    vec2(0.4997, -0.0542), vec2(0.0117, 0.9999), vec2(0.2522, -0.5537), vec2(-0.7800, 0.4656));
/// Four points of the same disk, for what is read beside the smoother map of leaves.
const vec2 kSquare[4] = vec2[](vec2(0.7, 0.0), vec2(0.0, 0.7), vec2(-0.7, 0.0), vec2(0.0, -0.7));
/// Radius of that disk in texels of a shadow map. With the bilinear comparison of each tap the
/// half-shadow of an edge is about 4 texels wide: 2 cm for a 10 m tree and a map of 2048, the width
/// of the sun's own half-shadow 2 m behind the edge.
const float kPoissonRadius = 1.7;

/// Towards the border of a map the disk grows, by this factor at most, to meet that of the next.
const float kWidestPoisson = 2.0;

/// Where a cascade's maps are read for a point: `at`, the point moved off its surface, depth not
/// beyond the farthest in the map; `z`, the same without that end; `turn`: the disk of taps' radius
/// and angle.
struct ShadowLookup {
  int cascade;
  vec3 at;
  float z;
  vec2 turn;
};

vec2 tapOf(ShadowLookup from, vec2 q) {
  return from.at.xy +
         vec2(from.turn.x * q.x - from.turn.y * q.y, from.turn.y * q.x + from.turn.x * q.y);
}

/// 1 in front of the nearest surface of the shadow map, 0 behind it, between them near its edges.
float openTap(ShadowLookup from, vec2 tap) {
  // Arrays have no textureLod with comparison; a single mip needs no derivatives.
  return texture(shadow_map, vec4(tap, float(from.cascade), from.at.z));
}

/// All or nothing, by the nearest surface.
float shadowMapVisibility(ShadowLookup from) {
  float sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += openTap(from, tapOf(from, kPoissonDisk[i]));
  return sum / 12.0;
}

/// Mean distance from the point to what is in front of it, m, 0 if nothing is: leaves, halfway
/// between the first and the last one, and wood, for points that have nothing behind them.
float blockerDistance(ShadowLookup from) {
  vec2 size = vec2(textureSize(blocker_map, 0).xy * blockerBlock());
  vec2 blocker = textureLod(blocker_map, vec3(from.at.xy / (frame.sun_light.w * size),
                                              float(from.cascade)), 0.0).xy;
  if (blocker.y <= 0.0) return 0.0;
  return max(from.z - blocker.x / blocker.y, 0.0) / depthOfMetre(from.cascade);
}

/// What wood leaves open and leaves let through. The texels of leaves are filtered first, as their
/// optical depths may be, and evaluated once. Each of them costs as much as several of wood's, so
/// leaves themselves read one, as the paper has it. `soft`: with the half-shadow of the sun's disk,
/// as wide as what casts it is far away (after Fernando, "Percentage-Closer Soft Shadows", 2005):
/// for surfaces that cast no shadow themselves.
vec3 layeredVisibility(ShadowLookup from, vec4 leaf, bool soft) {
  float open = 0.0;
  if (!soft) {
    for (int i = 0; i < 4; ++i) open += openTap(from, tapOf(from, kSquare[i])) / 4.0;
    return open * throughLeaves(from.cascade, foliageTap(from.cascade, from.at.xy), from.z, leaf);
  }
  float distance = blockerDistance(from);
  if (distance <= 0.0) return vec3(1.0);
  float radius = distance * tan(frame.sun_disk.w) / frame.cascade[from.cascade].x;
  float texels = length(from.turn) / frame.sun_light.w;
  from.turn *= clamp(radius, texels, max(texels, kWidestShadow)) / texels;
  vec4 leaves = vec4(0.0);
  for (int i = 0; i < 12; ++i) {
    vec2 tap = tapOf(from, kPoissonDisk[i]);
    float here = openTap(from, tap);
    open += here;
    leaves += here * foliageTap(from.cascade, tap);  // behind wood there are none in the map
  }
  if (open <= 0.0) return vec3(0.0);
  return open / 12.0 * throughLeaves(from.cascade, leaves / open, from.z, leaf);
}

/// Share of the sun by one cascade's maps. The taps lie on a disk turned by an angle of its own for
/// each texel of the map (Habel 2009, 5.5). The angle hangs on the world, not on the picture, so
/// nothing swims when the camera moves. A point of what is in the map itself is moved off its
/// surface, towards the sun's side, by the reach of the filter: in the normal's direction where the
/// sun grazes it, towards the sun where it does not. A surface therefore never shades itself, and the
/// shadow of another is displaced by less than three texels. The ground, which is not in the map,
/// stays where it is: a displacement is half of its error otherwise.
vec3 cascadeVisibility(int cascade, vec3 world_position, vec3 geometric_normal, vec4 leaf,
                       bool soft) {
  vec3 l = frame.to_sun.xyz;
  float texel_m = frame.cascade[cascade].x;
  vec2 off_center = abs(cascadePosition(cascade, world_position).xy - 0.5);
  float widening = min(frame.cascade[cascade].y, kWidestPoisson) - 1.0;
  float radius =
      kPoissonRadius * (1.0 + widening * smoothstep(0.2, 0.45, max(off_center.x, off_center.y)));
  float n_l = dot(geometric_normal, l);
  vec3 n = n_l < 0.0 ? -geometric_normal : geometric_normal;
  float grazing = sqrt(max(1.0 - n_l * n_l, 0.0));
  ShadowLookup from;
  from.cascade = cascade;
  float off_m = soft ? 0.0 : texel_m;
  from.at = cascadePosition(cascade,
                            world_position + (n * ((radius + 0.7) * grazing) + l) * off_m);
  from.z = from.at.z;
  from.at.z = min(from.at.z, 1.0);
  if (any(lessThan(from.at.xy, vec2(0.0))) || any(greaterThan(from.at.xy, vec2(1.0))))
    return vec3(1.0);
  vec2 cell = cascadeCell(cascade, from.at.xy);
  float angle = 6.28318531 * fract(52.9829189 * fract(dot(cell, vec2(0.06711056, 0.00583715))));
  from.turn = vec2(cos(angle), sin(angle)) * (radius * frame.sun_light.w);
  if (kShadowSource == kShadowMap) return vec3(shadowMapVisibility(from));
  return layeredVisibility(from, leaf, soft);
}

/// `geometric_normal` is the triangle's own, on either side; `leaf`, as throughLeaves() has it;
/// `soft`, as layeredVisibility() does.
vec3 sunVisibility(vec3 world_position, vec3 geometric_normal, vec4 leaf, bool soft) {
  CascadeChoice choice = chooseCascades(world_position);
  vec3 visibility = cascadeVisibility(choice.fine, world_position, geometric_normal, leaf, soft);
  if (choice.share < 1.0)
    visibility = mix(cascadeVisibility(choice.coarse, world_position, geometric_normal, leaf, soft),
                     visibility, choice.share);
  return visibility;
}
