#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A drawing in ink: lines along outlines, and where the normals or the depths that are seen jump.
const vec3 kInk = vec3(0.014, 0.012, 0.013);

void main() {
  float unit = unitInPixels();
  vec2 at = placeInPicture();
  vec4 sheet = paperHere();
  Layer broad = layerAt(foliage_broad, at), wide = layerAt(foliage_wide, at);
  Layer wood = layerAt(wood_layer, at);

  // Around foliage; gaps within it are lighter than its outline.
  float distance = borderOf(foliage_fine, at, foliageThreshold(wide), 0.012);
  float outline = lineAlong(distance, 1.5 * unit);
  outline *= 1.0 - 0.75 * smoothstep(0.5, 0.85, wide.cover);
  // Around wood that is seen.
  float front = blurredDepthTest(wood.depth, 1.03 * broad.depth, 0.03);
  outline = max(outline, barkInk(wood, at, 1.4 * unit) *
                             mix(1.0, front, insideBorder(distance, 2.0)));
  // Within it: more where it is dark.
  float dark = 1.0 - smoothstep(0.45, 0.85, foliageTone(broad, broad, wide));
  float interior = normalInk(unit) * mix(0.35, 1.0, dark);
  float ink = 1.0 - (1.0 - outline) * (1.0 - interior) *
                        (1.0 - depthInk(max(round(unit), 1.0)));
  // A pen leaves a little less in the sheet's valleys.
  ink *= 1.0 - 0.25 * (1.0 - sheet.r) * (1.0 - ink);
  writeLinear(mix(bareSheet(sheet.r, unit), kInk, ink));
}
