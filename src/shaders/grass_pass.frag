#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/sh.h"
#include "terms.glsl"
#include "dome.glsl"
#include "ground.glsl"
#include "sun_visibility.glsl"
#include "grass_set.glsl"

// The ground of a terrain, and grass on it: 2.3 of Habel 2009. A ray enters the shell of grass, meets
// slices across u and across v from front to back, and composites them until nothing is seen through
// them, until it comes to the ground, out of the shell, to what stands in the grass, or to the most
// slices that it may; what is still open then is filled by the opaque slice.
layout(constant_id = 20) const bool kGrass = true;
layout(constant_id = 21) const bool kBase = true;  // the layer that covers the ground
layout(constant_id = 23) const bool kMedium = true;  // slices finer than pixels are a medium

layout(location = 0) centroid in vec3 from_eye;
layout(location = 0) out vec4 out_color;

/// Behind this share of what covers, nothing is looked for.
const float kOpaque = 0.995;

struct Light {
  vec3 up;       // irradiance / pi of what faces the sky
  vec3 sideways; // mean of what faces the horizon, any way
};

/// What has been met so far.
struct Met {
  vec3 sunlit;   // to be lit by the sun: premultiplied
  vec3 color;    // lit by the rest: premultiplied
  float alpha;
  float depth_t; // where alpha passed the threshold
  float first_t; // where anything was met
};

/// What packGrassData() packed.
vec4 unpackGrassData(vec4 texel) {
  return vec4((texel.xy * 255.0 - 128.0) / 127.0, texel.zw);
}

vec4 canopyAt(float w) {
  float at = clamp(w / grass.shell.x, 0.0, 1.0) * float(kCanopySteps);
  int below = min(int(at), kCanopySteps - 1);
  return mix(grass.canopy[below], grass.canopy[below + 1], at - float(below));
}

/// Composites a texel, (2.3): `color` and `data` are times its alpha. The picture's axes in the
/// world; `facing` is towards the looker, `behind` if he sees its back.
void meet(inout Met met, vec4 color, vec4 data, vec3 right, vec3 up, vec3 facing, bool behind,
          float w, float t, vec3 tint, float density, Light light) {
  if (color.a <= 0.0) return;
  if (!kTextures) color.rgb = vec3(0.18 * color.a);
  float share = 1.0 - met.alpha;
  vec2 n = data.xy / color.a * (behind ? -1.0 : 1.0);
  vec3 normal = right * n.x + up * n.y + facing * sqrt(max(1.0 - dot(n, n), 0.0));
  float through = kTransmission ? data.z / color.a : 0.0;
  vec3 seen = share * color.rgb * tint;
  vec4 canopy = canopyAt(w);
  float n_l = dot(normal, frame.to_sun.xyz);
  float lit = sunThroughGrass(canopy.x * density, frame.to_sun.xyz, grass.rows, grass.shell.yz);
  if (kDiffuse) met.sunlit += seen * (lit * (max(n_l, 0.0) + through * max(-n_l, 0.0)));
  if (kAmbient) {
    if (kAmbientSource == kConstant) {
      met.color += seen * frame.open_sky.rgb;
    } else {
      float open = mix(1.0, canopy.y, density);
      vec3 sky = mix(light.sideways, light.up, abs(normal.y)) * open;
      // What is hidden by other plants is as bright as these.
      vec3 green = grass.mean.rgb * (0.5 + 0.5 * grass.mean.w) * (1.0 - open);
      sky += green * (light.up * open + frame.sun_light.rgb * (lit * max(frame.to_sun.y, 0.0)));
      met.color += seen * sky * (1.0 + through);
    }
  }
  met.alpha += share * color.a;
  if (met.first_t < 0.0) met.first_t = t;
  if (met.depth_t < 0.0 && met.alpha > grass.limits.y) met.depth_t = t;
}

/// Which of a map's plants stand: those that are not drawn as blades, where the density is d.
void thin(inout vec4 color, inout vec4 data, float density, float blades, float lod) {
  if (color.a <= 0.0) return;
  float rank = data.w / color.a, blur = clamp(0.15 * lod, 0.02, 1.0);
  float standing = plantsStanding(density, rank, blur);
  if (blades > 0.0) standing -= plantsStanding(density * blades, rank, blur);
  color *= standing;
  data *= standing;
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
  vec2 step = grass.terrain.zw;
  float x = groundHeight(place + vec2(step.x, 0.0)) - groundHeight(place - vec2(step.x, 0.0));
  float z = groundHeight(place + vec2(0.0, step.y)) - groundHeight(place - vec2(0.0, step.y));
  return normalize(vec3(-x / (2.0 * step.x), 1.0, -z / (2.0 * step.y)));
}

/// The layer's density at x, z from the eye.
float coverAt(vec2 place) {
  vec2 size = grass.cover_size.xy;
  if (size.x == 1.0 && size.y == 1.0) return cover[0] * grass.cover_size.z;
  vec2 at = clamp((place - grass.cover.xy) * grass.cover.zw - 0.5, vec2(0.0), size - 1.0);
  uvec2 low = uvec2(at), high = min(low + 1u, uvec2(size) - 1u);
  vec2 share = at - vec2(low);
  uint width = uint(size.x);
  float top = mix(cover[low.y * width + low.x], cover[low.y * width + high.x], share.x);
  float bottom = mix(cover[high.y * width + low.x], cover[high.y * width + high.x], share.x);
  return mix(top, bottom, share.y) * grass.cover_size.z;
}

/// Noise of wind in [-1, 1] at two sizes, that goes with it.
vec2 windNoise(vec3 place) {
  vec2 broad = place.xz / kWindNoise_m - grass.scroll.xy;
  vec2 fine = place.xz / kWindRipple_m - grass.scroll.zw;
  vec2 waves = vec2(textureLod(ground_noise, broad, 0.0).r, textureLod(ground_noise, broad.yx + 0.37, 0.0).r);
  vec2 ripples = vec2(textureLod(ground_noise, fine, 0.0).r, textureLod(ground_noise, fine.yx + 0.61, 0.0).r);
  return 2.0 * mix(waves, ripples, 0.4) - 1.0;
}

void write(vec3 lit, float alpha, vec3 direction, float distance) {
  // Alpha 0 is the background, where there is one instead of the sky.
  float haze = hazeShare(distance, frame.ground.z);
  vec3 far = kBackground ? vec3(0.0) : domeLuminance(direction);
  out_color = vec4(storable(mix(lit, far * alpha, haze)), kBackground ? alpha * (1.0 - haze) : alpha);
  vec4 clip = clipFromEye(direction * distance);
  gl_FragDepth = clip.z / clip.w;
}

vec3 shadowAt(vec3 place) {
  if (!kShadow) return vec3(1.0);
  return sunVisibility(frame.eye.xyz + place, vec3(0.0, 1.0, 0.0), vec4(frame.leaf_tint.rgb, 0.0), true);
}

vec3 skyOn(vec3 place, vec3 normal) {
  if (kAmbientSource == kConstant) return frame.open_sky.rgb;
  if (kAmbientSource == kTransfer && frame.ground_map.z > 0.0) return mappedLight(frame.eye.xyz + place);
  return shIrradiance(normal, frame.open_light);
}

/// What a ray through grass needs to know.
struct GrassRay {
  vec3 start;      // from the eye
  vec3 direction;
  float t_start;   // of `start`, from the eye; all other t are from there
  vec2 d;          // the direction along u and v
  vec2 past_tile;  // u, v of the start
  vec2 past_plane;
  vec2 bend;       // of tips, along u and v, m
  float sinks;     // how much longer bent blades are than they are high
  ShellPath path;
  float tall;      // of the shell's height that this grass has
  float density;
  float blades;    // share that is drawn as blades
  vec3 tint;
  Light light;
};

vec3 axisOf(bool v) {
  return v ? vec3(grass.rows.z, 0.0, grass.rows.w) : vec3(grass.rows.x, 0.0, grass.rows.y);
}

/// A slice's texel at t; `power` of such slices behind each other.
void meetSlice(inout Met met, GrassRay ray, bool across_u, uint number, float t, float w, float lod,
               float power, float layer) {
  vec2 here = ray.past_tile + ray.d * t;
  float at_rest = w / ray.tall * ray.sinks;
  here -= ray.bend * bendShape(at_rest, grass.shell.x);
  float along = (across_u ? here.y : here.x) / grass.shell.w, tile = floor(along);
  uint first_tile = across_u ? grass.eye_cell.w : grass.eye_cell.z, salt = across_u ? 0u : 1u;
  float x = wangPlace(number, first_tile + uint(int(tile)), along - tile, kBorderOfU + salt);
  if (layer < 0.0) layer = float(sliceKind(number, uint(grass.limits.w), kSliceKindOfU + salt));
  vec3 uv = vec3(x, 1.0 - at_rest / grass.shell.x, layer);
  vec4 color = textureLod(slice_colors, uv, lod);
  if (color.a <= 0.0) return;
  vec4 data = unpackGrassData(textureLod(slice_data, uv, lod));
  if (layer < grass.limits.w) thin(color, data, ray.density, ray.blades, lod);
  if (power != 1.0 && color.a > 0.0) {
    float several = (1.0 - pow(1.0 - min(color.a, 0.99), power)) / color.a;
    color *= several;
    data *= several;
  }
  vec3 right = axisOf(across_u), up = vec3(0.0, 1.0, 0.0), toward = cross(right, up);
  bool behind = dot(toward, ray.direction) > 0.0;
  meet(met, color, data, right, up, behind ? -toward : toward, behind, w, ray.t_start + t, ray.tint,
       ray.density, ray.light);
}

/// Texels of the ground, or of the level slice, at t.
void meetLevel(inout Met met, GrassRay ray, float t, float layer, float share, vec2 off, vec3 n, float w) {
  float lod = log2(max(grass.texels.z * grass.texels.w * (ray.t_start + t) *
                           inversesqrt(max(abs(ray.direction.y), 0.05)), 1.0));
  vec3 uv = vec3(groundPlace(ray.past_tile + ray.d * t - off), layer);
  vec4 color = share * textureLod(ground_colors, uv, lod);
  vec4 data = share * unpackGrassData(textureLod(ground_data, uv, lod));
  if (layer > 0.0)
    thin(color, data, ray.density, ray.blades, lod);
  else
    color.rgb = mix(grass.soil.rgb * color.a, color.rgb, smoothstep(0.0, 0.4, ray.density));
  vec3 right = normalize(axisOf(false) - n * dot(axisOf(false), n));
  meet(met, color, data, right, cross(n, right), n, false, w, ray.t_start + t, ray.tint, ray.density,
       ray.light);
}

/// Slice by slice. Returns whether the ray came to `end_t` before it was opaque or had met as many
/// as it may.
bool traceSlices(inout Met met, GrassRay ray, float end_t) {
  bvec2 parallel = lessThan(abs(ray.d), vec2(1e-7));
  vec2 spacing = grass.shell.yz, per_d = mix(1.0 / ray.d, vec2(0.0), parallel);
  bvec2 forward = greaterThan(ray.d, vec2(0.0));
  float scatter = grass.placing.x;
  ivec2 plane = ivec2(floor(ray.past_plane / spacing));
  vec2 next_t = vec2(kFarAway);
  // The first planes in front: the one of this cell may lie behind.
  for (int axis = 0; axis < 2; ++axis) {
    if (parallel[axis]) continue;
    bool ahead = slicePlace(plane[axis], grass.eye_cell[axis], scatter, uint(axis)) * spacing[axis] >
                 ray.past_plane[axis];
    if (ahead != forward[axis]) plane[axis] += forward[axis] ? 1 : -1;
    next_t[axis] = (slicePlace(plane[axis], grass.eye_cell[axis], scatter, uint(axis)) * spacing[axis] -
                    ray.past_plane[axis]) * per_d[axis];
  }
  float height = grass.shell.x;
  float middle_t = grass.limits.z > 0.0 ? shellCrossing(ray.path, 0.5 * height * ray.tall, false) : kFarAway;
  float texel_lod = log2(max(grass.texels.x, grass.texels.y) * grass.texels.w);
  int most = int(grass.limits.x);
  bool across_u = false;
  float t = 0.0;
  for (int i = 0; i < most;) {
    across_u = next_t.x < next_t.y;
    t = min(next_t.x, next_t.y);
    if (middle_t < min(t, end_t)) {
      // Hides, from above, that there are slices.
      meetLevel(met, ray, middle_t, 1.0, smoothstep(0.3, 0.9, -ray.direction.y),
                ray.bend * bendShape(0.5 * height, height), vec3(0.0, 1.0, 0.0), 0.5 * height * ray.tall);
      middle_t = kFarAway;
      if (met.alpha > kOpaque) return false;
      continue;
    }
    if (t >= end_t) return true;
    int axis = across_u ? 0 : 1;
    float lod = max(texel_lod + log2(ray.t_start + t) - 0.5 * log2(max(abs(ray.d[axis]), 0.1)), 0.0);
    meetSlice(met, ray, across_u, grass.eye_cell[axis] + uint(plane[axis]), t,
              shellHeight(ray.path, t), lod, 1.0, -1.0);
    if (met.alpha > kOpaque) return false;
    plane[axis] += forward[axis] ? 1 : -1;
    next_t[axis] = (slicePlace(plane[axis], grass.eye_cell[axis], scatter, uint(axis)) * spacing[axis] -
                    ray.past_plane[axis]) * per_d[axis];
    ++i;
  }
  if (kBase) {
    // What is still open.
    int axis = across_u ? 0 : 1;
    float lod = max(texel_lod + log2(ray.t_start + t), 0.0);
    meetSlice(met, ray, across_u, grass.eye_cell[axis] + uint(plane[axis]), t,
              max(shellHeight(ray.path, t), 0.0), lod, 1.0, grass.limits.w);
    met.alpha = 1.0;
  }
  return false;
}

/// Where the optical depth of the shell has grown to a share of all.
float heightOfDepth(float share) {
  float at = share * float(kCanopySteps);
  int below = min(int(at), kCanopySteps - 1);
  return mix(grass.canopy[below].z, grass.canopy[below + 1].z, at - float(below)) * grass.shell.x;
}

/// Steps through grass, finer at its top where little is seen at once, whose slices are nearer to each other than pixels:
/// what they look like on the mean, wherever they stand.
const int kFarSteps = 5;
bool traceMedium(inout Met met, GrassRay ray, float end_t) {
  vec2 rates = abs(ray.d) / grass.shell.yz;
  float rate = rates.x + rates.y, fall = max(-ray.path.slope, 1e-4) / max(rate, 1e-6);
  // Optical depth over optical depth of the whole shell; at 4 nothing is seen behind.
  float whole = grass.canopy[0].x * max(ray.density, 1e-3);
  float last = min(4.0 * fall / whole, 1.0);
  float top = ray.path.w;
  float fine = log2(max(max(grass.texels.x, grass.texels.y) * grass.texels.w * ray.t_start, 1.0));
  // Neighbouring slices that fall into a pixel are taken as one.
  float together = exp2(ceil(log2(max(ray.t_start * grass.texels.w / fall, 1.0))));
  for (int i = 0; i < kFarSteps; ++i) {
    float at = (float(i) + 0.5) / float(kFarSteps), next = (float(i) + 1.0) / float(kFarSteps);
    float w = heightOfDepth(at * at * last) * ray.tall;
    float t = max((ray.path.w - w) / max(-ray.path.slope, 1e-4), 0.0);
    if (t >= end_t) return true;
    float bottom = heightOfDepth(next * next * last) * ray.tall;
    float slices = max(top - bottom, 0.0) / fall;
    top = bottom;
    // Both directions, by how many slices there are of each.
    for (int axis = 0; axis < 2; ++axis) {
      float share = rates[axis] / rate;
      if (share < 0.01) continue;
      float plane = floor((ray.past_plane[axis] + ray.d[axis] * t) / (grass.shell[1 + axis] * together)) * together;
      meetSlice(met, ray, axis == 0, grass.eye_cell[axis] + uint(int(plane)), t, w, fine,
                slices * share, -1.0);
    }
    if (met.alpha > kOpaque) return false;
  }
  if (last >= 1.0) return true;
  if (kBase && met.alpha > 0.0) {
    float fill = 1.0 / met.alpha;
    met.sunlit *= fill;
    met.color *= fill;
    met.alpha = 1.0;
  }
  return false;
}

void main() {
  float t_start = length(from_eye);
  vec3 direction = from_eye / t_start;
  vec3 painted = vec3(0.0);
  if (!kGrass) painted = paintedGround(frame.eye.xz + from_eye.xz);
  if (!kGrass) {
    vec3 n = terrainNormal(from_eye.xz);
    vec3 color = kTextures ? painted : vec3(0.18);
    vec3 lit = illumination(kAmbient ? skyOn(from_eye, n) * color : vec3(0.0), frame.sun_light.rgb,
                            shadowAt(from_eye),
                            kDiffuse ? color * diffuseFactor(n, frame.to_sun.xyz) : vec3(0.0), 0.0, 0.0);
    write(lit, 1.0, direction, t_start);
    return;
  }

  float height = grass.shell.x;
  vec3 start = from_eye;
  if (!gl_FrontFacing) {
    // The shell's upper side from below: the ray began at the eye, if that is in the shell.
    if (grass.terrain_size.z == 0.0) discard;
    start = vec3(0.0);
    t_start = 0.0;
  }
  float w_start = frame.eye.y + start.y - groundHeight(start.xz);
  // What is drawn lies a little above the shell where the ground is curved.
  vec2 cell = grass.terrain.zw;
  for (int i = 0; i < 4 && w_start > 1.001 * height; ++i) {
    float ahead = 0.25 * min(cell.x, cell.y);
    vec3 next = start + direction * ahead;
    float fall = (w_start - (frame.eye.y + next.y - groundHeight(next.xz))) / ahead;
    if (fall < 1e-3) discard;
    float way = (w_start - height) / fall;
    start += direction * way;
    t_start += way;
    w_start = frame.eye.y + start.y - groundHeight(start.xz);
  }

  GrassRay ray;
  ray.start = start;
  ray.direction = direction;
  ray.t_start = t_start;
  vec3 place = frame.eye.xyz + start;
  ray.density = clamp(coverAt(start.xz), 0.0, 1.0);
  ray.blades = grass.blades.y > 0.0 ? 1.0 - smoothstep(grass.blades.x, grass.blades.y, t_start) : 0.0;
  ray.tall = grassHeight(ray.density);
  GroundLookup tones = groundLookup(place.xz, frame.ground.w);
  float far_lod = log2(max(t_start * grass.texels.w * 50.0, 1.0));
  ray.tint = groundTone(textureLod(ground_noise, tones.fine, far_lod - 2.0).r,
                        textureLod(ground_noise, tones.middle, max(far_lod - 5.0, 0.0)).r,
                        textureLod(ground_noise, tones.broad, 0.0).r, 0.35);
  ray.tint = mix(vec3(1.0), ray.tint, grass.cover_size.w);
  vec2 bend = grassBend(grass.moment, place, windNoise(place));
  ray.sinks = heightAtRest(1.0, bend);
  ray.bend = vec2(dot(grass.rows.xy, bend), dot(grass.rows.zw, bend)) * height;
  ray.d = vec2(dot(grass.rows.xy, direction.xz), dot(grass.rows.zw, direction.xz));
  vec2 at = vec2(dot(grass.rows.xy, start.xz), dot(grass.rows.zw, start.xz));
  ray.past_plane = grass.eye.xy + at;
  ray.past_tile = grass.eye.zw + at;

  float rate = abs(ray.d.x) / grass.shell.y + abs(ray.d.y) / grass.shell.z;
  float reach = min(grass.limits.x / max(rate, 1e-3), 8.0 * height / max(-direction.y, 0.02));
  vec3 half_way = start + direction * (0.5 * reach), end = start + direction * reach;
  ray.path = shellPath(w_start, frame.eye.y + half_way.y - groundHeight(half_way.xz),
                       frame.eye.y + end.y - groundHeight(end.xz), reach);
  float ground_t = shellCrossing(ray.path, 0.0, false), exit_t = shellCrossing(ray.path, height, true);
  float scene_t = kFarAway;
  if (grass.terrain_size.w > 0.0) {
    // Only where the whole pixel sees one surface: at its edges the depth test decides.
    vec2 depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).xy;
    if (depth.y > 0.0 && depth.x < 1.02 * depth.y)
      scene_t = frame.clip_from_world[3].z / (0.5 * (depth.x + depth.y) * clipFromEye(direction).w) - t_start;
  }
  if (scene_t <= 0.0) discard;
  float end_t = min(min(ground_t, exit_t), scene_t);

  if (kAmbientSource == kConstant) {
    ray.light.up = ray.light.sideways = frame.open_sky.rgb;
  } else {
    vec3 aside = normalize(vec3(-direction.z, 1e-4, direction.x));
    ray.light.up = skyOn(start, vec3(0.0, 1.0, 0.0));
    ray.light.sideways = 0.5 * (shIrradiance(aside, frame.open_light) + shIrradiance(-aside, frame.open_light));
    if (kAmbientSource == kTransfer && frame.ground_map.z > 0.0)
      ray.light.sideways *= ray.light.up / max(frame.open_sky.rgb, vec3(1e-20));
  }

  Met met = Met(vec3(0.0), vec3(0.0), 0.0, -1.0, -1.0);
  bool ended = true;
  // Slices in a pixel, one behind the other: many look like a medium.
  float fall = max(-ray.path.slope, 1e-4);
  float medium = kMedium ? smoothstep(0.35, 1.0, t_start * grass.texels.w * rate / fall) : 0.0;
  if (ray.density > 0.0 && medium < 1.0) ended = traceSlices(met, ray, end_t);
  if (kBase && ended && end_t == ground_t && met.alpha <= kOpaque) {
    vec3 foot = start + direction * ground_t;
    meetLevel(met, ray, ground_t, 0.0, 1.0, vec2(0.0), terrainNormal(foot.xz), 0.0);
  }
  if (ray.density > 0.0 && medium > 0.0) {
    Met mean = Met(vec3(0.0), vec3(0.0), 0.0, -1.0, -1.0);
    ended = traceMedium(mean, ray, end_t);
    if (kBase && ended && end_t == ground_t && mean.alpha <= kOpaque) {
      vec3 foot = start + direction * ground_t;
      meetLevel(mean, ray, ground_t, 0.0, 1.0, vec2(0.0), terrainNormal(foot.xz), 0.0);
    }
    if (medium == 1.0) met = mean;
    met.sunlit = mix(met.sunlit, mean.sunlit, medium);
    met.color = mix(met.color, mean.color, medium);
    met.alpha = mix(met.alpha, mean.alpha, medium);
    if (met.depth_t < 0.0) met.depth_t = mean.depth_t;
  }
  if (met.alpha <= 0.002) discard;
  float seen_t = met.depth_t >= 0.0 ? met.depth_t : met.first_t >= 0.0 ? met.first_t : t_start;
  vec3 lit = met.color + met.sunlit * frame.sun_light.rgb * shadowAt(direction * seen_t);
  write(lit, min(met.alpha, 1.0), direction, seen_t);
}
