#include "interchange/wind_quantities.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "plant/gltf_attributes.h"
#include "plant/gltf_stems.h"
#include "shared/beam.h"

namespace verdure {
namespace {

/// [0, 1), of 256 steps, so that bytes hold it.
float phaseOfNumber(std::uint64_t number) {
  return static_cast<float>(hash(number) >> 56) / 256.0f;
}

constexpr std::uint64_t kLeafNumbers = std::uint64_t{1} << 32;  // leaves are no branches

}  // namespace

float packDirection(const glm::vec3& direction) {
  const glm::vec3 shares = glm::clamp(0.5f * direction + 0.5f, 0.0f, 0.999f);
  // Each component is in the digit of base 16 that its fraction begins with; z is what remains.
  const float y = std::clamp(std::round(16.0f * shares.y - shares.z), 0.0f, 15.0f);
  const float fraction = (y + shares.z) / 16.0f;
  const float x = std::clamp(std::round(16.0f * shares.x - fraction), 0.0f, 15.0f);
  return x + fraction;
}

glm::ivec2 elementTextureSize(std::size_t elements) {
  glm::ivec2 size(1);
  while (static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) < elements)
    (size.x <= size.y ? size.x : size.y) *= 2;
  return size;
}

WindQuantities::WindQuantities(const Plant& plant, const PlantMotion& motion)
    : plant_(plant),
      motion_(motion),
      stems_(stemIds(plant)),
      element_size_(elementTextureSize(motion.tree.branches.size())) {
  const std::vector<MotionBranch>& branches = motion.tree.branches;
  for (const std::vector<VertexMotion>& mesh : motion.tree.meshes) {
    std::vector<Bend>& bends = bends_.emplace_back(mesh.size());
    parallelFor(mesh.size(), 1 << 12, [&](std::size_t v) {
      for (std::uint32_t b = mesh[v].branch; b != kNone; b = branches[b].parent) {
        const MotionBranch& branch = branches[b];
        const BranchMotion& swing = motion.branches[b];
        const float tip = (swing.mean + swing.swing) * branch.length;
        const float share = shared::beamDeflection(branch.fit, mesh[v].places[branch.level]) /
                            shared::beamDeflection(branch.fit, 1.0f);
        (branch.level == 0 ? bends[v].tree : bends[v].branch) += tip * std::max(share, 0.0f);
      }
    });
    for (const Bend& bend : bends) {
      largest_.tree = std::max(largest_.tree, bend.tree);
      largest_.branch = std::max(largest_.branch, bend.branch);
      largest_.sway = std::max(largest_.sway, bend.tree + bend.branch);
    }
  }
}

std::uint32_t WindQuantities::boughOf(std::uint32_t beam) const {
  while (beam != kNone && motion_.tree.branches[beam].level > 1)
    beam = motion_.tree.branches[beam].parent;
  return beam;
}

float WindQuantities::phaseOf(std::uint32_t beam) const {
  const std::uint32_t bough = boughOf(beam);
  return bough == kNone ? 0.0f : phaseOfNumber(bough);
}

float WindQuantities::of(WindQuantity quantity, std::size_t mesh, std::size_t vertex,
                         const glm::dmat4& plant_from_local) const {
  const Mesh& part = plant_.meshes[mesh];
  const VertexMotion& motion = motion_.tree.meshes[mesh][vertex];
  const MotionBranch* const branch =
      motion.branch == kNone ? nullptr : &motion_.tree.branches[motion.branch];
  const LeafMotion* const leaf = motion.leaf == kNone ? nullptr : &motion_.leaves[motion.leaf];
  const Bend& bend = bends_[mesh][vertex];
  const auto share = [](float part_of, float all) { return all > 0.0f ? part_of / all : 0.0f; };
  const auto local = [&](const glm::vec3& p, int axis) {
    return localPoint(plant_from_local, p)[axis];
  };
  // Directions as the mesh's own coordinates have them; the file's transforms are rarely skewed.
  const auto packed = [&](const glm::vec3& direction) {
    const glm::dvec3 d = glm::inverse(glm::dmat3(plant_from_local)) * glm::dvec3(direction);
    return packDirection(glm::vec3(glm::normalize(d)));
  };
  const auto ordinal = [](WindQuantity q) { return static_cast<int>(q); };
  switch (quantity) {
    case WindQuantity::kZero:
      return 0.0f;
    case WindQuantity::kOne:
      return 1.0f;
    case WindQuantity::kTreeBend:
      return share(bend.tree, largest_.tree);
    case WindQuantity::kBranchBend:
      return share(bend.branch, largest_.branch);
    case WindQuantity::kSway:
      return share(bend.tree + bend.branch, largest_.sway);
    case WindQuantity::kStillness:
      return 1.0f - share(bend.tree + bend.branch, largest_.sway);
    case WindQuantity::kBranchPhase:
      return phaseOf(motion.branch);
    case WindQuantity::kLeafPhase:
      return leaf == nullptr ? phaseOf(motion.branch) : phaseOfNumber(kLeafNumbers + motion.leaf);
    case WindQuantity::kLeafEdge:
      return leaf == nullptr
                 ? 0.0f
                 : std::min(share(glm::length(part.positions[vertex] - leaf->stalk), leaf->reach),
                            1.0f);
    case WindQuantity::kOpenness:
      return part.ambient.empty() ? 1.0f : part.ambient[vertex];
    case WindQuantity::kStem:
      return stems_.empty() ? -1.0f : stems_[mesh][vertex];
    case WindQuantity::kBranch:
      return branch == nullptr ? -1.0f : static_cast<float>(motion.branch);
    case WindQuantity::kLevel:
      return branch == nullptr ? 0.0f : static_cast<float>(branch->level);
    case WindQuantity::kPlace0:
    case WindQuantity::kPlace1:
    case WindQuantity::kPlace2:
    case WindQuantity::kPlace3:
      return motion.places[ordinal(quantity) - ordinal(WindQuantity::kPlace0)];
    case WindQuantity::kLength:
      return branch == nullptr ? 0.0f : branch->length;
    case WindQuantity::kPivotX:
    case WindQuantity::kPivotY:
    case WindQuantity::kPivotZ:
      return local(branch == nullptr ? part.positions[vertex] : branch->root,
                   ordinal(quantity) - ordinal(WindQuantity::kPivotX));
    case WindQuantity::kAnchorX:
    case WindQuantity::kAnchorY:
    case WindQuantity::kAnchorZ:
      return local(leaf == nullptr ? part.positions[vertex] : leaf->stalk,
                   ordinal(quantity) - ordinal(WindQuantity::kAnchorX));
    case WindQuantity::kX:
    case WindQuantity::kY:
    case WindQuantity::kZ:
      return local(part.positions[vertex], ordinal(quantity) - ordinal(WindQuantity::kX));
    case WindQuantity::kU:
      return part.uvs.empty() ? 0.0f : part.uvs[vertex].x;
    case WindQuantity::kV:
      return part.uvs.empty() ? 0.0f : part.uvs[vertex].y;
    case WindQuantity::kElementU:
    case WindQuantity::kElementV: {
      const int element = branch == nullptr ? 0 : static_cast<int>(motion.branch);
      return quantity == WindQuantity::kElementU
                 ? (static_cast<float>(element % element_size_.x) + 0.5f) /
                       static_cast<float>(element_size_.x)
                 : (static_cast<float>(element / element_size_.x) + 0.5f) /
                       static_cast<float>(element_size_.y);
    }
    case WindQuantity::kSwayDirection: {
      const std::uint32_t bough = boughOf(motion.branch);
      if (bough == kNone) return packDirection(glm::vec3(0, 1, 0));
      const MotionBranch& carrier = motion_.tree.branches[bough];
      const glm::vec3 up = glm::vec3(0, 1, 0) - carrier.t.y * carrier.t;
      return packed(glm::length(up) > 0.2f ? up : carrier.r);
    }
    case WindQuantity::kLeafAxis:
      return leaf == nullptr ? 0.0f : packed(leaf->axis);
    case WindQuantity::kLeafNormal:
      return leaf == nullptr ? 0.0f : packed(leaf->normal);
    case WindQuantity::kSpeedTreeGeometry:
      return leaf == nullptr ? 0.0f : 2.0f;
  }
  return 0.0f;
}

}  // namespace verdure
