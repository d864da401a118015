#include "plant/stem_growth.h"

#include <utility>

#include "base/check.h"
#include "base/random.h"

namespace verdure::growth {
namespace {

/// The direction halfway between two; `b` where they are opposite.
glm::vec3 halfway(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 sum = a + b;
  const float size = glm::length(sum);
  return size > 1e-3f ? sum / size : b;
}

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
      glm::vec3 step = halfway(alongOf(nodes.back().out), alongOf(next.in));
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
      return halfway(alongOf(node.in), alongOf(node.out));
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

}  // namespace

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

}  // namespace verdure::growth
