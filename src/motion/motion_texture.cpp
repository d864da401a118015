#include "motion/motion_texture.h"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "base/check.h"
#include "base/parallel.h"
#include "base/random.h"
#include "leaf/plane_transform.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr int kTexelsPerCycle = 8;         ///< of the highest frequency: 2, zero-padded 4 times
constexpr double kHighestFrequency = 2.0;  ///< in resonances, 4.5.3

/// Rows that are this much of the highest cycle along v apart are correlated by less than 0.1.
constexpr double kRowDistance = 0.85;

void need(bool ok, const char* where, const std::string& what, const std::string& advice) {
  if (!ok) throw Error(where, what, advice);
}

void checkSize(const char* where, int width, int height, int channels) {
  for (const int size : {width, height})
    need(size >= 64 && size <= 8192 && size % 16 == 0, where,
         fmt::format("a size of {} texels", size), "give a multiple of 16 from 64 to 8192");
  need(channels >= 1 && channels <= 4, where, fmt::format("{} channels", channels), "give 1 to 4");
}

/// A pair of independent Gaussian numbers of variance 1, by Box and Muller.
std::complex<double> gaussian(Random& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  const double turn = 2.0 * kPi * random.uniform();
  return {radius * std::cos(turn), radius * std::sin(turn)};
}

/// Fills a channel with noise of the given power at ku, kv cycles a texture, which counts up to
/// 1/8 of the size.
void fillChannel(MotionTexture& texture, int channel, std::uint64_t seed,
                 const std::function<double(int ku, int kv)>& power) {
  const int w = texture.width, h = texture.height;
  const int us = w / kTexelsPerCycle, vs = h / kTexelsPerCycle;
  const auto at = [&](int ku, int kv) {
    return static_cast<std::size_t>((kv + h) % h) * static_cast<std::size_t>(w) +
           static_cast<std::size_t>((ku + w) % w);
  };
  std::vector<std::complex<float>> plane(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  const std::uint64_t key = hash(hash(seed) + static_cast<std::uint64_t>(channel));
  parallelFor(static_cast<std::size_t>(2 * vs + 1), 4, [&](std::size_t row) {
    const int kv = static_cast<int>(row) - vs;
    Random random(key, row);
    // One half of the plane; the other is its conjugate, so that the field is real. No mean.
    for (int ku = kv > 0 ? 0 : 1; ku <= us; ++ku) {
      const std::complex<float> c(gaussian(random) * std::sqrt(power(ku, kv)));
      plane[at(ku, kv)] = c;
      plane[at(-ku, -kv)] = std::conj(c);
    }
  });
  transformPlane(plane, w, h, true);

  double squares = 0.0;
  for (const auto& value : plane) squares += double{value.real()} * double{value.real()};
  VERDURE_CHECK_LT(0.0, squares);
  const double scale = 1.0 / std::sqrt(squares / static_cast<double>(plane.size()));
  const auto channels = static_cast<std::size_t>(texture.channels);
  for (std::size_t i = 0; i < plane.size(); ++i)
    texture.values[i * channels + static_cast<std::size_t>(channel)] =
        static_cast<float>(scale * double{plane[i].real()});
}

MotionTexture emptyTexture(int width, int height, int channels) {
  MotionTexture texture{width, height, channels, {}};
  texture.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        static_cast<std::size_t>(channels));
  return texture;
}

/// The power in the plane, at q cycles a metre, whose projection on any line is windPower() of
/// k v_m less that of `highest`: Abel's inverse, -1/pi times the integral of P'(k) / k over
/// sqrt(k^2 - q^2). The power falls throughout, so this is positive.
double windPowerInPlane(double q, double highest) {
  if (q >= highest) return 0.0;
  // k = q cosh(x) makes it the integral of P'(k) over x; Simpson's rule.
  const double end = std::acosh(highest / q);
  constexpr int kSteps = 64;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double k = q * std::cosh(end * i / kSteps);
    const double slope = 5.0 / 3.0 * std::pow(1.0 + k, -8.0 / 3.0);  // -P', v_m = 1
    sum += slope * (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
  }
  return sum * end / (3.0 * kSteps * kPi);
}

std::uint32_t fixedPoint(double textures) {
  const double rest = textures - std::floor(textures);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(rest * 0x1p32)));
}

/// A slope whose multiples stay `apart` from whole numbers up to the `count`-th: the thesis, too,
/// rejects what is near a simple fraction.
double driftingSlope(Random& random, double apart, int count) {
  for (;;) {
    const double slope = apart * random.uniform(3.0f, 9.0f);  // blurs by 1 to 3 cycles a width
    bool good = true;
    for (int n = 1; n <= count && good; ++n)
      good = std::abs(n * slope - std::round(n * slope)) >= apart;
    if (good) return slope;
  }
}

}  // namespace

double windPower(double frequency_hz, double wind_speed) {
  return wind_speed / std::pow(1.0 + frequency_hz / wind_speed, 5.0 / 3.0);
}

double branchFrequency(double length, bool leafless) {
  need(length > 0.0 && std::isfinite(length), "branch", fmt::format("a length of {} m", length),
       "give one above 0");
  return 2.55 * std::pow(length, -0.59) * (leafless ? 2.5 : 1.0);
}

double branchResponse(const BranchOscillator& branch, double frequency_hz) {
  const double f = frequency_hz, fh = branch.frequency_hz;
  const double gamma = 4.0 * kPi * fh * branch.damping_ratio;
  return std::sqrt(windPower(f, branch.wind_speed)) /
         std::hypot(4.0 * kPi * kPi * (fh * fh - f * f), 2.0 * kPi * f * gamma);
}

float MotionTexture::sample(const glm::vec2& uv, int channel) const {
  const shared::MotionTexels texels = shared::motionTexels(uv, glm::uvec2(width, height));
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return values[(std::size_t{y} * static_cast<std::size_t>(width) + x) *
                      static_cast<std::size_t>(channels) +
                  static_cast<std::size_t>(channel)];
  };
  return shared::motionValue({at(texels.low.x, texels.low.y), at(texels.high.x, texels.low.y),
                              at(texels.low.x, texels.high.y), at(texels.high.x, texels.high.y)},
                             texels.share);
}

MotionTexture makeMotionTexture(const BranchOscillator& branch,
                                const MotionTextureOptions& options) {
  const char* where = "motion texture";
  checkSize(where, options.width, options.height, options.channels);
  need(branch.frequency_hz > 0.0 && std::isfinite(branch.frequency_hz), where,
       fmt::format("a resonance of {} Hz", branch.frequency_hz), "give one above 0");
  need(branch.wind_speed > 0.0 && std::isfinite(branch.wind_speed), where,
       fmt::format("a wind of {} m/s", branch.wind_speed),
       "give a speed above 0; at rest, give the motion no amplitude");
  need(branch.damping_ratio >= 0.02 && branch.damping_ratio <= 4.0, where,
       fmt::format("a damping ratio of {}", branch.damping_ratio), "give one from 0.02 to 4");

  MotionTexture texture = emptyTexture(options.width, options.height, options.channels);
  texture.cycles = options.width / (kTexelsPerCycle * kHighestFrequency);
  const auto power = [&](double cycles) {
    const double amplitude = branchResponse(branch, cycles / texture.cycles * branch.frequency_hz);
    return amplitude * amplitude;
  };
  const int us = options.width / kTexelsPerCycle, vs = options.height / kTexelsPerCycle;
  for (int channel = 0; channel < options.channels; ++channel) {
    if (options.layout == MotionLayout::kRadial) {
      fillChannel(texture, channel, options.seed, [&](int ku, int kv) {
        const double cycles = std::hypot(ku, static_cast<double>(kv) * us / vs);
        return cycles <= us ? power(cycles) : 0.0;
      });
    } else {
      // Hann's window along v: rows far apart are uncorrelated within 0.03.
      std::vector<double> along(static_cast<std::size_t>(us + 1));
      for (int ku = 0; ku <= us; ++ku) along[static_cast<std::size_t>(ku)] = power(ku);
      fillChannel(texture, channel, options.seed, [&](int ku, int kv) {
        const double window = std::cos(0.5 * kPi * kv / vs);
        return along[static_cast<std::size_t>(ku)] * window * window;
      });
    }
  }
  return texture;
}

MotionTexture makeWindTexture(double smallest_wavelength, int size, int channels,
                              std::uint64_t seed) {
  const char* where = "wind texture";
  checkSize(where, size, size, channels);
  need(smallest_wavelength > 0.0 && std::isfinite(smallest_wavelength), where,
       fmt::format("a wavelength of {} m", smallest_wavelength), "give one above 0");
  MotionTexture texture = emptyTexture(size, size, channels);
  texture.extent = smallest_wavelength * size / kTexelsPerCycle;
  for (int channel = 0; channel < channels; ++channel)
    fillChannel(texture, channel, seed, [&](int ku, int kv) {
      return windPowerInPlane(std::hypot(ku, kv) / texture.extent, 1.0 / smallest_wavelength);
    });
  return texture;
}

shared::MotionTrajectory makeTrajectory(const glm::dvec2& offset, double slope, double speed) {
  const char* where = "trajectory";
  need(std::isfinite(offset.x) && std::isfinite(offset.y), where, "an offset that is no number",
       "give finite ones");
  need(speed >= 0.0 && speed < 1.0, where, fmt::format("a speed of {} widths a second", speed),
       "give one from 0 to below 1, or a wider texture");
  need(slope * speed >= 0.0 && slope * speed < 1.0, where, fmt::format("a slope of {}", slope),
       "give one such that it crosses less than the height in a second");
  return {{fixedPoint(offset.x), fixedPoint(offset.y)},
          {fixedPoint(speed), fixedPoint(speed * slope)}};
}

shared::MotionTrajectory makeTrajectory(const MotionTexture& texture, double frequency_hz,
                                        std::uint64_t seed) {
  need(texture.cycles > 0.0, "trajectory", "the texture is not one of branches",
       "make it with makeMotionTexture()");
  Random random(hash(seed));
  const double slope =
      driftingSlope(random, kRowDistance * kTexelsPerCycle / texture.height, texture.height / 23);
  const double u = random.uniform(), v = random.uniform();
  return makeTrajectory({u, v}, slope, frequency_hz / texture.cycles);
}

MotionTime motionTime(double seconds) {
  need(std::isfinite(seconds), "time", fmt::format("{} s", seconds), "give a finite one");
  const double whole = std::floor(seconds);
  const double wrapped = whole - 0x1p32 * std::floor(whole * 0x1p-32);
  return {static_cast<std::uint32_t>(wrapped), static_cast<float>(seconds - whole)};
}

}  // namespace verdure
