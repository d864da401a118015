#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "base/parallel.h"
#include "motion/beam.h"
#include "verdure/error.h"
#include "verdure/motion.h"

namespace verdure {
namespace {

/// Below this place of a trunk, what parts from it hardly moves with it: u there is at most 0.04 of
/// the tip's.
constexpr float kRootPart = 0.15f;

/// Any unit vector across `t`, the same for the same t.
glm::vec3 across(const glm::vec3& t) {
  const glm::vec3 axis = std::abs(t.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  return glm::normalize(glm::cross(t, axis));
}

/// A polyline's places by length.
class Axis {
 public:
  explicit Axis(const Branch& branch) : points_(branch.points), reached_(points_.size(), 0.0f) {
    for (std::size_t i = 1; i < points_.size(); ++i)
      reached_[i] = reached_[i - 1] + glm::length(points_[i].position - points_[i - 1].position);
  }
  /// The place in [0, 1] of the polyline's point next to p.
  float placeOf(const glm::vec3& p) const {
    float best = std::numeric_limits<float>::max(), place = 0.0f;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const glm::vec3 a = points_[i].position, ab = points_[i + 1].position - a;
      const float square = glm::dot(ab, ab);
      const float along =
          square > 0.0f ? glm::clamp(glm::dot(p - a, ab) / square, 0.0f, 1.0f) : 0.0f;
      const glm::vec3 off = p - a - along * ab;
      if (glm::dot(off, off) >= best) continue;
      best = glm::dot(off, off);
      place = glm::mix(reached_[i], reached_[i + 1], along);
    }
    return reached_.back() > 0.0f ? place / reached_.back() : 0.0f;
  }

 private:
  const std::vector<BranchPoint>& points_;
  std::vector<float> reached_;
};

float volumeOf(const Branch& branch) {
  float sum = 0.0f;
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    const float a = branch.points[i - 1].radius, b = branch.points[i].radius;
    sum += glm::length(branch.points[i].position - branch.points[i - 1].position) *
           (a * a + a * b + b * b);
  }
  return sum * glm::pi<float>() / 3.0f;
}

MotionBranch beamOf(const Branch& branch) {
  MotionBranch beam;
  beam.root = branch.points.front().position;
  const glm::vec3 chord = branch.points.back().position - beam.root;
  beam.length = std::max(glm::length(chord), 1e-4f);
  if (glm::length(chord) > 1e-4f) beam.t = glm::normalize(chord);
  beam.r = across(beam.t);
  beam.s = glm::cross(beam.t, beam.r);
  beam.root_radius = branch.points.front().radius;
  beam.tip_radius = branch.points.back().radius;
  const float thick = std::max(beam.root_radius, 1e-6f);
  beam.fit = glm::vec2(fitBeam(beam.tip_radius / thick));
  return beam;
}

/// Where a branch of the plant is within the tree of beams.
struct Hung {
  std::uint32_t beam = kNone;
  bool own = true;  ///< the beam is the branch itself; else it rides at `places` of it
  glm::vec4 places{0.0f};
};

}  // namespace

MotionTree motionTree(const Plant& plant) {
  if (plant.branches.empty())
    throw Error("motion of " + plant.name, "its branches are not known",
                "grow the plant, or find its branches first");
  MotionTree tree;
  std::vector<Hung> hung(plant.branches.size());
  std::vector<Axis> axes;
  for (const Branch& branch : plant.branches) axes.emplace_back(branch);
  /// Where a point of branch b is along the beams.
  const auto placesAt = [&](std::uint32_t b, const glm::vec3& p) {
    glm::vec4 places = hung[b].places;
    if (hung[b].own) places[tree.branches[hung[b].beam].level] = axes[b].placeOf(p);
    return places;
  };
  for (std::uint32_t b = 0; b < plant.branches.size(); ++b) {
    const Branch& branch = plant.branches[b];
    // Trunks that part at their foot stand side by side.
    std::uint32_t parent = branch.parent;
    while (parent != kNone && branch.level == 0 &&
           axes[parent].placeOf(branch.points.front().position) < kRootPart)
      parent = plant.branches[parent].parent;
    MotionBranch beam = beamOf(branch);
    if (parent != kNone) {
      const std::uint32_t carrier = hung[parent].beam;
      const glm::vec4 places = placesAt(parent, beam.root);
      beam.level = tree.branches[carrier].level + 1;
      if (beam.level >= kMotionLevels) {
        hung[b] = {carrier, false, places};
        continue;
      }
      beam.parent = carrier;
      beam.place = places[beam.level - 1];
      hung[b].places = places;
    }
    hung[b].beam = static_cast<std::uint32_t>(tree.branches.size());
    tree.branches.push_back(beam);
  }
  for (std::uint32_t b = 0; b < plant.branches.size(); ++b) {
    const float wood = volumeOf(plant.branches[b]);
    for (std::uint32_t beam = hung[b].beam; beam != kNone; beam = tree.branches[beam].parent)
      tree.branches[beam].wood_m3 += wood;
  }
  for (const Leaf& leaf : plant.leaves) {
    if (leaf.branch == kNone) continue;
    for (std::uint32_t beam = hung[leaf.branch].beam; beam != kNone;
         beam = tree.branches[beam].parent)
      tree.branches[beam].leaf_m2 += leaf.area;
  }

  for (const Mesh& mesh : plant.meshes) {
    std::vector<VertexMotion>& motion = tree.meshes.emplace_back(mesh.positions.size());
    if (mesh.branch_of_vertex.empty()) continue;
    parallelFor(motion.size(), 1 << 12, [&](std::size_t v) {
      const std::uint32_t b = mesh.branch_of_vertex[v];
      if (b == kNone) return;
      motion[v] = {hung[b].beam, placesAt(b, mesh.positions[v])};
    });
  }
  for (std::uint32_t i = 0; i < plant.leaves.size(); ++i) {
    const Leaf& leaf = plant.leaves[i];
    if (leaf.branch == kNone) continue;
    const VertexMotion whole{hung[leaf.branch].beam, placesAt(leaf.branch, leaf.stalk), i};
    const Mesh& mesh = plant.meshes[leaf.mesh];
    for (std::uint32_t k = 0; k < leaf.triangle_count; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        tree.meshes[leaf.mesh]
                   [mesh.indices[3 * std::size_t{plant.leaf_triangles[leaf.first_triangle + k]} +
                                 c]] = whole;
  }
  return tree;
}

}  // namespace verdure
