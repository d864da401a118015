#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "grass_set.glsl"

// A node of the terrain, or of the shell of grass over it.
layout(constant_id = 21) const bool kGrass = true;
layout(constant_id = 25) const bool kFromEye = false;  // the ground under an eye that is in the shell
layout(constant_id = 23) const uint kCells = 16u;  // along a node
layout(location = 0) in vec4 corner_cell_begin;    // of TerrainNode
layout(location = 1) in float end;

layout(location = 0) centroid out vec3 from_eye;

void main() {
  vec3 eye = frame.eye.xyz;
  TerrainNode node = TerrainNode(corner_cell_begin.xy, corner_cell_begin.z, corner_cell_begin.w, end);
  uvec2 index = terrainGridIndex(node, uint(gl_VertexIndex), kCells, eye);
  vec2 drawn = drawnPlace(node, index, eye, grass.terrain_range.xy);
  vec2 place = drawn - eye.xz;
  float height = groundHeight(place);
  if (kGrass && !kFromEye) {
    // Where the ground falls away between vertices, the shell must not be cut off.
    float cell = drawnCell(node, drawn, eye, grass.terrain_range.xy);
    vec2 x = vec2(cell, 0.0), z = vec2(0.0, cell);
    vec2 around = vec2(groundHeight(place + x) + groundHeight(place - x),
                       groundHeight(place + z) + groundHeight(place - z));
    vec2 bulge = max(2.0 * height - around, 0.0) / 4.0;
    height += grass.placing.y + bulge.x + bulge.y;
  }
  from_eye = vec3(place.x, height - eye.y, place.y);
  gl_Position = clipFromEye(from_eye);
}
