#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "leaf/grown_leaf.h"

// Growth of leaves at 1024 x 1024 texels with one and two threads, and its parts: "Venation" is the
// outline and all veins, "Fields" coverage and distances.

namespace verdure {
namespace {

constexpr int kSize = 1024;

const LeafSpecies& speciesOf(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(1)));
  const LeafSpecies& species = allLeafSpecies()[static_cast<std::size_t>(state.range(0))];
  state.SetLabel(species.info.name);
  return species;
}

void GrowLeaf(benchmark::State& state) {
  LeafGrowOptions options;
  options.species = speciesOf(state).info.name;
  options.size = kSize;
  for (auto _ : state) benchmark::DoNotOptimize(growLeaf(options).opacity.data());
  setThreadCount(0);
}

void GrowVenation(benchmark::State& state) {
  const LeafSpecies& species = speciesOf(state);
  std::size_t nodes = 0;
  if (species.form)
    for (auto _ : state) nodes = growForm(species, 1).veins.size();
  else
    state.SkipWithError("needles have no venation");
  state.counters["nodes"] = static_cast<double>(nodes);
  setThreadCount(0);
}

void LeafFields(benchmark::State& state) {
  const LeafSpecies& species = speciesOf(state);
  if (species.form) {
    const GrownLeaf leaf = growForm(species, 1);
    for (auto _ : state)
      benchmark::DoNotOptimize(
          rasterise(leaf, species, {kSize, frameExtent(leaf.form.outline)}).coverage.data());
  } else {
    state.SkipWithError("needles have no venation");
  }
  setThreadCount(0);
}

void everySpecies(benchmark::internal::Benchmark* bench) {
  for (std::size_t s = 0; s < allLeafSpecies().size(); ++s)
    for (const int threads : {1, 2}) bench->Args({static_cast<int>(s), threads});
  bench->ArgNames({"species", "threads"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

BENCHMARK(GrowLeaf)->Apply(everySpecies);
BENCHMARK(GrowVenation)->Apply(everySpecies);
BENCHMARK(LeafFields)->Apply(everySpecies);

}  // namespace
}  // namespace verdure
