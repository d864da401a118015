// Descriptor set 1 of what is drawn on a terrain: one layer of grass and the terrain itself.
#include "shared/grass.h"
layout(set = 1, binding = 0, std140) uniform GrassBlock { GrassUniforms grass; };
layout(set = 1, binding = 1) uniform sampler2DArray slice_colors;   // kinds, and the opaque one
layout(set = 1, binding = 2) uniform sampler2DArray slice_data;
layout(set = 1, binding = 3) uniform sampler2DArray ground_colors;  // ground, middle
layout(set = 1, binding = 4) uniform sampler2DArray ground_data;
layout(set = 1, binding = 5, std430) readonly buffer Heights { float heights[]; };
layout(set = 1, binding = 6, std430) readonly buffer Cover { float cover[]; };
layout(set = 1, binding = 7) uniform sampler2D scene_depth;  // nearest, farthest of the samples
layout(set = 1, binding = 8) uniform sampler2DArray far_colors;   // kFarLevels of each kind and of their mean

/// The ground's height at x, z from the eye.
float groundHeight(vec2 from_eye) {
  if (grass.terrain_range.w > 0.0) return grass.terrain_range.x;
  uvec2 size = uvec2(grass.terrain_size.xy);
  TerrainCell at = terrainCell(from_eye, grass.terrain.xy, grass.terrain.zw, size);
  uint first = at.sample_before.y * size.x + at.sample_before.x, below = first + size.x;
  return bilinearHeight(vec4(heights[first], heights[first + 1u], heights[below],
                             heights[below + 1u]), at.share);
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

/// Nothing is lost far from the origin, where the eye's own coordinates are coarse.
vec4 clipFromEye(vec3 from_eye) {
  return frame.clip_from_world * vec4(from_eye, 0.0) +
         vec4(0.0, 0.0, frame.clip_from_world[3].z, 0.0);
}
