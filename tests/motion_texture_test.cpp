#include "motion/motion_texture.h"
#include "motion/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "base/parallel.h"
#include "base/random.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr double kPi = glm::pi<double>();

/// What a shader reads of a trajectory.
float motionAt(const MotionTexture& texture, const shared::MotionTrajectory& trajectory,
               double seconds, int channel = 0) {
  const MotionTime time = motionTime(seconds);
  return texture.sample(shared::motionUv(trajectory, time.whole, time.fraction), channel);
}

/// The vertex of the parabola through the logarithms of the 2 * `reach` + 1 bins about the highest
/// one, by least squares: a peak that is broader than a bin is noisy.
double peakOf(const std::vector<double>& power, int reach) {
  const auto top =
      static_cast<int>(std::max_element(power.begin() + 1, power.end()) - power.begin());
  double s2 = 0, s4 = 0, y0 = 0, y1 = 0, y2 = 0, n = 0;
  for (int i = -reach; i <= reach; ++i) {
    const double y = std::log(power.at(static_cast<std::size_t>(top + i))), x = i;
    s2 += x * x, s4 += x * x * x * x, y0 += y, y1 += x * y, y2 += x * x * y, n += 1;
  }
  const double slope = y1 / s2, curve = (n * y2 - s2 * y0) / (n * s4 - s2 * s2);
  return top - 0.5 * slope / curve;
}

/// (4.15) and (4.16), written again: power of the motion by r = f / f_h.
double truePower(const BranchOscillator& branch, double r) {
  const double wind = std::pow(1 + r * branch.frequency_hz / branch.wind_speed, -5.0 / 3.0);
  return wind /
         ((1 - r * r) * (1 - r * r) + 4 * branch.damping_ratio * branch.damping_ratio * r * r);
}

/// 51 periods a record, ten samples in each.
constexpr int kRecord = 512, kBins = 205;  // up to 4 f_h
constexpr double kSamplesPerPeriod = 10.0, kBinsPerResonance = kRecord / kSamplesPerPeriod;

Spectrum measure(const BranchOscillator& branch, MotionLayout layout) {
  Spectrum spectrum(kRecord, kBins);
  for (int seed = 0; seed < 2; ++seed) {
    MotionTextureOptions options;
    options.layout = layout;
    options.seed = static_cast<std::uint64_t>(seed) + 40;
    const MotionTexture texture = makeMotionTexture(branch, options);
    for (int i = 0; i < 150; ++i) {
      const auto trajectory =
          makeTrajectory(texture, branch.frequency_hz, static_cast<std::uint64_t>(i));
      const double start = 37.0 * i, step = 1.0 / (branch.frequency_hz * kSamplesPerPeriod);
      for (int channel = 0; channel < 2; ++channel)
        spectrum.add(
            [&](int k) { return motionAt(texture, trajectory, start + k * step, channel); });
    }
  }
  return spectrum;
}

class Branch : public testing::TestWithParam<BranchOscillator> {};
INSTANTIATE_TEST_SUITE_P(Dampings, Branch,
                         testing::Values(BranchOscillator{1.0, 0.1, 5.0},
                                         BranchOscillator{1.0, 0.2, 5.0},
                                         BranchOscillator{6.0, 0.15, 8.0},
                                         BranchOscillator{0.6, 0.4, 3.0},
                                         BranchOscillator{2.0, 0.95, 6.0}));

TEST_P(Branch, MovesWithTheSpectrumOfAnOscillatorInWind) {
  const BranchOscillator branch = GetParam();
  const Spectrum spectrum = measure(branch, MotionLayout::kSeparable);
  // Of all frequencies to 4 f_h, also those beyond 2 f_h that a texture leaves out.
  const double error = spectrum.errorTo([&](std::size_t bin) {
    return truePower(branch, static_cast<double>(bin) / kBinsPerResonance);
  });
  EXPECT_LT(error, 0.1);
  RecordProperty("error", std::to_string(error));
  std::printf("zeta %.2f, f_h %.1f: error %.3f", branch.damping_ratio, branch.frequency_hz, error);
  if (branch.damping_ratio < 0.5) {
    std::vector<double> truth;
    for (int bin = 0; bin < kBins; ++bin)
      truth.push_back(truePower(branch, bin / kBinsPerResonance));
    const int reach = static_cast<int>(0.6 * branch.damping_ratio * kBinsPerResonance);
    const double measured = peakOf(spectrum.power, reach) / kBinsPerResonance;
    const double expected = peakOf(truth, reach) / kBinsPerResonance;
    EXPECT_NEAR(measured, expected, 0.05 * expected);
    // Damping and the fall of the wind's power draw the peak below the resonance.
    if (branch.damping_ratio <= 0.15) {
      EXPECT_NEAR(measured, 1.0, 0.05);
    }
    std::printf(", peak %.3f of %.3f", measured, expected);
  }
  std::printf("\n");
}

TEST(MotionTexture, RadialOneHasAnotherSpectrum) {
  // Why it is not the default.
  const BranchOscillator branch{1.0, 0.2, 5.0};
  const Spectrum spectrum = measure(branch, MotionLayout::kRadial);
  const double error = spectrum.errorTo([&](std::size_t bin) {
    return truePower(branch, static_cast<double>(bin) / kBinsPerResonance);
  });
  std::printf("radial: error %.3f, peak %.3f\n", error,
              peakOf(spectrum.power, 6) / kBinsPerResonance);
  EXPECT_GT(error, 0.3);
}

TEST(MotionTexture, FollowsThePrintedFormulas) {
  EXPECT_NEAR(branchFrequency(1.0), 2.55, 1e-12);
  EXPECT_NEAR(branchFrequency(10.0), 0.65546, 1e-4);  // 2.55 * 10^-0.59
  EXPECT_NEAR(branchFrequency(3.0, true) / branchFrequency(3.0), 2.5, 1e-12);
  EXPECT_NEAR(windPower(0, 7), 7, 1e-12);
  EXPECT_NEAR(windPower(7, 7), 7 * std::pow(2, -5.0 / 3), 1e-12);
  const BranchOscillator branch{1.5, 0.3, 4.0};
  for (const double f : {0.1, 1.0, 1.5, 3.0}) {
    const double at_rest = branchResponse(branch, 0);
    EXPECT_NEAR(std::pow(branchResponse(branch, f) / at_rest, 2), truePower(branch, f / 1.5), 1e-9);
    // A steady force over the stiffness of 1 kg.
    EXPECT_NEAR(at_rest, 2.0 / std::pow(2 * kPi * 1.5, 2), 1e-9);
  }
}

class AnyTexture : public testing::TestWithParam<int> {
 protected:
  MotionTexture make(std::uint64_t seed) const {
    MotionTextureOptions options{256, 192, 2, MotionLayout::kSeparable, seed};
    if (GetParam() == 1) options.layout = MotionLayout::kRadial;
    if (GetParam() == 2) return makeWindTexture(0.3, 192, 3, seed);
    return makeMotionTexture({1.0, 0.2, 5.0}, options);
  }
};
INSTANTIATE_TEST_SUITE_P(Kinds, AnyTexture, testing::Values(0, 1, 2));

TEST_P(AnyTexture, HasMeanZeroAndUnitPower) {
  const MotionTexture texture = make(3);
  const auto n = static_cast<std::size_t>(texture.channels);
  std::vector<std::vector<double>> moments(n, std::vector<double>(5));
  for (std::size_t i = 0; i < texture.values.size(); ++i)
    for (int k = 1; k <= 4; ++k)
      moments[i % n][static_cast<std::size_t>(k)] += std::pow(texture.values[i], k);
  const double count = static_cast<double>(texture.values.size()) / static_cast<double>(n);
  double product = 0.0;
  for (std::size_t i = 0; i < texture.values.size(); i += n)
    product += double{texture.values[i]} * double{texture.values[i + 1]};
  for (const auto& m : moments) {
    EXPECT_NEAR(m[1] / count, 0.0, 1e-6);
    EXPECT_NEAR(m[2] / count, 1.0, 1e-6);
    EXPECT_NEAR(m[3] / count, 0.0, 0.25);  // Gauss: 0 and 3
    EXPECT_NEAR(m[4] / count, 3.0, 0.6);
  }
  EXPECT_NEAR(product / count, 0.0, 0.1);  // channels are independent
}

TEST_P(AnyTexture, TilesWithoutAStep) {
  const MotionTexture texture = make(4);
  // The highest frequency has 8 texels a cycle: second differences are small, across the border,
  // too. A cut through noise would have some of the size of the values.
  const int w = texture.width, h = texture.height, n = texture.channels;
  const auto at = [&](int x, int y) {
    return double{texture.values[static_cast<std::size_t>(((y + h) % h * w + (x + w) % w) * n)]};
  };
  double inside = 0.0, border = 0.0;
  const auto look = [&](double& sum, int x, int y) {
    sum += std::pow(at(x - 1, y) - 2 * at(x, y) + at(x + 1, y), 2) +
           std::pow(at(x, y - 1) - 2 * at(x, y) + at(x, y + 1), 2);
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) look(x == 0 || y == 0 ? border : inside, x, y);
  border /= w + h - 1;
  inside /= (w - 1) * (h - 1);
  EXPECT_LT(border, 2.5 * inside);
  EXPECT_LT(border, 0.15);
  // And as it is read: the same one width or height on.
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const glm::vec2 uv(random.uniform(), random.uniform());
    EXPECT_NEAR(texture.sample(uv), texture.sample(uv + glm::vec2(1, 0)), 1e-4);
    EXPECT_NEAR(texture.sample(uv), texture.sample(uv + glm::vec2(-1, 3)), 1e-4);
    EXPECT_NEAR(texture.sample({0, uv.y}), texture.sample({0.9999999f, uv.y}), 1e-4);
  }
}

TEST_P(AnyTexture, IsReadAsItsFourierSumRuns) {
  const MotionTexture texture = make(6);
  const int w = texture.width, h = texture.height, n = texture.channels;
  // All coefficients by direct sums: along x, then along y. Those beyond 1/8 are nothing.
  const int us = w / 8, vs = h / 8;
  using Complex = std::complex<double>;
  const auto size = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<Complex> rows(size(h * (us + 2)));
  for (int y = 0; y < h; ++y)
    for (int ku = 0; ku <= us + 1; ++ku)
      for (int x = 0; x < w; ++x)
        rows[size(y * (us + 2) + ku)] += double{texture.values[size((y * w + x) * n)]} *
                                         std::polar(1.0 / w, -2 * kPi * ku * x / w);
  std::vector<Complex> coefficients(size((2 * vs + 3) * (us + 2)));
  double power = 0.0, beyond = 0.0;
  for (int kv = -vs - 1; kv <= vs + 1; ++kv)
    for (int ku = 0; ku <= us + 1; ++ku) {
      Complex& c = coefficients[size((kv + vs + 1) * (us + 2) + ku)];
      for (int y = 0; y < h; ++y)
        c += rows[size(y * (us + 2) + ku)] * std::polar(1.0 / h, -2 * kPi * kv * y / h);
      const double share = (ku == 0 ? 1 : 2) * std::norm(c);
      power += share;
      if (ku > us || std::abs(kv) > vs) beyond += share;
    }
  EXPECT_NEAR(power, 1.0, 1e-5);  // nothing is beyond these
  EXPECT_LT(beyond, 1e-10);
  Random random(7);
  double squares = 0.0, worst = 0.0;
  constexpr int kPoints = 300;
  for (int i = 0; i < kPoints; ++i) {
    const glm::vec2 uv(random.uniform(), random.uniform());
    double exact = 0.0;
    for (int kv = -vs; kv <= vs; ++kv)
      for (int ku = 0; ku <= us; ++ku) {
        const double turn = 2 * kPi * (ku * (uv.x - 0.5 / w) + kv * (uv.y - 0.5 / h));
        exact += (ku == 0 ? 1 : 2) * std::real(coefficients[size((kv + vs + 1) * (us + 2) + ku)] *
                                               std::polar(1.0, turn));
      }
    const double error = std::abs(texture.sample(uv) - exact);
    squares += error * error;
    worst = std::max(worst, error);
  }
  std::printf("bilinear error: %.4f, at most %.3f\n", std::sqrt(squares / kPoints), worst);
  EXPECT_LT(std::sqrt(squares / kPoints), 0.04);
  EXPECT_LT(worst, 0.15);
}

TEST_P(AnyTexture, IsTheSameForAnyNumberOfThreads) {
  setThreadCount(1);
  const MotionTexture one = make(8);
  setThreadCount(2);
  const MotionTexture two = make(8);
  setThreadCount(0);
  EXPECT_EQ(one.values, two.values);
  EXPECT_EQ(one.values, make(8).values);
  EXPECT_NE(one.values, make(9).values);
}

/// Highest correlation of one signal with the other, delayed by steps from `first` to `last`.
double highestCorrelation(const std::vector<double>& a, const std::vector<double>& b, int first,
                          int last) {
  double highest = 0.0;
  const auto n = static_cast<int>(a.size());
  for (int lag = first; lag <= last; ++lag) {
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (int i = 0; i + lag < n; ++i) {
      const double x = a[static_cast<std::size_t>(i)], y = b[static_cast<std::size_t>(i + lag)];
      ab += x * y, aa += x * x, bb += y * y;
    }
    highest = std::max(highest, std::abs(ab) / std::sqrt(aa * bb));
  }
  return highest;
}

TEST(MotionTexture, DoesNotRepeatWithinAnHour) {
  const BranchOscillator branch{1.0, 0.2, 5.0};
  const MotionTexture texture = makeMotionTexture(branch);
  constexpr double kStep = 0.25;  // two samples in a cycle of the highest frequency
  double highest = 0.0, to_others = 0.0;
  std::vector<std::vector<double>> signals;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto trajectory = makeTrajectory(texture, branch.frequency_hz, seed);
    std::vector<double> signal;
    for (int i = 0; i < 2 * 14400; ++i) signal.push_back(motionAt(texture, trajectory, i * kStep));
    highest = std::max(highest, highestCorrelation(signal, signal, 40, 14400));
    signals.push_back(signal);
  }
  for (int i = 0; i < 3; ++i)
    to_others = std::max(to_others,
                         highestCorrelation(signals[static_cast<std::size_t>(i)],
                                            signals[static_cast<std::size_t>((i + 1) % 3)], 0, 40));
  std::printf("autocorrelation %.3f, of branches %.3f\n", highest, to_others);
  EXPECT_LT(highest, 0.1);
  EXPECT_LT(to_others, 0.1);

  // A slope of 1 / 20 does repeat, after 20 widths of 128 s.
  const auto trajectory = makeTrajectory({0.1, 0.2}, 0.05, 1.0 / 128);
  std::vector<double> signal;
  for (int i = 0; i < 2 * 14400; ++i) signal.push_back(motionAt(texture, trajectory, i * kStep));
  EXPECT_GT(highestCorrelation(signal, signal, 10240, 10240), 0.99);
}

TEST(MotionTexture, HasRowsOfTheirOwn) {
  const MotionTexture texture = makeMotionTexture({1.0, 0.3, 5.0});
  double worst = 0.0;
  for (int row = 0; row < 1024; row += 64)
    for (const int apart : {8, 13, 100, 511}) {
      double product = 0.0, a2 = 0.0, b2 = 0.0;
      for (int x = 0; x < 2048; ++x) {
        const double a = texture.values[static_cast<std::size_t>(2 * (row * 2048 + x))];
        const double b =
            texture.values[static_cast<std::size_t>(2 * ((row + apart) % 1024 * 2048 + x))];
        product += a * b, a2 += a * a, b2 += b * b;
      }
      worst = std::max(worst, std::abs(product) / std::sqrt(a2 * b2));
    }
  std::printf("rows: %.3f\n", worst);
  EXPECT_LT(worst, 0.3);  // a row has some 200 independent numbers
}

TEST(WindTexture, HasTheWindsSpectrumInAllDirections) {
  const double smallest = 0.25;
  for (const double turn : {0.0, 0.4, 0.9, 2.2}) {
    constexpr int kCount = 256, kMax = 64;
    Spectrum spectrum(kCount, kMax);
    const double step = smallest / 4;  // m; bins are 1 / (64 * smallest)
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      const MotionTexture texture = makeWindTexture(smallest, 512, 3, seed);
      EXPECT_NEAR(texture.extent, 16.0, 1e-12);
      Random random(seed);
      for (int i = 0; i < 200; ++i) {
        const glm::dvec2 start(random.uniform(), random.uniform());
        spectrum.add([&](int k) {
          const double way = k * step / texture.extent;
          return texture.sample(glm::vec2(start + way * glm::dvec2(std::cos(turn), std::sin(turn))),
                                i % 3);
        });
      }
    }
    const auto wind = [](double cycles_per_m) { return std::pow(1 + cycles_per_m, -5.0 / 3); };
    const double error = spectrum.errorTo([&](std::size_t bin) {
      return wind(static_cast<double>(bin) / (64 * smallest)) - wind(1 / smallest);
    });
    std::printf("wind towards %.1f: error %.3f\n", turn, error);
    EXPECT_LT(error, 0.15);
  }
}

TEST(Trajectory, IsWhereItShouldBeAfterHours) {
  Random random(11);
  for (const double speed : {0.0049, 0.0078125, 0.0631, 0.4}) {
    const double slope = 0.037;
    const glm::dvec2 offset(random.uniform(), random.uniform());
    const auto trajectory = makeTrajectory(offset, slope, speed);
    double worst = 0.0;
    for (const double hours : {0.0, 0.1, 1.0, 24.0})
      for (int i = 0; i < 200; ++i) {
        const double t = hours * 3600 + 60.0 * random.uniform();
        const MotionTime time = motionTime(t);
        EXPECT_NEAR(static_cast<double>(time.whole) + time.fraction, t, 1e-7);
        const glm::dvec2 uv = shared::motionUv(trajectory, time.whole, time.fraction);
        // The speed has steps of 2^-32 a second.
        const glm::dvec2 miss = uv - (offset + t * speed * glm::dvec2(1, slope));
        for (int k = 0; k < 2; ++k) {
          const double drift = std::abs(miss[k] - std::round(miss[k])) - t * 0x1p-33;
          worst = std::max(worst, drift);
        }
      }
    EXPECT_LT(worst, 0x1p-21) << speed;  // 1/1000 of a texel
  }
}

TEST(Trajectory, HasNoStepInTimeAndNoState) {
  const auto trajectory = makeTrajectory({0.3, 0.6}, 0.05, 0.0091);
  // Frames of an hour from now, forwards and backwards: smooth, and the same to the bit.
  std::vector<glm::vec2> places;
  double most = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const MotionTime time = motionTime(3600.0 + i / 60.0);
    places.push_back(shared::motionUv(trajectory, time.whole, time.fraction));
    if (i == 0) continue;
    const double moved = places.back().x - places[places.size() - 2].x;
    most = std::max(most, std::abs(moved - std::round(moved) - 0.0091 / 60));
  }
  EXPECT_LT(most, 3e-7);
  for (int i = 999; i >= 0; --i) {
    const MotionTime time = motionTime(3600.0 + i / 60.0);
    const glm::vec2 again = shared::motionUv(trajectory, time.whole, time.fraction);
    EXPECT_EQ(again, places[static_cast<std::size_t>(i)]);
  }
  // Before 0, time runs on.
  const MotionTime before = motionTime(-0.25), after = motionTime(0.25);
  const glm::vec2 a = shared::motionUv(trajectory, before.whole, before.fraction);
  const glm::vec2 b = shared::motionUv(trajectory, after.whole, after.fraction);
  EXPECT_NEAR(b.x - a.x, 0.0091 / 2, 3e-7);
}

TEST(Trajectory, SetsTheFrequencyByItsSpeed) {
  // A texture made for 1 Hz, read by a branch of 2.3 Hz: the resonance is there.
  const MotionTexture texture = makeMotionTexture({1.0, 0.1, 5.0});
  Spectrum spectrum(512, 150);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto trajectory = makeTrajectory(texture, 2.3, seed);
    spectrum.add([&](int i) { return motionAt(texture, trajectory, 1000.0 + i / 20.0); });
  }
  EXPECT_NEAR(peakOf(spectrum.power, 6) * 20 / 512, 2.3, 0.05 * 2.3);
}

TEST(MotionTexture, RefusesBadNumbers) {
  const double nan = std::nan("");
  EXPECT_THROW(branchFrequency(0), Error);
  EXPECT_THROW(branchFrequency(nan), Error);
  EXPECT_THROW(makeMotionTexture({0.0, 0.2, 5.0}), Error);
  EXPECT_THROW(makeMotionTexture({nan, 0.2, 5.0}), Error);
  EXPECT_THROW(makeMotionTexture({1.0, 0.0, 5.0}), Error);
  EXPECT_THROW(makeMotionTexture({1.0, nan, 5.0}), Error);
  EXPECT_THROW(makeMotionTexture({1.0, 0.2, 0.0}), Error);
  EXPECT_THROW(makeMotionTexture({}, {100, 64, 1}), Error);
  EXPECT_THROW(makeMotionTexture({}, {64, 64, 5}), Error);
  EXPECT_THROW(makeWindTexture(0.0), Error);
  EXPECT_THROW(makeWindTexture(0.1, 32), Error);
  EXPECT_THROW(makeTrajectory({0, 0}, 0.05, 1.0), Error);
  EXPECT_THROW(makeTrajectory({0, 0}, -0.05, 0.5), Error);
  EXPECT_THROW(makeTrajectory({nan, 0}, 0.05, 0.5), Error);
  EXPECT_THROW(makeTrajectory(makeWindTexture(0.1, 64), 1.0, 1), Error);
  EXPECT_THROW(motionTime(nan), Error);
}

}  // namespace
}  // namespace verdure
