#include "leaf/gaussian_sum.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/parallel.h"

namespace verdure {
namespace {

/// At most between the widths; a larger ratio has fewer terms and a larger residual.
constexpr double kRatio = 1.5;

/// Texels at which T is fitted, one of each eight that are the same.
struct Sample {
  int x = 0, y = 0;
  double count = 0.0;   ///< texels for which it stands
  double weight = 0.0;  ///< of its squared error
};

/// All texels near the middle, ever fewer outwards.
std::vector<Sample> chooseSamples(int radius) {
  std::vector<int> places;
  for (int i = 0; i <= radius; i += 1 + i / 5) places.push_back(i);
  std::vector<Sample> samples;
  const auto width = [&](std::size_t k) {
    const int next = k + 1 < places.size() ? places[k + 1] : places[k] + 1;
    const int last = k > 0 ? places[k - 1] : -places[1 % places.size()];
    return 0.5 * (next - last);
  };
  for (std::size_t j = 0; j < places.size(); ++j)
    for (std::size_t i = j; i < places.size(); ++i) {
      Sample s{places[i], places[j], 0.0, 0.0};
      const double same = (i == j ? 4.0 : 8.0) * (s.y == 0 ? 0.5 : 1.0);
      s.count = s.x == 0 ? 1.0 : same * width(i) * width(j);
      // Far texels matter by their number: they make up what reaches wide, even light.
      s.weight = s.count * (1.0 + std::hypot(s.x, s.y));
      samples.push_back(s);
    }
  return samples;
}

std::vector<float> makeTaps(double sigma, int most) {
  const int radius = std::clamp(static_cast<int>(std::ceil(4.0 * sigma - 0.5)), 1, most);
  const auto below = [sigma](double x) { return 0.5 * std::erf(x / (sigma * std::sqrt(2.0))); };
  std::vector<double> exact;
  double sum = 0.0;
  for (int i = 0; i <= radius; ++i) {
    exact.push_back(below(i + 0.5) - below(i - 0.5));
    sum += (i == 0 ? 1.0 : 2.0) * exact.back();
  }
  std::vector<float> taps;
  for (const double tap : exact) taps.push_back(static_cast<float>(tap / sum));
  return taps;
}

/// Solves the symmetric positive definite system in place by Cholesky's factor.
void factor(std::vector<double>& a, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) a[j * n + j] -= a[j * n + k] * a[j * n + k];
    a[j * n + j] = std::sqrt(a[j * n + j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i * n + j] -= a[i * n + k] * a[j * n + k];
      a[i * n + j] /= a[j * n + j];
    }
  }
}

void solve(const std::vector<double>& l, std::vector<double>& b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= l[i * n + k] * b[k];
    b[i] /= l[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k * n + i] * b[k];
    b[i] /= l[i * n + i];
  }
}

}  // namespace

GaussianSum fitGaussians(const Multipole& multipole, double texel, const ThicknessGrid& grid,
                         double radius_mm) {
  GaussianSum sum;
  const int radius = std::max(1, static_cast<int>(std::ceil(radius_mm / texel)));
  // From a width that stays within a texel, or is as narrow as T ever is, to one that fills the
  // kernel.
  const double spike = grid.thickness(0) - multipole.meanFreePath();
  const double widest = std::max(radius_mm / texel / 3.2, 0.5);
  const double narrowest = std::clamp(0.4 * spike / texel, 0.22, 0.5 * widest);
  const double steps = std::ceil(std::log(widest / narrowest) / std::log(kRatio));
  for (double k = 0.0; k <= steps; ++k) {
    const double sigma = narrowest * std::pow(widest / narrowest, k / steps);
    sum.terms.push_back({sigma * texel, makeTaps(sigma, radius), {}});
  }

  const std::vector<Sample> samples = chooseSamples(radius);
  const std::size_t n = sum.terms.size();
  const auto thicknesses = static_cast<std::size_t>(grid.size());
  std::vector<double> shares(samples.size() * n);
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (std::size_t k = 0; k < n; ++k) {
      const std::vector<float>& taps = sum.terms[k].taps;
      const auto tap = [&taps](int i) {
        return i < static_cast<int>(taps.size()) ? double{taps[static_cast<std::size_t>(i)]} : 0.0;
      };
      shares[s * n + k] = tap(samples[s].x) * tap(samples[s].y);
    }
  // Normal equations; the sum of all texels, the light that gets through, weighs most.
  constexpr double kTotalWeight = 1e4;
  std::vector<double> matrix(n * n, kTotalWeight);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t s = 0; s < samples.size(); ++s)
        matrix[i * n + k] += samples[s].weight * shares[s * n + i] * shares[s * n + k];
  for (std::size_t i = 0; i < n; ++i) matrix[i * n + i] *= 1.0 + 1e-12;
  factor(matrix, n);

  for (GaussianTerm& term : sum.terms) term.weights.resize(thicknesses);
  std::vector<double> residuals(thicknesses);
  parallelFor(thicknesses, 1, [&](std::size_t t) {
    const double thickness = grid.thickness(static_cast<int>(t));
    std::vector<double> found(n, kTotalWeight * multipole.total(thickness));
    std::vector<double> exact(samples.size());
    for (std::size_t s = 0; s < samples.size(); ++s) {
      exact[s] = texelShare(multipole, texel, samples[s].x, samples[s].y, thickness);
      for (std::size_t k = 0; k < n; ++k)
        found[k] += samples[s].weight * exact[s] * shares[s * n + k];
    }
    solve(matrix, found);
    double error = 0.0, size = 0.0;
    for (std::size_t s = 0; s < samples.size(); ++s) {
      double value = 0.0;
      for (std::size_t k = 0; k < n; ++k) value += found[k] * shares[s * n + k];
      error += samples[s].count * std::abs(value - exact[s]);
      size += samples[s].count * std::abs(exact[s]);
    }
    const double bright = 0.01 * multipole.total(grid.thickness(0));
    residuals[t] = error / size * std::min(1.0, multipole.total(thickness) / bright);
    for (std::size_t k = 0; k < n; ++k) sum.terms[k].weights[t] = static_cast<float>(found[k]);
  });
  sum.residual = *std::max_element(residuals.begin(), residuals.end());
  return sum;
}

}  // namespace verdure
