#include "verdure/scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "scene/place_limit.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr int kSide = 8;         // pieces of a cell along each side: a bit each
constexpr int kMostRounds = 96;  // of darts
constexpr int kQuietRounds = 4;  // without a new place to speak of: then it ends
constexpr double kLeastSuccess = 0.02;
constexpr double kCover = 0.5;  // of the area, by discs of several kinds
constexpr std::uint64_t kDartStream = 1, kKeepStream = 2, kLookStream = 3;

struct Dart {
  glm::vec2 place{0.0f};
  std::uint32_t kind = 0;
};

/// Whether plants may stand there as far as the ground is concerned.
class GoodGround {
 public:
  explicit GoodGround(const ScatterOptions& options)
      : options_(options), least_up_(std::cos(std::min(options.most_slope, glm::pi<float>()))) {}

  bool at(const glm::vec2& place) const {
    if (options_.terrain == nullptr) return options_.lowest_m <= 0.0f && options_.highest_m >= 0.0f;
    const float height = options_.terrain->heightAt(place);
    if (height < options_.lowest_m || height > options_.highest_m) return false;
    return least_up_ <= 0.0f || options_.terrain->normalAt(place).y >= least_up_;
  }

  /// Of the area, by the middles of 64 x 64 pieces.
  double share() const {
    if (options_.terrain == nullptr) return at(glm::vec2(0.0f)) ? 1.0 : 0.0;
    constexpr int kPieces = 64;
    int good = 0;
    for (int z = 0; z < kPieces; ++z)
      for (int x = 0; x < kPieces; ++x)
        good += at(options_.corner + options_.size_m * (glm::vec2(x, z) + 0.5f) / float{kPieces});
    return good / double{kPieces * kPieces};
  }

 private:
  const ScatterOptions& options_;
  float least_up_;  // y of the steepest normal
};

void check(const ScatterOptions& o) {
  constexpr const char* kWhere = "scatter";
  if (o.kinds.empty() || o.kinds.size() > 64)
    throw Error(kWhere, fmt::format("{} kinds of plants", o.kinds.size()), "give 1 to 64");
  const auto isLength = [](float v) { return v > 0.0f && v <= 1e7f; };
  if (!isLength(o.size_m.x) || !isLength(o.size_m.y) || !(std::abs(o.corner.x) <= 1e7f) ||
      !(std::abs(o.corner.y) <= 1e7f))
    throw Error(kWhere, "its area is empty or beyond 10,000 km", "give it in metres");
  std::size_t without = 0;
  for (const ScatterKind& kind : o.kinds) {
    if (!(kind.share > 0.0f) || !std::isfinite(kind.share))
      throw Error(kWhere, "a kind's share is not above 0", "leave the kind out");
    if (!(kind.radius_m >= 0.0f && kind.radius_m <= 1e4f))
      throw Error(kWhere, fmt::format("a kind's radius is {:g} m", kind.radius_m),
                  "choose 0 to 10000");
    if (!(kind.scale.x > 0.0f && kind.scale.y >= kind.scale.x && kind.scale.y <= 1e4f))
      throw Error(kWhere, "a kind's scales are not above 0 and rising", "0.85 to 1.15 is usual");
    without += kind.radius_m == 0.0f;
  }
  if (without != 0 && without != o.kinds.size())
    throw Error(kWhere, "some kinds have a radius of 0 and others do not",
                "give each a radius, or none");
  if (without != 0 && !o.per_m2)
    throw Error(kWhere, "without a radius there is room for any number",
                "give the number of places for the area");
  if (o.per_m2 && !(*o.per_m2 >= 0.0f && std::isfinite(*o.per_m2)))
    throw Error(kWhere, "the places for an area are no number", "give 0 or more");
  if (!(o.most_slope >= 0.0f) || std::isnan(o.lowest_m) || std::isnan(o.highest_m))
    throw Error(kWhere, "a limit of slope or height is no number");
  for (const float spread : {o.hue_spread, o.brightness_spread})
    if (!(spread >= 0.0f && spread <= 1.0f))
      throw Error(kWhere, fmt::format("a spread of tints is {:g}", spread), "choose 0 to 1");
  for (const TakenCircle& circle : o.taken)
    if (!(circle.radius_m >= 0.0f && std::isfinite(circle.radius_m)) ||
        !std::isfinite(circle.center.x) || !std::isfinite(circle.center.y))
      throw Error(kWhere, "a taken circle is not finite");
  if (o.density != nullptr) checkCoverMap(*o.density, kWhere);
  if (o.terrain != nullptr) checkTerrain(*o.terrain, kWhere);
}

/// Kinds by chance, each as likely as its weight.
class KindChoice {
 public:
  explicit KindChoice(const std::vector<double>& weights) : sums_(weights.size()) {
    std::partial_sum(weights.begin(), weights.end(), sums_.begin());
  }
  std::uint32_t operator()(Random& random) const {
    const double at = sums_.back() * random.next() * 0x1p-32;
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), at);
    return static_cast<std::uint32_t>(
        std::min<std::ptrdiff_t>(found - sums_.begin(), std::ssize(sums_) - 1));
  }

 private:
  std::vector<double> sums_;
};

std::vector<double> sharesOf(const ScatterOptions& options) {
  double sum = 0.0;
  for (const ScatterKind& kind : options.kinds) sum += kind.share;
  std::vector<double> shares;
  for (const ScatterKind& kind : options.kinds) shares.push_back(kind.share / sum);
  return shares;
}

/// Throws darts that keep their distances. Cells are as wide as the longest distance at least, so
/// that what is in a dart's way lies in its own cell or in those around; cells three apart do not
/// know of each other, and a ninth of all is thrown into at the same time.
class DartBoard {
 public:
  DartBoard(const ScatterOptions& options, const GoodGround& ground)
      : o_(options), ground_(ground), shares_(sharesOf(options)), found_(options.kinds.size()) {
    float largest = 0.0f, least = options.kinds[0].radius_m;
    for (const ScatterKind& kind : o_.kinds) {
      largest = std::max(largest, kind.radius_m);
      least = std::min(least, kind.radius_m);
    }
    double side = 2.0 * largest;
    // Where few places are wanted, cells for about one each do.
    if (o_.per_m2) side = std::max(side, 1.0 / std::sqrt(std::max(double{*o_.per_m2}, 1e-20)));
    double cells = 1.0;
    for (int a = 0; a < 2; ++a) {
      cells *= std::max(std::floor(double{o_.size_m[a]} / side), 1.0);
      if (cells < 1e9)
        count_[a] = std::max(static_cast<int>(std::floor(double{o_.size_m[a]} / side)), 1);
    }
    const double area = double{o_.size_m.x} * double{o_.size_m.y};
    // Circles of the smallest kind cover up to 0.55 of the area where they fall by chance.
    double most = std::max(0.55 * area / (M_PI * double{least} * double{least}), cells);
    if (o_.per_m2) most = std::min(most, area * double{*o_.per_m2}) + cells;
    checkPlaceCount(most, "scatter");
    cell_ = o_.size_m / glm::vec2(count_);
    // A round's darts are about half of what fits, so that all rounds together can find it.
    darts_ = std::clamp(static_cast<int>(std::ceil(0.5 * most / cells)), 1, 1024);
    cells_.resize(cellCount());
    open_.assign(cellCount() * o_.kinds.size(), ~std::uint64_t{0});
    if (!o_.taken.empty()) noteTaken();
  }

  /// Until no more find room, or there are `wanted`. Of several kinds the largest come first, each
  /// up to its share of what fits in all, so that small ones do not take the room of large ones.
  void fill(double wanted) {
    const double area = double{o_.size_m.x} * double{o_.size_m.y};
    std::vector<double> shares = shares_;
    std::vector<std::uint32_t> order(shares_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return o_.kinds[a].radius_m > o_.kinds[b].radius_m;
    });
    for (const std::uint32_t kind : order) {
      double disc = 0.0, sum = 0.0;
      for (std::size_t k = 0; k < shares.size(); ++k) {
        disc += shares[k] * M_PI * double{o_.kinds[k].radius_m} * double{o_.kinds[k].radius_m};
        sum += shares[k];
      }
      const double fit = shares.size() > 1 ? kCover * area * sum / disc : wanted;
      fill(kind, shares[kind] / sum * std::min(wanted, fit));
      if (found_[kind] == 0) shares[kind] = 0.0;  // the others do not wait for it
    }
  }

  /// Of each kind, the share of its places that is kept so that there are `wanted` in all and kinds
  /// have their shares; what found no place at all has none.
  std::vector<double> keep(double wanted) const {
    double shares = 0.0, most = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < shares_.size(); ++k)
      if (found_[k] > 0) {
        shares += shares_[k];
        most = std::min(most, static_cast<double>(found_[k]) / shares_[k]);
      }
    std::vector<double> keep(shares_.size(), 0.0);
    for (std::size_t k = 0; k < keep.size(); ++k)
      if (found_[k] > 0)
        keep[k] = std::min(
            shares_[k] * std::min(most, wanted / shares) / static_cast<double>(found_[k]), 1.0);
    return keep;
  }

  std::size_t cellCount() const {
    return static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y);
  }
  const std::vector<Dart>& cell(std::size_t i) const { return cells_[i]; }

 private:
  void fill(std::uint32_t kind, double wanted) {
    const auto cells = static_cast<double>(cellCount());
    double success = 1.0;  // found of a dart, in the last round
    int quiet = 0;
    for (int round = 0; round < kMostRounds && quiet < kQuietRounds; ++round) {
      const auto before = static_cast<double>(found_[kind]);
      if (before >= wanted) return;
      const double darts = std::min((wanted - before) / success, darts_ * cells);
      const std::uint64_t stream =
          4u + kind * std::uint64_t{kMostRounds} + static_cast<unsigned>(round);
      for (std::uint32_t color = 0; color < 9; ++color)
        throwInto(color, kind, stream, darts / cells);
      const double gain = static_cast<double>(found_[kind]) - before;
      success = std::max(gain / darts, kLeastSuccess);
      quiet = gain * 4000.0 <= before + gain ? quiet + 1 : 0;
    }
  }

  template <class Body>
  void forCellsAround(const glm::ivec2& at, const Body& body) const {
    for (int z = std::max(at.y - 1, 0); z <= std::min(at.y + 1, count_.y - 1); ++z)
      for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, count_.x - 1); ++x)
        body(glm::ivec2(x, z));
  }

  std::size_t indexOf(const glm::ivec2& at) const {
    return static_cast<std::size_t>(at.y) * static_cast<std::size_t>(count_.x) +
           static_cast<std::size_t>(at.x);
  }

  /// Closes those pieces of a cell that lie within a circle as a whole.
  void close(std::uint64_t& open, const glm::ivec2& at, const glm::dvec2& center, double reach) {
    reach *= 1.0 - 1e-6;  // rounding must not close what is open
    const glm::dvec2 piece = glm::dvec2(cell_) / double{kSide};
    const glm::dvec2 from = center - glm::dvec2(o_.corner) - glm::dvec2(at) * glm::dvec2(cell_);
    for (int z = 0; z < kSide; ++z) {
      const double low = z * piece.y - from.y, high = low + piece.y;
      const double away = std::max(std::abs(low), std::abs(high));
      if (away >= reach) continue;
      const double half = std::sqrt(reach * reach - away * away);
      const int first =
          static_cast<int>(std::ceil(std::clamp((from.x - half) / piece.x, 0.0, 8.0)));
      const int last =
          static_cast<int>(std::floor(std::clamp((from.x + half) / piece.x, 0.0, 8.0)));
      if (last > first)
        open &= ~(((std::uint64_t{1} << (last - first)) - 1) << (z * kSide + first));
    }
  }

  void noteTaken() {
    float largest = 0.0f;
    for (const ScatterKind& kind : o_.kinds) largest = std::max(largest, kind.radius_m);
    taken_.resize(cellCount());
    for (std::uint32_t i = 0; i < o_.taken.size(); ++i) {
      const TakenCircle& circle = o_.taken[i];
      const glm::vec2 last(count_ - 1);
      const glm::vec2 reach(circle.radius_m + largest);
      const glm::vec2 low = glm::floor((circle.center - reach - o_.corner) / cell_);
      const glm::vec2 high = glm::floor((circle.center + reach - o_.corner) / cell_);
      if (high.x < 0.0f || high.y < 0.0f || low.x > last.x || low.y > last.y) continue;
      const glm::ivec2 first(glm::max(low, glm::vec2(0.0f))), end(glm::min(high, last));
      for (int z = first.y; z <= end.y; ++z)
        for (int x = first.x; x <= end.x; ++x) {
          const std::size_t cell = indexOf({x, z});
          taken_[cell].push_back(i);
          for (std::size_t k = 0; k < o_.kinds.size(); ++k)
            close(open_[cell * o_.kinds.size() + k], {x, z}, circle.center,
                  double{circle.radius_m} + double{o_.kinds[k].radius_m});
        }
    }
  }

  /// `darts`: into each cell, on the mean.
  void throwInto(std::uint32_t color, std::uint32_t kind, std::uint64_t stream, double darts) {
    const glm::ivec2 first(color % 3, color / 3);
    const glm::ivec2 cells = (count_ - first + 2) / 3;
    if (cells.x <= 0 || cells.y <= 0) return;
    const auto across = static_cast<std::size_t>(cells.x);
    parallelFor(across * static_cast<std::size_t>(cells.y), 512, [&](std::size_t i) {
      const glm::ivec2 at = first + 3 * glm::ivec2(i % across, i / across);
      if (open_[indexOf(at) * o_.kinds.size() + kind] == 0) return;
      Random random(hash(o_.seed ^ hash(indexOf(at))), stream);
      const int count = static_cast<int>(darts + random.next() * 0x1p-32);
      for (int dart = 0; dart < count; ++dart) throwOne(at, kind, random);
    });
  }

  void throwOne(const glm::ivec2& at, std::uint32_t kind, Random& random) {
    const std::size_t index = indexOf(at);
    Dart dart;
    dart.kind = kind;
    std::uint64_t open = open_[index * o_.kinds.size() + kind];
    if (open == 0) return;
    for (std::uint32_t skip = random.below(static_cast<std::uint32_t>(std::popcount(open)));
         skip > 0; --skip)
      open &= open - 1;
    const int piece = std::countr_zero(open);
    const glm::vec2 within(static_cast<float>(piece % kSide) + random.uniform(),
                           static_cast<float>(piece / kSide) + random.uniform());
    dart.place = o_.corner + (glm::vec2(at) + within / float{kSide}) * cell_;
    const double radius = o_.kinds[dart.kind].radius_m;
    const auto isNear = [&](const glm::vec2& other, double other_radius) {
      const glm::dvec2 way = glm::dvec2(dart.place) - glm::dvec2(other);
      const double reach = radius + other_radius;
      return glm::dot(way, way) < reach * reach;
    };
    bool hit = false;
    forCellsAround(at, [&](const glm::ivec2& around) {
      if (hit) return;
      for (const Dart& other : cells_[indexOf(around)])
        hit = hit || isNear(other.place, double{o_.kinds[other.kind].radius_m});
    });
    if (hit) return;
    if (!taken_.empty())
      for (const std::uint32_t i : taken_[index])
        if (isNear(o_.taken[i].center, double{o_.taken[i].radius_m})) return;
    if (!ground_.at(dart.place)) return;
    cells_[index].push_back(dart);
    ++found_[dart.kind];
    forCellsAround(at, [&](const glm::ivec2& around) {
      for (std::size_t k = 0; k < o_.kinds.size(); ++k)
        if (std::uint64_t& left = open_[indexOf(around) * o_.kinds.size() + k]; left != 0)
          close(left, around, dart.place, radius + double{o_.kinds[k].radius_m});
    });
  }

  const ScatterOptions& o_;
  const GoodGround& ground_;
  std::vector<double> shares_;
  std::vector<std::atomic<std::size_t>> found_;  // of each kind
  glm::ivec2 count_{1};
  glm::vec2 cell_{1.0f};
  int darts_ = 1;  // into each cell in a round, at most
  std::vector<std::vector<Dart>> cells_;
  std::vector<std::uint64_t> open_;                // of each cell and kind: pieces with room
  std::vector<std::vector<std::uint32_t>> taken_;  // circles that reach each cell; may be empty
};

/// Greens that are more yellow or more blue, and darker.
std::uint32_t tintOf(const ScatterOptions& options, Random& random) {
  const float hue = random.vary(options.hue_spread);
  const float bright = 1.0f - options.brightness_spread * random.uniform();
  const glm::vec3 color = hue > 0.0f ? glm::vec3(1.0f, 1.0f - 0.35f * hue, 1.0f - 0.6f * hue)
                                     : glm::vec3(1.0f + hue, 1.0f, 1.0f);
  const glm::uvec3 bytes(glm::round(255.0f * bright * color));
  return bytes.r << 16 | bytes.g << 8 | bytes.b;
}

/// `number`: of the place among all that were tried.
Placement placementOf(const ScatterOptions& options, const Dart& dart, std::uint64_t number) {
  Random random(hash(options.seed ^ hash(number)), kLookStream);
  const ScatterKind& kind = options.kinds[dart.kind];
  Placement place;
  place.plant = kind.plant;
  const float height = options.terrain == nullptr ? 0.0f : options.terrain->heightAt(dart.place);
  place.position = {dart.place.x, height, dart.place.y};
  place.angle = random.uniform(0.0f, glm::two_pi<float>());
  place.scale = random.uniform(kind.scale.x, kind.scale.y);
  place.tint = tintOf(options, random);
  place.phase = random.next();
  return place;
}

/// Thins out, each kind to `keep` of it, and gives each place its look. `darts` are those of list
/// i, `first` of each list's places is numbered.
template <class DartsOf>
std::vector<Placement> thinned(const ScatterOptions& options, std::size_t lists,
                               const std::vector<double>& keep, const DartsOf& dartsOf) {
  std::vector<std::size_t> begin(lists + 1, 0), number(lists + 1, 0);
  const auto kept = [&](std::size_t list, std::size_t i, const Dart& dart) {
    const double share =
        keep[dart.kind] *
        (options.density == nullptr ? 1.0 : double{options.density->at(dart.place)});
    if (share >= 1.0) return true;
    Random random(hash(options.seed ^ hash(number[list] + i)), kKeepStream);
    return random.next() * 0x1p-32 < share;
  };
  for (std::size_t l = 0; l < lists; ++l) number[l + 1] = number[l] + dartsOf(l).size();
  parallelFor(lists, 1024, [&](std::size_t l) {
    const auto& darts = dartsOf(l);
    for (std::size_t i = 0; i < darts.size(); ++i) begin[l + 1] += kept(l, i, darts[i]);
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Placement> places(begin.back());
  parallelFor(lists, 1024, [&](std::size_t l) {
    const auto& darts = dartsOf(l);
    std::size_t out = begin[l];
    for (std::size_t i = 0; i < darts.size(); ++i)
      if (kept(l, i, darts[i])) places[out++] = placementOf(options, darts[i], number[l] + i);
  });
  return places;
}

}  // namespace

std::vector<Placement> scatterPlants(const ScatterOptions& options) {
  check(options);
  const GoodGround ground(options);
  const double area = double{options.size_m.x} * double{options.size_m.y};
  if (options.kinds[0].radius_m > 0.0f) {
    DartBoard board(options, ground);
    const double wanted = options.per_m2 ? double{*options.per_m2} * area * ground.share() : 1e300;
    board.fill(wanted);
    return thinned(options, board.cellCount(), board.keep(wanted),
                   [&](std::size_t c) -> const std::vector<Dart>& { return board.cell(c); });
  }
  const double count = std::round(double{*options.per_m2} * area);
  checkPlaceCount(count, "scatter");
  const KindChoice choice(sharesOf(options));
  // One list a piece of the work; what falls on bad or taken ground is dropped.
  constexpr std::size_t kList = 256;
  const auto all = static_cast<std::size_t>(count);
  std::vector<std::vector<Dart>> lists((all + kList - 1) / kList);
  parallelFor(lists.size(), 8, [&](std::size_t l) {
    for (std::size_t i = l * kList; i < std::min(all, (l + 1) * kList); ++i) {
      Random random(hash(options.seed ^ hash(i)), kDartStream);
      Dart dart;
      dart.kind = choice(random);
      dart.place = options.corner + options.size_m * glm::vec2(random.uniform(), random.uniform());
      const bool is_free =
          std::none_of(options.taken.begin(), options.taken.end(), [&](const TakenCircle& circle) {
            return glm::distance(glm::dvec2(dart.place), glm::dvec2(circle.center)) <
                   double{circle.radius_m};
          });
      if (is_free && ground.at(dart.place)) lists[l].push_back(dart);
    }
  });
  return thinned(options, lists.size(), std::vector<double>(options.kinds.size(), 1.0),
                 [&](std::size_t l) -> const std::vector<Dart>& { return lists[l]; });
}

}  // namespace verdure
