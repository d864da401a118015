#include "verdure/sky_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "shared/sh.h"
#include "sky/fit_kernel.h"
#include "sky/harmonic_basis.h"
#include "sky/preetham.h"
#include "sky/projection.h"
#include "sky/sky_fit_coordinates.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::size_t kMostDegree = 31;
constexpr std::size_t kMostOutputs = 3 * kMaxBands * (kMaxBands + 1) / 2;  // 84
constexpr std::size_t kMostStride = (kMostOutputs + kFitLanes - 1) / kFitLanes * kFitLanes;
/// Rows of the fit's quadrature; see Sky::rows().
constexpr int kRows = 128;

/// T_0(x) to T_degree(x).
void chebyshev(float x, int degree, float* values) {
  values[0] = 1.0f;
  values[1] = x;
  for (int i = 2; i <= degree; ++i) values[i] = 2.0f * x * values[i - 1] - values[i - 2];
}

/// The even points of a circle seen from the side: from 1 to -1, both included.
double samplePoint(std::size_t k, std::size_t count) {
  return std::cos(glm::pi<double>() * static_cast<double>(k) / static_cast<double>(count - 1));
}

/// The matrix (degree + 1 rows, a column for each sample) that turns samples into coefficients of
/// Chebyshev polynomials of `coordinates`, by least squares. The ends of the range, where
/// polynomials err most, count twice.
std::vector<double> leastSquares(const std::vector<double>& coordinates, int degree) {
  const std::size_t n = static_cast<std::size_t>(degree + 1), samples = coordinates.size();
  const std::size_t columns = n + samples;
  std::vector<double> rows(n * columns);  // normal equations, and their right sides
  for (std::size_t k = 0; k < samples; ++k) {
    const double angle = std::acos(std::clamp(coordinates[k], -1.0, 1.0));
    const double weight = k == 0 || k + 1 == samples ? 2.0 : 1.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double t_i = weight * std::cos(static_cast<double>(i) * angle);
      rows[i * columns + n + k] = t_i;
      for (std::size_t j = 0; j < n; ++j)
        rows[i * columns + j] += t_i * std::cos(static_cast<double>(j) * angle);
    }
  }
  // Gauss and Jordan; the matrix is positive definite.
  for (std::size_t p = 0; p < n; ++p) {
    const double pivot = rows[p * columns + p];
    for (std::size_t j = p; j < columns; ++j) rows[p * columns + j] /= pivot;
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = rows[i * columns + p];
      if (i == p || factor == 0.0) continue;
      for (std::size_t j = p; j < columns; ++j)
        rows[i * columns + j] -= factor * rows[p * columns + j];
    }
  }
  std::vector<double> solution(n * samples);
  for (std::size_t i = 0; i < n; ++i)
    std::copy_n(&rows[i * columns + n], samples, &solution[i * samples]);
  return solution;
}

void checkOptions(const SkyFitOptions& o) {
  checkBands(o.bands);
  for (const int degree : {o.sun_degree, o.turbidity_degree})
    if (degree < 1 || degree > static_cast<int>(kMostDegree))
      throw Error("sky fit", fmt::format("degree {} is outside of [1, {}]", degree, kMostDegree),
                  "the paper uses 13 and 7");
  if (!(o.turbidity_min >= 2.0f && o.turbidity_min < o.turbidity_max && o.turbidity_max <= 10.0f))
    throw Error("sky fit",
                fmt::format("turbidity {:g} to {:g} is no range inside of [2, 10]", o.turbidity_min,
                            o.turbidity_max),
                "the paper uses 2.5 to 6");
}

/// The point k of an even grid over a range.
float gridPoint(float from, float to, int k, int steps) {
  return from + (to - from) * static_cast<float>(k) / static_cast<float>(steps);
}

/// Preetham's sky with its colours outside of the gamut.
class UnclampedSky final : public Sky {
 public:
  UnclampedSky(float sun_zenith, float turbidity)
      : formula_(preethamFormula(turbidity, {0.0f, std::cos(sun_zenith), std::sin(sun_zenith)})) {}
  glm::vec3 luminance(const glm::vec3& direction) const override {
    return direction.y < 0.0f ? glm::vec3(0.0f) : shared::skyColorUnclamped(direction, formula_);
  }

 private:
  shared::SkyFormula formula_;
};

}  // namespace

SkyModel preethamModel() {
  return [](float sun_zenith, float turbidity) {
    return std::make_shared<UnclampedSky>(sun_zenith, turbidity);
  };
}

SkyFit::SkyFit(const SkyModel& model, const SkyFitOptions& options) : options_(options) {
  checkOptions(options);
  const auto outputs = static_cast<std::size_t>(3 * options.bands * (options.bands + 1) / 2);
  stride_ = (outputs + kFitLanes - 1) / kFitLanes * kFitLanes;
  const auto rows = static_cast<std::size_t>(options.sun_degree + 1);
  const auto columns = static_cast<std::size_t>(options.turbidity_degree + 1);
  const std::size_t suns = 2 * rows, airs = 2 * columns;
  std::vector<double> zeniths, turbidities, sun_coordinates, air_coordinates;
  for (std::size_t k = 0; k < suns; ++k) {
    zeniths.push_back(0.25 * glm::pi<double>() * (1.0 + samplePoint(k, suns)));
    sun_coordinates.push_back(sunCoordinate(zeniths.back()));
  }
  const double low = double{options.turbidity_min}, high = double{options.turbidity_max};
  const AirCoordinate air(options);
  air_scale_ = air.scale;
  air_offset_ = air.offset;
  for (std::size_t k = 0; k < airs; ++k) {
    turbidities.push_back(0.5 * (low + high) + 0.5 * (high - low) * samplePoint(k, airs));
    air_coordinates.push_back(air(turbidities.back()));
  }
  const SkyProjection projection(options.bands, kRows);
  using Sample = std::array<double, kMostOutputs>;
  std::vector<Sample> samples(suns * airs);
  parallelFor(samples.size(), 8, [&](std::size_t k) {
    const HarmonicSums sums = projection.ofSymmetric(
        *model(static_cast<float>(zeniths[k / airs]), static_cast<float>(turbidities[k % airs])));
    std::size_t out = 0;
    for (int l = 0; l < options.bands; ++l)
      for (int m = 0; m <= l; ++m)
        for (int c = 0; c < 3; ++c)
          samples[k][out++] = sums[static_cast<std::size_t>(l * l + l + m)][c];
  });

  const std::vector<double> of_suns = leastSquares(sun_coordinates, options.sun_degree);
  const std::vector<double> of_airs = leastSquares(air_coordinates, options.turbidity_degree);
  coefficients_.assign(rows * columns * stride_, 0.0f);
  parallelFor(rows, 1, [&](std::size_t i) {
    for (std::size_t j = 0; j < columns; ++j) {
      Sample sum{};
      for (std::size_t s = 0; s < suns; ++s)
        for (std::size_t a = 0; a < airs; ++a) {
          const double w = of_suns[i * suns + s] * of_airs[j * airs + a];
          for (std::size_t k = 0; k < outputs; ++k) sum[k] += w * samples[s * airs + a][k];
        }
      for (std::size_t k = 0; k < outputs; ++k)
        coefficients_[(i * columns + j) * stride_ + k] = static_cast<float>(sum[k]);
    }
  });
}

Harmonics SkyFit::atZenithAngle(float sun_zenith, float turbidity) const {
  if (!(turbidity >= options_.turbidity_min && turbidity <= options_.turbidity_max))
    throw Error("turbidity",
                fmt::format("{:g} is outside of the fitted range [{:g}, {:g}]", turbidity,
                            options_.turbidity_min, options_.turbidity_max),
                "fit a wider range");
  std::array<float, kMostDegree + 1> x, y;
  chebyshev(
      sunCoordinate(std::clamp(sun_zenith, 0.0f, static_cast<float>(0.5 * glm::pi<double>()))),
      options_.sun_degree, x.data());
  chebyshev(AirCoordinate(air_scale_, air_offset_)(turbidity), options_.turbidity_degree, y.data());
  std::array<float, kMostStride> out;
  sumPolynomials(x.data(), static_cast<std::size_t>(options_.sun_degree + 1), y.data(),
                 static_cast<std::size_t>(options_.turbidity_degree + 1), coefficients_.data(),
                 stride_, out.data());
  Harmonics h;
  h.bands = options_.bands;
  const float* next = out.data();
  for (int l = 0; l < h.bands; ++l)
    for (int m = 0; m <= l; ++m, next += 3)
      h.weights[static_cast<std::size_t>(l * l + l + m)] = {next[0], next[1], next[2]};
  return h;
}

Harmonics SkyFit::at(const glm::vec3& to_sun, float turbidity) const {
  const glm::vec3 d = shared::shFromWorld(to_sun);
  const float across = std::hypot(d.x, d.y);
  Harmonics h = atZenithAngle(std::atan2(across, std::max(d.z, 0.0f)), turbidity);
  const float dim = twilight(std::atan2(d.z, across));
  // (5.2) where all weights of m < 0 are 0.
  const float c1 = across > 0.0f ? d.x / across : 1.0f, s1 = across > 0.0f ? d.y / across : 0.0f;
  float c = dim, s = 0.0f;
  for (int m = 0; m < h.bands; ++m) {
    for (int l = m; l < h.bands; ++l) {
      const glm::vec3 weight = h.weights[static_cast<std::size_t>(l * l + l + m)];
      h.weights[static_cast<std::size_t>(l * l + l - m)] = weight * s;
      h.weights[static_cast<std::size_t>(l * l + l + m)] = weight * c;
    }
    const float before = c;
    c = c * c1 - s * s1;
    s = s * c1 + before * s1;
  }
  return h;
}

SkyFitErrors measureSkyFit(const SkyFit& fit, const SkyModel& model, int sun_steps,
                           int turbidity_steps) {
  const SkyFitOptions& o = fit.options();
  const SkyProjection projection(o.bands, kRows);
  struct Point {
    double least = 0.0;
    std::array<glm::dvec3, kMaxBands> sums{}, squares{};  ///< of the errors of each band
  };
  const auto airs = static_cast<std::size_t>(turbidity_steps + 1);
  std::vector<Point> points(static_cast<std::size_t>(sun_steps + 1) * airs);
  const auto sunAt = [&](std::size_t k) {
    return gridPoint(0.0f, static_cast<float>(0.5 * glm::pi<double>()), static_cast<int>(k / airs),
                     sun_steps);
  };
  const auto airAt = [&](std::size_t k) {
    return gridPoint(o.turbidity_min, o.turbidity_max, static_cast<int>(k % airs), turbidity_steps);
  };
  parallelFor(points.size(), 8, [&](std::size_t k) {
    const HarmonicSums truth = projection.ofSymmetric(*model(sunAt(k), airAt(k)));
    const Harmonics h = fit.atZenithAngle(sunAt(k), airAt(k));
    points[k].least = std::min({truth[0].r, truth[0].g, truth[0].b});
    for (int l = 0; l < o.bands; ++l)
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
        const auto si = static_cast<std::size_t>(i);
        const glm::dvec3 error = glm::abs(glm::dvec3(h.weights[si]) - truth[si]);
        points[k].sums[static_cast<std::size_t>(l)] += error;
        points[k].squares[static_cast<std::size_t>(l)] += error * error;
      }
  });
  SkyFitErrors errors;
  errors.least_weight = points[0].least;
  for (const Point& p : points) errors.least_weight = std::min(errors.least_weight, p.least);
  for (std::size_t k = 0; k < points.size(); ++k) {
    glm::dvec3 sum(0.0), square(0.0);
    for (std::size_t n = 0; n < static_cast<std::size_t>(o.bands); ++n) {
      sum += points[k].sums[n];
      square += points[k].squares[n];
      const double maximal = std::max({sum.r, sum.g, sum.b}) / errors.least_weight;
      const double mean = std::sqrt(std::max({square.r, square.g, square.b})) / errors.least_weight;
      if (maximal > errors.maximal[n]) {
        errors.maximal[n] = maximal;
        if (n + 1 == static_cast<std::size_t>(o.bands)) {
          errors.worst_sun_zenith = sunAt(k);
          errors.worst_turbidity = airAt(k);
        }
      }
      errors.mean[n] = std::max(errors.mean[n], mean);
    }
  }
  return errors;
}

}  // namespace verdure
