// Descriptors of the passes that compute how far a plant is bent, for each place where it stands.
#include "shared/sway.h"
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Beams { MotionBeam beams[]; };
layout(set = 0, binding = 1, std430) readonly buffer Drives { MotionDrive drives[]; };
layout(set = 0, binding = 2, std430) readonly buffer Leaves { MotionLeaf leaves[]; };
layout(set = 0, binding = 3, std430) readonly buffer Texels { uint texels[]; };
struct Seat {
  vec4 rows[3];  // of world_from_plant
  uvec4 motion;  // instance.glsl
};
layout(set = 0, binding = 4, std430) readonly buffer Seats { Seat seats[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Amplitudes { vec2 amplitudes[]; };
layout(set = 0, binding = 6, std430) writeonly buffer Turns { uint turns[]; };
layout(push_constant, std430) uniform JobBlock { MotionJob job; };

vec3 worldFrom(Seat seat, vec3 p) {
  vec4 q = vec4(p, 1.0);
  return vec3(dot(seat.rows[0], q), dot(seat.rows[1], q), dot(seat.rows[2], q));
}

/// Where the wind blows to in the plant's coordinates.
vec3 localToward(Seat seat) {
  vec3 d = job.moment.toward.xyz;
  vec3 local = seat.rows[0].xyz * d.x + seat.rows[1].xyz * d.y + seat.rows[2].xyz * d.z;
  return local * inversesqrt(max(dot(local, local), 1e-30));
}

float localSpeed(Seat seat) {
  return gustySpeed(job.moment, vec3(seat.rows[0].w, seat.rows[1].w, seat.rows[2].w));
}

vec2 readMotion(uint first, uvec2 size, vec2 uv) {
  MotionTexels at = motionTexels(uv, size);
  uint low = first + at.low.y * size.x, high = first + at.high.y * size.x;
  vec2 a = unpackHalf2x16(texels[low + at.low.x]), b = unpackHalf2x16(texels[low + at.high.x]);
  vec2 c = unpackHalf2x16(texels[high + at.low.x]), d = unpackHalf2x16(texels[high + at.high.x]);
  return vec2(motionValue(vec4(a.x, b.x, c.x, d.x), at.share),
              motionValue(vec4(a.y, b.y, c.y, d.y), at.share));
}
