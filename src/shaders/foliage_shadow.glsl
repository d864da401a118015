#include "shared/foliage_shadow.h"

/// Depth of a cascade's maps per metre towards the sun.
float depthPerMetre(int cascade) {
  mat4 m = frame.shadow_from_world[cascade];
  return length(vec3(m[0][2], m[1][2], m[2][2]));
}

/// What leaves let through to the point `at` of a cascade's map, of depth `z`, by one filtered texel
/// of the light depth map. `leaf`: leafTint() of the leaves, leafOpticalDepth() of one.
vec3 throughLeaves(int cascade, vec2 at, float z, float depth_per_m, vec4 leaf) {
  LeafLayers layers = leafLayers(textureLod(foliage_map, vec3(at, float(cascade)), 0.0));
  if (kFoliage && kShadowSource == kDepthPaper) return vec3(paperShadow(layers, z, leaf.w));
  if (kShadowSource != kDepthOrdered)
    return throughLayers(layers, spreadDepth(layers, z), leaf.rgb);
  // The point has been moved off its own surface: what is still in front of it is another's.
  float behind = clamp((z - layers.near) / (2.0 * frame.cascade[cascade].x * depth_per_m), 0.0, 1.0);
  return throughLayers(layers, orderedDepth(layers, z, behind, leaf.w, kFoliage), leaf.rgb);
}
