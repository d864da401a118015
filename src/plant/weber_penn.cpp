#include "plant/weber_penn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "plant/stem_growth.h"
#include "verdure/error.h"

namespace verdure {
namespace {

using namespace growth;

/// Place and frame at `along` metres on a stem.
std::pair<glm::vec3, glm::quat> placeOn(const Stem& stem, float along) {
  const auto above = std::upper_bound(stem.along.begin(), stem.along.end(), along);
  const auto hi = std::clamp<std::size_t>(static_cast<std::size_t>(above - stem.along.begin()), 1,
                                          stem.along.size() - 1);
  const std::size_t lo = hi - 1;
  const float t =
      std::clamp((along - stem.along[lo]) / (stem.along[hi] - stem.along[lo]), 0.0f, 1.0f);
  return {glm::mix(stem.points[lo].position, stem.points[hi].position, t),
          glm::slerp(stem.frames[lo], stem.frames[hi], t)};
}

/// Turns from child to child around a parent (nRotate).
class Spiral {
 public:
  Spiral(const LevelParameters& level, Random& random)
      : level_(level), random_(random), angle_(random.uniform(0, 360)) {}
  float next() {
    if (level_.rotate >= 0) {
      angle_ += level_.rotate + random_.vary(level_.rotate_v);
      return radiansOf(angle_);
    }
    // Negative: alternately to both sides, 180 + nRotate away from the middle.
    side_ = -side_;
    return radiansOf(side_ * (180 + level_.rotate + random_.vary(level_.rotate_v)));
  }

 private:
  const LevelParameters& level_;
  Random& random_;
  float angle_;
  float side_ = 1;
};

float downAngle(const Tree& tree, const LevelParameters& level, const Stem& parent, float offset,
                Random& random) {
  if (level.down_angle_v >= 0) return radiansOf(level.down_angle + random.vary(level.down_angle_v));
  // Negative variation: the angle changes along the parent.
  const float bare = tree.bareLength(parent);
  const float ratio = (parent.length - offset) / std::max(parent.length - bare, 1e-6f);
  return radiansOf(level.down_angle + level.down_angle_v * (1 - 2 * shapeRatio(0, ratio, tree.p)));
}

/// A whole number with the mean `x`.
int roundAtRandom(float x, Random& random) {
  return static_cast<int>(std::floor(std::max(x, 0.0f) + random.uniform()));
}

std::vector<Bud> budsOf(const Tree& tree, const Stem& parent, std::uint32_t parent_index) {
  const int n = parent.level + 1;
  const LevelParameters& level = tree.p.at(n);
  Random random(hash(parent.stream ^ 0x62756473ull));
  const float bare = tree.bareLength(parent);
  // Numbers of children, section 4.3.
  float most = level.branches;
  if (parent.level == 1) {
    const float share = parent.length / parent.parent_length / std::max(parent.length_share, 1e-6f);
    most *= 0.2f + 0.8f * std::min(share, 1.0f);
  } else if (parent.level > 1) {
    most *= 1.0f - 0.5f * parent.offset / parent.parent_length;
  }
  const float low = std::max(bare, parent.start);
  const float carrying = parent.length - low;
  const int count = roundAtRandom(most * carrying / std::max(parent.length - bare, 1e-6f), random);
  std::vector<Bud> buds;
  Spiral spiral(level, random);
  for (int k = 0; k < count; ++k) {
    Bud bud;
    const float t = (static_cast<float>(k) + 0.5f + random.vary(0.35f)) / static_cast<float>(count);
    bud.offset = low + carrying * t;
    bud.parent = parent_index;
    bud.parent_length = parent.length;
    bud.level = n;
    bud.stream = hash(parent.stream + 0x51ed270b0ull * static_cast<std::uint64_t>(k + 1));
    const auto [position, frame] = placeOn(parent, bud.offset);
    bud.position = position;
    const float turn = spiral.next();
    bud.frame = glm::normalize(frame * aboutZ(turn) *
                               aboutX(downAngle(tree, level, parent, bud.offset, random)));
    bud.length_share = std::max(level.length + random.vary(level.length_v), 0.0f);
    if (n == 1) {
      const float ratio = (parent.length - bud.offset) / std::max(parent.length - bare, 1e-6f);
      bud.length = parent.length * bud.length_share *
                   shapeRatio(static_cast<int>(tree.p.shape), ratio, tree.p);
    } else {
      bud.length = bud.length_share * (parent.length - 0.6f * bud.offset);
    }
    // Twigs thinner than a millimetre across would vanish.
    bud.radius =
        std::max(std::min(parent.radius * std::pow(bud.length / parent.length, tree.p.ratio_power),
                          tree.radiusAt(parent, bud.offset)),
                 0.0006f);
    buds.push_back(bud);
  }
  return buds;
}

/// Turns a leaf towards the light by the fraction LeafBend (section 4.9): first its azimuth away
/// from the trunk, then its upper side up.
glm::quat bendToLight(const glm::quat& frame, const glm::vec3& position, float bend) {
  glm::vec3 normal = frame * glm::vec3(0, 1, 0);
  float azimuth = std::atan2(position.z, position.x) - std::atan2(normal.z, normal.x);
  azimuth = std::remainder(azimuth, 2 * kPi);
  // A turn by +a about +Y lowers atan2(z, x) by a.
  glm::quat result = glm::angleAxis(-bend * azimuth, kUp) * frame;
  normal = result * glm::vec3(0, 1, 0);
  const glm::vec3 axis = glm::cross(normal, kUp);
  const float size = glm::length(axis);
  if (size > 1e-6f) result = glm::angleAxis(bend * declination(normal), axis / size) * result;
  return glm::normalize(result);
}

/// `mean_length`: of all stems that carry leaves. The paper gives each of them the same number,
/// however short, which crowds the leaves of short branches at the top; LeafByLength moves them to
/// the long ones and keeps their sum about the same.
std::vector<LeafPlace> leavesOf(const Tree& tree, const Stem& stem, float mean_length,
                                std::uint32_t index) {
  const TreeParameters& p = tree.p;
  const LevelParameters& level = p.at(stem.level + 1);
  Random random(hash(stem.stream ^ 0x6c656166ull));
  const bool fan = p.leaves < 0;
  float wanted = std::abs(p.leaves) * p.leaf_quality;
  if (!fan && stem.level > 0)
    wanted *= shapeRatio(static_cast<int>(p.leaf_distrib),
                         std::clamp(stem.offset / stem.parent_length, 0.0f, 1.0f), p);
  if (!fan) wanted *= (stem.length - stem.start) / stem.length;
  if (!fan && p.leaf_by_length > 0) wanted *= std::pow(stem.length / mean_length, p.leaf_by_length);
  const int count = roundAtRandom(wanted, random);
  std::vector<LeafPlace> leaves;
  Spiral spiral(level, random);
  const float size = p.leaf_scale / std::sqrt(p.leaf_quality);
  for (int k = 0; k < count; ++k) {
    const float place = (static_cast<float>(k) + 1) / static_cast<float>(count);
    const float offset =
        fan ? stem.length : stem.start + (stem.length - stem.start) * (0.06f + 0.94f * place);
    const auto [position, frame] = placeOn(stem, offset);
    glm::quat turned;
    const float down = radiansOf(level.down_angle + random.vary(std::abs(level.down_angle_v)));
    if (fan) {
      // Spread over nRotate degrees in the plane of x and z, each leaf lowered by nDownAngle.
      const float spread =
          count > 1 ? (static_cast<float>(k) / static_cast<float>(count - 1) - 0.5f) : 0.0f;
      turned = frame * aboutY(radiansOf(spread * level.rotate + random.vary(level.rotate_v))) *
               aboutX(down);
    } else {
      turned = frame * aboutZ(spiral.next()) * aboutX(down);
    }
    LeafPlace leaf;
    const float radius = tree.radiusAt(stem, offset);
    leaf.position = position;
    leaf.frame = bendToLight(glm::normalize(turned), position, p.leaf_bend);
    // The foot sits on the bark; leaves of a fan part by a hair, so that each stays one piece.
    leaf.position += alongOf(leaf.frame) * (0.7f * radius + (fan ? 0.01f * size : 0.0f));
    const float variation = random.uniform(0.82f, 1.12f);
    leaf.length = size * variation;
    leaf.width = leaf.length * p.leaf_scale_x;
    leaf.branch = index;
    leaf.noise = random.next();
    leaves.push_back(leaf);
  }
  return leaves;
}

Tree makeTree(const TreeParameters& p, std::uint64_t seed) {
  Random random(hash(seed ^ 0x74726565ull));
  Tree tree{p};
  tree.height = std::max(p.scale + random.vary(p.scale_v), 0.2f * p.scale);
  tree.z_scale = std::max(p.z_scale + random.vary(p.z_scale_v), 0.05f);
  tree.trunk_scale = std::max(p.scale0 + random.vary(p.scale0_v), 0.05f);
  tree.trunk_length =
      std::max(p.level[0].length + random.vary(p.level[0].length_v), 0.01f) * tree.height;
  tree.base_length = std::min(p.base_size * tree.height, 0.95f * tree.trunk_length);
  return tree;
}

/// Throws Error if `parents` stems with `each` children would be more than any plant needs.
void checkCount(std::size_t parents, float each, const std::string& name) {
  constexpr double kMost = 3e6;
  const double count = static_cast<double>(parents) * static_cast<double>(each);
  if (count > kMost)
    throw Error("parameter " + name, fmt::format("asks for up to {:.0f} of them", count),
                fmt::format("keep the whole tree below {:.0f}, by this or a lower level", kMost));
}

}  // namespace

Skeleton growSkeleton(const TreeParameters& p, std::uint64_t seed) {
  const Tree tree = makeTree(p, seed);
  Skeleton skeleton;
  skeleton.height = tree.height;
  skeleton.z_scale = tree.z_scale;
  std::vector<Stem>& stems = skeleton.stems;
  const auto append = [&](std::vector<Stem>&& group, const Bud& bud) {
    const auto first = static_cast<std::uint32_t>(stems.size());
    for (Stem& stem : group) {
      stem.parent = stem.parent == kNone ? bud.parent : first + stem.parent;
      stems.push_back(std::move(stem));
    }
  };

  Bud trunk;
  trunk.frame = aboutX(-kPi / 2) * aboutZ(Random(hash(seed)).uniform(0, 2 * kPi));
  trunk.length = tree.trunk_length;
  trunk.length_share = p.level[0].length;
  trunk.radius = tree.trunk_length * p.ratio;
  trunk.stream = hash(seed + 0x7472756e6bull);
  append(growGroup(tree, trunk), trunk);

  std::size_t begin = 0;
  for (int level = 1; level < static_cast<int>(p.levels); ++level) {
    const std::size_t end = stems.size();
    checkCount(end - begin, p.at(level).branches, std::to_string(level) + "Branches");
    std::vector<std::vector<Bud>> buds(end - begin);
    parallelFor(end - begin, 16, [&](std::size_t i) {
      buds[i] = budsOf(tree, stems[begin + i], static_cast<std::uint32_t>(begin + i));
    });
    std::vector<const Bud*> order;
    for (const auto& list : buds)
      for (const Bud& bud : list) order.push_back(&bud);
    std::vector<std::vector<Stem>> groups(order.size());
    parallelFor(order.size(), 32, [&](std::size_t i) { groups[i] = growGroup(tree, *order[i]); });
    for (std::size_t i = 0; i < order.size(); ++i) append(std::move(groups[i]), *order[i]);
    begin = end;
  }

  checkCount(stems.size() - begin, std::abs(p.leaves) * p.leaf_quality, "Leaves");
  double mean_length = 0;
  for (std::size_t i = begin; i < stems.size(); ++i)
    mean_length += double{stems[i].length} / static_cast<double>(stems.size() - begin);
  std::vector<std::vector<LeafPlace>> leaves(stems.size() - begin);
  parallelFor(leaves.size(), 32, [&](std::size_t i) {
    leaves[i] = leavesOf(tree, stems[begin + i], static_cast<float>(mean_length),
                         static_cast<std::uint32_t>(begin + i));
  });
  std::size_t count = 0;
  for (const auto& list : leaves) count += list.size();
  skeleton.leaves.reserve(count);
  for (const auto& list : leaves)
    skeleton.leaves.insert(skeleton.leaves.end(), list.begin(), list.end());
  return skeleton;
}

}  // namespace verdure
