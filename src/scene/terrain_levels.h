#ifndef VERDURE_SCENE_TERRAIN_LEVELS_H_
#define VERDURE_SCENE_TERRAIN_LEVELS_H_

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "shared/terrain.h"
#include "verdure/terrain.h"

/// What a renderer needs of a terrain: which squares of it to draw how finely, and its slopes.
namespace verdure {

/// A level reaches as far as this number of its nodes' sides: cells of a level appear between
/// 1 / 4 and 1 / 2 of an n-th radian wide, for n cells along a node. Above 2, or a node that has to
/// slide would begin to before the finer one beside it ends.
constexpr int kNodeReach = 4;

struct TerrainLevels {
  float finest_m = 0.25f;  ///< side of the finest cells, above 0; taken as the next lower power of
                           ///< two, so that places are sums without rounding
  int cells = 16;          ///< along a node's side, even, at least 2
  float radius_m = 2000.0f;        ///< drawn around the eye; below 2^20 finest_m
  glm::vec2 heights{0.0f, 20.0f};  ///< lowest and highest place of the ground
};

/// The nodes that cover the square of half side radius_m around the eye, without those outside of
/// the picture: none overlap, and each is nearer than all before it, along any ray from the eye.
/// Which they are depends on the eye and on a lattice at the world's origin alone. Near, far and
/// their order of depths do not matter: only what is beside, above, below or behind the picture is
/// left out. `eye` is finite, with x and z below 2^22 finest_m. It may be another eye than
/// that of `clip_from_world`: for a shadow, that of the picture.
std::vector<shared::TerrainNode> selectTerrainNodes(const TerrainLevels& levels,
                                                    const glm::vec3& eye,
                                                    const glm::mat4& clip_from_world);

/// As many nodes as selectTerrainNodes() never exceeds, whatever the eye.
std::size_t mostTerrainNodes(const TerrainLevels& levels);

/// Lowest and highest sample.
glm::vec2 heightRange(const Terrain& terrain);

/// Slopes along x and z at the samples, by central differences (to one side at the edges): what
/// normalAt() is bilinear in, see shared::bilinearSlope() and shared::slopeLeft().
std::vector<glm::vec2> terrainSlopes(const Terrain& terrain);

/// One of them.
glm::vec2 terrainSlope(const Terrain& terrain, int x, int z);

}  // namespace verdure

#endif  // VERDURE_SCENE_TERRAIN_LEVELS_H_
