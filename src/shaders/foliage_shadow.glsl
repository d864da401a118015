#include "shared/foliage_shadow.h"

/// A filtered texel of a cascade's light depth map.
vec4 foliageTap(int cascade, vec2 at) {
  return texture(foliage_map, vec3(at, float(cascade)));
}

/// What leaves let through to a point of depth `z` in a cascade's map, by a filtered texel of the
/// light depth map. `leaf`: leafTint() of the leaves, leafOpticalDepth() of one.
vec3 throughLeaves(int cascade, vec4 texel, float z, vec4 leaf) {
  LeafLayers layers = leafLayers(texel);
  if (kFoliage && kShadowSource == kDepthPaper) return vec3(paperShadow(layers, z, leaf.w));
  if (kShadowSource != kDepthOrdered)
    return throughLayers(layers, spreadDepth(layers, z), leaf.rgb, 1.0);
  // The point has been moved off its own surface: what is still in front of it is another's.
  float two_texels = 2.0 * frame.cascade[cascade].x * depthOfMetre(cascade);
  float behind = clamp((z - layers.near) / two_texels, 0.0, 1.0);
  // Transfer vectors know what shines through leaves, and where it goes: they hide the sun itself.
  if (kAmbientSource == kTransfer && (kFoliage || frame.ground_map.z > 0.0))
    return vec3(1.0 - layers.covered * behind);
  // In front of the first leaf all light is still the sun's own.
  float share = kFoliage ? 1.0 : mix(1.0, shareBelowCrown(), behind);
  return throughLayers(layers, orderedDepth(layers, z, behind, leaf.w, kFoliage), leaf.rgb, share);
}
