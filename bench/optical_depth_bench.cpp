// The optical-depth field of a tree at its vertices, against the direct sum and against rays, in
// one run. File reading and writing are not part of it.
#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "verdure/grow.h"
#include "verdure/occlusion.h"
#include "verdure/optical_depth.h"

namespace verdure {
namespace {

/// An oak of about 200,000 vertices.
const Plant& tree() {
  static const Plant plant = [] {
    GrowOptions options;
    options.species = "black-oak";
    options.texture_size = 64;
    options.set = {{"Leaves", "11"}};
    return grow(options);
  }();
  return plant;
}

void bakeTree(benchmark::State& state) {
  DepthOptions options;
  options.fit = state.range(0) != 0;
  DepthReport report;
  for (auto _ : state) report = bakeOpticalDepth(tree(), options).report;
  state.counters["vertices"] = static_cast<double>(report.vertices);
  state.counters["terms"] = report.terms_per_vertex;
  state.counters["ms_surfels"] = 1e3 * report.seconds_surfels;
  state.counters["ms_field"] = 1e3 * report.seconds_field;
  state.counters["ms_fit"] = 1e3 * report.seconds_fit;
  state.counters["ms_light"] = 1e3 * report.seconds_light;
}
BENCHMARK(bakeTree)->ArgName("fit")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void fitMetaballs(benchmark::State& state) {
  DensityFit fit;
  for (auto _ : state) benchmark::DoNotOptimize(fitDensity(tree(), {}, &fit).rho);
  state.counters["rms_before"] = fit.before.rms;
  state.counters["rms_after"] = fit.after.rms;
}
BENCHMARK(fitMetaballs)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Every 500th vertex; the time is that of all.
void directSum(benchmark::State& state) {
  const std::vector<Surfel> surfels = plantSurfels(tree());
  DepthFieldOptions options = plantDepthOptions(tree(), surfels);
  options.opening = 0.0f;
  const OpticalDepthField field(surfels, options);
  std::vector<glm::vec3> points, normals;
  std::size_t all = 0;
  for (const Mesh& mesh : tree().meshes)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v, ++all)
      if (all % 500 == 0) {
        points.push_back(mesh.positions[v]);
        normals.push_back(mesh.normals[v]);
      }
  std::vector<DepthSums> sums(points.size());
  for (auto _ : state) field.sumAt(points, normals, sums);
  state.counters["s_for_all_vertices"] = benchmark::Counter(
      static_cast<double>(points.size()) / static_cast<double>(all),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(directSum)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Every 100th vertex, the scene's building included.
void rays256(benchmark::State& state) {
  std::vector<VertexId> some;
  const std::vector<VertexId> all = allVertices(tree());
  for (std::size_t i = 0; i < all.size(); i += 100) some.push_back(all[i]);
  for (auto _ : state) benchmark::DoNotOptimize(traceOpenness(tree(), some).size());
  state.counters["s_for_all_vertices"] = benchmark::Counter(
      static_cast<double>(some.size()) / static_cast<double>(all.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(rays256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace verdure
