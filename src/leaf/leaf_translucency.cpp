#include "verdure/leaf_translucency.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "base/progress.h"
#include "leaf/fill_outside.h"
#include "leaf/leaf_transport.h"
#include "shared/leaf_basis.h"

namespace verdure {
namespace {

/// Light that leaves over what the closed form lets through of what enters. The basis' functions
/// are summed first: they are cos(theta) then, which no sum can make 0.
double conservation(const LeafTransport& leaf, const std::array<Plane, 3>& in,
                    const std::array<const Plane*, 3>& out) {
  std::vector<double> totals;
  for (int k = 0; k < leaf.grid().size(); ++k)
    totals.push_back(leaf.multipole().total(leaf.grid().thickness(k)));
  double entering = 0, leaving = 0;
  for (std::size_t i = 0; i < in[0].size(); ++i) {
    if (leaf.inside()[i] != 0) {
      const float place = leaf.places()[i];
      const auto k = static_cast<std::size_t>(place);
      const double high = totals[std::min(k + 1, totals.size() - 1)];
      const double total = totals[k] + double{place - static_cast<float>(k)} * (high - totals[k]);
      entering += total * (double{in[0][i]} + double{in[1][i]} + double{in[2][i]});
    }
    leaving += double{(*out[0])[i]} + double{(*out[1])[i]} + double{(*out[2])[i]};
  }
  return leaving / entering;
}

std::vector<glm::vec3> finished(const LeafTransport& leaf,
                                const std::array<const Plane*, 3>& planes) {
  const auto w = static_cast<std::size_t>(leaf.width()),
             h = static_cast<std::size_t>(leaf.height());
  std::vector<glm::vec3> texels(w * h);
  std::vector<std::uint8_t> inside(w * h);
  parallelFor(h, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const std::size_t i = y * leaf.stride() + x;
      texels[y * w + x] = {(*planes[0])[i], (*planes[1])[i], (*planes[2])[i]};
      inside[y * w + x] = leaf.inside()[i];
    }
  });
  fillOutside(texels, inside, leaf.width(), leaf.height());
  return texels;
}

GaussianSum fit(LeafTransport& leaf) {
  const Timer timer;
  GaussianSum sum =
      fitGaussians(leaf.multipole(), double{leaf.texel()}, leaf.grid(), leaf.report().radius_mm);
  leaf.report().fit_seconds = timer.seconds();
  leaf.report().terms = static_cast<int>(sum.terms.size());
  leaf.report().residual = sum.residual;
  return sum;
}

}  // namespace

LeafTranslucency bakeLeafTranslucency(const LeafSet& set, const LeafBakeOptions& options) {
  LeafTransport leaf(set, options);
  const std::vector<glm::vec3> directions = hemisphereDirections(options.directions, options.seed);
  const std::vector<glm::vec3> weights = projectionWeights(directions);
  std::array<std::array<Plane, 3>, 2> light;  // that enters the front, the back
  for (const int side : {0, 1})
    light[static_cast<std::size_t>(side)] = leaf.enteringLight(side, directions, weights);

  std::vector<const Plane*> planes;
  for (const auto& side : light)
    for (const Plane& plane : side) planes.push_back(&plane);
  std::vector<Plane> through;
  if (options.method == LeafBakeMethod::kGaussians) {
    const GaussianSum sum = fit(leaf);
    const Timer timer;
    through = leaf.throughGaussians(sum, planes);
    leaf.report().convolution_seconds = timer.seconds();
  } else {
    Timer timer;
    leaf.makeDirectKernel();
    leaf.report().fit_seconds = timer.lap();
    for (const Plane* plane : planes)
      through.push_back(leaf.throughDirectly(*plane, 0, leaf.height()));
    leaf.report().convolution_seconds = timer.lap();
  }
  LeafTranslucency baked;
  baked.width = set.width;
  baked.height = set.height;
  for (const std::size_t lit : {0, 1}) {
    const std::array<const Plane*, 3> out{&through[3 * lit], &through[3 * lit + 1],
                                          &through[3 * lit + 2]};
    (lit == 1 ? baked.front : baked.back) = finished(leaf, out);
    leaf.report().conserved[1 - lit] = conservation(leaf, light[lit], out);
  }
  baked.report = leaf.report();
  return baked;
}

std::vector<float> lightThroughLeaf(const LeafSet& set, bool back_lit, const glm::vec3& w,
                                    const LeafBakeOptions& options) {
  LeafTransport leaf(set, options);
  const auto light = leaf.enteringLight(back_lit ? 1 : 0, {w}, {glm::vec3(1, 0, 0)});
  const Plane through = leaf.throughGaussians(fit(leaf), {&light[0]})[0];
  const auto width = static_cast<std::size_t>(set.width);
  std::vector<float> texels;
  for (std::size_t y = 0; y < static_cast<std::size_t>(set.height); ++y)
    for (std::size_t i = y * leaf.stride(); i < y * leaf.stride() + width; ++i)
      texels.push_back(leaf.inside()[i] != 0 ? through[i] : 0.0f);
  return texels;
}

std::vector<LeafErrors> measureLeafErrors(const LeafSet& set, const LeafTranslucency& baked,
                                          const LeafBakeOptions& options) {
  constexpr int kAzimuths = 4;
  LeafTransport leaf(set, options);
  const GaussianSum sum = fit(leaf);
  std::vector<LeafErrors> all;
  for (const double fraction : {2.0, 4.0, 8.0}) {
    LeafErrors errors;
    errors.elevation = std::numbers::pi / fraction;
    errors.histogram.assign(kLeafErrorBins, 0.0);
    struct Light {
      float exact, found;
    };
    std::vector<Light> lights;
    double sum_exact = 0;
    for (const int side : {0, 1}) {
      const std::vector<glm::vec3>& h = side == 0 ? baked.back : baked.front;
      // Overhead all azimuths are one.
      for (int a = 0; a < (fraction > 2.0 ? kAzimuths : 1); ++a) {
        const double azimuth = (a + 0.1) * 2.0 * std::numbers::pi / kAzimuths;
        const glm::vec3 w(std::cos(errors.elevation) * std::cos(azimuth),
                          std::cos(errors.elevation) * std::sin(azimuth),
                          std::sin(errors.elevation));
        const auto light = leaf.enteringLight(side, {w}, {glm::vec3(1, 0, 0)});
        const Plane through = leaf.throughGaussians(sum, {&light[0]})[0];
        // shared::leafTransport looks from the other side.
        const glm::vec3 to_sun(w.x, w.y, -w.z);
        const auto width = static_cast<std::size_t>(leaf.width());
        for (std::size_t texel = 0; texel < h.size(); ++texel) {
          const std::size_t i = texel / width * leaf.stride() + texel % width;
          if (leaf.inside()[i] == 0) continue;
          lights.push_back({through[i], shared::leafTransport(h[texel], to_sun)});
          sum_exact += double{through[i]};
        }
      }
    }
    const double least = 0.01 * sum_exact / static_cast<double>(lights.size());
    std::vector<double> values;
    for (const Light& light : lights)
      if (double{light.exact} > least)
        values.push_back(double{light.found} / double{light.exact} - 1.0);
    errors.dark = 1.0 - static_cast<double>(values.size()) / static_cast<double>(lights.size());
    for (const double value : values) {
      errors.mean += value;
      errors.mean_absolute += std::abs(value);
      errors.rms += value * value;
      const double bin = std::floor((value + 0.5) * kLeafErrorBins);
      errors.histogram[static_cast<std::size_t>(std::clamp(bin, 0.0, kLeafErrorBins - 1.0))] += 1.0;
    }
    const auto count = static_cast<double>(values.size());
    errors.mean /= count;
    errors.mean_absolute /= count;
    errors.rms = std::sqrt(errors.rms / count);
    for (double& bin : errors.histogram) bin /= count;
    const auto percentile = [&](double share) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (count - 1.0));
      std::nth_element(values.begin(), at, values.end());
      return *at;
    };
    errors.low = percentile(0.05);
    errors.high = percentile(0.95);
    all.push_back(errors);
  }
  return all;
}

}  // namespace verdure
