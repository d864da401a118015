#ifndef VERDURE_SHARED_FOLIAGE_SHADOW_H_
#define VERDURE_SHARED_FOLIAGE_SHADOW_H_

#include "leaf.h"
#include "portable.h"
#include "tone.h"

// Light through layers of leaves: Gumbau, Chover, Rebollo, Remolar, "Real-Time Illumination of
// Foliage Using Depth Maps", ICCS 2008. A texel of the light depth map holds
//   x  1 - depth of the leaf nearest to the light
//   y  depth of the farthest leaf
//   z  1
//   w  optical depth of all leaves together, each -ln(alpha), alpha what it lets through
// and zeros where there is no leaf. Depths lie in [0, 1], 0 nearest to the light. exp(-w) is the
// paper's alpha^C, w / -ln(alpha) its number of layers C. All four may be filtered linearly: then z
// is the share of the filter that leaves cover, and the others over z are means of that share.

SHARED_BEGIN

/// -ln(alpha) of a leaf of diffuse transmittance `through`, linear RGB in [0, 1], alpha its
/// luminance: [0, 6].
SHARED_FUNCTION float leafOpticalDepth(vec3 through) {
  return -log(clamp(luminanceOf(through), 0.0024787522f, 1.0f));
}

/// The optical depth in each colour channel relative to leafOpticalDepth(): [0.25, 4].
SHARED_FUNCTION vec3 leafTint(vec3 through) {
  vec3 least = max(through, vec3(1e-6f));
  vec3 depth = vec3(-log(least.x), -log(least.y), -log(least.z));
  return clamp(depth / max(leafOpticalDepth(through), 1e-3f), vec3(0.25f), vec3(4.0f));
}

/// What a filtered texel says.
struct LeafLayers {
  float covered;  ///< share of the filter where there are leaves, [0, 1]; of that share:
  float near;     ///< depth of the nearest leaf
  float far;      ///< of the farthest
  float depth;    ///< optical depth of all
};

SHARED_FUNCTION LeafLayers leafLayers(vec4 texel) {
  LeafLayers layers;
  float scale = texel.z > 0.0f ? 1.0f / texel.z : 0.0f;
  layers.covered = min(texel.z, 1.0f);
  layers.near = 1.0f - texel.x * scale;
  layers.far = texel.y * scale;
  layers.depth = texel.w * scale;
  return layers;
}

/// t of (4): where depth `z` lies between the nearest (0) and the farthest leaf (1). 0 in a single
/// layer, however it is rounded, and 1 behind it.
SHARED_FUNCTION float shareOfLayers(LeafLayers layers, float z) {
  float thickness = max(layers.far - layers.near, 1e-5f);
  return clamp((z - layers.near) / thickness, 0.0f, 1.0f);
}

/// S of (4), w (1 - t), for a leaf at depth `z`; `leaf_depth`: -ln(alpha) of one leaf. w, the
/// layers weighted by their transparency, is the mean of 1 for the first and alpha for each other
/// one: printed, more layers make leaves brighter, against the paper's text.
SHARED_FUNCTION float paperShadow(LeafLayers layers, float z, float leaf_depth) {
  float count = max(layers.depth / max(leaf_depth, 1e-3f), 1.0f);
  float weight = mix(exp(-leaf_depth), 1.0f, 1.0f / count);
  return mix(1.0f, weight * (1.0f - shareOfLayers(layers, z)), layers.covered);
}

/// Optical depth in front of depth `z` if all layers are evenly spread: the share t of them (Beer
/// and Lambert).
SHARED_FUNCTION float spreadDepth(LeafLayers layers, float z) {
  return layers.depth * shareOfLayers(layers, z);
}

/// Optical depth in front of depth `z` if the first layer is where it is, the last one, too, and
/// only those between them are evenly spread. `behind`: [0, 1], whether `z` is behind the first.
/// `leaf_depth`: of one leaf; `own`: whether the point is on a leaf, one of the layers itself.
SHARED_FUNCTION float orderedDepth(LeafLayers layers, float z, float behind, float leaf_depth,
                                   bool own) {
  float first = min(leaf_depth, layers.depth);
  float others = max(layers.depth - first - (own ? leaf_depth : 0.0f), 0.0f);
  return behind * (first + others * shareOfLayers(layers, z));
}

/// A texel of the map of what hides the sun stands for so many of the shadow maps' along each side:
/// read bilinearly, it averages about what the widest half-shadow does.
SHARED_FUNCTION int blockerBlock() {
  return 16;
}

/// Light leaves a leaf in all directions: of what comes through the crown of a tree that stands
/// alone, about this share reaches the ground below, the rest passes beside it (path-traced at 35
/// and 60 degrees: 0.2 to 0.3 of alpha^C).
SHARED_FUNCTION float shareBelowCrown() {
  return 0.25f;
}

/// Share of light, by colour channel, that passes the covered and the open part of a filter.
/// `share`: of the light through leaves that arrives.
SHARED_FUNCTION vec3 throughLayers(LeafLayers layers, float optical_depth, vec3 tint, float share) {
  return vec3(1.0f - layers.covered) +
         (layers.covered * share) * vec3(exp(-optical_depth * tint.x), exp(-optical_depth * tint.y),
                                         exp(-optical_depth * tint.z));
}

SHARED_END

#endif  // VERDURE_SHARED_FOLIAGE_SHADOW_H_
