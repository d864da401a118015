#include "plant/weber_penn.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "base/random.h"

namespace verdure {
namespace {

constexpr float kPi = 3.14159265358979f;
const glm::vec3 kUp(0, 1, 0);
/// Radii stay above this, m, so that no ring of a stem's mesh shrinks to a point.
constexpr float kThinnest = 1e-5f;

float radiansOf(float degrees) {
  return degrees * (kPi / 180.0f);
}

glm::quat aboutX(float angle) {
  return glm::angleAxis(angle, glm::vec3(1, 0, 0));
}
glm::quat aboutY(float angle) {
  return glm::angleAxis(angle, glm::vec3(0, 1, 0));
}
glm::quat aboutZ(float angle) {
  return glm::angleAxis(angle, glm::vec3(0, 0, 1));
}
glm::vec3 alongOf(const glm::quat& frame) {
  return frame * glm::vec3(0, 0, 1);
}

float declination(const glm::vec3& direction) {
  return std::acos(std::clamp(direction.y, -1.0f, 1.0f));
}

/// A stem before it grows.
struct Bud {
  std::uint32_t parent = kNone;
  int level = 0;
  float offset = 0, parent_length = 1;
  glm::vec3 position{0.0f};
  glm::quat frame{};
  float length = 0, length_share = 1, radius = 0;
  std::uint64_t stream = 0;
};

/// What all stems of one tree share.
struct Tree {
  const TreeParameters& p;
  float height = 0;  ///< scale_tree of the paper
  float z_scale = 1;
  float trunk_scale = 1;
  float trunk_length = 0;
  float base_length = 0;

  float radiusAt(const Stem& stem, float along) const {
    const float z = std::clamp(along / stem.length, 0.0f, 1.0f);
    float r = taperedRadius(p.at(stem.level).taper, z, stem.radius, stem.length);
    if (stem.level == 0) r *= trunk_scale * flareFactor(p.flare, z);
    return std::max(r, kThinnest);
  }
  /// Length of a stem at the foot that carries no children, m.
  float bareLength(const Stem& stem) const { return stem.level == 0 ? base_length : 0.0f; }
};

/// A node of a stem's curve: where it bends and splits.
struct Node {
  glm::vec3 position{0.0f};
  glm::quat in{}, out{};
};

/// Grows one stem and its clones (the original first). All random numbers come from bud.stream, so
/// that growing it again with another length keeps its form.
class StemGrower {
 public:
  StemGrower(const Tree& tree, const Bud& bud, float length)
      : tree_(tree), bud_(bud), level_(tree.p.at(bud.level)), length_(length) {
    segments_ = static_cast<int>(level_.curve_res);
    // A helix needs a few segments a turn whatever CurveRes says.
    if (level_.curve_v < 0) segments_ = std::max(segments_, 8);
    segment_length_ = length_ / static_cast<float>(segments_);
  }

  std::vector<Stem> grow() {
    Random random(bud_.stream);
    const float first_error = random.uniform(-0.5f, 0.5f);
    Node first;
    first.position = bud_.position;
    first.in = first.out = bud_.frame;
    extend(kNone, 0, first, bud_.frame, 0.0f, first_error, bud_.stream);
    return std::move(stems_);
  }

 private:
  float curveOf(int segment) const {
    const float half = 0.5f * static_cast<float>(segments_);
    if (level_.curve_back == 0.0f) return level_.curve / static_cast<float>(segments_);
    return (static_cast<float>(segment) + 0.5f < half ? level_.curve : level_.curve_back) / half;
  }

  /// Frame at the end of a segment. `straighten`: the part of an earlier split's angle that each
  /// following segment gives back.
  glm::quat bend(const glm::quat& frame, int segment, float straighten, Random& random) const {
    const float variation = std::max(level_.curve_v, 0.0f) / static_cast<float>(segments_);
    // The paper varies the bend about x alone, which leaves each stem in one plane; half of the
    // variation goes to y as well.
    const float x = radiansOf(curveOf(segment) + random.vary(variation)) - straighten;
    const float y = radiansOf(random.vary(0.5f * variation));
    glm::quat next = frame * aboutX(x) * aboutY(y);
    if (bud_.level >= 2 && tree_.p.attraction_up != 0.0f) {
      // Vertical attraction: the paper's turn about x, AttractionUp * declination *
      // cos(orientation) / CurveRes, is the x part of this vector.
      const glm::vec3 along = alongOf(next);
      const glm::vec3 turn = glm::cross(along, kUp) * (tree_.p.attraction_up * declination(along) /
                                                       static_cast<float>(segments_));
      const float angle = glm::length(turn);
      if (angle > 1e-6f) {
        // Never beyond the vertical.
        const float limit =
            tree_.p.attraction_up > 0 ? declination(along) : kPi - declination(along);
        next = glm::angleAxis(std::min(angle, limit), turn / angle) * next;
      }
    }
    return glm::normalize(next);
  }

  /// Frame of a helical stem (nCurveV < 0): one turn about the stem's axis, at a slope of
  /// |nCurveV|.
  glm::quat helix(const glm::quat& axis, int node) const {
    const float turn = 2 * kPi * static_cast<float>(node) / static_cast<float>(segments_);
    return axis * aboutZ(turn) * aboutX(radiansOf(-level_.curve_v)) * aboutZ(-turn);
  }

  /// Grows from node `first_index` to the tip.
  void extend(std::uint32_t original, int first_index, const Node& first,
              const glm::quat& first_axis, float straighten, float error, std::uint64_t stream) {
    const auto self = static_cast<std::uint32_t>(stems_.size());
    VERDURE_CHECK_LT(stems_.size(), std::size_t{100000});
    stems_.emplace_back();
    Random random(hash(stream ^ 0x73746d65ull));
    std::vector<Node> nodes{first};
    glm::quat axis = first_axis;  // of a helix
    if (level_.curve_v < 0) nodes[0].out = helix(axis, first_index);
    for (int i = first_index; i < segments_; ++i) {
      Node next;
      if (level_.curve_v < 0) {
        axis = bend(axis, i, straighten, random);
        next.in = helix(axis, i + 1);
      } else {
        next.in = bend(nodes.back().out, i, straighten, random);
      }
      glm::vec3 step = glm::normalize(alongOf(nodes.back().out) + alongOf(next.in));
      step.y *= tree_.z_scale;
      next.position = nodes.back().position + segment_length_ * step;
      next.out = next.in;
      if (i + 1 < segments_) {
        const int splits = splitsAt(i, error);
        if (splits > 0) split(self, i + 1, splits, next, axis, straighten, error, stream, random);
      }
      nodes.push_back(next);
    }
    finish(stems_[self], nodes, first_index, original, stream);
  }

  /// Number of clones after a segment; spreads fractions over segments (Floyd and Steinberg's error
  /// diffusion, as in the paper, but along each stem, so that stems do not depend on each other).
  int splitsAt(int segment, float& error) const {
    if (bud_.level == 0 && segment == 0 && tree_.p.base_splits > 0)
      return static_cast<int>(tree_.p.base_splits);
    if (level_.seg_splits <= 0) return 0;
    const float effective = std::max(0.0f, std::round(level_.seg_splits + error));
    error -= effective - level_.seg_splits;
    // Clones of clones grow without bound when each segment splits: stop at a sane number.
    return stems_.size() > 200 ? 0 : static_cast<int>(effective);
  }

  void split(std::uint32_t self, int index, int splits, Node& node, glm::quat& axis,
             float& straighten, float& error, std::uint64_t stream, Random& random) {
    const bool helical = level_.curve_v < 0;
    const glm::quat frame = helical ? axis : node.in;
    const float tilt = declination(alongOf(frame));
    const auto angleOf = [&] {
      return std::max(0.0f,
                      radiansOf(level_.split_angle + random.vary(level_.split_angle_v)) - tilt);
    };
    const auto remaining = static_cast<float>(segments_ - index);
    // Where the trunk divides the stems spread evenly about the vertical; elsewhere by the paper's
    // 20 + 0.75 (30 + |declination - 90|) random^2 degrees, to either side.
    const bool even = bud_.level == 0 && splits > 1;
    const float first_turn = even ? random.uniform(0, 2 * kPi) : 0.0f;
    for (int c = 1; c <= splits; ++c) {
      const float angle = angleOf();
      float turn;
      if (even) {
        turn = 2 * kPi * static_cast<float>(c) / static_cast<float>(splits + 1) +
               random.vary(0.2f) + first_turn;
      } else {
        const float u = random.uniform();
        turn = radiansOf(20 + 0.75f * (30 + std::abs(tilt * 180 / kPi - 90)) * u * u) *
               static_cast<float>((c + 1) / 2);
        if ((c % 2 == 0) != (random.next() % 2 == 0)) turn = -turn;
      }
      const glm::quat turned = glm::normalize(glm::angleAxis(turn, kUp) * frame * aboutX(angle));
      Node clone = node;
      clone.out = turned;
      extend(self, index, clone, turned, straighten + angle / remaining, error,
             hash(stream + 0x9177ull * static_cast<std::uint64_t>(index * 64 + c)));
    }
    const float angle = angleOf();
    const glm::quat own = glm::normalize(glm::angleAxis(first_turn, kUp) * frame * aboutX(angle));
    straighten += angle / remaining;
    if (helical) {
      axis = own;
    } else {
      node.out = own;
    }
  }

  /// Turns nodes into a smooth polyline (cubic Hermite segments) with radii and frames.
  void finish(Stem& stem, const std::vector<Node>& nodes, int first_index, std::uint32_t original,
              std::uint64_t stream) const {
    stem.level = bud_.level;
    stem.length = length_;
    stem.length_share = bud_.length_share;
    stem.radius = bud_.radius;
    stem.stream = stream;
    stem.start = static_cast<float>(first_index) * segment_length_;
    // Clones hang on the stem they left; indices are local to the group until it is appended.
    stem.parent = original;
    stem.parent_along = original == kNone ? bud_.offset : stem.start;
    stem.offset = bud_.offset;
    stem.parent_length = bud_.parent_length;

    const auto tangent = [&](const Node& node) {
      return glm::normalize(alongOf(node.in) + alongOf(node.out));
    };
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const Node& a = nodes[i];
      const Node& b = nodes[i + 1];
      // A clone's first tangent is its original's, so that their surfaces start as one.
      const glm::vec3 ta = i == 0 && original != kNone ? alongOf(a.in) : tangent(a);
      const glm::vec3 tb = tangent(b);
      const float chord = glm::length(b.position - a.position);
      const float from = stem.start + static_cast<float>(i) * segment_length_;
      for (const float t : samples(from, std::acos(std::clamp(glm::dot(ta, tb), -1.0f, 1.0f)))) {
        const float t2 = t * t, t3 = t2 * t;
        BranchPoint point;
        point.position = (2 * t3 - 3 * t2 + 1) * a.position + (t3 - 2 * t2 + t) * chord * ta +
                         (3 * t2 - 2 * t3) * b.position + (t3 - t2) * chord * tb;
        const float along = from + t * segment_length_;
        point.radius = tree_.radiusAt(stem, along);
        stem.points.push_back(point);
        stem.along.push_back(along);
        stem.frames.push_back(glm::slerp(a.out, b.in, t));
      }
    }
    stem.points.push_back({nodes.back().position, tree_.radiusAt(stem, length_)});
    stem.along.push_back(length_);
    stem.frames.push_back(nodes.back().in);
  }

  /// Where to cut the segment that begins at `from` (m): 0 and as many more as its bend, its flare
  /// and its taper ask for.
  std::vector<float> samples(float from, float bend_angle) const {
    const float radius = tree_.p.at(bud_.level).taper < 1
                             ? bud_.radius
                             : bud_.radius * std::max(0.1f, 1 - from / length_);
    float step = radiansOf(radius > 0.02f ? 9.0f : radius > 0.005f ? 16.0f : 30.0f);
    int count = std::clamp(static_cast<int>(std::ceil(bend_angle / step)), 1, 8);
    if (bud_.level == 0) count = std::max(count, 3);
    if (level_.taper > 1.0f) {
      // Rounded ends and rows of spheres: a cut every third of a radius where the radius changes.
      const bool periodic = level_.taper > 2.0f;
      if (periodic || from + segment_length_ > length_ - 1.5f * bud_.radius)
        count = std::clamp(static_cast<int>(segment_length_ / (0.3f * bud_.radius)), count, 64);
    }
    std::vector<float> t;
    for (int k = 0; k < count; ++k) t.push_back(static_cast<float>(k) / static_cast<float>(count));
    if (bud_.level == 0 && tree_.p.flare > 0)
      for (const float z : {0.006f, 0.015f, 0.028f, 0.045f, 0.065f, 0.095f, 0.125f}) {
        const float at = (z * length_ - from) / segment_length_;
        if (at > 0.0f && at < 1.0f) t.push_back(at);
      }
    std::sort(t.begin(), t.end());
    t.erase(std::unique(t.begin(), t.end(), [](float a, float b) { return b - a < 0.004f; }),
            t.end());
    return t;
  }

  const Tree& tree_;
  const Bud& bud_;
  const LevelParameters& level_;
  float length_;
  int segments_ = 1;
  float segment_length_ = 0;
  std::vector<Stem> stems_;
};

bool inside(const Tree& tree, const std::vector<Stem>& group) {
  for (const Stem& stem : group)
    for (const BranchPoint& point : stem.points)
      if (!insideEnvelope(tree.p, tree.height, tree.z_scale, point.position)) return false;
  return true;
}

/// Grows a stem with its clones, pruned. Empty if pruning leaves nothing.
std::vector<Stem> growGroup(const Tree& tree, const Bud& bud) {
  float length = bud.length;
  if (length < 1e-4f) return {};
  std::vector<Stem> group = StemGrower(tree, bud, length).grow();
  if (bud.level == 0 || tree.p.prune_ratio <= 0 || inside(tree, group)) return group;
  // The paper: shorten and grow again with the same random numbers until the stem fits.
  float fit = length;
  for (int i = 0; i < 40; ++i) {
    fit *= 0.9f;
    group = StemGrower(tree, bud, fit).grow();
    if (inside(tree, group)) break;
    if (i == 39) fit = 0;
  }
  if (tree.p.prune_ratio >= 1) return fit > 0 ? std::move(group) : std::vector<Stem>{};
  length += tree.p.prune_ratio * (fit - length);
  return StemGrower(tree, bud, length).grow();
}

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

std::vector<LeafPlace> leavesOf(const Tree& tree, const Stem& stem, std::uint32_t index) {
  const TreeParameters& p = tree.p;
  const LevelParameters& level = p.at(stem.level + 1);
  Random random(hash(stem.stream ^ 0x6c656166ull));
  const bool fan = p.leaves < 0;
  float wanted = std::abs(p.leaves) * p.leaf_quality;
  if (!fan && stem.level > 0)
    wanted *= shapeRatio(static_cast<int>(p.leaf_distrib),
                         std::clamp(stem.offset / stem.parent_length, 0.0f, 1.0f), p);
  if (!fan) wanted *= (stem.length - stem.start) / stem.length;
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

}  // namespace

float shapeRatio(int shape, float ratio, const TreeParameters& p) {
  switch (shape) {
    case 0:
      return 0.2f + 0.8f * ratio;
    case 1:
      return 0.2f + 0.8f * std::sin(kPi * ratio);
    case 2:
      return 0.2f + 0.8f * std::sin(0.5f * kPi * ratio);
    case 3:
      return 1.0f;
    case 4:
      return 0.5f + 0.5f * ratio;
    case 5:
      return ratio <= 0.7f ? ratio / 0.7f : (1 - ratio) / 0.3f;
    case 6:
      return 1.0f - 0.8f * ratio;
    case 7:
      return ratio <= 0.7f ? 0.5f + 0.5f * ratio / 0.7f : 0.5f + 0.5f * (1 - ratio) / 0.3f;
    default:
      if (ratio < 0 || ratio > 1) return 0.0f;
      return ratio < 1 - p.prune_width_peak
                 ? std::pow(ratio / (1 - p.prune_width_peak), p.prune_power_high)
                 : std::pow((1 - ratio) / p.prune_width_peak, p.prune_power_low);
  }
}

float taperedRadius(float taper, float z, float radius, float length) {
  const float unit = taper < 1 ? taper : taper < 2 ? 2 - taper : 0.0f;
  const float cone = radius * (1 - unit * z);
  if (taper < 1) return cone;
  const float to_tip = (1 - z) * length;
  const float depth = taper < 2 || to_tip < cone ? 1.0f : taper - 2;
  const float in_sphere =
      taper < 2 ? to_tip : std::abs(to_tip - 2 * cone * std::floor(to_tip / (2 * cone) + 0.5f));
  if (taper < 2 && in_sphere >= cone) return cone;
  const float h = in_sphere - cone;
  return (1 - depth) * cone + depth * std::sqrt(std::max(cone * cone - h * h, 0.0f));
}

float flareFactor(float flare, float z) {
  const float y = std::max(0.0f, 1 - 8 * z);
  return flare * (std::pow(100.0f, y) - 1) / 100 + 1;
}

bool insideEnvelope(const TreeParameters& p, float height, float z_scale, const glm::vec3& point) {
  const float across = std::sqrt(point.x * point.x + point.z * point.z) / height;
  const float ratio = (height - point.y / z_scale) / (height * (1 - p.base_size));
  return across < p.prune_width * shapeRatio(8, ratio, p);
}

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

  std::vector<std::vector<LeafPlace>> leaves(stems.size() - begin);
  parallelFor(leaves.size(), 32, [&](std::size_t i) {
    leaves[i] = leavesOf(tree, stems[begin + i], static_cast<std::uint32_t>(begin + i));
  });
  std::size_t count = 0;
  for (const auto& list : leaves) count += list.size();
  skeleton.leaves.reserve(count);
  for (const auto& list : leaves)
    skeleton.leaves.insert(skeleton.leaves.end(), list.begin(), list.end());
  return skeleton;
}

}  // namespace verdure
