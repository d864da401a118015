#include "plant/attach_branches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "plant/axis_fit.h"
#include "plant/axis_tree.h"
#include "plant/weld.h"

namespace verdure {
namespace {

/// Of the radius of what hangs: how far from a surface it may begin and still touches it.
constexpr float kTouch = 0.5f;
/// Costs of contacts that are possible but unlikely.
constexpr float kAtItsRoot = 2.0f;  ///< where the other begins: siblings leave from one place
constexpr float kRootShare = 0.15f;
constexpr float kThinner = 1.0f;  ///< on what is thinner than this share of it
constexpr float kThinnerShare = 0.6f;

struct Contact {
  float cost = 0.0f;
  std::uint32_t piece = 0, branch = 0;
};

struct Heights {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  void add(const Branch& branch) {
    for (const BranchPoint& p : branch.points) {
      low = std::min(low, p.position.y);
      high = std::max(high, p.position.y);
    }
  }
};

class Attacher {
 public:
  Attacher(std::vector<Branch>& branches, const std::vector<std::uint32_t>& piece_of_branch,
           const std::vector<bool>& fixed)
      : branches_(branches),
        piece_of_(piece_of_branch),
        fixed_(fixed),
        root_(fixed.size(), kNone),
        heights_(fixed.size()),
        axes_(branches),
        joined_(fixed.size()) {
    for (std::uint32_t b = 0; b < branches.size(); ++b) {
      if (root_[piece_of_[b]] == kNone) root_[piece_of_[b]] = b;
      heights_[piece_of_[b]].add(branches[b]);
      all_.add(branches[b]);
    }
  }

  void attach() {
    joinTouching();
    joinFloating();
  }

 private:
  bool open(std::uint32_t piece) const {
    return !fixed_[piece] && root_[piece] != kNone && branches_[root_[piece]].parent == kNone;
  }

  void contactsOf(std::uint32_t piece, std::vector<Contact>& contacts) const {
    const BranchPoint base = branches_[root_[piece]].points.front();
    const float reach = std::max(kTouch * base.radius, 1e-4f * (all_.high - all_.low));
    for (const AxisHit& hit : axes_.within(base.position, reach)) {
      if (piece_of_[hit.branch] == piece) continue;
      const float radius = std::max(hit.radius, 1e-12f);
      float cost = hit.distance <= radius
                       ? hit.distance / radius
                       : 1.0f + (hit.distance - radius) / std::max(base.radius, 1e-12f);
      const Branch& other = branches_[hit.branch];
      if (hit.along < kRootShare * other.points.front().radius) cost += kAtItsRoot;
      if (hit.radius < kThinnerShare * base.radius) cost += kThinner;
      if (cost < kAtItsRoot) contacts.push_back({cost, piece, hit.branch});
    }
  }

  bool join(std::uint32_t piece, std::uint32_t branch) {
    const std::uint32_t other = piece_of_[branch];
    if (joined_.find(piece) == joined_.find(other)) return false;
    joined_.join(piece, other);
    branches_[root_[piece]].parent = branch;
    return true;
  }

  void joinTouching() {
    std::vector<std::vector<Contact>> found(fixed_.size());
    parallelFor(found.size(), 64, [&](std::size_t piece) {
      const auto p = static_cast<std::uint32_t>(piece);
      if (open(p)) contactsOf(p, found[piece]);
    });
    std::vector<Contact> contacts;
    for (const auto& some : found) contacts.insert(contacts.end(), some.begin(), some.end());
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const Contact& a, const Contact& b) { return a.cost < b.cost; });
    for (const Contact& c : contacts)
      if (open(c.piece)) join(c.piece, c.branch);
  }

  /// A piece that begins at its lower end, and is large or low.
  bool stands(std::uint32_t piece) const {
    const float y = branches_[root_[piece]].points.front().position.y;
    const Heights& own = heights_[piece];
    const float all = all_.high - all_.low;
    return y <= own.low + 0.1f * (own.high - own.low) &&
           (own.high - own.low >= 0.25f * all || y <= all_.low + 0.03f * all);
  }

  void joinFloating() {
    std::vector<std::uint32_t> floating;
    bool any_stands = false;
    for (std::uint32_t p = 0; p < fixed_.size(); ++p) {
      if (root_[p] == kNone) continue;
      if (open(p) && !stands(p))
        floating.push_back(p);
      else if (fixed_[p] || branches_[root_[p]].parent == kNone)
        any_stands = true;
    }
    if (!any_stands && !floating.empty()) {  // a bough alone: its thickest piece is the trunk
      const auto trunk =
          std::max_element(floating.begin(), floating.end(), [&](std::uint32_t a, std::uint32_t b) {
            return branches_[root_[a]].points[0].radius < branches_[root_[b]].points[0].radius;
          });
      floating.erase(trunk);
    }
    std::vector<Contact> gaps;
    const auto nearest = [&](std::uint32_t piece) {
      const std::uint32_t own = joined_.find(piece);
      const AxisHit hit =
          axes_.nearest(branches_[root_[piece]].points.front().position,
                        [&](std::uint32_t b) { return joined_.find(piece_of_[b]) != own; });
      return Contact{hit.branch == kNone ? 0.0f : hit.gap(), piece, hit.branch};
    };
    for (const std::uint32_t p : floating) gaps.push_back(nearest(p));
    std::stable_sort(gaps.begin(), gaps.end(),
                     [](const Contact& a, const Contact& b) { return a.cost < b.cost; });
    for (Contact c : gaps) {
      if (c.branch != kNone && joined_.find(c.piece) == joined_.find(piece_of_[c.branch]))
        c = nearest(c.piece);
      const std::vector<BranchPoint>& axis = branches_[root_[c.piece]].points;
      // Farther than it is long, it is a plant of its own.
      const float most = std::max(axisLength(axis), 0.02f * (all_.high - all_.low));
      if (c.branch != kNone && c.cost <= most) join(c.piece, c.branch);
    }
  }

  std::vector<Branch>& branches_;
  const std::vector<std::uint32_t>& piece_of_;
  const std::vector<bool>& fixed_;
  std::vector<std::uint32_t> root_;  ///< of each piece
  std::vector<Heights> heights_;
  Heights all_;
  AxisTree axes_;
  DisjointSets joined_;
};

}  // namespace

void attachPieces(std::vector<Branch>& branches, const std::vector<std::uint32_t>& piece_of_branch,
                  const std::vector<bool>& fixed) {
  if (branches.empty()) return;
  Attacher(branches, piece_of_branch, fixed).attach();
}

}  // namespace verdure
