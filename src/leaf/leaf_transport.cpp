#include "leaf/leaf_transport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/random.h"
#include "shared/leaf_basis.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::size_t kChunk = 16 * kPlaneLanes;

/// rho_d of (3.4). Checks set and options, because it is what is asked first.
double surfaceReflection(const LeafSet& set, const LeafBakeOptions& options) {
  const std::string where = set.name.empty() ? "leaf" : set.name;
  checkLeafSet(set, where);
  if (std::none_of(set.opacity.begin(), set.opacity.end(), [](float o) { return o >= 0.5f; }))
    throw Error(where, "the opacity shows no leaf", "mend its opacity map");
  if (options.directions < 16 || options.directions > 65536)
    throw Error("--directions", fmt::format("is {}", options.directions), "give 16 to 65536");
  if (!options.surface_reflection) return insideReflection(double{set.optics.refractive_index});
  const float rho = *options.surface_reflection;
  if (!(rho >= 0 && rho < 1))
    throw Error("--surface-reflection", fmt::format("is {:g}", rho), "give a number in [0, 1)");
  return double{rho};
}

/// Least and most of a plane where there is leaf.
ThicknessGrid makeGrid(const Multipole& multipole, const Plane& thickness) {
  float least = std::numeric_limits<float>::max(), most = 0;
  for (const float d : thickness)
    if (d > 0) {
      least = std::min(least, d);
      most = std::max(most, d);
    }
  const double limit = multipole.leastThickness();
  return {multipole, std::max(double{least}, limit), std::max(double{most}, limit)};
}

}  // namespace

std::vector<glm::vec3> hemisphereDirections(int count, std::uint64_t seed) {
  int rows = static_cast<int>(std::sqrt(static_cast<double>(count)));
  while (count % rows != 0) --rows;
  const int columns = count / rows;
  Random random(seed);
  std::vector<glm::vec3> directions;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const float u = (static_cast<float>(i) + random.uniform()) / static_cast<float>(columns);
      const float v = (static_cast<float>(j) + random.uniform()) / static_cast<float>(rows);
      const float a = 2 * u - 1, b = 2 * v - 1;  // onto concentric squares, then rings
      float r = a, phi = 0;
      constexpr float kQuarter = std::numbers::pi_v<float> / 4;
      if (std::abs(a) > std::abs(b)) {
        phi = kQuarter * b / a;
      } else if (b != 0) {
        r = b;
        phi = 2 * kQuarter - kQuarter * a / b;
      }
      const float out = r * std::sqrt(2 - r * r);
      directions.emplace_back(out * std::cos(phi), out * std::sin(phi), 1 - r * r);
    }
  return directions;
}

std::vector<glm::vec3> projectionWeights(const std::vector<glm::vec3>& directions) {
  glm::dmat3 gram(0);
  for (const glm::vec3& w : directions) {
    const glm::dvec3 basis = shared::leafBasis(w);
    gram += glm::outerProduct(basis, basis);
  }
  const glm::dmat3 inverse = glm::inverse(gram);
  std::vector<glm::vec3> weights;
  for (const glm::vec3& w : directions)
    weights.emplace_back(inverse * glm::dvec3(shared::leafBasis(w)));
  return weights;
}

LeafTransport::LeafTransport(const LeafSet& set, const LeafBakeOptions& options)
    : width_(set.width),
      height_(set.height),
      stride_((static_cast<std::size_t>(set.width) + kPlaneLanes - 1) / kPlaneLanes * kPlaneLanes),
      texel_(set.mm_per_texel),
      report_{.surface_reflection = surfaceReflection(set, options)},
      multipole_(set.optics, report_.surface_reflection, options.pairs),
      grid_(multipole_, 1.0, 1.0) {
  const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
  const std::size_t n = stride_ * h;
  inside_.resize(n);
  thickness_.resize(n);
  for (Side& side : sides_)
    for (Plane* plane : {&side.x, &side.y, &side.z, &side.entering}) plane->resize(n);
  for (std::vector<float>& relief : relief_mm_) relief.resize(n);
  const auto limit = static_cast<float>(multipole_.leastThickness());
  parallelFor(h, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const std::size_t from = y * w + x, to = y * stride_ + x;
      if (set.opacity[from] < 0.5f) continue;
      inside_[to] = 1;
      thickness_[to] = std::max(set.thickness_mm[from], limit);
      for (const std::size_t s : {0, 1}) {
        const LeafSide& side = s == 0 ? set.front : set.back;
        sides_[s].x[to] = side.normal[from].x;
        sides_[s].y[to] = side.normal[from].y;
        sides_[s].z[to] = side.normal[from].z;
        sides_[s].entering[to] = 1.0f - glm::dot(side.albedo[from], options.wavelength);
        relief_mm_[s][to] = side.relief_mm[from];
      }
    }
  });
  report_.least_thickness_mm = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    if (set.opacity[i] < 0.5f) continue;
    const double d = double{set.thickness_mm[i]};
    report_.least_thickness_mm = std::min(report_.least_thickness_mm, d);
    report_.most_thickness_mm = std::max(report_.most_thickness_mm, d);
    ++report_.texels;
    if (d < double{limit}) ++report_.clamped;
  }
  grid_ = makeGrid(multipole_, thickness_);
  places_.resize(n);
  parallelFor(n, kChunk, [&](std::size_t i) {
    if (inside_[i] != 0) places_[i] = grid_.place(thickness_[i]);
  });
  report_.radius_mm =
      kernelRadius(multipole_, grid_.thickness(0), grid_.thickness(grid_.size() - 1));
  radius_ = std::max(1, static_cast<int>(std::ceil(report_.radius_mm / double{texel_})));
}

std::array<Plane, 3> LeafTransport::enteringLight(int side,
                                                  const std::vector<glm::vec3>& directions,
                                                  const std::vector<glm::vec3>& weights) {
  const auto s = static_cast<std::size_t>(side);
  Timer timer;
  if (horizon_[s].empty())
    horizon_[s].emplace_back(relief_mm_[s], inside_, width_, height_, stride_, texel_);
  report_.horizon_seconds += timer.lap();
  std::array<std::vector<LitDirection>, kHorizonSlices> slices;
  for (std::size_t m = 0; m < directions.size(); ++m) {
    const glm::vec3& w = directions[m];
    const double turn = std::atan2(double{w.y}, double{w.x}) / Horizon::azimuth(1);
    const double place = turn < 0 ? turn + kHorizonSlices : turn;
    const double slice = std::min(std::floor(place), kHorizonSlices - 1.0);
    const float run = std::hypot(w.x, w.y);
    slices[static_cast<std::size_t>(slice)].push_back({w.x,
                                                       w.y,
                                                       w.z,
                                                       static_cast<float>(place - slice),
                                                       w.z / std::max(run, 1e-9f),
                                                       {weights[m].x, weights[m].y, weights[m].z}});
  }
  const std::size_t n = thickness_.size();
  std::array<Plane, 3> sums{Plane(n), Plane(n), Plane(n)};
  float* const to[3] = {sums[0].data(), sums[1].data(), sums[2].data()};
  Plane first, second, opening;
  for (int slice = 0; slice < kHorizonSlices; ++slice) {
    const int next = (slice + 1) % kHorizonSlices;
    timer.lap();
    first = std::move(second);
    second.clear();
    const std::vector<LitDirection>& lit = slices[static_cast<std::size_t>(slice)];
    if (lit.empty()) continue;
    if (first.empty()) first = horizon_[s][0].slopes(slice);
    if (slice == 0) opening = first;
    second = next == 0 && !opening.empty() ? std::move(opening) : horizon_[s][0].slopes(next);
    report_.horizon_seconds += timer.lap();
    const LitTexels texels{sides_[s].x.data(),        sides_[s].y.data(), sides_[s].z.data(),
                           sides_[s].entering.data(), first.data(),       second.data()};
    parallelChunks(n, kChunk, [&](std::size_t begin, std::size_t end) {
      addDirections(lit, texels, begin, end - begin, to);
    });
    report_.projection_seconds += timer.lap();
  }
  return sums;
}

std::vector<Plane> LeafTransport::throughGaussians(const GaussianSum& sum,
                                                   const std::vector<const Plane*>& planes) const {
  const auto h = static_cast<std::size_t>(height_);
  std::vector<Plane> through(planes.size(), Plane(thickness_.size())), rows = through;
  const Plane nothing(stride_);
  for (const GaussianTerm& term : sum.terms) {
    const std::size_t reach = term.taps.size() - 1;
    parallelChunks(h, 8, [&](std::size_t begin, std::size_t end) {
      std::vector<float> weight(stride_), weighted(stride_ + 2 * reach);
      for (std::size_t y = begin; y < end; ++y) {
        const float* const place = places_.data() + y * stride_;
        for (std::size_t x = 0; x < stride_; ++x) {
          const auto k = static_cast<std::size_t>(place[x]);
          const float low = term.weights[k];
          const float high = term.weights[std::min(k + 1, term.weights.size() - 1)];
          weight[x] = low + (place[x] - static_cast<float>(k)) * (high - low);
        }
        for (std::size_t p = 0; p < planes.size(); ++p) {
          const float* const light = planes[p]->data() + y * stride_;
          for (std::size_t x = 0; x < stride_; ++x) weighted[reach + x] = weight[x] * light[x];
          convolveRow(weighted.data() + reach, rows[p].data() + y * stride_, stride_, term.taps);
        }
      }
    });
    parallelChunks(h, 16, [&](std::size_t begin, std::size_t end) {
      std::vector<const float*> near(2 * reach + 1);
      for (std::size_t p = 0; p < planes.size(); ++p)
        for (std::size_t y = begin; y < end; ++y) {
          for (std::size_t k = 0; k < near.size(); ++k) {
            const std::size_t row = y + k;  // reach too high
            near[k] = row >= reach && row - reach < h ? rows[p].data() + (row - reach) * stride_
                                                      : nothing.data();
          }
          addColumns(near.data(), through[p].data() + y * stride_, stride_, term.taps);
        }
    });
  }
  return through;
}

void LeafTransport::makeDirectKernel() {
  if (!direct_.empty()) return;
  const auto side = static_cast<std::size_t>(2 * radius_ + 1);
  const auto thicknesses = static_cast<std::size_t>(grid_.size());
  direct_.resize(side * side * thicknesses);
  parallelFor(thicknesses, 1, [&](std::size_t t) {
    for (int y = 0; y <= radius_; ++y)
      for (int x = 0; x <= y; ++x) {
        const auto share = static_cast<float>(
            texelShare(multipole_, double{texel_}, x, y, grid_.thickness(static_cast<int>(t))));
        for (const auto& [a, b] : {std::pair{x, y}, std::pair{y, x}})
          for (const int u : {radius_ - a, radius_ + a})
            for (const int v : {radius_ - b, radius_ + b})
              direct_[(static_cast<std::size_t>(v) * side + static_cast<std::size_t>(u)) *
                          thicknesses +
                      t] = share;
      }
  });
}

Plane LeafTransport::throughDirectly(const Plane& plane, int begin, int end) const {
  VERDURE_CHECK_EQ(direct_.empty(), false);
  const auto side = static_cast<std::size_t>(2 * radius_ + 1);
  const auto thicknesses = static_cast<std::size_t>(grid_.size());
  Plane through(plane.size());
  parallelFor(static_cast<std::size_t>(end - begin), 1, [&](std::size_t row) {
    const int y = begin + static_cast<int>(row);
    for (int x = 0; x < width_; ++x) {
      double sum = 0;
      for (int v = std::max(y - radius_, 0); v <= std::min(y + radius_, height_ - 1); ++v) {
        float of_row = 0;
        for (int u = std::max(x - radius_, 0); u <= std::min(x + radius_, width_ - 1); ++u) {
          const std::size_t i = static_cast<std::size_t>(v) * stride_ + static_cast<std::size_t>(u);
          const auto k = static_cast<std::size_t>(places_[i]);
          const float* const shares =
              direct_.data() + (static_cast<std::size_t>(v - y + radius_) * side +
                                static_cast<std::size_t>(u - x + radius_)) *
                                   thicknesses;
          const float low = shares[k], high = shares[std::min(k + 1, thicknesses - 1)];
          of_row += (low + (places_[i] - static_cast<float>(k)) * (high - low)) * plane[i];
        }
        sum += double{of_row};
      }
      through[static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x)] =
          static_cast<float>(sum);
    }
  });
  return through;
}

}  // namespace verdure
