#include "plant/surface_branches.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "plant/axis_fit.h"
#include "plant/weld.h"

namespace verdure {
namespace {

/// A loop of the level set at one level of an arc.
struct Section {
  float level = 0.0f;
  float perimeter = 0.0f;
  glm::vec3 centroid{0.0f};
  bool ring = false;  ///< at a ring of points, all of which are as far
  float radius() const { return perimeter / glm::two_pi<float>(); }
};

/// A piece of bark between forks.
struct Arc {
  std::uint32_t parent = kNone;
  std::vector<std::uint32_t> children;
  std::uint32_t top = 0;  ///< its farthest point
  float low = 0.0f, high = 0.0f;
  float even = std::numeric_limits<float>::max();  ///< from here on a fork bulges
  float area = 0.0f;
  float carried = 0.0f;  ///< area of it and all beyond
  std::vector<Section> sections;

  float radius() const { return area / (glm::two_pi<float>() * std::max(high - low, 1e-12f)); }
};

class PatchSplitter {
 public:
  PatchSplitter(const WoodPatch& patch, const PatchGraph& graph,
                std::span<const std::uint32_t> sources)
      : patch_(patch),
        graph_(graph),
        sources_(sources.begin(), sources.end()),
        distance_(surfaceDistance(patch, graph, sources)) {}

  PatchBranches split() {
    sweep();
    placeLevels();
    measureSections();
    for (Arc& arc : arcs_)
      std::erase_if(arc.sections, [](const Section& s) { return !(s.perimeter > 0.0f); });
    assemble();
    return std::move(result_);
  }

 private:
  // --- the tree of arcs

  /// A connected part of what is farther than the sweep has come.
  struct Part {
    std::uint32_t arc = 0, top = 0;
    float area = 0.0f;
    bool forks = false;
  };

  /// A cylinder as long as 1.5 of its diameters, a cone as long as 0.75 ones; a half ball is less.
  bool isBranch(const Part& part, float level) const {
    const float length = distance_[part.top] - level;
    return part.forks || length * length > 1.5f * part.area / glm::pi<float>();
  }

  void sweep() {
    const std::size_t count = patch_.points.size();
    std::vector<float> area(count, 0.0f);
    for (const auto& t : patch_.triangles) {
      const glm::vec3 &a = patch_.points[t[0]], &b = patch_.points[t[1]], &c = patch_.points[t[2]];
      for (const std::uint32_t p : t) area[p] += glm::length(glm::cross(b - a, c - a)) / 6.0f;
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return distance_[a] != distance_[b] ? distance_[a] > distance_[b] : a < b;
    });
    DisjointSets sets(count);
    std::vector<Part> parts(count);  // by representative
    std::vector<bool> reached(count, false);
    std::vector<std::uint32_t> alias;
    arc_of_.resize(count);
    std::vector<std::uint32_t> beside;
    const auto newArc = [&](std::uint32_t top) {
      arcs_.emplace_back().top = top;
      arcs_.back().high = distance_[top];
      alias.push_back(static_cast<std::uint32_t>(arcs_.size() - 1));
      return alias.back();
    };
    const auto elder = [&](std::uint32_t a, std::uint32_t b) {
      const std::uint32_t s = parts[a].top, t = parts[b].top;
      return distance_[s] != distance_[t] ? distance_[s] > distance_[t] : s < t;
    };
    for (const std::uint32_t v : order) {
      beside.clear();
      for (const std::uint32_t n : graph_.neighbours(v))
        if (reached[n]) beside.push_back(sets.find(n));
      std::sort(beside.begin(), beside.end());
      beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
      std::sort(beside.begin(), beside.end(), elder);
      Part part;
      if (beside.empty()) {
        part.arc = newArc(v);
        part.top = v;
      } else {
        part = parts[beside[0]];
        std::vector<std::uint32_t> split{part.arc};
        for (std::size_t i = 1; i < beside.size(); ++i) {
          const Part& other = parts[beside[i]];
          if (isBranch(other, distance_[v])) {
            split.push_back(other.arc);
            continue;
          }
          alias[other.arc] = part.arc;
          arcs_[part.arc].area += arcs_[other.arc].area;
          part.area += other.area;
        }
        if (split.size() > 1) {
          part.arc = newArc(v);
          part.forks = true;
          for (const std::uint32_t child : split) {
            arcs_[child].parent = part.arc;
            arcs_[child].low = distance_[v];
          }
          arcs_[part.arc].children = std::move(split);
        }
      }
      arc_of_[v] = part.arc;
      part.area += area[v];
      arcs_[part.arc].area += area[v];
      reached[v] = true;
      for (const std::uint32_t n : beside) sets.join(n, v);
      parts[sets.find(v)] = part;
      root_ = part.arc;
    }
    for (std::uint32_t& arc : arc_of_)
      while (alias[arc] != arc) arc = alias[arc];
    for (std::uint32_t a = 0; a < arcs_.size(); ++a) {  // children before parents
      arcs_[a].carried += arcs_[a].area;
      if (arcs_[a].parent != kNone) arcs_[arcs_[a].parent].carried += arcs_[a].carried;
    }
  }

  // --- sections

  /// Levels in the arc's even part: below the merging loops of a fork, and where an open end still
  /// has all of its rim.
  void placeLevels() {
    std::vector<std::vector<float>> points(arcs_.size());
    for (std::uint32_t p = 0; p < arc_of_.size(); ++p) points[arc_of_[p]].push_back(distance_[p]);
    for (std::uint32_t a = 0; a < arcs_.size(); ++a) {
      Arc& arc = arcs_[a];
      const float length = arc.high - arc.low;
      if (!(length > 0.0f) || points[a].empty()) continue;  // empty: part of another arc
      float low = arc.low, high = arc.high;
      if (arc.children.empty()) {
        const auto rim = graph_.rimThrough(arc.top);
        if (rim.size() > 2)
          for (const std::uint32_t p : rim)
            if (arc_of_[p] == a) high = std::min(high, distance_[p]);
      } else {
        float thickest = 0.0f;
        for (const std::uint32_t child : arc.children)
          if (child != arc.children[0]) thickest = std::max(thickest, arcs_[child].radius());
        high = arc.even = std::max(high - 3.0f * thickest, arc.low + 0.5f * length);
      }
      if (arc.parent != kNone) low = std::min(low + arc.radius(), low + 0.25f * (high - low));
      if (!(high > low)) continue;
      if (placeAtRings(arc, std::move(points[a]), low, high)) continue;
      const float wanted = std::ceil((high - low) / std::max(arc.radius(), 1e-12f));
      const auto levels = static_cast<std::size_t>(std::clamp(wanted, 3.0f, 64.0f));
      arc.sections.resize(levels);
      for (std::size_t k = 0; k < levels; ++k)
        arc.sections[k].level =
            low + (high - low) * (static_cast<float>(k) + 0.5f) / static_cast<float>(levels);
    }
  }

  /// Tubes of rings far apart are straight in between: levels at their rings miss no bend.
  static bool placeAtRings(Arc& arc, std::vector<float> points, float low, float high) {
    std::sort(points.begin(), points.end());
    const float radius = arc.radius();
    std::size_t rings = 0;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
      double sum = 0.0;
      for (; end < points.size() && (end == begin || points[end] - points[end - 1] < 0.4f * radius);
           ++end)
        sum += static_cast<double>(points[end]);
      ++rings;
      Section section;
      section.level = static_cast<float>(sum / static_cast<double>(end - begin));
      section.ring = end - begin > 2 && points[end - 1] - points[begin] < 0.4f * radius;
      if (section.level > low && section.level < high) arc.sections.push_back(section);
    }
    if (static_cast<float>(rings) * 2.0f * radius < points.back() - points.front() &&
        arc.sections.size() > 1)
      return true;
    arc.sections.clear();
    return false;
  }

  void measureSections() {
    for (const auto& t : patch_.triangles) {
      std::array<std::uint32_t, 3> p = t;
      std::sort(p.begin(), p.end(), [this](std::uint32_t a, std::uint32_t b) {
        return distance_[a] != distance_[b] ? distance_[a] < distance_[b] : a < b;
      });
      const float low = distance_[p[0]], middle = distance_[p[1]], high = distance_[p[2]];
      if (!(high > low)) continue;
      const auto between = [&](std::uint32_t a, std::uint32_t b, float level) {
        return glm::mix(patch_.points[a], patch_.points[b],
                        (level - distance_[a]) / (distance_[b] - distance_[a]));
      };
      for (std::uint32_t a = arc_of_[p[2]]; a != kNone; a = arcs_[a].parent) {
        std::vector<Section>& sections = arcs_[a].sections;
        // A point at the level itself is below it: so loops are whole also where rings lie in it.
        auto s = std::lower_bound(sections.begin(), sections.end(), low,
                                  [](const Section& x, float level) { return x.level < level; });
        for (; s != sections.end() && s->level < high; ++s) {
          const glm::vec3 x = between(p[0], p[2], s->level);
          const glm::vec3 y =
              s->level < middle ? between(p[0], p[1], s->level) : between(p[1], p[2], s->level);
          const float length = glm::length(y - x);
          s->perimeter += length;
          s->centroid += 0.5f * length * (x + y);
        }
        if (low >= arcs_[a].low) break;
      }
    }
    for (Arc& arc : arcs_)
      for (Section& s : arc.sections)
        if (s.perimeter > 0.0f) s.centroid /= s.perimeter;
  }

  // --- branches

  /// The arc's section nearest to `beyond` after its start; null without sections.
  const Section* sectionAt(const Arc& arc, float beyond) const {
    const Section* best = nullptr;
    for (const Section& s : arc.sections)
      if (best == nullptr ||
          std::abs(s.level - arc.low - beyond) < std::abs(best->level - arc.low - beyond))
        best = &s;
    return best;
  }

  /// Which of the arc's children goes on as the branch that has come from `before` to `here`.
  std::uint32_t chooseNext(const Arc& arc, const glm::vec3& before, const glm::vec3& here) const {
    const glm::vec3 run = here - before;
    std::uint32_t best = arc.children[0];
    float most = -1.0f;
    for (const std::uint32_t c : arc.children) {
      const Arc& child = arcs_[c];
      const float radius = child.radius();
      const Section *near = sectionAt(child, 2.0f * radius), *far = sectionAt(child, 8.0f * radius);
      if (near == nullptr) continue;
      glm::vec3 way = far->centroid - near->centroid;
      if (!(glm::length(way) > 0.1f * near->radius())) way = near->centroid - here;
      const float lengths = glm::length(way) * glm::length(run);
      const float straight = lengths > 0.0f ? glm::dot(way, run) / lengths : 1.0f;
      const float score =
          near->radius() * (0.4f + std::max(straight, 0.0f)) * std::sqrt(std::sqrt(child.carried));
      if (score > most) {
        most = score;
        best = c;
      }
    }
    return best;
  }

  void assemble() {
    struct Start {
      std::uint32_t arc, parent;
    };
    std::vector<Start> starts{{root_, kNone}};
    std::vector<std::uint32_t> branch_of_arc(arcs_.size(), kNone);
    std::vector<std::vector<Section>> chains;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      Branch branch;
      branch.parent = starts[i].parent;
      if (branch.parent != kNone) branch.level = result_.branches[branch.parent].level + 1;
      std::vector<Section> chain;
      std::uint32_t a = starts[i].arc;
      glm::vec3 source(0.0f);
      for (const std::uint32_t s : sources_) source += patch_.points[s];
      source /= static_cast<float>(sources_.size());
      for (;;) {
        const Arc& arc = arcs_[a];
        branch_of_arc[a] = number;
        chain.insert(chain.end(), arc.sections.begin(), arc.sections.end());
        if (arc.children.empty()) break;
        glm::vec3 here = source, before = source;
        if (!chain.empty()) {
          here = chain.back().centroid;
          const float reach = chain.back().level - 6.0f * chain.back().radius();
          for (const Section& s : chain)
            if (s.level <= reach || &s == &chain.front()) before = s.centroid;
          if (chain.size() == 1) before = source;
        }
        const std::uint32_t next = chooseNext(arc, before, here);
        for (const std::uint32_t child : arc.children)
          if (child != next) starts.push_back({child, number});
        a = next;
      }
      result_.tips.push_back(arcs_[a].top);
      result_.branches.push_back(std::move(branch));
      chains.push_back(std::move(chain));
    }
    result_.branch_of_point.resize(arc_of_.size());
    std::vector<std::vector<std::uint32_t>> points(result_.branches.size());
    for (std::uint32_t p = 0; p < arc_of_.size(); ++p) {
      result_.branch_of_point[p] = branch_of_arc[arc_of_[p]];
      points[result_.branch_of_point[p]].push_back(p);
    }
    for (std::uint32_t b = 0; b < result_.branches.size(); ++b) layAxis(b, chains[b], points[b]);
  }

  /// Where a branch ends: the middle of an open rim; the point beyond the last ring, or that ring
  /// if a flat cap closes it; else the foot of the last point on the axis. `chain`: from that end
  /// on.
  glm::vec3 endOf(std::span<const std::uint32_t> end, std::span<const Section> chain) const {
    glm::vec3 middle(0.0f);
    for (const std::uint32_t p : end) middle += patch_.points[p];
    middle /= static_cast<float>(end.size());
    if (end.size() > 2 || chain.size() < 2) return middle;
    const Section& last = chain.front();
    if (last.ring) {
      const bool on_cap = glm::length(middle - last.centroid) > 0.6f * last.radius() &&
                          glm::length(middle - last.centroid) < 1.2f * last.radius() &&
                          std::abs(distance_[end[0]] - last.level) < 0.5f * last.radius();
      return on_cap ? last.centroid : middle;
    }
    // The direction is that of some radii.
    std::size_t inner = 1;
    while (inner + 1 < chain.size() &&
           std::abs(chain[inner].level - last.level) < 3.0f * chain[inner].radius())
      ++inner;
    const glm::vec3 way = last.centroid - chain[inner].centroid;
    if (!(glm::length(way) > 0.0f)) return middle;
    const glm::vec3 t = glm::normalize(way);
    const float ahead = glm::dot(middle - last.centroid, t);
    // Far ahead, it is the point of a cone.
    return ahead > 0.0f && ahead < 4.0f * last.radius() ? last.centroid + ahead * t : middle;
  }

  /// What welding has left of a thin branch may have points but no surface.
  std::vector<Section> meansOf(std::vector<std::uint32_t> points) const {
    std::sort(points.begin(), points.end(), [this](std::uint32_t p, std::uint32_t q) {
      return distance_[p] != distance_[q] ? distance_[p] < distance_[q] : p < q;
    });
    std::vector<Section> means;
    const std::size_t groups = std::min<std::size_t>(points.size() / 2, 16);
    for (std::size_t g = 0; g < groups; ++g) {
      Section& mean = means.emplace_back();
      const std::size_t begin = g * points.size() / groups, end = (g + 1) * points.size() / groups;
      for (std::size_t i = begin; i < end; ++i) {
        mean.centroid += patch_.points[points[i]] / static_cast<float>(end - begin);
        mean.level += distance_[points[i]] / static_cast<float>(end - begin);
      }
    }
    return means;
  }

  void layAxis(std::uint32_t b, std::vector<Section> chain,
               const std::vector<std::uint32_t>& points) {
    Branch& branch = result_.branches[b];
    const std::uint32_t top = result_.tips[b];
    const auto rim = graph_.rimThrough(top);
    // On a cap or a dome the level sets no longer go round the axis.
    const auto trim = [&chain](bool front, float end) {
      while (chain.size() > 3) {
        const Section& s = front ? chain.front() : chain.back();
        const Section& inner = front ? chain[std::min<std::size_t>(3, chain.size() - 1)]
                                     : chain[chain.size() - std::min<std::size_t>(4, chain.size())];
        if (s.ring || std::abs(s.level - end) > 2.0f * inner.radius()) break;
        chain.erase(front ? chain.begin() : chain.end() - 1);
      }
    };
    if (chain.empty()) chain = meansOf(points);
    if (rim.size() < 3) trim(false, distance_[top]);
    if (branch.parent == kNone && sources_.size() < 3) trim(true, 0.0f);
    std::vector<glm::vec3> line;
    for (const Section& s : chain) line.push_back(s.centroid);
    const std::uint32_t tip_alone[] = {top};
    const std::span<const std::uint32_t> end =
        rim.size() > 2 ? std::span<const std::uint32_t>(rim) : tip_alone;
    const glm::vec3 tip = endOf(end, std::vector<Section>(chain.rbegin(), chain.rend()));
    if (branch.parent == kNone)
      line.insert(line.begin(), endOf(sources_, chain));
    else
      line.insert(line.begin(), rootOn(result_.branches[branch.parent].points, line, tip));
    line.push_back(tip);
    for (const glm::vec3& p : line)
      if (branch.points.empty() || p != branch.points.back().position)
        branch.points.push_back({p, 0.0f});
    if (branch.points.size() < 2) branch.points.push_back(branch.points.back());
    std::vector<std::pair<float, float>> samples;
    for (const std::uint32_t p : points)
      if (distance_[p] <= arcs_[arc_of_[p]].even)
        samples.push_back(placeOnAxis(branch.points, patch_.points[p]));
    if (samples.empty())
      for (const std::uint32_t p : points)
        samples.push_back(placeOnAxis(branch.points, patch_.points[p]));
    fitRadii(std::move(samples), branch.points);
    simplifyAxis(branch.points);
  }

  /// Where a branch leaves the axis of its parent: it is followed back from its first sections.
  static glm::vec3 rootOn(const std::vector<BranchPoint>& parent,
                          const std::vector<glm::vec3>& line, const glm::vec3& tip) {
    const glm::vec3 first = line.empty() ? tip : line[0];
    const glm::vec3 second =
        line.size() > 1 ? line[std::min<std::size_t>(2, line.size() - 1)] : tip;
    glm::vec3 foot = pointOnAxis(parent, placeOnAxis(parent, first).first);
    const glm::vec3 way = second - first;
    if (!(glm::length(way) > 0.0f)) return foot;
    const glm::vec3 t = glm::normalize(way);
    for (int i = 0; i < 3; ++i) {
      // No farther back than twice the way to the parent's axis: it may run beside it.
      const float back = std::min(std::max(glm::dot(first - foot, t), 0.0f),
                                  2.0f * placeOnAxis(parent, first).second);
      foot = pointOnAxis(parent, placeOnAxis(parent, first - back * t).first);
    }
    return foot;
  }

  const WoodPatch& patch_;
  const PatchGraph& graph_;
  std::vector<std::uint32_t> sources_;
  std::vector<float> distance_;
  std::vector<Arc> arcs_;
  std::vector<std::uint32_t> arc_of_;
  std::uint32_t root_ = 0;
  PatchBranches result_;
};

}  // namespace

PatchBranches branchesOfPatch(const WoodPatch& patch, const PatchGraph& graph,
                              std::span<const std::uint32_t> sources) {
  return PatchSplitter(patch, graph, sources).split();
}

}  // namespace verdure
