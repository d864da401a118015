#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion_job.glsl"
// Amplitudes of one branch at one place.
void main() {
  uint i = gl_GlobalInvocationID.x, place = gl_WorkGroupID.y;
  if (i >= job.count) return;
  Seat seat = seats[job.first_instance + place];
  MotionDrive drive = drives[job.first + i];
  vec2 uv = branchUv(drive, motionPhase(seat.motion.z), job.whole, job.moment.drift.w);
  vec2 noise = readMotion(drive.texels, uvec2(drive.size & 0xffffu, drive.size >> 16), uv);
  amplitudes[job.out_base + place * job.count + i] =
      branchAmplitudes(beams[job.first + i], drive, localToward(seat), localSpeed(seat), noise);
}
