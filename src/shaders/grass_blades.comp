#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "grass_set.glsl"
#include "grass_blades_set.glsl"
// Which plants are drawn one by one: those near the eye and in the picture. Each ribbon of them is
// listed; the order does not matter.
layout(local_size_x = 64) in;
layout(set = 2, binding = 1, std430) writeonly buffer Blades { GrassBlade blades[]; };
layout(set = 2, binding = 2, std430) buffer Draw { uint draw[]; };  // indexed, indirect
layout(push_constant, std430) uniform JobBlock { BladeJob job; };

void main() {
  uint cell = gl_GlobalInvocationID.x;
  if (cell >= job.cells * job.cells) return;
  ivec2 local = ivec2(cell % job.cells, cell / job.cells) - int(job.cells / 2u);
  uvec2 number = job.eye_cell + uvec2(local);
  uint plant = grassHash(number.x, number.y, 64u + job.kind);
  vec2 in_cell = vec2(ribbonRandom(plant, 0xfffeu, 0u, 21u), ribbonRandom(plant, 0xfffeu, 0u, 22u));
  vec2 place = (vec2(local) + in_cell) * job.cell_m - job.past;
  float density = clamp(coverAt(place), 0.0, 1.0);
  if (density <= 0.0) return;
  vec3 root = vec3(place.x, groundHeight(place) - grass.terrain_range.z, place.y);
  float share = 1.0 - smoothstep(grass.blades.x, grass.blades.y, length(root));
  // In the last tenth of its way it grows.
  float above = density * share - plantRank(plant);
  if (above <= 0.0) return;
  vec4 clip = job.clip_from_eye * vec4(root + vec3(0.0, 0.5 * job.reach_m, 0.0), 0.0);
  float reach = 1.5 * job.reach_m;
  vec2 aside = reach * vec2(length(vec3(job.clip_from_eye[0].x, job.clip_from_eye[1].x, job.clip_from_eye[2].x)),
                            length(vec3(job.clip_from_eye[0].y, job.clip_from_eye[1].y, job.clip_from_eye[2].y)));
  if (clip.w < -reach || any(greaterThan(abs(clip.xy), vec2(max(clip.w, 0.0) + reach) + aside))) return;
  float scale = grassHeight(density) * min(0.35 + 6.5 * above, 1.0);
  for (uint p = job.first_part; p < job.first_part + job.parts; ++p) {
    uint count = parts[p].kind.z;
    uint at = atomicAdd(draw[1], count);
    for (uint i = 0u; i < count; ++i)
      blades[at + i] = GrassBlade(root, plant, p, i, scale, density);
  }
}
