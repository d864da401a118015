#include "verdure/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>

#include "bake/ray_bake.h"
#include "bake/ray_directions.h"
#include "bake/scene_light.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"

namespace verdure {
namespace {

constexpr int kMostBounceBands = 3;

/// The sums of one vertex and side: light that came straight, without colour, and bounced light of
/// each channel.
struct Sums {
  std::array<float, kMaxBands * kMaxBands> direct{};
  std::array<float, 3 * kMaxBands * kMaxBands> bounced{};
};

void checkOptions(const TransferOptions& o) {
  if (o.bands < 2 || o.bands > kMaxBands)
    throw Error("transfer bands", fmt::format("{} is outside of [2, 7]", o.bands), "5 is usual");
  if (o.bounce_bands < 0 || o.bounce_bands > std::min(kMostBounceBands, o.bands))
    throw Error("transfer's bounced bands",
                fmt::format("{} is outside of [0, {}]", o.bounce_bands,
                            std::min(kMostBounceBands, o.bands)),
                "3 is usual");
  if (o.ground_size < 0 || o.ground_size == 1 || o.ground_size > 1024)
    throw Error("transfer's ground", fmt::format("{} points a side", o.ground_size),
                "use 0, or 2 to 1024");
}

class Baker {
 public:
  Baker(const Plant& plant, const TransferOptions& options)
      : plant_(plant),
        options_(options),
        count_(static_cast<std::size_t>(options.bands * options.bands)),
        bounce_count_(static_cast<std::size_t>(options.bounce_bands * options.bounce_bands)) {
    checkOptions(options);
    std::size_t bytes = 0;
    for (const Mesh& mesh : plant.meshes)
      bytes += mesh.positions.size() * (count_ + bounce_count_) * 6 *
               (mesh.kind == PartKind::kFoliage ? 2 : 1);
    if (bytes > options.rays.max_memory_bytes)
      throw Error("transfer",
                  fmt::format("needs {} MiB, more than the {} MiB allowed", bytes >> 20,
                              options.rays.max_memory_bytes >> 20),
                  "use fewer bands or allow more");
  }

  PlantTransfer bake() {
    const RayBake rays(plant_, options_.rays);
    PlantTransfer transfer;
    transfer.bands = options_.bands;
    transfer.bounce_bands = options_.bounce_bands;
    for (const Mesh& mesh : plant_.meshes)
      transfer.meshes.push_back(
          emptyVectors(mesh.positions.size(), mesh.kind == PartKind::kFoliage));
    const std::vector<VertexId> vertices = allVertices(plant_);
    layGround(transfer.ground);
    const auto ground_points = static_cast<std::size_t>(transfer.ground.size) *
                               static_cast<std::size_t>(transfer.ground.size);
    SceneLight light(plant_, rays, options_.rays, options_.bands);
    std::size_t sides = ground_points;
    for (const Mesh& mesh : plant_.meshes)
      sides += mesh.positions.size() * (mesh.kind == PartKind::kFoliage ? 2 : 1);
    const double own = static_cast<double>(sides) * options_.rays.rays;
    const double patches = light.rayCount() / std::max(light.rayCount() + own, 1.0);
    const double vertices_end = 1.0 - static_cast<double>(ground_points) * options_.rays.rays /
                                          std::max(own, 1.0) * (1.0 - patches);
    light.bounce(patches);
    rays.forEach(vertices.size(), kVertexStream, patches, vertices_end,
                 [&](std::size_t i, Random& random) {
                   const VertexId id = vertices[i];
                   TransferVectors& out = transfer.meshes[id.mesh];
                   const glm::vec3& n = rays.normalOf(id);
                   const auto start = [&](const glm::vec3& d) { return rays.starts.from(id, d); };
                   store(trace(light, n, start, random), id.vertex, out.front, out.front_bounced);
                   if (!out.back.empty())
                     store(trace(light, -n, start, random), id.vertex, out.back, out.back_bounced);
                 });
    rays.forEach(
        ground_points, kGroundStream, vertices_end, 1.0, [&](std::size_t i, Random& random) {
          GroundTransfer& ground = transfer.ground;
          const auto size = static_cast<std::size_t>(ground.size);
          const glm::vec2 at =
              ground.corner +
              ground.step * glm::vec2(static_cast<float>(i % size), static_cast<float>(i / size));
          const glm::vec3 up(0.0f, 1.0f, 0.0f);
          Ray ray;
          ray.origin = rays.scene.originOff({at.x, ground.height, at.y}, up);
          const auto start = [&ray](const glm::vec3& d) {
            ray.direction = d;
            return ray;
          };
          store(trace(light, up, start, random), i, ground.vectors.front,
                ground.vectors.front_bounced);
        });
    return transfer;
  }

 private:
  static constexpr std::uint64_t kVertexStream = 1, kGroundStream = 2;

  TransferVectors emptyVectors(std::size_t vertices, bool both_sides) const {
    TransferVectors v;
    v.front.resize(vertices * count_ * 3);
    v.front_bounced.resize(vertices * bounce_count_ * 3);
    if (!both_sides) return v;
    v.back.resize(v.front.size());
    v.back_bounced.resize(v.front_bounced.size());
    return v;
  }

  void layGround(GroundTransfer& ground) const {
    if (!options_.rays.ground_height || options_.ground_size == 0) return;
    ground.size = options_.ground_size;
    ground.height = *options_.rays.ground_height;
    const GroundSquare square = groundSquare(plant_, ground.height);
    ground.corner = square.corner;
    ground.step = square.side / static_cast<float>(ground.size - 1);
    ground.vectors = emptyVectors(
        static_cast<std::size_t>(ground.size) * static_cast<std::size_t>(ground.size), false);
  }

  template <class Start>
  Sums trace(const SceneLight& light, const glm::vec3& normal, const Start& start,
             Random& random) const {
    const int rays = options_.rays.rays;
    const ShiftedLattice lattice(rays, random);
    const glm::mat3 axes = axesAround(normal);
    Sums sums;
    std::array<SceneLight::Slot, RayBake::kBatch> met;
    for (int first = 0; first < rays; first += RayBake::kBatch) {
      std::size_t count = 0;
      for (int r = first; r < std::min(first + RayBake::kBatch, rays); ++r) {
        const glm::vec2 u = lattice.point(r);
        met[count++] = light.follow(start(axes * cosineDirection(u.x, u.y)), sums.direct.data());
      }
      light.gather({met.data(), count}, sums.bounced.data());
    }
    return sums;
  }

  void store(const Sums& sums, std::size_t vertex, std::vector<std::uint16_t>& all,
             std::vector<std::uint16_t>& bounced) const {
    const float scale = 1.0f / static_cast<float>(options_.rays.rays);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < count_; ++i)
        all[(vertex * count_ + i) * 3 + c] =
            glm::packHalf1x16((sums.direct[i] + sums.bounced[3 * i + c]) * scale);
      for (std::size_t i = 0; i < bounce_count_; ++i)
        bounced[(vertex * bounce_count_ + i) * 3 + c] =
            glm::packHalf1x16(sums.bounced[3 * i + c] * scale);
    }
  }

  const Plant& plant_;
  const TransferOptions& options_;
  std::size_t count_, bounce_count_;
};

}  // namespace

PlantTransfer bakeTransfer(const Plant& plant, const TransferOptions& options) {
  return Baker(plant, options).bake();
}

}  // namespace verdure
