#ifndef VERDURE_PLANT_LEAF_SHAPE_H_
#define VERDURE_PLANT_LEAF_SHAPE_H_

#include <glm/glm.hpp>
#include <vector>

namespace verdure {

/// Outlines of leaves (the parameter LeafShape).
enum class LeafShape {
  kElliptic,    ///< tupelo
  kRound,       ///< aspen: nearly a circle, blunt teeth, a short tip
  kLanceolate,  ///< willow
  kLobed,       ///< black oak: seven pointed lobes
  kPalmate,     ///< Japanese maple: seven fingers
  kTriangular,  ///< birch: broad base, double teeth, long tip
  kSmallOval,   ///< box, privet
  kNeedles      ///< pine: a shoot with its needles
};
inline constexpr int kLeafShapeCount = 8;

/// Where the stalk ends and the blade begins, fraction of the leaf's length.
inline constexpr float kLeafStalk = 0.1f;

/// Outline of a leaf as a closed polygon: x in [-0.5, 0.5] across, y in [0, 1] from the foot of the
/// stalk to the tip. Needles have none (empty).
std::vector<glm::vec2> leafOutline(LeafShape shape);

/// Axes of the fingers of a palmate leaf: tips, seen from palmCenter().
std::vector<glm::vec2> palmTips();
glm::vec2 palmCenter();

/// The polygon that carries the outline as geometry: right-hand side of a hull that is symmetric
/// about the midrib, foot (0, 0) and tip (0, 1) left out, from foot to tip. It contains the
/// outline.
std::vector<glm::vec2> leafHull(LeafShape shape);

}  // namespace verdure

#endif  // VERDURE_PLANT_LEAF_SHAPE_H_
