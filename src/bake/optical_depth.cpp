#include "verdure/optical_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bake/surfel_tree.h"
#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr const char* kWhere = "optical depth";
// Points that share one list of terms: a few vectors, close together.
constexpr std::size_t kGroup = 64;

/// The pieces that sortedByMedians() leaves: halving needs no coordinates to be repeated.
void piecesOf(std::size_t first, std::size_t last,
              std::vector<std::pair<std::size_t, std::size_t>>& pieces) {
  if (last - first <= kGroup) {
    if (last > first) pieces.emplace_back(first, last);
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  piecesOf(first, middle, pieces);
  piecesOf(middle, last, pieces);
}

/// exp(-k max(X - v mu, 0)) along the cosine mu to the thin side, integrated in closed form.
struct LinearDepth {
  double x, v, k;  ///< X, 3 |toward|, k
  double m;        ///< nothing stands at cosines above

  LinearDepth(const DepthSums& sums, const DepthModel& model)
      : x(std::max(double{sums.depth}, 0.0)),
        v(3.0 * glm::length(glm::dvec3(sums.toward))),
        k(model.k),
        m(v > x ? x / v : 1.0) {}
  bool even() const { return k * v < 1e-3; }

  /// Mean over the sphere.
  double mean() const {
    if (even()) return std::exp(-k * x);
    const double s = k * v;
    return 0.5 * (1.0 - m + (std::exp(s * m - k * x) - std::exp(-s - k * x)) / s);
  }
  /// 2 int_0^1 mu ... d mu.
  double outward() const {
    if (even()) return std::exp(-k * x);
    const double s = k * v;
    return 1.0 - m * m +
           2.0 * (std::exp(s * m - k * x) * (s * m - 1.0) + std::exp(-k * x)) / (s * s);
  }
};

float modelled(double mean, const DepthModel& model) {
  return static_cast<float>(std::clamp(model.a + model.b * mean, 0.0, 1.0));
}

}  // namespace

struct OpticalDepthField::State {
  SurfelTree tree;
  DepthFieldOptions options;
  NearWeight near;  ///< in the tree's units
};

OpticalDepthField::OpticalDepthField(std::span<const Surfel> surfels,
                                     const DepthFieldOptions& options)
    : state_(std::make_unique<State>()) {
  if (!(options.near_gain >= 0.0f && std::isfinite(options.near_gain)) ||
      !(options.near_radius > 0.0f && std::isfinite(options.near_radius)) ||
      !(options.opening >= 0.0f && options.opening <= 0.9f))
    throw Error(kWhere, "an option is out of range",
                "near_gain >= 0, near_radius > 0, opening in [0, 0.9]");
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Surfel& s = surfels[i];
    if (!std::isfinite(s.position.x + s.position.y + s.position.z) ||
        !(s.area >= 0.0f && std::isfinite(s.area)) ||
        !(s.extent >= 0.0f && std::isfinite(s.extent)))
      throw Error(kWhere, fmt::format("surfel {} is not finite or has a negative size", i),
                  "check the mesh it comes from");
  }
  state_->tree = SurfelTree(surfels);
  state_->options = options;
  const float radius = options.near_radius * state_->tree.scale();
  state_->near.b = radius * radius;
  state_->near.a = radius * radius * (1.0f + options.near_gain);
}
OpticalDepthField::~OpticalDepthField() = default;
OpticalDepthField::OpticalDepthField(OpticalDepthField&&) noexcept = default;
OpticalDepthField& OpticalDepthField::operator=(OpticalDepthField&&) noexcept = default;

std::size_t OpticalDepthField::surfelCount() const {
  return state_->tree.count();
}
const DepthFieldOptions& OpticalDepthField::options() const {
  return state_->options;
}

double OpticalDepthField::sumAt(std::span<const glm::vec3> points,
                                std::span<const glm::vec3> normals,
                                std::span<DepthSums> sums) const {
  const std::vector<std::uint32_t> order = sortedByMedians(points, kGroup);
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  piecesOf(0, points.size(), pieces);
  std::vector<double> evaluated(pieces.size());
  parallelChunks(pieces.size(), 8, [&](std::size_t begin, std::size_t end) {
    DepthTerms terms;
    std::vector<float> in(6 * kGroup), out(5 * kGroup);
    for (std::size_t piece = begin; piece < end; ++piece) {
      const auto [first, last] = pieces[piece];
      const std::size_t n = (last - first + kDepthLanes - 1) / kDepthLanes * kDepthLanes;
      glm::vec3 low(0.0f), high(0.0f);
      for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t from = order[std::min(first + i, last - 1)];
        const glm::vec3 p = state_->tree.toTree(points[from]);
        const glm::vec3 normal = normals.empty() ? glm::vec3(0.0f) : normals[from];
        for (int a = 0; a < 3; ++a) {
          const auto row = static_cast<std::size_t>(a);
          in[row * n + i] = p[a];
          in[(3 + row) * n + i] = normal[a];
        }
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
      }
      terms.clear();
      state_->tree.termsFor(low, high, state_->options.opening, terms);
      const float* const x = in.data();
      sumDepthTerms(terms, {x, x + n, x + 2 * n, x + 3 * n, x + 4 * n, x + 5 * n, n}, state_->near,
                    out.data());
      for (std::size_t i = first; i < last; ++i) {
        const float* const o = out.data() + (i - first);
        sums[order[i]] = {o[0], {o[n], o[2 * n], o[3 * n]}, o[4 * n]};
      }
      evaluated[piece] = static_cast<double>(terms.count) * static_cast<double>(last - first);
    }
  });
  const double all = std::accumulate(evaluated.begin(), evaluated.end(), 0.0);
  return points.empty() ? 0.0 : all / static_cast<double>(points.size());
}

DepthSums OpticalDepthField::termsOf(std::span<const Surfel> surfels, const glm::vec3& point,
                                     const glm::vec3& normal) const {
  const float radius2 = state_->options.near_radius * state_->options.near_radius;
  DepthSums sums;
  for (const Surfel& s : surfels) {
    if (!(s.area > 0.0f)) continue;
    const glm::vec3 o = s.position - point;
    const float r2 = glm::dot(o, o), r = std::sqrt(r2);
    const float near = 1.0f + state_->options.near_gain * radius2 / (radius2 + r2);
    const float w = near * 0.5f * s.area / (12.5663706f * r2 + 2.0f * s.area);
    sums.depth += w;
    if (!(r > 0.0f)) continue;
    sums.toward += w / r * o;
    sums.hemisphere += 4.0f * w * std::max(glm::dot(normal, o) / r, 0.0f);
  }
  return sums;
}

float opennessOf(const DepthSums& sums, const DepthModel& model) {
  return modelled(LinearDepth(sums, model).mean(), model);
}

float hemisphereLightOf(const DepthSums& sums, const DepthModel& model) {
  return modelled(std::exp(-double{model.k} * double{sums.hemisphere}), model);
}

float outwardLightOf(const DepthSums& sums, const DepthModel& model) {
  return modelled(LinearDepth(sums, model).outward(), model);
}

}  // namespace verdure
