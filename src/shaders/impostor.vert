#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "impostor_set.glsl"
layout(set = 1, binding = 3, std430) readonly buffer Places { ForestPlace places[]; };
layout(set = 1, binding = 4, std430) readonly buffer Fars { uint fars[]; };
layout(set = 1, binding = 5, std430) readonly buffer Ranges { uvec2 ranges[]; };
layout(set = 1, binding = 7, std430) readonly buffer Beams { MotionBeam beams[]; };
layout(set = 1, binding = 8, std430) readonly buffer Drives { MotionDrive drives[]; };
layout(set = 1, binding = 9, std430) readonly buffer Texels { uint texels[]; };

layout(location = 0) out vec3 out_local;  // on the card, plant's coordinates
layout(location = 1) out vec3 out_position;
layout(location = 2) flat out vec3 out_eye;  // plant's coordinates
layout(location = 3) flat out vec3 out_weights;
layout(location = 4) flat out uvec3 out_views;
layout(location = 5) flat out vec2 out_turn;  // cosine and sine of its angle
layout(location = 6) flat out uvec2 out_seat;
layout(location = 7) flat out float out_scale;
layout(location = 8) out vec3 out_now;  // clip x, y, w; both of velocities alone
layout(location = 9) out vec3 out_last;

vec2 trunkNoise(MotionDrive drive, uvec2 phase, uint whole, float fraction) {
  uvec2 size = uvec2(drive.size & 0xffffu, drive.size >> 16);
  MotionTexels at = motionTexels(branchUv(drive, phase, whole, fraction), size);
  uint low = drive.texels + at.low.y * size.x, high = drive.texels + at.high.y * size.x;
  vec2 a = unpackHalf2x16(texels[low + at.low.x]), b = unpackHalf2x16(texels[low + at.high.x]);
  vec2 c = unpackHalf2x16(texels[high + at.low.x]), d = unpackHalf2x16(texels[high + at.high.x]);
  return vec2(motionValue(vec4(a.x, b.x, c.x, d.x), at.share),
              motionValue(vec4(a.y, b.y, c.y, d.y), at.share));
}

/// As its trunk moves; what grows on it is too small to be seen moving.
vec3 bentWithTrunk(ImpostorKind kind, ForestPlace place, MotionMoment moment, uint whole, vec3 p) {
  MotionBeam beam = beams[kind.beam];
  MotionDrive drive = drives[kind.beam];
  vec3 toward = turnedBy(-place.angle, moment.toward.xyz);
  float speed = gustySpeed(moment, vec3(place.x, place.y, place.z));
  vec2 noise = trunkNoise(drive, motionPhase(place.phase), whole, moment.drift.w);
  float along = clamp(dot(p - beam.root, beam.t) / beam.span, 0.0, 1.0);
  MovedVertex at = MovedVertex(p, vec3(0.0, 1.0, 0.0));
  return bentByBeam(beam, along, branchAmplitudes(beam, drive, toward, speed, noise), at).position;
}

void main() {
  ImpostorKind kind = kinds[job.kind];
  uint index = fars[job.first_far + ranges[job.range].x + uint(gl_InstanceIndex)];
  ForestPlace place = places[index];
  bool sun = job.cascade != kForestNone;
  vec3 middle = forestMiddle(place, kind.sphere);
  vec3 to_eye = sun ? frame.to_sun.xyz : normalize(frame.eye.xyz - middle);
  vec3 d = turnedBy(-place.angle, to_eye);
  vec3 right = viewRight(d), up = cross(d, right);

  uint vertex = uint(gl_VertexIndex), corner = vertex % 6u;
  bool is_right = corner == 1u || corner == 2u || corner == 4u;
  bool is_upper = corner == 2u || corner == 4u || corner == 5u;
  float row = float(vertex / 6u + (is_upper ? 1u : 0u)) / float(kImpostorRows);
  vec3 local = kind.sphere.xyz +
               kind.sphere.w * ((is_right ? 1.0 : -1.0) * right + (2.0 * row - 1.0) * up);
  bool moves = kind.moves != 0u;
  vec3 bent = moves ? bentWithTrunk(kind, place, kind.moment, kind.whole, local) : local;
  vec3 base = vec3(place.x, place.y, place.z);
  out_position = base + place.scale * turnedBy(place.angle, bent);
  out_local = local;
  out_eye = sun ? local + d * (4.0 * kind.sphere.w)
                : turnedBy(-place.angle, frame.eye.xyz - base) / place.scale;
  NearestViews nearest = nearestViews(d, float(kind.views));
  out_weights = nearest.weights;
  float n = float(kind.views);
  out_views = uvec3(nearest.first.y * n + nearest.first.x, nearest.second.y * n + nearest.second.x,
                    nearest.third.y * n + nearest.third.x);
  out_turn = vec2(cos(place.angle), sin(place.angle));
  out_scale = place.scale;
  uint fade = kForestWhole;
  if (!sun) {
    ForestLevel level = forestLevel(kind.reach, kind.meshes, 1u,
                                    distance(middle, frame.eye.xyz) / place.scale,
                                    job.most / place.scale);
    if (level.level < kind.meshes)
      fade = min(uint(round(level.share * float(kForestWhole))), kForestWhole - 1u) | kForestRest;
  }
  out_seat = uvec2(place.phase, (place.tint & 0xffffffu) | (fade << 24));
  if (sun) {
    vec3 at = (frame.shadow_from_world[job.cascade] * vec4(out_position, 1.0)).xyz;
    gl_Position = vec4(at.xy * 2.0 - 1.0, at.z, 1.0);
  } else {
    gl_Position = frame.clip_from_world * vec4(out_position, 1.0);
  }
  if (job.velocity == 0u) return;
  vec3 was = moves ? bentWithTrunk(kind, place, kind.last_moment, kind.last_whole, local) : local;
  vec4 last = frame.last_clip_from_world *
              vec4(base + place.scale * turnedBy(place.angle, was), 1.0);
  out_now = gl_Position.xyw;
  out_last = last.xyw;
}
