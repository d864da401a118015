#include "bake/depth_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::size_t kModelSamples = 192;  // of each kind
constexpr int kModelRays = 128;
constexpr std::size_t kFewest = 24;  // fewer say too little

/// Ranks from 0, ties at their mean.
std::vector<double> ranksOf(std::span<const float> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) ranks[order[k]] = 0.5 * static_cast<double>(i + j - 1);
    i = j;
  }
  return ranks;
}

using Prediction = float (*)(const DepthSums&, const DepthModel&);

/// Least squares for a and b at a given k, then golden section over the logarithm of k.
DepthModel fitModel(Prediction predict, const std::vector<DepthSums>& sums,
                    const std::vector<float>& traced) {
  std::vector<double> x(sums.size());
  const auto solve = [&](double k, double& error) {
    const DepthModel plain{0.0f, 1.0f, static_cast<float>(k)};
    double s1 = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      x[i] = double{predict(sums[i], plain)};
      const double y = double{traced[i]};
      s1 += 1, sx += x[i], sy += y, sxx += x[i] * x[i], sxy += x[i] * y;
    }
    const double spread = sxx - sx * sx / s1;
    const double b = spread > 1e-9 ? (sxy - sx * sy / s1) / spread : 0.0;
    const double a = (sy - b * sx) / s1;
    const DepthModel model{static_cast<float>(a), static_cast<float>(b), static_cast<float>(k)};
    error = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double e = std::clamp(a + b * x[i], 0.0, 1.0) - double{traced[i]};
      error += e * e;
    }
    return model;
  };
  double low = std::log(0.05), high = std::log(6.0);
  constexpr double kGolden = 0.6180339887498949;
  double error = 0.0;
  DepthModel best{};
  double best_error = std::numeric_limits<double>::infinity();
  const auto at = [&](double log_k) {
    const DepthModel model = solve(std::exp(log_k), error);
    if (error < best_error) {
      best_error = error;
      best = model;
    }
    return error;
  };
  double u = high - kGolden * (high - low), v = low + kGolden * (high - low);
  double fu = at(u), fv = at(v);
  for (int i = 0; i < 16; ++i)
    if (fu < fv) {
      high = v, v = u, fv = fu;
      u = high - kGolden * (high - low), fu = at(u);
    } else {
      low = u, u = v, fu = fv;
      v = low + kGolden * (high - low), fv = at(v);
    }
  return best;
}

}  // namespace

Agreement agreementOf(std::span<const float> predicted, std::span<const float> traced) {
  Agreement result;
  if (predicted.empty()) return result;
  const auto n = static_cast<double>(predicted.size());
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const double e = double{predicted[i]} - double{traced[i]};
    result.rms += e * e / n;
  }
  result.rms = std::sqrt(result.rms);
  const std::vector<double> p = ranksOf(predicted), t = ranksOf(traced);
  const double middle = 0.5 * (n - 1.0);
  double pt = 0, pp = 0, tt = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    pt += (p[i] - middle) * (t[i] - middle);
    pp += (p[i] - middle) * (p[i] - middle);
    tt += (t[i] - middle) * (t[i] - middle);
  }
  result.rank = pp > 0.0 && tt > 0.0 ? pt / std::sqrt(pp * tt) : 0.0;
  return result;
}

TracedSamples traceSamples(const Plant& plant, std::size_t count, int rays, std::uint32_t seed,
                           std::size_t max_memory_bytes,
                           const std::function<glm::vec3(VertexId)>& normalOf) {
  Random random(seed);
  std::vector<VertexId> chosen;
  for (const PartKind kind : {PartKind::kFoliage, PartKind::kWood}) {
    std::size_t all = 0;
    for (const Mesh& mesh : plant.meshes)
      if (mesh.kind == kind) all += mesh.positions.size();
    // Selection sampling (Knuth, The Art of Computer Programming, 3.4.2, algorithm S).
    std::size_t wanted = std::min(count, all), left = all;
    for (std::uint32_t m = 0; m < plant.meshes.size(); ++m) {
      if (plant.meshes[m].kind != kind) continue;
      for (std::uint32_t v = 0; v < plant.meshes[m].positions.size(); ++v, --left)
        if (random.below(static_cast<std::uint32_t>(left)) < wanted) {
          chosen.push_back({m, v});
          --wanted;
        }
    }
  }
  RayOptions options;
  options.rays = rays;
  options.seed = seed;
  options.max_memory_bytes = max_memory_bytes;
  std::vector<glm::vec3> normals;
  if (normalOf)
    for (const VertexId id : chosen) normals.push_back(normalOf(id));
  const std::vector<Openness> traced = traceOpenness(plant, chosen, options, normals);
  TracedSamples samples;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!(traced[i].share > 0.0f)) continue;
    samples.vertices.push_back(chosen[i]);
    samples.openness.push_back(traced[i].share);
    samples.light.push_back(traced[i].light);
  }
  return samples;
}

DepthFit fitDepthModels(const Plant& plant, std::span<const DepthSums> sums, std::uint32_t seed,
                        std::size_t max_memory_bytes) {
  std::vector<std::size_t> first;
  std::size_t vertex = 0;
  for (const Mesh& mesh : plant.meshes) {
    first.push_back(vertex);
    vertex += mesh.positions.size();
  }
  const auto sumsAt = [&](VertexId id) -> const DepthSums& {
    return sums[first[id.mesh] + id.vertex];
  };
  const auto kindAt = [&](VertexId id) { return plant.meshes[id.mesh].kind; };
  const TracedSamples samples =
      traceSamples(plant, kModelSamples, kModelRays, seed, max_memory_bytes, [&](VertexId id) {
        const glm::vec3& own = plant.meshes[id.mesh].normals[id.vertex];
        return kindAt(id) == PartKind::kFoliage ? crownNormalOf(sumsAt(id), own) : own;
      });
  DepthFit fit;
  fit.samples = samples.vertices.size();
  for (const PartKind kind : {PartKind::kFoliage, PartKind::kWood}) {
    std::vector<DepthSums> some;
    std::vector<float> openness, light;
    for (std::size_t i = 0; i < fit.samples; ++i) {
      if (kindAt(samples.vertices[i]) != kind) continue;
      some.push_back(sumsAt(samples.vertices[i]));
      openness.push_back(samples.openness[i]);
      light.push_back(samples.light[i]);
    }
    if (some.size() < kFewest) continue;
    const bool leaves = kind == PartKind::kFoliage;
    (leaves ? fit.models.leaf : fit.models.wood) = fitModel(opennessOf, some, openness);
    (leaves ? fit.models.crown_light : fit.models.wood_light) =
        fitModel(leaves ? outwardLightOf : hemisphereLightOf, some, light);
  }
  const auto agreement = [&](const DepthModels& models, bool of_light) {
    std::vector<float> predicted;
    for (const VertexId id : samples.vertices) {
      const DepthSums& s = sumsAt(id);
      const bool leaves = kindAt(id) == PartKind::kFoliage;
      predicted.push_back(!of_light ? opennessOf(s, models.of(kindAt(id)))
                          : leaves  ? outwardLightOf(s, models.crown_light)
                                    : hemisphereLightOf(s, models.wood_light));
    }
    return agreementOf(predicted, of_light ? samples.light : samples.openness);
  };
  fit.before = agreement(DepthModels{}, false);
  fit.after = agreement(fit.models, false);
  fit.light_before = agreement(DepthModels{}, true);
  fit.light_after = agreement(fit.models, true);
  return fit;
}

}  // namespace verdure
