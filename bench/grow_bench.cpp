#include <benchmark/benchmark.h>

#include "base/parallel.h"
#include "plant/leaf_shape.h"
#include "plant/species.h"
#include "plant/tree_mesh.h"
#include "plant/weber_penn.h"
#include "verdure/grow.h"

// Growth with one and two threads. "Grow" is the whole call with textures of 512 pixels, "Shape"
// the stems, leaves and meshes alone, "Textures" the rest.

namespace verdure {
namespace {

const Species& speciesOf(const benchmark::State& state) {
  return allSpecies()[static_cast<std::size_t>(state.range(0))];
}

LeafShape leafOf(const Species& species) {
  return static_cast<LeafShape>(static_cast<int>(species.parameters.leaf_shape));
}

LeafAtlas leavesOf(const Species& species, int size) {
  return growLeafAtlas(leafSpeciesOf(leafOf(species)), size, 0.4f);
}

/// Makes a tree without textures; returns the number of leaves.
std::size_t shape(const Species& species, const TreeParameters& parameters,
                  const LeafAtlas& atlas) {
  const Skeleton skeleton = growSkeleton(parameters, 1);
  Plant plant;
  plant.meshes.push_back(meshStems(skeleton, parameters, species.bark.width_m, 0.0f, 1e9f));
  plant.meshes.push_back(meshLeaves(skeleton, atlas, species.blade, LeafForm::kMesh,
                                    leafOf(species) == LeafShape::kNeedles, 1, plant));
  benchmark::DoNotOptimize(plant.meshes.data());
  return plant.leaves.size();
}

void Grow(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(1)));
  GrowOptions options;
  options.species = speciesOf(state).info.name;
  std::size_t leaves = 0;
  for (auto _ : state) leaves = grow(options).leaves.size();
  state.SetLabel(options.species);
  state.counters["leaves"] = static_cast<double>(leaves);
  setThreadCount(0);
}

void Shape(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(1)));
  const Species& species = speciesOf(state);
  const LeafAtlas atlas = leavesOf(species, 32);
  std::size_t leaves = 0;
  for (auto _ : state) leaves = shape(species, species.parameters, atlas);
  state.SetLabel(species.info.name);
  state.counters["leaves"] = static_cast<double>(leaves);
  setThreadCount(0);
}

void FortyThousandLeaves(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(0)));
  const Species& aspen = findSpecies("quaking-aspen");
  TreeParameters parameters = aspen.parameters;
  setParameters(parameters, "ScaleV=0 Leaves=45");
  const LeafAtlas atlas = leavesOf(aspen, 32);
  std::size_t leaves = 0;
  for (auto _ : state) leaves = shape(aspen, parameters, atlas);
  state.counters["leaves"] = static_cast<double>(leaves);
  setThreadCount(0);
}

void Textures(benchmark::State& state) {
  setThreadCount(static_cast<int>(state.range(1)));
  const Species& species = speciesOf(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(makeBark(species.bark, 512, 1).color.rgba.data());
    benchmark::DoNotOptimize(leavesOf(species, 512).light.front.data());
  }
  state.SetLabel(species.info.name);
  setThreadCount(0);
}

void everySpecies(benchmark::internal::Benchmark* bench) {
  for (std::size_t s = 0; s < allSpecies().size(); ++s)
    for (const int threads : {1, 2}) bench->Args({static_cast<int>(s), threads});
  bench->ArgNames({"species", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(FortyThousandLeaves)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(Grow)->Apply(everySpecies);
BENCHMARK(Shape)->Apply(everySpecies);
BENCHMARK(Textures)->Apply(everySpecies);

}  // namespace
}  // namespace verdure
