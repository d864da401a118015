#ifndef VERDURE_INTERCHANGE_CLIP_JOINTS_H_
#define VERDURE_INTERCHANGE_CLIP_JOINTS_H_

#include "verdure/motion.h"

namespace verdure {

/// A cross section of a branch, with a joint. Joint 0 is the plant's own and stands still.
struct ClipJoint {
  std::uint32_t parent = 0;      ///< below its own number
  std::uint32_t branch = kNone;  ///< of MotionTree
  float place = 0.0f;            ///< on it, [0, 1]
  glm::vec3 pivot{0.0f};         ///< at rest
};

struct ClipJoints {
  std::vector<ClipJoint> joints;
  std::vector<std::uint32_t> first_of;     ///< by branch: its first joint, kNone: it has none
  std::vector<std::uint32_t> segments_of;  ///< by branch: one less than its joints
  std::size_t bent_branches = 0;
};

/// At most `most` joints, one by one where they take most off the squares of what vertices are off.
ClipJoints chooseJoints(const Plant& plant, const PlantMotion& motion, std::size_t most);

/// Between which joints a vertex is, and its share of the second.
struct JointWeights {
  std::uint32_t low = 0, high = 0;
  float share = 0.0f;
};
JointWeights weightsOf(const ClipJoints& joints, const MotionTree& tree,
                       const VertexMotion& vertex);

/// Where each joint is with the branches bent: plant coordinates from the joint's, whose origin is
/// its pivot.
std::vector<glm::dmat4> poseJoints(const ClipJoints& joints, const MotionTree& tree,
                                   const std::vector<glm::vec2>& amplitudes);

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_CLIP_JOINTS_H_
