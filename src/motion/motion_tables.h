#ifndef VERDURE_MOTION_MOTION_TABLES_H_
#define VERDURE_MOTION_MOTION_TABLES_H_

#include <array>
#include <vector>

#include "shared/sway.h"
#include "verdure/motion.h"

namespace verdure {

/// A motion texture of two channels, as halves: what CPU and GPU read.
struct PackedMotionTexture {
  glm::uvec2 size{0};
  std::vector<std::uint32_t> texels;  ///< rows first; channels 0 and 1 as in packHalf2x16()
  float farthest = 0.0f;              ///< length of the longest texel
};

/// A plant's motion as arrays for the GPU; all indices count from the plant's first.
struct MotionTables {
  std::vector<shared::MotionBeam> beams;
  std::vector<shared::MotionDrive> drives;  ///< of each beam
  std::vector<shared::MotionLeaf> leaves;
  std::vector<std::vector<glm::uvec2>> hangs;  ///< of each vertex of each mesh
  std::vector<std::uint32_t> texels;           ///< of all textures, see MotionDrive::texels
  std::vector<float> farthest;  ///< of each beam, the length of its texture's longest texel
  PackedMotionTexture wind;     ///< for leaves
  float wind_extent = 1.0f;     ///< of that, m

  /// What hangs on a beam itself, at rest; boxes are empty where nothing does.
  struct Load {
    Bounds box;
    bool any = false;
    float leaf_reach = 0.0f;  ///< of the leaf that reaches farthest from its stalk, m
    std::array<float, kMotionLevels> reach{};  ///< from its pivots, own beam first, m
  };
  std::vector<Load> loads;
  Bounds still;  ///< of vertices that hang on nothing
  bool any_still = false;
};

/// The wind over plants whose leaves read a texture that is `extent` metres wide. Throws Error
/// unless wind and time are what they should be.
shared::MotionMoment momentOf(const Wind& wind, double seconds, float extent);

/// Bilinear, as the shaders read it.
glm::vec2 readMotion(const std::uint32_t* texels, const glm::uvec2& size, const glm::vec2& uv);

/// See movedBounds() in verdure/motion.h.
Bounds movedBounds(const MotionTables& tables, const Wind& wind);

/// Calls visit(branch, place) for a vertex's branch and for those that carry it, down to the trunk.
template <class Visit>
void forEachCarrier(const MotionTree& tree, const VertexMotion& motion, const Visit& visit) {
  for (std::uint32_t b = motion.branch; b != kNone; b = tree.branches[b].parent)
    visit(b, motion.places[tree.branches[b].level]);
}

}  // namespace verdure

#endif  // VERDURE_MOTION_MOTION_TABLES_H_
