#include "interchange/clip_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "base/parallel.h"
#include "shared/beam.h"

namespace verdure {
namespace {

constexpr std::uint32_t kMostSegments = 15;
constexpr float kSpacing = 0.7f;

/// Joints stand closer towards the tip, where a tapered beam bends most.
float placeOf(std::uint32_t joint, std::uint32_t segments) {
  return std::pow(static_cast<float>(joint) / static_cast<float>(segments), kSpacing);
}

/// Mean square over a branch by which vertices are off, as share of its tip's way: stiff, or
/// between two joints, which each show the beam's tangent.
double lossOf(const glm::vec2& fit, std::uint32_t segments) {
  constexpr int kSamples = 24;
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / kSamples;
    float shown = 0.0f;
    if (segments > 0) {
      std::uint32_t j = 0;
      while (j + 2 <= segments && placeOf(j + 1, segments) <= x) ++j;
      const float a = placeOf(j, segments), b = placeOf(j + 1, segments);
      const auto tangent = [&](float at) {
        return shared::beamDeflection(fit, at) + shared::beamSlope(fit, at) * (x - at);
      };
      shown = glm::mix(tangent(a), tangent(b), (x - a) / (b - a));
    }
    const double off = double{shown - shared::beamDeflection(fit, x)};
    sum += off * off / kSamples;
  }
  const double tip = double{shared::beamDeflection(fit, 1.0f)};
  return sum / (tip * tip);
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
  ClipJoints chosen;
  chosen.segments_of.assign(branches.size(), 0);
  struct Offer {
    double gain;  ///< for each joint that it takes
    std::uint32_t branch, segments;
    bool operator<(const Offer& other) const {
      return gain != other.gain ? gain < other.gain : branch > other.branch;
    }
  };
  std::priority_queue<Offer> offers;
  // Joints that n segments take beyond those that the branch has.
  const auto more = [&](std::uint32_t b, std::uint32_t n) {
    return n - chosen.segments_of[b] + (chosen.segments_of[b] == 0 ? 1 : 0);
  };
  std::vector<std::array<double, kMostSegments + 1>> losses(branches.size());
  parallelFor(branches.size(), 16, [&](std::size_t b) {
    for (std::uint32_t n = 0; n <= kMostSegments; ++n) losses[b][n] = lossOf(branches[b].fit, n);
  });
  // One segment can be worse than none: the next number of them is the one that each joint is
  // worth most for.
  const auto offer = [&](std::uint32_t b) {
    const double way =
        double{branches[b].length} * double{motion.branches[b].mean + motion.branches[b].swing};
    Offer best{0.0, b, 0};
    for (std::uint32_t n = chosen.segments_of[b] + 1; n <= kMostSegments; ++n) {
      const double gain =
          carried[b] * way * way * (losses[b][chosen.segments_of[b]] - losses[b][n]) / more(b, n);
      if (gain > best.gain) best = {gain, b, n};
    }
    if (best.segments > 0) offers.push(best);
  };
  for (std::uint32_t b = 0; b < branches.size(); ++b) offer(b);
  std::size_t count = 1;
  while (!offers.empty() && count < most) {
    const Offer next = offers.top();
    offers.pop();
    if (count + more(next.branch, next.segments) > most) continue;
    count += more(next.branch, next.segments);
    chosen.bent_branches += chosen.segments_of[next.branch] == 0;
    chosen.segments_of[next.branch] = next.segments;
    offer(next.branch);
  }
  chosen.joints.emplace_back();
  chosen.first_of.assign(branches.size(), kNone);
  for (std::uint32_t b = 0; b < branches.size(); ++b) {
    if (chosen.segments_of[b] == 0) continue;
    chosen.first_of[b] = static_cast<std::uint32_t>(chosen.joints.size());
    const std::uint32_t n = chosen.segments_of[b] + 1;
    // It hangs on the last joint below its root of the next branch with joints.
    VertexMotion root;
    root.branch = branches[b].parent;
    for (std::uint32_t c = b; branches[c].parent != kNone; c = branches[c].parent)
      root.places[branches[c].level - 1] = branches[c].place;
    std::uint32_t parent = weightsOf(chosen, motion.tree, root).low;
    for (std::uint32_t j = 0; j < n; ++j) {
      const float place = placeOf(j, n - 1);
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
  const std::uint32_t steps = joints.segments_of[b];
  const float place = vertex.places[level];
  const std::uint32_t first = joints.first_of[b];
  std::uint32_t j = first;
  while (j + 2 <= first + steps && joints.joints[j + 1].place <= place) ++j;
  const float a = joints.joints[j].place, reach = joints.joints[j + 1].place - a;
  return {j, j + 1, std::clamp((place - a) / reach, 0.0f, 1.0f)};
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
