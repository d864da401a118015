#include "shared/foliage_shadow.h"

/// What leaves let through to the point `at` of the map, by one filtered texel of the light depth
/// map. `leaf`: leafTint() of the leaves, leafOpticalDepth() of one (0: the point is on none).
vec3 throughLeaves(vec3 at, vec4 leaf) {
  LeafLayers layers = leafLayers(textureLod(foliage_map, at.xy, 0.0));
  if (kFoliage && kShadowSource == kDepthPaper) return vec3(paperShadow(layers, at.z, leaf.w));
  if (kShadowSource != kDepthOrdered) return throughLayers(layers, spreadDepth(layers, at.z), leaf.rgb);
  // The point has been moved off its own surface; what is left in front of it, is another's.
  mat4 m = frame.shadow_from_world;
  float depth_per_m = length(vec3(m[0][2], m[1][2], m[2][2]));
  float behind = clamp((at.z - layers.near) / (2.0 * frame.to_sun.w * depth_per_m), 0.0, 1.0);
  return throughLayers(layers, orderedDepth(layers, at.z, behind, leaf.w, kFoliage), leaf.rgb);
}
