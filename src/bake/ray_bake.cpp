#include "bake/ray_bake.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

Scene sceneOf(const Plant& plant, const RayOptions& options) {
  if (options.rays < 1 || options.rays > 65536)
    throw Error("rays", fmt::format("{} is outside of [1, 65536]", options.rays), "256 is usual");
  if (options.bounces < 0 || options.bounces > 64)
    throw Error("bounces", fmt::format("{} is outside of [0, 64]", options.bounces), "3 is usual");
  Scene scene;
  scene.items.emplace_back().plant = &plant;
  scene.ground = options.ground_height.has_value();
  scene.ground_height = options.ground_height.value_or(0.0f);
  return scene;
}

}  // namespace

double areaOf(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const glm::vec3& p = mesh.positions[corner[0]];
  return 0.5 * static_cast<double>(glm::length(
                   glm::cross(mesh.positions[corner[1]] - p, mesh.positions[corner[2]] - p)));
}

RayBake::RayBake(const Plant& plant, const RayOptions& options, const CrownLight* normals)
    : plant_(plant),
      options_(options),
      normals_(normals),
      scene(sceneOf(plant, options), {options.max_memory_bytes}),
      starts(plant, scene, options.ground_height) {
  if (normals == nullptr) return;
  bool fits = normals->meshes.size() == plant.meshes.size();
  for (std::size_t m = 0; fits && m < plant.meshes.size(); ++m)
    fits = normals->meshes[m].normals.size() == plant.meshes[m].positions.size();
  if (!fits) throw Error(plant.name, "the normals belong to another plant", "bake this plant");
}

const glm::vec3& RayBake::normalOf(VertexId id) const {
  return normals_ != nullptr ? normals_->meshes[id.mesh].normals[id.vertex]
                             : plant_.meshes[id.mesh].normals[id.vertex];
}

void RayBake::forEachVertex(std::span<const VertexId> vertices, double begin, double end,
                            const std::function<void(std::size_t, Random&)>& body) const {
  for (const VertexId& id : vertices)
    if (id.mesh >= plant_.meshes.size() || id.vertex >= plant_.meshes[id.mesh].positions.size())
      throw Error(plant_.name, fmt::format("has no vertex {} of mesh {}", id.vertex, id.mesh));
  run(vertices.size(), begin, end, [&](std::size_t i) {
    const std::uint64_t number = (std::uint64_t{vertices[i].mesh} << 32) + vertices[i].vertex;
    Random random(hash(number ^ hash(options_.seed)));
    body(i, random);
  });
}

void RayBake::forEach(std::size_t count, std::uint64_t stream, double begin, double end,
                      const std::function<void(std::size_t, Random&)>& body) const {
  run(count, begin, end, [&](std::size_t i) {
    Random random(hash(i ^ hash(options_.seed)), stream);
    body(i, random);
  });
}

void RayBake::run(std::size_t count, double begin, double end,
                  const std::function<void(std::size_t)>& body) const {
  constexpr std::size_t kGrain = 64;
  std::atomic<bool> cancelled{false};
  std::atomic<std::size_t> done{0};
  std::mutex telling;
  parallelChunks(count, kGrain, [&](std::size_t first, std::size_t last) {
    if (cancelled.load(std::memory_order_relaxed)) return;
    const RayThread mode;
    for (std::size_t i = first; i < last; ++i) body(i);
    const std::size_t so_far = done.fetch_add(last - first) + last - first;
    if (!options_.progress) return;
    // Whoever finds another thread telling goes on tracing.
    if (const std::unique_lock lock(telling, std::try_to_lock); lock.owns_lock() && !cancelled)
      if (!options_.progress(begin + (end - begin) * static_cast<double>(so_far) /
                                         static_cast<double>(count)))
        cancelled = true;
  });
  if (cancelled) throw Error("bake", "was cancelled");
}

}  // namespace verdure
