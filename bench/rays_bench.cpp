// Rays a second beside a bare Embree loop over the same triangles and rays in the same run, and the
// time of the bakes by rays: rays_bench [species].
#include <embree3/rtcore.h>
#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "light_paths.h"
#include "rays/ray_scene.h"
#include "verdure/grow.h"
#include "verdure/occlusion.h"
#include "verdure/transfer.h"

namespace verdure {
namespace {

constexpr std::size_t kOrigins = 4096;
constexpr std::size_t kRaysEach = 64;
constexpr int kRounds = 5;

/// Ambient occlusion's rays: from points just off vertices, a cosine hemisphere each.
std::vector<Ray> occlusionRays(const Plant& plant, const RayScene& scene) {
  std::vector<Ray> rays(kOrigins * kRaysEach);
  const std::vector<VertexId> all = allVertices(plant);
  parallelFor(kOrigins, 64, [&](std::size_t i) {
    Random random(i);
    const VertexId id = all[random.below(static_cast<std::uint32_t>(all.size()))];
    const Mesh& mesh = plant.meshes[id.mesh];
    const glm::vec3& n = mesh.normals[id.vertex];
    const glm::mat3 axes = axesAround(n);
    const ShiftedLattice lattice(kRaysEach, random);
    for (std::size_t r = 0; r < kRaysEach; ++r) {
      const glm::vec2 u = lattice.point(static_cast<int>(r));
      Ray& ray = rays[i * kRaysEach + r];
      ray.direction = axes * cosineDirection(u.x, u.y);
      ray.origin = scene.originOff(mesh.positions[id.vertex], n);
    }
  });
  return rays;
}

/// The same triangles without anything of ours.
struct Bare {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);

  Bare(const Plant& plant, bool robust) {
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (const Mesh& mesh : plant.meshes) {
      const RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      std::copy(mesh.positions.begin(), mesh.positions.end(),
                static_cast<glm::vec3*>(
                    rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(glm::vec3), mesh.positions.size())));
      std::copy(mesh.indices.begin(), mesh.indices.end(),
                static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
                    g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangleCount())));
      rtcCommitGeometry(g);
      rtcAttachGeometry(scene, g);
      rtcReleaseGeometry(g);
    }
    rtcCommitScene(scene);
  }
  ~Bare() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  static RTCRay embreeRay(const Ray& r) {
    RTCRay ray{};
    ray.org_x = r.origin.x;
    ray.org_y = r.origin.y;
    ray.org_z = r.origin.z;
    ray.dir_x = r.direction.x;
    ray.dir_y = r.direction.y;
    ray.dir_z = r.direction.z;
    ray.tfar = r.t_max;
    ray.mask = ~0u;
    return ray;
  }
  bool occluded(const Ray& r) const {
    RTCRay ray = embreeRay(r);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0.0f;
  }
  float distance(const Ray& r) const {
    RTCRayHit query{};
    query.ray = embreeRay(r);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
    return query.ray.tfar;
  }
  void occluded8(const Ray* r, std::uint8_t* free) const {
    RTCRay8 p;
    alignas(32) int valid[8];
    for (int i = 0; i < 8; ++i) {
      valid[i] = -1;
      p.org_x[i] = r[i].origin.x;
      p.org_y[i] = r[i].origin.y;
      p.org_z[i] = r[i].origin.z;
      p.dir_x[i] = r[i].direction.x;
      p.dir_y[i] = r[i].direction.y;
      p.dir_z[i] = r[i].direction.z;
      p.tnear[i] = 0.0f;
      p.tfar[i] = r[i].t_max;
      p.time[i] = 0.0f;
      p.mask[i] = ~0u;
      p.flags[i] = 0;
      p.id[i] = 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded8(valid, scene, &context, &p);
    for (int i = 0; i < 8; ++i) free[i] = p.tfar[i] < 0.0f ? 0 : 1;
  }
};

struct Contender {
  const char* name;
  std::function<double(std::size_t begin, std::size_t end)> trace;  ///< returns a checksum
  double best = 1e30, sum = 0.0;
};

void measure(const char* title, std::vector<Contender> contenders, std::size_t rays) {
  for (int round = 0; round < kRounds; ++round)
    for (Contender& c : contenders) {  // interleaved: other work on the machine hits all alike
      std::vector<double> sums((rays + 4095) / 4096);
      Timer timer;
      parallelChunks(rays, 4096, [&](std::size_t begin, std::size_t end) {
        const RayThread mode;
        sums[begin / 4096] = c.trace(begin, end);
      });
      c.best = std::min(c.best, timer.seconds());
      c.sum = 0.0;
      for (const double s : sums) c.sum += s;
    }
  fmt::print("{}\n", title);
  for (const Contender& c : contenders)
    fmt::print("  {:34} {:6.2f} million rays/s, {:5.2f} of the first (checksum {:.0f})\n", c.name,
               static_cast<double>(rays) / c.best * 1e-6, contenders.front().best / c.best, c.sum);
}

void run(const std::string& species, LeafForm form) {
  GrowOptions options;
  options.species = species;
  options.seed = 4;
  options.leaf_form = form;
  const Plant plant = grow(options);
  Plant opaque = plant;
  for (Material& m : opaque.materials) m.alpha_mode = AlphaMode::kOpaque;
  Timer timer;
  const RayScene ours(opaque);
  const double seconds = timer.lap();
  const RayScene cut(plant);
  const double cut_seconds = timer.lap();
  fmt::print(
      "\n{}, leaves as {}: {} vertices, {} triangles; built in {:.2f} s, with its cut in "
      "{:.2f} s; {:.0f} bytes a triangle\n",
      species, form == LeafForm::kMesh ? "meshes" : "cards", vertexCount(plant),
      triangleCount(plant), seconds, cut_seconds,
      static_cast<double>(ours.memoryBytes()) / static_cast<double>(triangleCount(plant)));
  const Bare bare(opaque, true), fast(opaque, false);
  const std::vector<Ray> rays = occlusionRays(plant, ours);
  const auto count = [](auto occluded) {
    return [occluded](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) sum += occluded(i) ? 1.0 : 0.0;
      return sum;
    };
  };
  const auto many = [&rays](const auto& visibility, std::size_t batch) {
    return [&rays, visibility, batch](std::size_t begin, std::size_t end) {
      std::uint8_t free[64];
      double sum = 0.0;
      for (std::size_t i = begin; i < end; i += batch) {
        visibility(&rays[i], free);
        for (std::size_t r = 0; r < batch; ++r) sum += 1 - free[r];
      }
      return sum;
    };
  };
  measure("occlusion",
          {{"bare rtcOccluded1", count([&](std::size_t i) { return bare.occluded(rays[i]); })},
           {"RayScene::occluded", count([&](std::size_t i) { return ours.occluded(rays[i]); })},
           {"RayScene::visibility", many(
                                        [&](const Ray* r, std::uint8_t* free) {
                                          ours.visibility({r, 64}, {free, 64});
                                        },
                                        64)},
           {"bare rtcOccluded8",
            many([&](const Ray* r, std::uint8_t* free) { bare.occluded8(r, free); }, 8)},
           {"bare rtcOccluded1, not robust",
            count([&](std::size_t i) { return fast.occluded(rays[i]); })},
           {"RayScene::occluded with its cut",
            count([&](std::size_t i) { return cut.occluded(rays[i]); })}},
          rays.size());
  const auto distances = [](auto distance) {
    return [distance](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t i = begin; i < end; ++i) {
        const float d = distance(i);
        if (d < 1e30f) sum += static_cast<double>(d);
      }
      return sum;
    };
  };
  const auto traced = [&rays](const RayScene& scene) {
    return [&rays, &scene](std::size_t i) {
      const auto hit = scene.trace(rays[i]);
      return hit ? hit->distance : 1e30f;
    };
  };
  measure("nearest hit",
          {{"bare rtcIntersect1", distances([&](std::size_t i) { return bare.distance(rays[i]); })},
           {"RayScene::trace", distances(traced(ours))},
           {"RayScene::closestHit (surface)", distances([&](std::size_t i) {
              const auto hit = ours.closestHit(rays[i]);
              return hit ? hit->distance + 1e-9f * hit->reflectance.g : 1e30f;
            })},
           {"RayScene::trace with its cut", distances(traced(cut))}},
          rays.size());
  if (form == LeafForm::kCard) return;
  // Whole plants, but for the paths: a share of the vertices, and what it makes for all.
  const std::vector<VertexId> all = allVertices(plant);
  RayOptions o;
  o.rays = 64;
  o.ground_height = 0.0f;
  const auto tell = [&](const char* what, double share = 1.0) {
    fmt::print("{}: {:.1f} s for 200,000 vertices\n", what,
               timer.lap() * 2e5 / (share * static_cast<double>(all.size())));
  };
  timer.lap();
  {
    Scene world;
    world.items.emplace_back().plant = &plant;
    const RayScene scene(world);
    const RayStarts starts(plant, scene, o.ground_height);
    constexpr std::size_t kStep = 64;
    std::vector<glm::vec3> light(all.size() / kStep);
    timer.lap();
    parallelChunks(light.size(), 64, [&](std::size_t begin, std::size_t end) {
      const RayThread mode;
      for (std::size_t i = begin; i < end; ++i) {
        const VertexId id = all[i * kStep];
        Random random(i);
        test::followPaths(
            scene, starts, id, plant.meshes[id.mesh].normals[id.vertex], o.rays, o.bounces, true,
            random,
            [&](const glm::vec3&, const glm::vec3& throughput, int) { light[i] += throughput; });
      }
    });
    tell("whole paths, 64 rays, 3 bounces",
         static_cast<double>(light.size()) / static_cast<double>(all.size()));
  }
  for (const int bounces : {0, 3}) {
    o.bounces = bounces;
    bakeAmbient(plant, o);
    tell(bounces == 0 ? "ambient, 64 rays, 0 bounces" : "ambient, 64 rays, 3 bounces");
  }
  TransferOptions t;
  t.rays = o;
  t.ground_size = 0;
  bakeTransfer(plant, t);
  tell("transfer, 5 bands, 64 rays each side, 3 bounces");
}

}  // namespace
}  // namespace verdure

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::string species = argc > 1 ? argv[1] : "black-oak";
  verdure::run(species, verdure::LeafForm::kMesh);
  verdure::run(species, verdure::LeafForm::kCard);
}
