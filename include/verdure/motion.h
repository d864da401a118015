#ifndef VERDURE_MOTION_H_
#define VERDURE_MOTION_H_

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "verdure/plant.h"

/// Plants in wind: Habel, "Real-time Rendering and Animation of Vegetation", dissertation, TU Wien
/// 2009, chapter 4.
namespace verdure {

inline constexpr int kMotionLevels = 4;

/// A branch as a beam, at rest: metres.
struct MotionBranch {
  std::uint32_t parent = kNone;  ///< index into MotionTree::branches, below its own; kNone: ground
  int level = 0;                 ///< 0 to kMotionLevels - 1: its parent's + 1
  float place = 0.0f;            ///< where it leaves its parent, [0, 1] of that one's length
  glm::vec3 root{0.0f};
  glm::vec3 t{0, 1, 0}, r{1, 0, 0}, s{0, 0, 1};  ///< axis from root to tip, two directions across
  float length = 0.0f;                           ///< from root to tip, straight
  float root_radius = 0.0f, tip_radius = 0.0f;
  glm::vec2 fit{0.0f};   ///< c_2, c_4 of (4.8)
  float wood_m3 = 0.0f;  ///< of the branch and all that it carries (4.17, without the density)
};

/// What each vertex of a mesh hangs on.
struct VertexMotion {
  std::uint32_t branch = kNone;  ///< kNone: it stands still
  /// Where it is along each of its branches, by their levels, [0, 1]; its own last, 0 beyond.
  glm::vec4 places{0.0f};
};

struct MotionTree {
  std::vector<MotionBranch> branches;
  std::vector<std::vector<VertexMotion>> meshes;  ///< of each mesh of the plant, vertex by vertex
};

/// The tree of beams of a plant whose branches are known (Plant::branches, branch_of_vertex and
/// Leaf::branch: grown ones). Trunks that part near the foot (below 0.15 of the first) stand
/// side by side; what would be deeper than kMotionLevels is part of the branch
/// that carries it. Leaves hang on their stalk's place as a whole. Throws Error for a plant
/// without branches.
MotionTree motionTree(const Plant& plant);

/// The plant's positions and normals with its branches bent: `amplitude` gives each branch's along
/// r and s, metres for each 1 of (4.8). With 0 everywhere the plant itself, to the bit.
void bendPlant(const MotionTree& tree,
               const std::function<glm::vec2(std::uint32_t branch)>& amplitude, Plant& plant);

}  // namespace verdure

#endif  // VERDURE_MOTION_H_
