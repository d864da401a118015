#ifndef VERDURE_INTERCHANGE_WIND_QUANTITIES_H_
#define VERDURE_INTERCHANGE_WIND_QUANTITIES_H_

#include "verdure/motion.h"

namespace verdure {

/// What a channel of a vertex can hold.
enum class WindQuantity {
  kZero,
  kOne,
  kTreeBend,     ///< deflection by the trunk, 1 = the largest of the plant
  kBranchBend,   ///< by all branches above the trunk together, 1 = the largest: 0 where one begins
  kSway,         ///< by all together, 1 = the largest
  kStillness,    ///< 1 - kSway
  kBranchPhase,  ///< [0, 1), the same on a bough with all that it carries
  kLeafPhase,    ///< [0, 1), the same on a leaf; on wood kBranchPhase
  kLeafEdge,     ///< 0 at a leaf's stalk and on wood to 1 at the leaf's farthest vertex
  kOpenness,     ///< ambient coefficient of a bake, 1 = open; 1 without a bake
  kStem,         ///< number of the plant's own branch, -1: none
  kBranch,       ///< number of the beam, -1: none
  kLevel,        ///< of the beam, 0 = trunk
  kPlace0,       ///< VertexMotion::places
  kPlace1,
  kPlace2,
  kPlace3,
  kLength,  ///< of the beam, m
  kPivotX,  ///< the beam's root, in the mesh's coordinates
  kPivotY,
  kPivotZ,
  kAnchorX,  ///< the leaf's stalk, in the mesh's coordinates; the vertex itself for wood
  kAnchorY,
  kAnchorZ,
  kX,  ///< the vertex itself, in the mesh's coordinates
  kY,
  kZ,
  kU,  ///< its texture coordinates
  kV,
  kElementU,  ///< the beam's texel in Pivot Painter's textures
  kElementV,
  kSwayDirection,      ///< packDirection(): across the bough that carries it, upwards
  kLeafAxis,           ///< packDirection(): from a leaf's stalk outwards; 0 for wood
  kLeafNormal,         ///< packDirection()
  kSpeedTreeGeometry,  ///< 0 wood, 2 leaf
};

/// A direction in a float, as SpeedTree's UnpackNormalFromFloat() reads it: components are
/// 2 frac(value / (16, 1, 1/16)) - 1, within 1/16 each.
float packDirection(const glm::vec3& direction);

/// Size of Pivot Painter's textures for a number of elements: powers of two, about square.
glm::ivec2 elementTextureSize(std::size_t elements);

class WindQuantities {
 public:
  WindQuantities(const Plant& plant, const PlantMotion& motion);

  float of(WindQuantity quantity, std::size_t mesh, std::size_t vertex,
           const glm::dmat4& plant_from_local) const;
  /// kBranchPhase of a beam.
  float phaseOf(std::uint32_t beam) const;
  /// The largest deflection by a wind of 1 m/s, m, mean and root mean square of the swing together:
  /// what kTreeBend, kBranchBend and kSway are shares of.
  struct Largest {
    float tree = 0.0f, branch = 0.0f, sway = 0.0f;
  };
  const Largest& largest() const { return largest_; }

 private:
  struct Bend {
    float tree = 0.0f, branch = 0.0f;
  };
  std::uint32_t boughOf(std::uint32_t beam) const;

  const Plant& plant_;
  const PlantMotion& motion_;
  std::vector<std::vector<Bend>> bends_;
  std::vector<std::vector<float>> stems_;
  Largest largest_;
  glm::ivec2 element_size_{1};
};

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_WIND_QUANTITIES_H_
