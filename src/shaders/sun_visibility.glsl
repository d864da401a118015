// S of (1): the share of the sun seen from a point, by the shadow map.

/// A tent of 3 x 3 texels as four bilinear comparisons (Castano, "Shadow Mapping Summary", 2013).
/// `geometric_normal` is the triangle's own, on either side. The point is moved off its surface,
/// towards the sun's side, by the reach of the filter: in the normal's direction where the sun
/// grazes it, towards the sun where it does not. A surface therefore never shades itself, and the
/// shadow of another is displaced by less than two texels.
float sunVisibility(vec3 world_position, vec3 geometric_normal) {
  vec3 l = frame.to_sun.xyz;
  float texel_m = frame.to_sun.w;
  float n_l = dot(geometric_normal, l);
  vec3 n = n_l < 0.0 ? -geometric_normal : geometric_normal;
  float grazing = sqrt(max(1.0 - n_l * n_l, 0.0));
  vec3 p = world_position + n * (2.0 * texel_m * grazing) + l * texel_m;
  vec3 at = (frame.shadow_from_world * vec4(p, 1.0)).xyz;
  at.z = min(at.z, 1.0);  // beyond the map: behind everything in it
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 1.0;

  float texel = frame.sun_color.w;
  vec2 uv = at.xy / texel;
  vec2 base = floor(uv + 0.5);
  vec2 s = uv + 0.5 - base;
  base -= 0.5;
  vec2 w0 = 3.0 - 2.0 * s;
  vec2 w1 = 1.0 + 2.0 * s;
  vec2 a = (2.0 - s) / w0 - 1.0;
  vec2 b = s / w1 + 1.0;
  float sum = w0.x * w0.y * textureLod(shadow_map, vec3((base + a) * texel, at.z), 0.0);
  sum += w1.x * w0.y * textureLod(shadow_map, vec3((base + vec2(b.x, a.y)) * texel, at.z), 0.0);
  sum += w0.x * w1.y * textureLod(shadow_map, vec3((base + vec2(a.x, b.y)) * texel, at.z), 0.0);
  sum += w1.x * w1.y * textureLod(shadow_map, vec3((base + b) * texel, at.z), 0.0);
  return sum / 16.0;
}
