#ifndef VERDURE_SHARED_TERRAIN_H_
#define VERDURE_SHARED_TERRAIN_H_

#include "portable.h"

// Ground as a height field, drawn to the horizon: Strugar, "Continuous Distance-Dependent Level of
// Detail for Rendering Heightmaps", Journal of Graphics, GPU, and Game Tools 14(4), 2009. Squares
// of the ground are drawn by one grid of cells, each level's twice as wide as the last one's. The
// farther vertices of each square slide onto the next level's, so that neighbours meet.

SHARED_BEGIN

/// Where a place lies among the samples of a terrain: the one before it along x and along z, and
/// its share of the way to the next ones, [0, 1].
struct TerrainCell {
  uvec2 sample_before;  ///< at most the last but one
  vec2 share;
};

/// `corner`: x, z of the first sample; `spacing_m` between them, above 0; `samples` along x and z,
/// at least 2 each. Places outside of the samples read the edge.
SHARED_FUNCTION TerrainCell terrainCell(vec2 place, vec2 corner, vec2 spacing_m, uvec2 samples) {
  vec2 last = vec2(float(samples.x - 1u), float(samples.y - 1u));
  vec2 at = clamp((place - corner) / spacing_m, vec2(0.0f, 0.0f), last);
  vec2 before = min(floor(at), last - vec2(1.0f, 1.0f));
  TerrainCell cell;
  cell.sample_before = uvec2(uint(before.x), uint(before.y));
  cell.share = at - before;
  return cell;
}

/// `corner_heights` of a cell: at the sample before, the next along x, the next along z, both.
SHARED_FUNCTION float bilinearHeight(vec4 corner_heights, vec2 share) {
  return mix(mix(corner_heights.x, corner_heights.y, share.x),
             mix(corner_heights.z, corner_heights.w, share.x), share.y);
}

/// The same of slopes.
SHARED_FUNCTION vec2 bilinearSlope(vec2 before, vec2 along_x, vec2 along_z, vec2 both, vec2 share) {
  return mix(mix(before, along_x, share.x), mix(along_z, both, share.x), share.y);
}

/// How much of the edge's slope along x and along z is left at a place: all inside. Outside, where
/// the ground is level, it fades within one spacing, so that no edge is seen.
SHARED_FUNCTION vec2 slopeLeft(vec2 place, vec2 corner, vec2 spacing_m, uvec2 samples) {
  vec2 last = vec2(float(samples.x - 1u), float(samples.y - 1u));
  vec2 at = (place - corner) / spacing_m;
  vec2 outside = max(max(-at, at - last), vec2(0.0f, 0.0f));
  return clamp(vec2(1.0f, 1.0f) - outside, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
}

/// The unit normal where the height grows by `slope` a metre along x and along z.
SHARED_FUNCTION vec3 slopeNormal(vec2 slope) {
  return normalize(vec3(-slope.x, 1.0f, -slope.y));
}

/// A square of the ground; its corner and cells lie on a lattice that never moves.
struct TerrainNode {
  vec2 corner;          ///< its smallest x and z, a multiple of its side
  float cell_m;         ///< side of its cells, a power of two
  float morph_begin_m;  ///< distance from which on its vertices slide
  float morph_end_m;    ///< distance at which they have reached those of the next level
};
SHARED_SIZE(TerrainNode, 20);

/// How far a place is from the eye, by which levels are chosen, m: the largest of the distances
/// along x, along z, and above or below the ground's lowest and highest place (`heights`).
SHARED_FUNCTION float terrainDistance(vec2 place, vec3 eye, vec2 heights) {
  float aside = max(abs(place.x - eye.x), abs(place.y - eye.z));
  return max(aside, max(heights.x - eye.y, eye.y - heights.y));
}

/// 0 up to `begin`, 1 from `end` on, both exactly.
SHARED_FUNCTION float terrainMorph(float distance, float begin, float end) {
  if (distance <= begin) return 0.0f;
  if (distance >= end) return 1.0f;
  return (distance - begin) / (end - begin);
}

/// x, z of a vertex of a node's grid, with indices from 0 to its number of cells. Those with an odd
/// index slide to the even one before; at `morph` 1 the grid is that of the next level.
SHARED_FUNCTION vec2 morphedPlace(vec2 corner, float cell_m, uvec2 grid_index, float morph) {
  vec2 index = vec2(float(grid_index.x), float(grid_index.y));
  vec2 odd = vec2(float(grid_index.x & 1u), float(grid_index.y & 1u));
  return corner + cell_m * (index - morph * odd);
}

/// How far a node's vertices at a place slide.
SHARED_FUNCTION float nodeMorph(TerrainNode node, vec2 place, vec3 eye, vec2 heights) {
  return terrainMorph(terrainDistance(place, eye, heights), node.morph_begin_m, node.morph_end_m);
}

/// x, z at which a vertex is drawn: a function of the node's level, the vertex' place at rest and
/// the eye alone, so that nodes agree about the vertices that they share.
SHARED_FUNCTION vec2 drawnPlace(TerrainNode node, uvec2 grid_index, vec3 eye, vec2 heights) {
  vec2 at_rest = morphedPlace(node.corner, node.cell_m, grid_index, 0.0f);
  return morphedPlace(node.corner, node.cell_m, grid_index, nodeMorph(node, at_rest, eye, heights));
}

/// Side of the cells about a place that is drawn: unlike cell_m, the same for all nodes that meet
/// there, and without steps when the eye moves.
SHARED_FUNCTION float drawnCell(TerrainNode node, vec2 drawn_place, vec3 eye, vec2 heights) {
  return node.cell_m * (1.0f + nodeMorph(node, drawn_place, eye, heights));
}

/// The k-th farthest of `count` rows of cells, seen from `eye_row`: all before it and all behind
/// it from the outside in, then its own.
SHARED_FUNCTION uint rowFarthestFirst(uint k, uint count, float eye_row) {
  uint own = uint(clamp(floor(eye_row), 0.0f, float(count)));
  return k < own ? k : count - 1u - (k - own);
}

/// Grid index of a node's vertex: 6 for each of cells x cells, as two triangles that are
/// counter-clockwise from above. They come back to front as seen from the eye, as nodes do: exact
/// where nothing slides. All diagonals run from the next vertex along x to the next along z, as a
/// sliding grid needs.
SHARED_FUNCTION uvec2 terrainGridIndex(TerrainNode node, uint vertex, uint cells, vec3 eye) {
  float eye_x = (eye.x - node.corner.x) / node.cell_m;
  float eye_z = (eye.z - node.corner.y) / node.cell_m;
  uint cell = vertex / 6u;
  uint x = rowFarthestFirst(cell / cells, cells, eye_x);
  uint z = rowFarthestFirst(cell % cells, cells, eye_z);
  uint corner = vertex % 6u;
  // The triangle on the diagonal's other side is first.
  bool eye_is_beyond = eye_x - float(x) + (eye_z - float(z)) > 1.0f;
  bool beyond = (corner >= 3u) == eye_is_beyond;
  corner = corner % 3u;
  // Before the diagonal: (0, 0), (0, 1), (1, 0); beyond: (1, 1), (1, 0), (0, 1).
  uint dx = corner == 2u ? 1u : 0u;
  uint dz = corner == 1u ? 1u : 0u;
  return beyond ? uvec2(x + 1u - dx, z + 1u - dz) : uvec2(x + dx, z + dz);
}

SHARED_END

#endif  // VERDURE_SHARED_TERRAIN_H_
