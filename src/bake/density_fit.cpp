#include "bake/density_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "bake/crown_parameters.h"
#include "bake/depth_fit.h"
#include "base/progress.h"
#include "shared/density.h"
#include "verdure/density.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::size_t kFieldSamples = 256;  // of leaves and of wood each
constexpr int kFieldRays = 128;
// The openness of this quantile counts as 1: k of (4) is 1 outside the crown, where a leaf still
// has its neighbours.
constexpr double kFullQuantile = 0.95;
constexpr float kLeastDepth = 1e-3f;

/// k_min by least squares, in [0, 1], and the mean squared error: k = 1 - (1 - k_min) g.
double errorOf(std::span<const float> sums, std::span<const float> target, Falloff& f) {
  double gg = 0, gt = 0, tt = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double g =
        1.0 - double{shared::ambientCoefficient(sums[i] - f.tau, f.d_min, 0.0f, f.exponent)};
    const double t = 1.0 - double{target[i]};
    gg += g * g, gt += g * t, tt += t * t;
  }
  const double slope = gg > 0.0 ? std::clamp(gt / gg, 0.0, 1.0) : 0.0;
  f.k_min = static_cast<float>(1.0 - slope);
  return std::max(0.0, tt - 2.0 * slope * gt + slope * slope * gg) /
         static_cast<double>(sums.size());
}

}  // namespace

double fitFalloff(std::span<const float> sums, std::span<const float> target, Falloff& best) {
  std::vector<float> sorted(sums.begin(), sums.end());
  std::sort(sorted.begin(), sorted.end());
  const float most = std::max(sorted.back(), kLeastDepth);
  const auto quantile = [&](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  };
  struct Start {
    double error;
    Falloff falloff;
  };
  std::vector<Start> starts;
  for (const double low : {-1.0, 0.0, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5})
    for (const double high : {0.3, 0.5, 0.7, 0.85, 0.95, 1.0, 1.5, 3.0})
      for (const float exponent : {0.25f, 0.5f, 1.0f, 2.0f, 4.0f}) {
        Falloff f;
        f.tau = low < 0.0 ? 0.0f : quantile(low);
        f.d_min = (high <= 1.0 ? quantile(high) : static_cast<float>(high) * most) - f.tau;
        f.exponent = exponent;
        if (f.d_min < kLeastDepth * most) continue;
        const double error = errorOf(sums, target, f);
        starts.push_back({error, f});
      }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.error < b.error; });
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < std::min<std::size_t>(starts.size(), 4); ++s) {
    auto [error, at] = starts[s];
    for (float step = 0.5f; step > 0.01f;) {
      bool better = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
          Falloff f = at;
          if (axis == 0) f.tau = std::clamp(f.tau + sign * step * 0.3f * most, 0.0f, 0.95f * most);
          if (axis == 1) f.d_min = std::max(f.d_min * std::exp(sign * step), kLeastDepth * most);
          if (axis == 2) f.exponent = std::clamp(f.exponent * std::exp(sign * step), 0.05f, 20.0f);
          const double e = errorOf(sums, target, f);
          if (e < error) {
            error = e;
            at = f;
            better = true;
          }
        }
      if (!better) step *= 0.5f;
    }
    if (error < least) {
      least = error;
      best = at;
    }
  }
  return std::sqrt(least);
}

DensityOptions fitDensity(const Plant& plant, const DensityOptions& options, DensityFit* fit) {
  Timer timer;
  std::size_t skipped = 0;
  const std::vector<glm::vec3> centers = foliageCenters(plant, skipped);
  if (centers.size() < 2)
    throw Error(plant.name, "the plant has fewer than two leaves", "check --foliage");
  const TracedSamples samples =
      traceSamples(plant, kFieldSamples, kFieldRays, options.seed, options.max_memory_bytes);
  if (samples.vertices.empty())
    throw Error(plant.name, "no vertex sees anything of the sky", "leave --fit out");
  std::vector<glm::vec3> points;
  for (const VertexId id : samples.vertices)
    points.push_back(plant.meshes[id.mesh].positions[id.vertex]);
  std::vector<float> sorted = samples.openness;
  std::sort(sorted.begin(), sorted.end());
  const float full =
      sorted[static_cast<std::size_t>(kFullQuantile * static_cast<double>(sorted.size() - 1))];
  std::vector<float> target;
  for (const float o : samples.openness) target.push_back(std::min(o / full, 1.0f));

  const auto sumsFor = [&](float rho) {
    std::vector<Generator> generators;
    for (const glm::vec3& c : centers) generators.push_back({c, rho});
    std::vector<float> sums(points.size());
    DensityField(generators, options.norm).sumAt(points, sums);
    return sums;
  };
  const auto coefficients = [&](const std::vector<float>& sums, const Falloff& f) {
    std::vector<float> k;
    for (const float s : sums)
      k.push_back(shared::ambientCoefficient(s - f.tau, f.d_min, f.k_min, f.exponent));
    return k;
  };

  // rho: from the smallest that still joins leaves to the crown's own size, then between the
  // neighbours of the best two.
  const float usual = defaultRho(centers);
  std::map<float, std::pair<double, Falloff>> tried;
  const auto attempt = [&](float rho) {
    const auto [at, fresh] = tried.try_emplace(rho);
    if (fresh) at->second.first = fitFalloff(sumsFor(rho), target, at->second.second);
    return at->second.first;
  };
  constexpr int kCoarse = 9;
  std::array<float, kCoarse> rhos{};
  std::array<double, kCoarse> errors{};
  for (std::size_t i = 0; i < kCoarse; ++i) {
    rhos[i] = usual * 0.35f * std::pow(1.5f, static_cast<float>(i));
    errors[i] = attempt(rhos[i]);
  }
  std::array<std::size_t, kCoarse> order{};
  for (std::size_t i = 0; i < kCoarse; ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
  for (std::size_t s = 0; s < 2; ++s) {
    float center = rhos[order[s]];
    for (float step = 1.22f; step > 1.04f; step = std::sqrt(step))
      for (const float factor : {step, 1.0f / step})
        if (attempt(rhos[order[s]] * factor) < attempt(center)) center = rhos[order[s]] * factor;
  }
  const auto best = std::min_element(tried.begin(), tried.end(), [](const auto& a, const auto& b) {
    return a.second.first < b.second.first;
  });

  if (fit != nullptr) {
    const float rho = options.rho.value_or(usual);
    std::vector<Generator> generators;
    for (const glm::vec3& c : centers) generators.push_back({c, rho});
    std::vector<float> at_leaves(centers.size());
    DensityField(generators, options.norm).sumAt(centers, at_leaves);
    const CrownThresholds usual_thresholds = defaultThresholds(at_leaves, options);
    fit->samples = points.size();
    fit->full = full;
    fit->before =
        agreementOf(coefficients(sumsFor(rho), {usual_thresholds.tau, usual_thresholds.d_min,
                                                options.k_min, options.exponent}),
                    target);
    fit->after = agreementOf(coefficients(sumsFor(best->first), best->second.second), target);
  }
  DensityOptions fitted = options;
  fitted.rho = best->first;
  fitted.tau = best->second.second.tau;
  fitted.d_min = best->second.second.d_min;
  fitted.k_min = best->second.second.k_min;
  fitted.exponent = best->second.second.exponent;
  if (fit != nullptr) fit->seconds = timer.seconds();
  return fitted;
}

}  // namespace verdure
