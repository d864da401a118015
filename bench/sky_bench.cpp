// The sky's harmonics from the fit, against plain projection (the baseline), in the same run. The
// argument is the number of bands.
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/parallel.h"
#include "verdure/sky_fit.h"

namespace verdure {
namespace {

glm::vec3 sunAt(float zenith, float azimuth) {
  return {std::sin(zenith) * std::sin(azimuth), std::cos(zenith),
          std::sin(zenith) * std::cos(azimuth)};
}

void reconstruct(benchmark::State& state) {
  SkyFitOptions options;
  options.bands = static_cast<int>(state.range(0));
  const SkyFit fit(preethamModel(), options);
  float t = 0.0f;
  for (auto _ : state) {
    t = t > 0.99f ? 0.0f : t + 1e-3f;
    benchmark::DoNotOptimize(fit.at(sunAt(1.5f * t, 6.0f * t), 2.5f + 3.5f * t));
  }
  state.counters["bytes"] = static_cast<double>(fit.coefficients().size_bytes());
}
BENCHMARK(reconstruct)->DenseRange(1, 7)->Unit(benchmark::kMicrosecond);

void project(benchmark::State& state) {
  float t = 0.0f;
  setThreadCount(1);
  for (auto _ : state) {
    t = t > 0.99f ? 0.0f : t + 1e-3f;
    const Daylight light = preethamDaylight(2.5f + 3.5f * t, sunAt(1.5f * t, 6.0f * t));
    benchmark::DoNotOptimize(projectSky(*light.sky, static_cast<int>(state.range(0))));
  }
  setThreadCount(0);
}
BENCHMARK(project)->Arg(4)->Arg(7)->Unit(benchmark::kMicrosecond);

void fitModel(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(SkyFit(preethamModel()));
}
BENCHMARK(fitModel)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace verdure
