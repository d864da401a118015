#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/forest.h"
// The farthest of what a depth buffer holds in each tile, and in each block of 8 x 8 tiles: what lies
// behind all of it cannot be seen. Depths fall with the distance, and are 0 where nothing is.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DMS depths;
layout(set = 0, binding = 1, std430) writeonly buffer Tiles { float tiles[]; };

shared float farthest[64];

float farthestInTile(ivec2 corner, ivec2 size) {
  float least = 1.0;
  ivec2 end = min(corner + ivec2(kDepthTile), size);
  for (int y = corner.y; y < end.y; ++y)
    for (int x = corner.x; x < end.x; ++x) {
      for (int s = 0; s < 4; ++s) least = min(least, texelFetch(depths, ivec2(x, y), s).r);
      if (least == 0.0) return 0.0;
    }
  return least;
}

void main() {
  uvec2 at = gl_GlobalInvocationID.xy, count = gl_NumWorkGroups.xy * kDepthTile;
  uint local = gl_LocalInvocationIndex;
  float least = farthestInTile(ivec2(at * kDepthTile), textureSize(depths));
  tiles[at.y * count.x + at.x] = least;
  farthest[local] = least;
  barrier();
  for (uint step = 32u; step > 0u; step /= 2u) {
    if (local < step) farthest[local] = min(farthest[local], farthest[local + step]);
    barrier();
  }
  if (local == 0u)
    tiles[count.x * count.y + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] =
        farthest[0];
}
