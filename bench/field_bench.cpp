// The density field and its surface. The baseline (a plain splat, and with VTK its surface) is
// measured in the same run; the first argument is the radius in tenths of a voxel.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/random.h"
#include "field_bench_vtk.h"

namespace verdure {

void splatDense(std::span<const Generator> generators, const Lattice& lattice,
                std::vector<float>& sums) {
  const auto nx = static_cast<std::size_t>(lattice.points.x),
             ny = static_cast<std::size_t>(lattice.points.y);
  sums.assign(nx * ny * static_cast<std::size_t>(lattice.points.z), 0.0f);
  const float h = lattice.spacing;
  parallelChunks(static_cast<std::size_t>(lattice.points.z), 8, [&](std::size_t b, std::size_t e) {
    for (const Generator& g : generators) {
      const glm::vec3 c = (g.position - lattice.origin) / h;
      const float r = g.radius / h, inverse2 = 1.0f / (r * r);
      const glm::ivec3 low(glm::ceil(c - r)), high(glm::floor(c + r));
      const int z0 = std::max(low.z, static_cast<int>(b)),
                z1 = std::min(high.z, static_cast<int>(e) - 1);
      for (int z = z0; z <= z1; ++z)
        for (int y = low.y; y <= high.y; ++y)
          for (int x = low.x; x <= high.x; ++x) {
            const glm::vec3 d = glm::vec3(x, y, z) - c;
            const float s2 = glm::dot(d, d) * inverse2;
            if (s2 < 1.0f)
              sums[static_cast<std::size_t>(x) +
                   nx * (static_cast<std::size_t>(y) + ny * static_cast<std::size_t>(z))] +=
                  (1.0f - s2) * (1.0f - s2);
          }
    }
  });
}

namespace {

constexpr int kCells = 128;

/// 20,000 points in an ellipsoid of 3 x 4 x 3, and a threshold at half the mean interior density.
struct Scene {
  std::vector<Generator> generators;
  Lattice lattice;
  float tau = 0;

  explicit Scene(float radius_voxels, std::size_t count = 20000) {
    Random random(1);
    // The lattice spans the points and the influence: solve for the radius in voxels.
    const float voxel = 4.0f / (static_cast<float>(kCells) - 2.0f * radius_voxels);
    const float radius = radius_voxels * voxel;
    while (generators.size() < count) {
      const glm::vec3 p(random.vary(1), random.vary(1), random.vary(1));
      if (glm::dot(p, p) <= 1.0f) generators.push_back({p * glm::vec3(1.5f, 2.0f, 1.5f), radius});
    }
    const DensityField field(generators);
    lattice = field.lattice(kCells);
    std::vector<glm::vec3> inside;
    for (std::size_t i = 0; i < count; i += 20) inside.push_back(0.5f * generators[i].position);
    std::vector<float> sums(inside.size());
    field.sumAt(inside, sums);
    for (const float s : sums) tau += 0.5f * s / static_cast<float>(sums.size());
  }
};

void fieldAndSurface(benchmark::State& state) {
  const Scene scene(static_cast<float>(state.range(0)) / 10.0f);
  setThreadCount(static_cast<int>(state.range(1)));
  SurfaceStatistics statistics;
  Surface surface;
  for (auto _ : state) {
    const DensityField field(scene.generators);
    surface = field.surface(scene.lattice, scene.tau, std::size_t{1} << 30, &statistics);
    benchmark::DoNotOptimize(surface.positions.data());
  }
  setThreadCount(0);
  state.counters["vertices"] = static_cast<double>(surface.positions.size());
  state.counters["evaluated_share"] = static_cast<double>(statistics.grid_points_evaluated) /
                                      (static_cast<double>(statistics.grid_points.x) *
                                       statistics.grid_points.y * statistics.grid_points.z);
  state.counters["coarse_step"] = statistics.coarse_step;
}
BENCHMARK(fieldAndSurface)
    ->ArgsProduct({{40, 75, 134, 260}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void fieldOnWholeLattice(benchmark::State& state) {
  const Scene scene(static_cast<float>(state.range(0)) / 10.0f);
  setThreadCount(2);
  for (auto _ : state) {
    const DensityField field(scene.generators);
    benchmark::DoNotOptimize(field.sumOn(scene.lattice).data());
  }
  setThreadCount(0);
}
BENCHMARK(fieldOnWholeLattice)->Arg(75)->Arg(134)->Unit(benchmark::kMillisecond)->UseRealTime();

void baselineSplat(benchmark::State& state) {
  const Scene scene(static_cast<float>(state.range(0)) / 10.0f);
  setThreadCount(2);
  std::vector<float> sums;
  for (auto _ : state) splatDense(scene.generators, scene.lattice, sums);
  setThreadCount(0);
}
BENCHMARK(baselineSplat)
    ->Arg(40)
    ->Arg(75)
    ->Arg(134)
    ->Arg(260)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

#ifdef VERDURE_BENCH_VTK
void baselineSplatAndFlyingEdges(benchmark::State& state) {
  const Scene scene(static_cast<float>(state.range(0)) / 10.0f);
  setThreadCount(2);
  std::vector<float> sums;
  std::size_t vertices = 0;
  for (auto _ : state) {
    splatDense(scene.generators, scene.lattice, sums);
    vertices = flyingEdges(scene.lattice, sums, scene.tau);
  }
  setThreadCount(0);
  state.counters["vertices"] = static_cast<double>(vertices);
}
BENCHMARK(baselineSplatAndFlyingEdges)
    ->Arg(40)
    ->Arg(75)
    ->Arg(134)
    ->Arg(260)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
#endif

}  // namespace
}  // namespace verdure
