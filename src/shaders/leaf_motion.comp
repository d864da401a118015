#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion_job.glsl"
// Bending and twisting of one leaf at one place.
void main() {
  uint i = gl_GlobalInvocationID.x, place = gl_WorkGroupID.y;
  if (i >= job.count) return;
  Seat seat = seats[job.first_instance + place];
  MotionLeaf leaf = leaves[job.first + i];
  vec3 stalk = worldFrom(seat, leaf.stalk);
  uvec2 size = uvec2(job.wind_size);
  vec2 noise =
      job.moment.planes.x * readMotion(job.wind_texels, size, windUv(job.moment, stalk, 0)) +
      job.moment.planes.y * readMotion(job.wind_texels, size, windUv(job.moment, stalk, 1)) +
      job.moment.planes.z * readMotion(job.wind_texels, size, windUv(job.moment, stalk, 2));
  turns[job.out_base + place * job.count + i] =
      packHalf2x16(leafTurns(leaf, localToward(seat), localSpeed(seat), noise));
}
