#include "interchange/clip_joints.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "shared/beam.h"

namespace verdure {
namespace {

std::uint32_t jointsFor(int level) {
  return level == 0 ? 6 : level == 1 ? 4 : 3;
}

glm::vec3 axisPoint(const MotionBranch& branch, float place) {
  return branch.root + branch.t * (place * branch.length);
}

/// As glm::mat4: what a section of the branch and all it carries does.
glm::dmat4 matrixOf(const MotionBranch& branch, float place, const glm::vec2& amplitude) {
  const shared::BeamFrame frame{branch.root, branch.length, branch.t, branch.r, branch.s};
  const shared::BeamPose pose = shared::poseOfBeam(frame, branch.fit, place, amplitude);
  glm::dmat4 m(1.0);
  for (int c = 0; c < 3; ++c) {
    glm::vec3 axis(0.0f);
    axis[c] = 1.0f;
    m[c] = glm::dvec4(glm::dvec3(shared::posedVector(pose, axis)), 0.0);
  }
  m[3] = glm::dvec4(glm::dvec3(shared::posedPoint(pose, glm::vec3(0.0f))), 1.0);
  return m;
}

}  // namespace

ClipJoints chooseJoints(const Plant& plant, const PlantMotion& motion, std::size_t most) {
  const std::vector<MotionBranch>& branches = motion.tree.branches;
  // How much is lost when a branch does not bend: its tip's way times what it carries.
  std::vector<double> carried(branches.size(), 0.0);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    for (const VertexMotion& vertex : motion.tree.meshes[m])
      if (vertex.branch != kNone) carried[vertex.branch] += 1.0;
  for (std::size_t b = branches.size(); b-- > 0;)
    if (branches[b].parent != kNone) carried[branches[b].parent] += carried[b];
  std::vector<double> worth(branches.size());
  for (std::size_t b = 0; b < branches.size(); ++b)
    worth[b] = carried[b] * double{branches[b].length} *
               double{motion.branches[b].mean + motion.branches[b].swing} /
               jointsFor(branches[b].level);
  std::vector<std::uint32_t> order(branches.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return worth[a] > worth[b]; });
  std::vector<bool> bent(branches.size(), false);
  std::size_t count = 1;
  ClipJoints chosen;
  for (const std::uint32_t b : order) {
    const std::size_t more = jointsFor(branches[b].level);
    if (count + more > most) continue;
    bent[b] = true;
    count += more;
    ++chosen.bent_branches;
  }
  chosen.joints.emplace_back();
  chosen.first_of.assign(branches.size(), kNone);
  for (std::uint32_t b = 0; b < branches.size(); ++b) {
    if (!bent[b]) continue;
    chosen.first_of[b] = static_cast<std::uint32_t>(chosen.joints.size());
    const std::uint32_t n = jointsFor(branches[b].level);
    // It hangs on the last joint below its root of the next branch with joints.
    VertexMotion root;
    root.branch = branches[b].parent;
    for (std::uint32_t c = b; branches[c].parent != kNone; c = branches[c].parent)
      root.places[branches[c].level - 1] = branches[c].place;
    std::uint32_t parent = weightsOf(chosen, motion.tree, root).low;
    for (std::uint32_t j = 0; j < n; ++j) {
      const float place = static_cast<float>(j) / static_cast<float>(n - 1);
      chosen.joints.push_back({parent, b, place, axisPoint(branches[b], place)});
      parent = static_cast<std::uint32_t>(chosen.joints.size()) - 1;
    }
  }
  return chosen;
}

JointWeights weightsOf(const ClipJoints& joints, const MotionTree& tree,
                       const VertexMotion& vertex) {
  std::uint32_t b = vertex.branch;
  while (b != kNone && joints.first_of[b] == kNone) b = tree.branches[b].parent;
  if (b == kNone) return {};
  const int level = tree.branches[b].level;
  const std::uint32_t steps = jointsFor(level) - 1;
  const float along = vertex.places[level] * static_cast<float>(steps);
  const auto low = std::min(static_cast<std::uint32_t>(std::max(along, 0.0f)), steps - 1);
  const std::uint32_t first = joints.first_of[b];
  return {first + low, first + low + 1, std::clamp(along - static_cast<float>(low), 0.0f, 1.0f)};
}

std::vector<glm::dmat4> poseJoints(const ClipJoints& joints, const MotionTree& tree,
                                   const std::vector<glm::vec2>& amplitudes) {
  std::vector<glm::dmat4> poses(joints.joints.size(), glm::dmat4(1.0));
  parallelFor(poses.size(), 64, [&](std::size_t j) {
    const ClipJoint& joint = joints.joints[j];
    if (joint.branch == kNone) return;
    glm::dmat4 pose(1.0);
    pose[3] = glm::dvec4(glm::dvec3(joint.pivot), 1.0);
    float place = joint.place;
    // From its own branch to the trunk: what a branch carries moves with its section.
    for (std::uint32_t b = joint.branch; b != kNone; b = tree.branches[b].parent) {
      // Branches without joints are stiff.
      if (joints.first_of[b] != kNone)
        pose = matrixOf(tree.branches[b], place, amplitudes[b]) * pose;
      place = tree.branches[b].place;
    }
    poses[j] = pose;
  });
  return poses;
}

}  // namespace verdure
