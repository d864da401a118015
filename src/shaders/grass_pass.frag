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
#include "grass_place.glsl"
#include "grass_light.glsl"

// The ground of a terrain, and grass on it: 2.3 of Habel 2009. A ray enters the shell of grass, meets
// slices across u and across v from front to back, and composites them until nothing is seen through
// them, until it comes to the ground, out of the shell, to what stands in the grass, or to the most
// slices that it may; what is still open then is filled by the opaque slice.
layout(constant_id = 21) const bool kGrass = true;
layout(constant_id = 22) const bool kBase = true;  // the layer that covers the ground
layout(constant_id = 25) const bool kFromEye = false;  // rays that never leave the shell they begin in
layout(constant_id = 24) const bool kMedium = true;  // slices finer than pixels are a medium

layout(location = 0) centroid in vec3 from_eye;
layout(location = 0) out vec4 out_color;

/// Behind this share of what covers, nothing is looked for.
const float kOpaque = 0.995;

void write(vec3 lit, float alpha, vec3 direction, float distance) {
  // Alpha 0 is the background, where there is one instead of the sky.
  float haze = hazeShare(distance, frame.ground.z);
  vec3 far = kBackground ? vec3(0.0) : domeLuminance(direction);
  out_color = vec4(storable(mix(lit, far * alpha, haze)), kBackground ? alpha * (1.0 - haze) : alpha);
  vec4 clip = clipFromEye(direction * distance);
  gl_FragDepth = clip.z / clip.w;
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
  float reach;     // that it holds for
  float tall;      // of the shell's height that this grass has
  float density;
  vec3 tint;
  Light light;
};

/// Where a slice's picture is read at t and w.
vec3 slicePlaceAt(GrassRay ray, bool across_u, uint number, float t, float w) {
  float at_rest = w / ray.tall * ray.sinks;
  vec2 here = ray.past_tile + ray.d * t - ray.bend * bendShape(at_rest, grass.shell.x);
  return slicePicture(across_u, number, across_u ? here.y : here.x, at_rest);
}

/// Share of the plants that are drawn as blades where the ray is at t, w above the ground.
float bladesAt(GrassRay ray, float t, float w) {
  if (grass.blades.y <= 0.0) return 0.0;
  vec3 root = ray.start + ray.direction * t - vec3(0.0, w, 0.0);
  return 1.0 - smoothstep(grass.blades.x, grass.blades.y, length(root));
}

/// A slice's texel at t; of the opaque slice if it is the last.
void meetSlice(inout Met met, GrassRay ray, bool across_u, uint number, float t, float w, float lod,
               bool last) {
  float blades = last ? 0.0 : bladesAt(ray, t, w);
  if (blades >= 1.0) return;
  vec3 uv = slicePlaceAt(ray, across_u, number, t, w);
  if (last) uv.z = grass.limits.w;
  vec4 color = textureLod(slice_colors, uv, lod);
  if (color.a <= 0.0) return;
  vec4 data = unpackGrassData(textureLod(slice_data, uv, lod));
  if (!last) thin(color, data, ray.density, blades, lod);
  vec3 right = axisOf(across_u), up = vec3(0.0, 1.0, 0.0), toward = cross(right, up);
  bool behind = dot(toward, ray.direction) > 0.0;
  meet(met, color, data, right, up, behind ? -toward : toward, behind, w, ray.t_start + t, ray.tint,
       ray.density, ray.light);
}

/// Texels of the ground, or of the level slice, at t.
void meetLevel(inout Met met, GrassRay ray, float t, float layer, float share, vec2 off, vec3 n, float w) {
  meetLevel(met, ray.past_tile + ray.d * t - off, ray.t_start + t, ray.direction, layer, share, n, w,
            ray.density, bladesAt(ray, t, w), ray.tint, ray.light);
}

/// Where the optical depth of the shell has grown to a share of all, by the root of that.
float heightOfDepth(float root) {
  float at = root * float(kCanopySteps);
  int below = min(int(at), kCanopySteps - 1);
  return mix(grass.canopy[below].z, grass.canopy[below + 1].z, at - float(below)) * grass.shell.x;
}

/// So many slices as one.
void meetSlices(inout Met met, GrassRay ray, bool across_u, uint number, float t, float w, float slices) {
  vec3 uv = slicePlaceAt(ray, across_u, number, t, w);
  float texels = float(kFarColumns) / (4.0 * grass.shell.w);
  float level = log2(max(texels * grass.texels.w * (ray.t_start + t), 1.0));
  level = floor(min(level, float(kFarLevels - 1)) + 0.5);
  vec4 one = textureLod(far_colors, vec3(uv.xy, uv.z * float(kFarLevels) + level), 0.0);
  float widest = (grass.limits.w + 1.0) * float(kFarLevels) - 1.0;
  vec4 mean = textureLod(far_colors, vec3(uv.xy, widest), 0.0);
  // Many slices vary less than one: each is at another place.
  float share = inversesqrt(max(slices, 1.0));
  float a = mix(mean.a * mean.a, one.a * one.a, share);
  if (a <= 0.0) return;
  float alpha = 1.0 - pow(1.0 - min(a * ray.density * (1.0 - bladesAt(ray, t, w)), 0.99), slices);
  vec4 color = vec4(mix(mean.rgb, one.rgb, share * one.a * one.a / a) * alpha, alpha);
  vec3 right = axisOf(across_u), up = vec3(0.0, 1.0, 0.0), toward = cross(right, up);
  bool behind = dot(toward, ray.direction) > 0.0;
  meet(met, color, vec4(0.0, 0.0, grass.mean.w, 0.5) * color.a, right, up, behind ? -toward : toward,
       behind, w, ray.t_start + t, ray.tint, ray.density, ray.light);
}

/// Steps through grass, finer at its top where little is seen at once, whose slices are nearer to
/// each other than pixels: what they look like on the mean, wherever they stand.
const int kFarSteps = 5;
void traceMedium(inout Met met, GrassRay ray, float from_t, inout float end_t) {
  vec2 rates = abs(ray.d) / grass.shell.yz;
  // Down to the lowest place on the way, with one slope; over a ridge it rises again.
  float limit_t = min(end_t, max(ray.reach, from_t + 1e-3));
  float turn_t = ray.path.curve > 1e-7 ? -0.5 * ray.path.slope / ray.path.curve : kFarAway;
  float low_t = max(min(limit_t, turn_t), from_t + 1e-3);
  float w_from = shellHeight(ray.path, from_t), top = w_from;
  float w_low = clamp(shellHeight(ray.path, low_t), 0.0, w_from);
  float slope = max((w_from - w_low) / (low_t - from_t), 1e-5);
  float rate = max(rates.x + rates.y, 1e-6), fall = slope / rate;
  float times = turn_t < limit_t ? 2.0 : 1.0;
  // Optical depth over that of the whole shell; at 4 nothing is seen behind.
  float whole = max(grass.canopy[0].x * ray.density, 1e-6);
  float before = min(canopyAt(w_from / ray.tall).x / grass.canopy[0].x, 1.0);
  float deepest = canopyAt(w_low / ray.tall).x / grass.canopy[0].x;
  float enough = before + 4.0 * fall / whole;
  float last = max(min(enough, deepest), before);
  float root = sqrt(before), more = sqrt(last) - root;
  // Neighbouring slices that fall into a pixel are taken as one.
  float together = exp2(ceil(log2(max(ray.t_start * grass.texels.w / fall, 1.0))));
  // Across u and across v in turns, by how many slices there are of each.
  float t = from_t;
  for (int i = 0; i < 2 * kFarSteps && t < end_t && met.alpha <= kOpaque; ++i) {
    float begin = root + float(i / 2) / float(kFarSteps) * more;
    float end = begin + more / float(kFarSteps);
    float bottom = min(heightOfDepth(end) * ray.tall, top);
    float w = clamp(heightOfDepth(sqrt(0.5 * (begin * begin + end * end))) * ray.tall, bottom, top);
    t = from_t + (w_from - w) / slope;
    bool across_u = (i & 1) == 0;
    float count = times * max(top - bottom, 0.0) / fall * (across_u ? rates.x : rates.y) / rate;
    vec2 plane = floor((ray.past_plane + ray.d * t) / (grass.shell.yz * together)) * together;
    uint number = across_u ? grass.eye_cell.x + uint(int(plane.x)) : grass.eye_cell.y + uint(int(plane.y));
    if (count > 0.01 && t < end_t) meetSlices(met, ray, across_u, number, t, w, count);
    if (!across_u) top = bottom;
  }
  if (enough < deepest) {
    if (kBase && met.alpha > 0.0) {
      float fill = 1.0 / met.alpha;
      met.sunlit *= fill;
      met.color *= fill;
      met.sum_t *= fill;
      met.alpha = 1.0;
    }
    end_t = kFarAway;  // it did not come there
  }
}

/// The next of the slices across one axis: its number from the eye's, and where the ray meets it.
struct SliceWalk {
  int plane;
  float t;
};
SliceWalk walkAt(int plane, float past, float d, uint eye_plane, float spacing, uint salt) {
  return SliceWalk(plane, (slicePlace(plane, eye_plane, grass.placing.x, salt) * spacing - past) / d);
}
SliceWalk firstSlice(float past, float d, uint eye_plane, float spacing, uint salt) {
  if (abs(d) < 1e-7) return SliceWalk(0, kFarAway);
  // That of the cell may lie in front or behind.
  int plane = int(floor(past / spacing));
  bool ahead = slicePlace(plane, eye_plane, grass.placing.x, salt) * spacing > past;
  if (ahead != (d > 0.0)) plane += d > 0.0 ? 1 : -1;
  return walkAt(plane, past, d, eye_plane, spacing, salt);
}
SliceWalk nextSlice(SliceWalk walk, float past, float d, uint eye_plane, float spacing, uint salt) {
  return walkAt(walk.plane + (d > 0.0 ? 1 : -1), past, d, eye_plane, spacing, salt);
}

/// Slice by slice, until nothing is seen through them, to `end_t`, or to as many as the ray may
/// meet; returns where it ended.
float traceSlices(inout Met met, GrassRay ray, float end_t) {
  SliceWalk u = firstSlice(ray.past_plane.x, ray.d.x, grass.eye_cell.x, grass.shell.y, 0u);
  SliceWalk v = firstSlice(ray.past_plane.y, ray.d.y, grass.eye_cell.y, grass.shell.z, 1u);
  float height = grass.shell.x;
  float middle_t = grass.limits.z > 0.0 ? shellCrossing(ray.path, 0.5 * height * ray.tall, false) : kFarAway;
  int most = int(grass.limits.x);
  bool across_u = false;
  float t = 0.0;
  for (int i = 0; i < most && met.alpha <= kOpaque; ++i) {
    across_u = u.t < v.t;
    float next_t = min(u.t, v.t);
    if (middle_t < min(next_t, end_t)) {
      // Hides, from above, that there are slices.
      meetLevel(met, ray, middle_t, 1.0, smoothstep(0.3, 0.9, -ray.direction.y),
                ray.bend * bendShape(0.5 * height, height), vec3(0.0, 1.0, 0.0),
                0.5 * height * ray.tall);
      middle_t = kFarAway;
    }
    if (next_t >= end_t) return end_t;
    t = next_t;
    float across = abs(across_u ? ray.d.x : ray.d.y);
    float lod = sliceLod(ray.t_start + t, across);
    uint number = across_u ? grass.eye_cell.x + uint(u.plane) : grass.eye_cell.y + uint(v.plane);
    bool last = !kMedium && kBase && i == most - 1;
    float w = shellHeight(ray.path, t);
    if (w < grass.placing.y * ray.tall) meetSlice(met, ray, across_u, number, t, w, lod, last);
    if (last) met.alpha = 1.0;
    if (across_u)
      u = nextSlice(u, ray.past_plane.x, ray.d.x, grass.eye_cell.x, grass.shell.y, 0u);
    else
      v = nextSlice(v, ray.past_plane.y, ray.d.y, grass.eye_cell.y, grass.shell.z, 1u);
  }
  return t;
}

/// Over the ground, of a place from the eye.
float heightAbove(vec3 place) {
  return frame.eye.y + place.y - groundHeight(place.xz);
}

/// Where a ray that has entered the shell comes to the ground or out of the shell again; or, neither
/// of both, as far as it was looked for.
struct ShellEnd {
  float t;
  bool ground;
  bool above;
};
ShellEnd endOfShell(vec3 start, vec3 direction, float w_start, float t_start) {
  if (grass.terrain_range.w > 0.0) {
    if (direction.y < 0.0) return ShellEnd(max(w_start / -direction.y, 1e-4), true, false);
    return ShellEnd((grass.placing.y - w_start) / max(direction.y, 1e-5) + 1e-4, false, true);
  }
  float cell = max(min(grass.terrain.z, grass.terrain.w), 0.02 * t_start);
  // What is drawn may lie above the shell: a ray that leaves the one and not the other comes back.
  float top = 1.5 * max(grass.placing.y, w_start);
  float step = min(0.25 * top / max(-direction.y, 0.02), cell);
  float t = 0.0, w = w_start;
  ShellEnd end = ShellEnd(0.0, false, false);
  for (int i = 0; i < 16 && !end.ground && !end.above; ++i) {
    float next_w = heightAbove(start + direction * (t + step));
    if (next_w <= 0.0) {
      // Between two heights the ground is nearly even.
      float way = step * w / (w - next_w);
      float middle_w = heightAbove(start + direction * (t + way));
      way += middle_w > 0.0 ? (step - way) * middle_w / (middle_w - next_w)
                            : way * middle_w / (w - middle_w);
      end = ShellEnd(t + way, true, false);
    } else if (next_w >= top && next_w > w) {
      end = ShellEnd(t + step * (top - w) / (next_w - w), false, true);
    } else {
      t += step;
      w = next_w;
      step *= 1.25;
      end.t = t;
    }
  }
  if (!end.ground && !end.above) end.ground = w < w_start;  // so far away that it does not matter
  end.t = max(end.t, 1e-4);
  return end;
}

void main() {
  float t_start = length(from_eye);
  vec3 direction = from_eye / t_start;
  // At the horizon what is interpolated may lie behind the eye.
  vec3 middle = pixelDirection();
  if (dot(direction, middle) < 1.0 - 4.0 * grass.texels.w * grass.texels.w) direction = middle;
  if (!kGrass) {
    vec3 n = terrainNormal(from_eye.xz);
    vec3 color = kTextures ? paintedGround(frame.eye.xz + from_eye.xz) : vec3(0.18);
    vec3 lit = illumination(kAmbient ? skyOn(from_eye, n) * color : vec3(0.0), frame.sun_light.rgb,
                            shadowAt(from_eye),
                            kDiffuse ? color * diffuseFactor(n, frame.to_sun.xyz) : vec3(0.0), 0.0, 0.0);
    write(lit, 1.0, direction, t_start);
    return;
  }

  float height = grass.shell.x, top = grass.placing.y;
  vec3 start = from_eye;
  if (kFromEye || !gl_FrontFacing) {
    // The shell's upper side from below: the ray began at the eye, if that is in the shell.
    if (grass.terrain_size.z == 0.0 || kFromEye != gl_FrontFacing) discard;
    start = vec3(0.0);
    t_start = 0.0;
  }
  float w_start = heightAbove(start);
  // What is drawn lies a little above the shell where the ground is curved.
  float ahead = 0.25 * min(grass.terrain.z, grass.terrain.w);
  for (int i = 0; i < 6 && w_start > 1.001 * top; ++i) {
    vec3 next = start + direction * ahead;
    float fall = (w_start - heightAbove(next)) / ahead;
    float way = min((w_start - top) / max(fall, 1e-6), max(4.0 * ahead, 0.02 * t_start));
    start += direction * way;
    t_start += way;
    w_start = heightAbove(start);
  }

  GrassRay ray;
  ray.start = start;
  ray.direction = direction;
  ray.t_start = t_start;
  vec3 place = frame.eye.xyz + start;
  ray.density = clamp(coverAt(start.xz), 0.0, 1.0);
  ray.tall = grassHeight(ray.density);
  ray.tint = grassTint(place.xz, t_start);
  vec2 bend = grassBend(grass.moment, place, windNoise(place));
  ray.sinks = heightAtRest(1.0, bend);
  ray.bend = vec2(dot(grass.rows.xy, bend), dot(grass.rows.zw, bend)) * height;
  ray.d = vec2(dot(grass.rows.xy, direction.xz), dot(grass.rows.zw, direction.xz));
  vec2 at = vec2(dot(grass.rows.xy, start.xz), dot(grass.rows.zw, start.xz));
  ray.past_plane = grass.eye.xy + at;
  ray.past_tile = grass.eye.zw + at;

  float rate = abs(ray.d.x) / grass.shell.y + abs(ray.d.y) / grass.shell.z;
  ShellEnd shell_end = endOfShell(start, direction, w_start, t_start);
  if (kFromEye && !shell_end.ground) discard;
  float reach = shell_end.t;
  ray.reach = reach;
  ray.path = shellPath(w_start, heightAbove(start + direction * (0.5 * reach)),
                       heightAbove(start + direction * reach), reach);
  float ground_t = shell_end.ground ? reach : kFarAway, exit_t = shell_end.above ? reach : kFarAway;
  float scene_t = kFarAway;
  if (grass.terrain_size.w > 0.0) {
    // Only where the whole pixel sees one surface: at its edges the depth test decides.
    vec2 depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).xy;
    if (depth.y > 0.0 && depth.x < 1.02 * depth.y)
      scene_t = frame.clip_from_world[3].z / (0.5 * (depth.x + depth.y) * clipFromEye(direction).w) - t_start;
  }
  if (scene_t <= 0.0) discard;
  float end_t = min(min(ground_t, exit_t), scene_t);

  ray.light = lightAt(start, sidewaysLight(direction), direction);

  Met met = kNothingMet;
  // Slices in a pixel, one behind the other: many look like a medium, and so does what is behind as
  // many as may be met.
  float fall = max(-ray.path.slope, 1e-4);
  float medium = kMedium ? smoothstep(0.5, 1.5, t_start * grass.texels.w * rate / fall) : 0.0;
  float came_t = end_t;
  if (ray.density > 0.0 && medium < 1.0) came_t = traceSlices(met, ray, end_t);
  bool open = came_t < end_t && met.alpha <= kOpaque;
  bool at_ground = came_t == ground_t;
  Met mean = met;
  float mean_end_t = end_t;
  if (kMedium && ray.density > 0.0 && (open || medium > 0.0)) {
    if (medium > 0.0) {
      mean = kNothingMet;
      came_t = 0.0;
    }
    traceMedium(mean, ray, came_t, mean_end_t);
    if (medium == 0.0) {
      met = mean;
      at_ground = mean_end_t == ground_t;
    } else if (open) {
      addBehind(met, mean);
    }
  }
  if (kBase && end_t == ground_t && ground_t < kFarAway) {
    vec3 foot = start + direction * ground_t;
    Met ground = kNothingMet;
    meetLevel(ground, ray, ground_t, 0.0, 1.0, vec2(0.0), terrainNormal(foot.xz), 0.0);
    if (at_ground) addBehind(met, ground);
    if (mean_end_t == ground_t) addBehind(mean, ground);
  }
  if (medium > 0.0) {
    met.sunlit = mix(met.sunlit, mean.sunlit, medium);
    met.color = mix(met.color, mean.color, medium);
    met.sum_t = mix(met.sum_t, mean.sum_t, medium);
    met.alpha = mix(met.alpha, mean.alpha, medium);
    if (met.depth_t < 0.0) met.depth_t = mean.depth_t;
    if (met.first_t < 0.0) met.first_t = mean.first_t;
  }
  if (met.alpha <= 0.002) discard;
  float seen_t = met.depth_t >= 0.0 ? met.depth_t : met.first_t >= 0.0 ? met.first_t : t_start;
  vec3 lit = met.color + met.sunlit * frame.sun_light.rgb * shadowAt(direction * (met.sum_t / met.alpha));
  write(lit, min(met.alpha, 1.0), direction, seen_t);
}
