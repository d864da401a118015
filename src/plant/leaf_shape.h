#ifndef VERDURE_PLANT_LEAF_SHAPE_H_
#define VERDURE_PLANT_LEAF_SHAPE_H_

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>

namespace verdure {

/// Leaves of grown plants (the parameter LeafShape): each is a species of growLeaf().
enum class LeafShape {
  kElliptic,    ///< tupelo
  kRound,       ///< aspen
  kLanceolate,  ///< willow
  kLobed,       ///< black oak
  kPalmate,     ///< Japanese maple
  kTriangular,  ///< birch
  kSmallOval,   ///< privet
  kNeedles      ///< pine: a shoot with its needles
};
inline constexpr int kLeafShapeCount = 8;

/// LeafGrowOptions::species of a shape.
std::string leafSpeciesOf(LeafShape shape);

/// The polygon that carries a leaf as geometry. Its axis runs from the foot, (0, 0), to the tip;
/// on each side are two corners, from the foot on. It contains the leaf but for the ends of its
/// stalk and of its tip.
struct LeafHull {
  glm::vec2 tip{0, 1};
  std::array<glm::vec2, 2> right, left;
};

/// The smallest such polygon around points (x across, y upwards from the foot; whatever unit) whose
/// corners lie in [-reach_left, reach_right] across.
LeafHull leafHull(std::span<const glm::vec2> points, float reach_left, float reach_right);

}  // namespace verdure

#endif  // VERDURE_PLANT_LEAF_SHAPE_H_
