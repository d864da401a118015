#include "leaf/venation.h"

#include <algorithm>
#include <cmath>

namespace verdure {
namespace {

constexpr float kMidribShare = 0.75f;  ///< radius of the midrib's foot, by the stalk's

/// Points by number in square cells.
class PointGrid {
 public:
  PointGrid(const LeafFrame& frame, float cell)
      : cell_(cell),
        left_(-0.5f * frame.extent_mm),
        count_(static_cast<int>(frame.extent_mm / cell) + 1),
        cells_(static_cast<std::size_t>(count_) * static_cast<std::size_t>(count_)) {}

  void add(const glm::vec2& p, int id) {
    cells_[at(column(p.x - left_), column(p.y))].push_back(id);
  }

  /// body(id) for all points of the cells that a circle touches.
  template <class Body>
  void near(const glm::vec2& p, float radius, const Body& body) const {
    const int x1 = column(p.x - left_ + radius), y1 = column(p.y + radius);
    for (int y = column(p.y - radius); y <= y1; ++y)
      for (int x = column(p.x - left_ - radius); x <= x1; ++x)
        for (const int id : cells_[at(x, y)]) body(id);
  }

 private:
  int column(float v) const {
    return std::clamp(static_cast<int>(std::floor(v / cell_)), 0, count_ - 1);
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(count_) +
           static_cast<std::size_t>(x);
  }
  float cell_, left_;
  int count_;
  std::vector<std::vector<int>> cells_;
};

/// Depth below the outline, sampled.
class Depth {
 public:
  Depth(const Polyline& outline, int size)
      : frame_{size, frameExtent(outline)},
        values_(signedDistance(outline, 0.08f * frame_.extent_mm, frame_)) {}
  const LeafFrame& frame() const { return frame_; }
  float operator()(const glm::vec2& mm) const {
    const glm::vec2 p = frame_.toTexel(mm) - 0.5f;
    const int n = frame_.size;
    const int x = std::clamp(static_cast<int>(std::floor(p.x)), 0, n - 2);
    const int y = std::clamp(static_cast<int>(std::floor(p.y)), 0, n - 2);
    const float fx = p.x - static_cast<float>(x), fy = p.y - static_cast<float>(y);
    const auto at = [&](int i, int j) {
      return values_[static_cast<std::size_t>(j) * static_cast<std::size_t>(n) +
                     static_cast<std::size_t>(i)];
    };
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), fx),
                    glm::mix(at(x, y + 1), at(x + 1, y + 1), fx), fy);
  }
  /// Whether the straight line stays `depth` inside.
  bool open(const glm::vec2& a, const glm::vec2& b, float depth) const {
    const float length = glm::length(b - a);
    for (float u = 0; u < length;) {
      const float d = (*this)(a + (u / length) * (b - a));
      if (d < depth) return false;
      u += std::max(d - depth, 0.7f * frame_.mmPerTexel());
    }
    return (*this)(b) >= depth;
  }

 private:
  LeafFrame frame_;
  std::vector<float> values_;
};

struct Source {
  glm::vec2 position;
  int node = -1;  ///< nearest that it sees
  float distance = 1e30f;
};

class Growth {
 public:
  Growth(const LeafPlan& form, const VenationOptions& options, std::uint64_t seed)
      : form_(form),
        options_(options),
        random_(hash(seed ^ 0x7665696eull)),
        depth_(form.outline, 448),
        grid_(depth_.frame(), std::max(2 * options.step_mm, 0.5f * options.spacing_mm)) {}

  std::vector<VeinNode> run() {
    placeGuides();
    closeEnds(0, 2.5f * options_.spacing_mm);
    float spacing = options_.first_spacing_mm;
    for (bool last = false; !last; spacing *= 0.66f) {
      last = spacing <= options_.spacing_mm * 1.2f;
      if (last) spacing = options_.spacing_mm;
      placeSources(spacing);
      const std::size_t before = nodes_.size();
      grow(std::max(kKillShare * spacing, 1.05f * options_.step_mm));
      closeEnds(before, 2.2f * spacing);
    }
    return std::move(nodes_);
  }

 private:
  int add(const glm::vec2& p, int parent, int order, int guide) {
    const int id = static_cast<int>(nodes_.size());
    nodes_.push_back({p, parent, order, guide == 0});
    guide_of_.push_back(guide);
    grid_.add(p, id);
    return id;
  }

  const VeinNode& node(int id) const { return nodes_[static_cast<std::size_t>(id)]; }

  /// Whether a node of a guide other than these two lies within `radius`.
  bool crowded(const glm::vec2& p, float radius, int guide, int parent_guide) const {
    bool found = false;
    grid_.near(p, radius, [&](int id) {
      const int g = guide_of_[static_cast<std::size_t>(id)];
      if (g != guide && g != parent_guide && glm::length(node(id).position - p) < radius)
        found = true;
    });
    return found;
  }

  void placeGuides() {
    for (std::size_t g = 0; g < form_.guides.size(); ++g) {
      const VeinGuide& guide = form_.guides[g];
      const int self = static_cast<int>(g);
      const ArcCurve curve(guide.points);
      int parent = -1;
      if (guide.parent < 0) {
        parent = add(guide.points.front(), -1, guide.order, self);
      } else {
        float best = 1e30f;
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
          const float d = glm::length(nodes_[i].position - guide.points.front());
          if (guide_of_[i] == guide.parent && d < best) {
            best = d;
            parent = static_cast<int>(i);
          }
        }
        if (parent < 0) continue;
      }
      // It begins on a node, and is bent to do so.
      const glm::vec2 snap = node(parent).position - guide.points.front();
      const int steps = static_cast<int>(std::ceil(curve.length() / options_.step_mm));
      // Large veins go nearly to the tips of teeth, but see no bay narrower than a sample.
      const float least =
          std::max(0.4f * options_.clearance_mm, 0.75f * depth_.frame().mmPerTexel());
      for (int k = 1; k <= steps; ++k) {
        const float f = static_cast<float>(k) / static_cast<float>(steps);
        const glm::vec2 p = curve.at(curve.length() * f) + (1 - f) * (1 - f) * snap;
        const bool blade = self > 0 || p.y > form_.blade_base + 1.0f;
        if (blade && depth_(p) < least) break;
        // Loops end near the vein above.
        if (guide.order > 1 && f > 0.3f &&
            crowded(p, 1.3f * options_.spacing_mm, self, guide.parent))
          break;
        parent = add(p, parent, guide.order, self);
      }
    }
  }

  bool onStalk(const glm::vec2& p) const {
    bool found = false;
    const float reach = 2 * form_.stalk_radius;
    if (p.y < form_.blade_base)
      grid_.near(p, reach, [&](int id) {
        found |= node(id).midrib && glm::length(node(id).position - p) < reach;
      });
    return found;
  }

  /// Sources at least `spacing` from all nodes and from each other, so many that none fits in
  /// between (up to the candidates' distance).
  void placeSources(float spacing) {
    const LeafFrame& frame = depth_.frame();
    const float pitch = 0.4f * spacing;
    const int count = static_cast<int>(frame.extent_mm / pitch) + 1;
    std::vector<glm::vec2> candidates;
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < count; ++i) {
        const float x = (static_cast<float>(i) + random_.uniform()) * pitch;
        const float y = (static_cast<float>(j) + random_.uniform()) * pitch;
        const glm::vec2 p(x - 0.5f * frame.extent_mm, y);
        if (depth_(p) > 1.5f * options_.clearance_mm && !onStalk(p)) candidates.push_back(p);
      }
    for (std::size_t i = candidates.size(); i > 1; --i)
      std::swap(candidates[i - 1], candidates[random_.below(static_cast<std::uint32_t>(i))]);
    PointGrid placed(frame, spacing);
    sources_.clear();
    for (const glm::vec2& p : candidates) {
      bool free = true;
      placed.near(p, spacing, [&](int id) {
        if (glm::length(sources_[static_cast<std::size_t>(id)].position - p) < spacing)
          free = false;
      });
      if (!free) continue;
      grid_.near(p, spacing, [&](int id) {
        if (glm::length(node(id).position - p) < spacing) free = false;
      });
      if (!free) continue;
      Source source{p};
      findNode(source, 2 * spacing);
      if (source.node < 0) continue;  // no vein sees it
      placed.add(p, static_cast<int>(sources_.size()));
      sources_.push_back(source);
    }
  }

  /// The nearest node that the source sees, looking ever farther.
  void findNode(Source& source, float radius) const {
    for (; radius < 2 * depth_.frame().extent_mm; radius *= 2) {
      std::vector<std::pair<float, int>> near;
      grid_.near(source.position, radius, [&](int id) {
        const float d = glm::length(node(id).position - source.position);
        if (d < radius && !(node(id).midrib && node(id).position.y < form_.blade_base))
          near.emplace_back(d, id);
      });
      std::sort(near.begin(), near.end());
      for (const auto& [d, id] : near)
        if (depth_.open(source.position, node(id).position, options_.clearance_mm)) {
          source.node = id;
          source.distance = d;
          return;
        }
    }
  }

  /// A step from a node; false if it would leave the blade or meet another node.
  bool step(int from, const glm::vec2& direction) {
    const float size = glm::length(direction);
    if (size < 1e-4f) return false;
    const glm::vec2 p = node(from).position + (options_.step_mm / size) * direction;
    if (depth_(p) < 0.8f * options_.clearance_mm) return false;
    bool free = true;
    grid_.near(p, 0.4f * options_.step_mm, [&](int id) {
      if (glm::length(node(id).position - p) < 0.4f * options_.step_mm) free = false;
    });
    if (free) add(p, from, 3, -1);
    return free;
  }

  void grow(float kill) {
    const LeafFrame& frame = depth_.frame();
    PointGrid where(frame, std::max(options_.spacing_mm, kill));
    std::vector<int> live;
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      where.add(sources_[i].position, static_cast<int>(i));
      live.push_back(static_cast<int>(i));
    }
    const auto source = [&](int id) -> Source& { return sources_[static_cast<std::size_t>(id)]; };
    struct Pull {
      int node, source;
    };
    while (!live.empty()) {
      std::vector<Pull> pulls;
      float reach = 0;
      for (const int id : live) {
        pulls.push_back({source(id).node, id});
        reach = std::max(reach, source(id).distance);
      }
      std::stable_sort(pulls.begin(), pulls.end(),
                       [](const Pull& a, const Pull& b) { return a.node < b.node; });
      const std::size_t before = nodes_.size();
      std::vector<int> stuck;
      for (std::size_t i = 0; i < pulls.size();) {
        const int from = pulls[i].node;
        glm::vec2 sum(0);
        int nearest = pulls[i].source;
        for (; i < pulls.size() && pulls[i].node == from; ++i) {
          const Source& s = source(pulls[i].source);
          sum += (s.position - node(from).position) / s.distance;
          if (s.distance < source(nearest).distance) nearest = pulls[i].source;
        }
        // Where the mean leads nowhere new, straight to the nearest source.
        const glm::vec2 aside(-sum.y, sum.x);
        if (!step(from, sum + random_.vary(0.35f) * aside) &&
            !step(from, source(nearest).position - node(from).position))
          stuck.push_back(nearest);
      }
      for (std::size_t id = before; id < nodes_.size(); ++id) {
        const glm::vec2 p = nodes_[id].position;
        where.near(p, reach, [&](int s) {
          const float d = glm::length(source(s).position - p);
          if (d < source(s).distance &&
              depth_.open(source(s).position, p, 0.8f * options_.clearance_mm)) {
            source(s).distance = d;
            source(s).node = static_cast<int>(id);
          }
        });
      }
      // A source to which no step leads is given up: another node stands in the way, so a vein is
      // near it.
      for (const int id : stuck) source(id).distance = 0;
      std::erase_if(live, [&](int id) { return source(id).distance < kill; });
    }
  }

  /// Runs the ends of veins that have grown since node `first` straight into the vein that lies
  /// ahead, if one does: fields between veins look closed, while the venation stays a tree.
  void closeEnds(std::size_t first, float reach) {
    const std::size_t grown = nodes_.size();
    std::vector<char> inner(grown, 0);
    for (const VeinNode& n : nodes_)
      if (n.parent >= 0) inner[static_cast<std::size_t>(n.parent)] = 1;
    for (std::size_t id = first; id < grown; ++id) {
      if (inner[id]) continue;
      std::vector<int> own;  // where it came from does not count
      glm::vec2 root = nodes_[id].position;
      for (int a = static_cast<int>(id); a >= 0 && own.size() < 64; a = node(a).parent) {
        own.push_back(a);
        if (own.size() <= 4) root = node(a).position;
      }
      const glm::vec2 tip = nodes_[id].position, ahead = tip - root;
      if (glm::dot(ahead, ahead) <= 0) continue;
      const glm::vec2 heading = glm::normalize(ahead);
      int target = -1;
      float best = 1e30f;
      grid_.near(tip, reach, [&](int other) {
        const glm::vec2 d = node(other).position - tip;
        const float length = glm::length(d);
        if (length <= 0 || length > reach) return;
        const float turn = 1 - glm::dot(d, heading) / length;
        if (turn > (nodes_[id].order < 3 ? 1.2f : 0.7f) || length * (1 + turn) >= best) return;
        if (std::find(own.begin(), own.end(), other) != own.end()) return;
        best = length * (1 + turn);
        target = other;
      });
      if (target < 0) continue;
      const glm::vec2 end = node(target).position;
      if (!depth_.open(tip, end, 0.8f * options_.clearance_mm)) continue;
      const float length = glm::length(end - tip);
      const int steps = std::max(1, static_cast<int>(std::ceil(length / options_.step_mm)));
      int parent = static_cast<int>(id);
      // A slight bow, where there is room for it.
      glm::vec2 bow = random_.vary(0.16f) * glm::vec2(tip.y - end.y, end.x - tip.x);
      if (depth_(0.5f * (tip + end)) < options_.clearance_mm + 0.5f * length) bow = glm::vec2(0);
      for (int k = 1; k <= steps; ++k) {
        const float f = k < steps ? static_cast<float>(k) / static_cast<float>(steps)
                                  : 1 - 0.05f * options_.step_mm / length;
        parent = add(glm::mix(tip, end, f) + f * (1 - f) * bow, parent, 3, -1);
      }
    }
  }

  const LeafPlan& form_;
  const VenationOptions& options_;
  Random random_;
  Depth depth_;
  PointGrid grid_;
  std::vector<VeinNode> nodes_;
  std::vector<int> guide_of_;  ///< of each node, -1 for those that grew freely
  std::vector<Source> sources_;
};

}  // namespace

std::vector<VeinNode> growVenation(const LeafPlan& form, const VenationOptions& options,
                                   std::uint64_t seed) {
  std::vector<VeinNode> nodes = Growth(form, options, seed).run();
  setVeinWidths(nodes, kMidribShare * form.stalk_radius, options.exponent);
  return nodes;
}

}  // namespace verdure
