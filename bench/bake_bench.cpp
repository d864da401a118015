// The whole bake of a crown: per step, over plant sizes, threads, and a population of a million
// leaves. File reading and writing are not part of it.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "base/parallel.h"
#include "base/random.h"
#include "verdure/density.h"
#include "verdure/grow.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

/// A grown tree, thinned to about `vertices` vertices by dropping leaves evenly.
const Plant& treeOf(std::size_t vertices) {
  static std::map<std::size_t, Plant> trees;
  const auto found = trees.find(vertices);
  if (found != trees.end()) return found->second;
  GrowOptions options;
  options.species = "black-oak";
  options.texture_size = 64;
  Plant plant = grow(options);
  std::size_t wood = 0;
  for (const Mesh& mesh : plant.meshes)
    if (mesh.kind == PartKind::kWood) wood += mesh.positions.size();
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    Mesh& mesh = plant.meshes[m];
    if (mesh.kind != PartKind::kFoliage) continue;
    const double share = std::min(
        1.0, static_cast<double>(vertices - wood) / static_cast<double>(mesh.positions.size()));
    const auto keep = static_cast<std::size_t>(share * static_cast<double>(mesh.positions.size()));
    // Leaves come one after another: keep whole runs spread over the crown.
    Mesh thin = mesh;
    thin.positions.clear();
    thin.normals.clear();
    thin.uvs.clear();
    thin.indices.clear();
    double due = 0;
    for (const Leaf& leaf : plant.leaves) {
      if (leaf.mesh != m) continue;
      due += share;
      if (due < 1.0 || thin.positions.size() >= keep) continue;
      due -= 1.0;
      std::map<std::uint32_t, std::uint32_t> renamed;
      for (std::size_t t = 0; t < leaf.triangle_count; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v =
              mesh.indices[3 * plant.leaf_triangles[leaf.first_triangle + t] + k];
          const auto [at, fresh] =
              renamed.insert({v, static_cast<std::uint32_t>(thin.positions.size())});
          if (fresh) {
            thin.positions.push_back(mesh.positions[v]);
            thin.normals.push_back(mesh.normals[v]);
            thin.uvs.push_back(mesh.uvs[v]);
          }
          thin.indices.push_back(at->second);
        }
    }
    mesh = std::move(thin);
  }
  findLeaves(plant);
  return trees.emplace(vertices, std::move(plant)).first->second;
}

void bakeTree(benchmark::State& state) {
  const Plant& plant = treeOf(static_cast<std::size_t>(state.range(0)));
  setThreadCount(static_cast<int>(state.range(1)));
  DensityReport report;
  for (auto _ : state) report = bakeDensity(plant).report;
  setThreadCount(0);
  state.counters["vertices"] = static_cast<double>(report.vertices);
  state.counters["leaves"] = static_cast<double>(report.leaves);
  state.counters["ms_surface"] = 1e3 * report.seconds_surface;
  state.counters["ms_ambient"] = 1e3 * report.seconds_ambient;
  state.counters["ms_normals"] = 1e3 * report.seconds_normals;
}
BENCHMARK(bakeTree)
    ->ArgsProduct({{200000, 350000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A crown of `count` quads at constant density: the radius stays, the crown grows, so that the
/// work should be in proportion to the leaves.
Plant quadCrown(std::size_t count) {
  Random random(1);
  const float size = std::cbrt(static_cast<float>(count) / 1000.0f);
  Plant plant;
  plant.materials.push_back({});
  Mesh mesh;
  mesh.kind = PartKind::kFoliage;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 c = size * glm::vec3(random.vary(1), random.vary(1), random.vary(1));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& o : {glm::vec3(0), glm::vec3(0.05f, 0, 0), glm::vec3(0.05f, 0.05f, 0),
                               glm::vec3(0, 0.05f, 0)}) {
      mesh.positions.push_back(c + o);
      mesh.normals.push_back({0, 0, 1});
    }
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    plant.leaves.push_back({0, static_cast<std::uint32_t>(2 * i), 2, kNone,
                            c + glm::vec3(0.025f, 0.025f, 0), 0.0025f, c});
    plant.leaf_triangles.push_back(static_cast<std::uint32_t>(2 * i));
    plant.leaf_triangles.push_back(static_cast<std::uint32_t>(2 * i + 1));
  }
  plant.meshes.push_back(std::move(mesh));
  return plant;
}

void bakeLeaves(benchmark::State& state) {
  const Plant plant = quadCrown(static_cast<std::size_t>(state.range(0)));
  setThreadCount(static_cast<int>(state.range(1)));
  DensityOptions options;
  options.rho = 0.4f;
  // Voxels of a fixed size, too.
  options.grid =
      static_cast<int>(2.0f * std::cbrt(static_cast<float>(state.range(0)) / 1000.0f) / 0.05f);
  for (auto _ : state) benchmark::DoNotOptimize(bakeDensity(plant, options).report.tau);
  setThreadCount(0);
  state.counters["us_per_leaf"] = benchmark::Counter(
      static_cast<double>(state.range(0)) * 1e-6,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(bakeLeaves)
    ->ArgsProduct({{1000, 10000, 100000, 1000000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void bakePopulationOfAMillionLeaves(benchmark::State& state) {
  const Plant plant = quadCrown(40000);
  const Plant* plants[] = {&plant};
  std::vector<Placement> placements;
  Random random(2);
  for (int i = 0; i < 25; ++i)
    placements.push_back(
        {0,
         {10.0f * static_cast<float>(i % 5), 0.0f, 10.0f * static_cast<float>(i / 5)},
         random.uniform(0.0f, 6.28f),
         random.uniform(0.8f, 1.2f)});
  setThreadCount(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(bakeDensityPopulation(plants, placements).size());
  setThreadCount(0);
}
BENCHMARK(bakePopulationOfAMillionLeaves)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace verdure
