// Light through a leaf: the bake at several resolutions, its convolution beside one by Fourier
// transforms of the same accuracy, and both beside the direct sum of (3.16), of which a few rows
// are timed. Not a Google Benchmark: everything is measured in turns, and minima are told.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/random.h"
#include "leaf/leaf_maps.h"
#include "leaf/leaf_transport.h"
#include "leaf/plane_transform.h"

namespace {

using namespace verdure;

/// An ellipse of 100 mm with veins of 0.5 mm in a blade of 0.15 mm, and bumps.
LeafSet veinedLeaf(int size) {
  LeafSet set;
  set.name = "veins";
  set.width = set.height = size;
  set.mm_per_texel = 100.0f / static_cast<float>(size);
  Random random(1);
  std::vector<bool> inside;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) * set.mm_per_texel - 50;
      const float v = (static_cast<float>(y) + 0.5f) * set.mm_per_texel - 50;
      const float vein = std::exp(-20 * std::pow(std::sin(0.4f * (u + std::abs(v))), 2.0f));
      inside.push_back(u * u + 1.2f * v * v < 49.0f * 49.0f);
      set.opacity.push_back(inside.back() ? 1.0f : 0.0f);
      set.thickness_mm.push_back(0.15f + 0.35f * vein);
      set.front.relief_mm.push_back(0.1f - 0.1f * vein + 0.3f * std::sin(u) * std::sin(v));
      set.back.relief_mm.push_back(set.thickness_mm.back() - set.front.relief_mm.back());
      for (LeafSide* side : {&set.front, &set.back}) {
        side->albedo.emplace_back(0.1f + 0.1f * random.uniform());
        side->translucency.emplace_back(0.3f);
      }
    }
  for (LeafSide* side : {&set.front, &set.back})
    for (const glm::vec2& s :
         slopesFromHeights(side->relief_mm, inside, size, size, set.mm_per_texel))
      side->normal.push_back(glm::normalize(glm::vec3(-s.x, s.y, 1)));
  return set;
}

/// Eigenvectors (columns) of a symmetric matrix by Jacobi's rotations, the largest value first.
std::vector<std::vector<double>> eigenvectors(std::vector<std::vector<double>> a) {
  const std::size_t n = a.size();
  std::vector<std::vector<double>> v(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) v[i][i] = 1;
  for (int sweep = 0; sweep < 60; ++sweep)
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (std::abs(a[p][q]) < 1e-300) continue;
        const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::size_t k = 0; k < n; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
          const double t = v[k][p], u = v[k][q];
          v[k][p] = c * t - s * u;
          v[k][q] = s * t + c * u;
        }
      }
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return a[i][i] > a[j][j]; });
  std::vector<std::vector<double>> sorted(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) sorted[i].push_back(v[k][order[i]]);
  return sorted;
}

/// The best kernels of a rank: T = sum over k of weights[k][thickness] times the kernel of
/// coefficients[k] of the Gaussians (the singular value decomposition of T, found among them).
struct LowRank {
  std::vector<std::vector<double>> coefficients;
  std::vector<std::vector<float>> weights;
};

LowRank reduce(const GaussianSum& sum, const LeafTransport& leaf, std::size_t rank) {
  const std::size_t n = sum.terms.size(), d = sum.terms[0].weights.size();
  const auto product = [&](std::size_t i, std::size_t k) {
    const auto &a = sum.terms[i].taps, &b = sum.terms[k].taps;
    double line = 0;
    for (std::size_t t = 0; t < std::min(a.size(), b.size()); ++t)
      line += (t == 0 ? 1 : 2) * double{a[t]} * double{b[t]};
    return line * line;
  };
  std::vector<std::vector<double>> l(n, std::vector<double>(n, 0.0));  // Cholesky's factor
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j; i < n; ++i) {
      double x = product(i, j) * (i == j ? 1 + 1e-12 : 1);
      for (std::size_t k = 0; k < j; ++k) x -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(x) : x / l[j][j];
    }
  std::vector<std::vector<double>> points(d, std::vector<double>(n, 0.0));
  std::vector<std::vector<double>> scatter(n, std::vector<double>(n, 0.0));
  for (std::size_t t = 0; t < d; ++t) {
    double total = leaf.multipole().total(leaf.grid().thickness(static_cast<int>(t)));
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = j; i < n; ++i) points[t][j] += l[i][j] * double{sum.terms[i].weights[t]};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        scatter[i][j] += points[t][i] * points[t][j] / (total * total);
  }
  const auto vectors = eigenvectors(scatter);
  LowRank low;
  for (std::size_t k = 0; k < std::min(rank, n); ++k) {
    std::vector<double> c(n);
    for (std::size_t i = n; i-- > 0;) {
      c[i] = vectors[k][i];
      for (std::size_t j = i + 1; j < n; ++j) c[i] -= l[j][i] * c[j];
      c[i] /= l[i][i];
    }
    low.coefficients.push_back(c);
    low.weights.emplace_back();
    for (std::size_t t = 0; t < d; ++t) {
      double w = 0;
      for (std::size_t i = 0; i < n; ++i) w += vectors[k][i] * points[t][i];
      low.weights.back().push_back(static_cast<float>(w));
    }
  }
  return low;
}

/// The convolution by Fourier transforms: two planes are one complex plane, because the kernels are
/// even; all terms are added up before the transform back.
std::vector<Plane> throughTransforms(const LeafTransport& leaf, const GaussianSum& sum,
                                     const LowRank& low, const std::vector<const Plane*>& planes) {
  using Complex = std::complex<float>;
  const int width = fastSize(leaf.width() + leaf.radius());
  const int height = fastSize(leaf.height() + leaf.radius());
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  const auto spectra = [&](int size) {
    std::vector<std::vector<float>> all;
    for (const GaussianTerm& term : sum.terms) {
      all.emplace_back();
      for (int u = 0; u < size; ++u) {
        double value = double{term.taps[0]};
        for (std::size_t t = 1; t < term.taps.size(); ++t)
          value += 2 * double{term.taps[t]} *
                   std::cos(2 * std::numbers::pi * u * static_cast<double>(t) / size);
        all.back().push_back(static_cast<float>(value));
      }
    }
    return all;
  };
  const auto along = spectra(width), across = spectra(height);
  const std::size_t pairs = planes.size() / 2;
  std::vector<std::vector<Complex>> sums(pairs, std::vector<Complex>(w * h));
  std::vector<Complex> plane(w * h);
  std::vector<float> kernel(w * h);
  for (std::size_t k = 0; k < low.weights.size(); ++k) {
    const std::vector<float>& weights = low.weights[k];
    parallelFor(h, 16, [&](std::size_t v) {
      std::fill_n(kernel.begin() + static_cast<std::ptrdiff_t>(v * w), w, 0.0f);
      for (std::size_t m = 0; m < along.size(); ++m) {
        const float c =
            static_cast<float>(low.coefficients[k][m]) * across[m][v] / static_cast<float>(w * h);
        for (std::size_t u = 0; u < w; ++u) kernel[v * w + u] += c * along[m][u];
      }
    });
    for (std::size_t p = 0; p < pairs; ++p) {
      parallelFor(h, 16, [&](std::size_t y) {
        Complex* const row = plane.data() + y * w;
        std::fill_n(row, w, Complex{});
        if (y >= static_cast<std::size_t>(leaf.height())) return;
        for (std::size_t x = 0; x < static_cast<std::size_t>(leaf.width()); ++x) {
          const std::size_t i = y * leaf.stride() + x;
          const float place = leaf.places()[i];
          const auto t = static_cast<std::size_t>(place);
          const float high = weights[std::min(t + 1, weights.size() - 1)];
          const float a = weights[t] + (place - static_cast<float>(t)) * (high - weights[t]);
          row[x] = {a * (*planes[2 * p])[i], a * (*planes[2 * p + 1])[i]};
        }
      });
      transformPlane(plane, width, height, false);
      parallelFor(h, 16, [&](std::size_t v) {
        for (std::size_t i = v * w; i < (v + 1) * w; ++i) sums[p][i] += kernel[i] * plane[i];
      });
    }
  }
  std::vector<Plane> through(planes.size(), Plane(planes[0]->size()));
  for (std::size_t p = 0; p < pairs; ++p) {
    transformPlane(sums[p], width, height, true);
    for (std::size_t y = 0; y < static_cast<std::size_t>(leaf.height()); ++y)
      for (std::size_t x = 0; x < static_cast<std::size_t>(leaf.width()); ++x) {
        through[2 * p][y * leaf.stride() + x] = sums[p][y * w + x].real();
        through[2 * p + 1][y * leaf.stride() + x] = sums[p][y * w + x].imag();
      }
  }
  return through;
}

double relativeError(const LeafTransport& leaf, const Plane& found, const Plane& truth, int begin,
                     int end) {
  double error = 0, size = 0;
  for (auto i = static_cast<std::size_t>(begin) * leaf.stride();
       i < static_cast<std::size_t>(end) * leaf.stride(); ++i) {
    const double t = double{truth[i]}, e = double{found[i]} - t;
    error += e * e;
    size += t * t;
  }
  return std::sqrt(error / size);
}

template <typename Action>
double leastSeconds(int times, const Action& action) {
  double least = 1e30;
  for (int i = 0; i < times; ++i) {
    const Timer timer;
    action();
    least = std::min(least, timer.seconds());
  }
  return least;
}

}  // namespace

int main() {
  fmt::print(
      "texels    bake s   CPU s  horizon  project  convolve  terms  residual  CPU us/texel\n");
  for (const int size : {256, 512, 1024, 2048}) {
    const LeafSet set = veinedLeaf(size);
    double least = 1e30,
           cpu = 1e30;  // of all threads: what other work on the machine adds least to
    LeafBakeReport best;
    for (int i = 0; i < 3; ++i) {
      const Timer timer;
      const std::clock_t start = std::clock();
      const LeafBakeReport report = bakeLeafTranslucency(set).report;
      cpu = std::min(cpu, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      if (const double s = timer.seconds(); s < least) {
        least = s;
        best = report;
      }
    }
    fmt::print("{:4}^2  {:8.3f} {:7.3f} {:8.3f} {:8.3f}  {:8.3f}  {:5}  {:.1e}  {:8.3f}\n", size,
               least, cpu, best.horizon_seconds, best.projection_seconds, best.convolution_seconds,
               best.terms, best.residual, 1e6 * cpu / (double(size) * size));
  }

  for (const int size : {512, 1024}) {
    const LeafSet set = veinedLeaf(size);
    const LeafBakeOptions options;
    LeafTransport leaf(set, options);
    const auto directions = hemisphereDirections(options.directions, options.seed);
    const auto weights = projectionWeights(directions);
    const auto front = leaf.enteringLight(0, directions, weights);
    const auto back = leaf.enteringLight(1, directions, weights);
    std::vector<const Plane*> planes;
    for (const auto* side : {&front, &back})
      for (const Plane& plane : *side) planes.push_back(&plane);
    const GaussianSum sum =
        fitGaussians(leaf.multipole(), double{leaf.texel()}, leaf.grid(), leaf.report().radius_mm);
    const int begin = size / 2, rows = 4;
    leaf.makeDirectKernel();
    Plane truth;
    const double direct =
        leastSeconds(2, [&] { truth = leaf.throughDirectly(front[0], begin, begin + rows); });
    std::vector<Plane> found;
    const double gaussians = leastSeconds(5, [&] { found = leaf.throughGaussians(sum, planes); });
    fmt::print("\n{}^2, six planes: Gaussians ({}) {:.3f} s, error {:.1e}\n", size,
               sum.terms.size(), gaussians,
               relativeError(leaf, found[0], truth, begin, begin + rows));
    for (const std::size_t rank : {3, 4, 5, 6}) {
      const LowRank low = reduce(sum, leaf, rank);
      const double seconds =
          leastSeconds(2, [&] { found = throughTransforms(leaf, sum, low, planes); });
      fmt::print("  transforms, rank {}: {:.3f} s, error {:.1e}, {:.1f} times the Gaussians\n",
                 rank, seconds, relativeError(leaf, found[0], truth, begin, begin + rows),
                 seconds / gaussians);
    }
    const double whole = leastSeconds(3, [&] { bakeLeafTranslucency(set); });
    const double all = direct / rows * size * 2 * options.directions;
    fmt::print(
        "  direct sum of {} directions, both sides, from {} rows: {:.0f} s, {:.0f} times the "
        "bake\n",
        options.directions, rows, all, all / whole);
  }
}
