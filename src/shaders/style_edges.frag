#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A drawing in ink: lines where the normals or the depths that are seen jump.
const vec3 kInk = vec3(0.012, 0.011, 0.012);

void main() {
  float unit = unitInPixels();
  float normals = smoothstep(0.07, 0.22, normalChange(unit));
  float ink = 1.0 - (1.0 - normals) * (1.0 - depthInk(max(round(unit), 1.0)));
  vec4 sheet = paperHere();
  // A pen leaves a little less in the sheet's valleys.
  ink *= 1.0 - 0.25 * (1.0 - sheet.r) * (1.0 - ink);
  writeLinear(mix(bareSheet(sheet.r, unit), kInk, ink));
}
