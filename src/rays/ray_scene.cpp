#include "rays/ray_scene.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>
#if defined(__SSE2__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "rays/cut_table.h"
#include "scene/leaf_surface.h"
#include "scene/scene.h"
#include "shared/sky.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// The alpha cut of the triangles of one Embree geometry that are neither opaque nor cut away.
struct CutPart {
  const CutTable* table = nullptr;
  std::vector<std::array<glm::vec2, 3>> uvs;  ///< of each triangle's corners

  bool cutAt(std::uint32_t primitive, float u, float v) const {
    const std::array<glm::vec2, 3>& c = uvs[primitive];
    return table->transparentAt(c[0] * (1.0f - u - v) + c[1] * u + c[2] * v);
  }
};

void cutFilter(const RTCFilterFunctionNArguments* args) {
  const auto& part = *static_cast<const CutPart*>(args->geometryUserPtr);
  if (args->N == 1) {
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    if (part.cutAt(hit->primID, hit->u, hit->v)) args->valid[0] = 0;
    return;
  }
  for (unsigned int i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    if (part.cutAt(RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i),
                   RTCHitN_v(args->hit, args->N, i)))
      args->valid[i] = 0;
  }
}

/// Some triangles of a mesh as one Embree geometry.
struct Part {
  std::uint32_t mesh = 0;
  std::vector<std::uint32_t> triangles;  ///< of the mesh, for each primitive; empty = all, in order
  std::unique_ptr<CutPart> cut;          ///< null: opaque
};

/// What an Embree geometry of the top scene is: a part of an item, or an instance of a plant.
struct TopGeometry {
  std::uint32_t item = 0, instance = 0;
  std::uint32_t plant = 0;  ///< index into State::plants
  std::uint32_t part = 0;
};

struct PlantParts {
  const Plant* plant = nullptr;
  std::size_t placements = 0;
  std::vector<Part> parts;
  std::vector<TexelGrid> textures;  ///< of each mesh's base colour, if it has one
  std::vector<bool> textured;
  std::vector<std::optional<LeafSurface>> leaves;  ///< of each mesh that is foliage
  std::vector<const CutTable*> cuts;               ///< of each mesh; null: opaque
  RTCScene scene = nullptr;                        ///< null unless it is instanced
};

struct Placement3 {
  glm::mat4 world_from_plant{1.0f};
  glm::mat3 normal_matrix{1.0f};
  bool mirrored = false;
};

std::string deviceError(RTCDevice device) {
  return fmt::format("Embree says error {}", static_cast<int>(rtcGetDeviceError(device)));
}

bool countBytes(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

void checkPlant(const Plant& plant) {
  for (const Mesh& mesh : plant.meshes) {
    const std::string where = plant.name + ", mesh " + mesh.name;
    const std::size_t count = mesh.positions.size();
    if (mesh.normals.size() != count)
      throw Error(where, "has not one normal for each vertex", "load it with loadPlant");
    if (!mesh.uvs.empty() && mesh.uvs.size() != count)
      throw Error(where, "has not one texture coordinate for each vertex");
    if (std::any_of(mesh.indices.begin(), mesh.indices.end(),
                    [count](std::uint32_t i) { return i >= count; }))
      throw Error(where, "has an index past its last vertex");
  }
}

/// Bytes that Embree needs, from above: its BVH4 over blocks of four triangles takes 100 to 130
/// bytes a triangle with what it uses while building, an instance about 700.
std::size_t estimatedBytes(const std::vector<PlantParts>& plants, std::size_t instances) {
  std::size_t bytes = instances * 1024 + (std::size_t{1} << 20);
  for (const PlantParts& p : plants) {
    std::size_t vertices = 0, triangles = 0;
    for (const Mesh& mesh : p.plant->meshes) {
      vertices += mesh.positions.size();
      triangles += mesh.triangleCount();
    }
    // Opaque and mixed triangles of one mesh are two geometries with the same vertices.
    bytes += 2 * 12 * vertices + 200 * triangles;
  }
  return bytes;
}

}  // namespace

struct RayScene::State {
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::atomic<std::int64_t> bytes{0};
  std::vector<PlantParts> plants;
  std::vector<std::uint32_t> plant_of_item;
  std::vector<std::vector<Placement3>> placements;  ///< of each item
  std::vector<TopGeometry> top_geometries;          ///< by geometry ID
  std::map<std::pair<const Texture*, float>, std::unique_ptr<CutTable>> cut_tables;
  bool leaf_maps = true;
  bool ground = false;
  float ground_height = 0.0f;
  float least_size = 0.0f;  ///< of coordinates, for originOff

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    for (const PlantParts& p : plants)
      if (p.scene != nullptr) rtcReleaseScene(p.scene);
    if (top != nullptr) rtcReleaseScene(top);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build(const Scene& scene, const RaySceneOptions& options);
  void notePlants(const Scene& scene);
  void splitPlant(PlantParts& plant);
  RTCScene newScene() const;
  void attach(RTCScene scene, std::uint32_t id, const PlantParts& plant, const Part& part,
              const glm::mat4* transform) const;
  void commit(RTCScene scene) const;
  RayHit located(const RTCRayHit& query) const;
  std::optional<float> groundDistance(const Ray& ray) const;
};

void RayScene::State::notePlants(const Scene& scene) {
  std::map<const Plant*, std::uint32_t> known;
  for (const SceneItem& item : scene.items) {
    if (item.plant == nullptr) throw Error("scene", "an item has no plant", "set SceneItem::plant");
    const auto [entry, is_new] =
        known.try_emplace(item.plant, static_cast<std::uint32_t>(plants.size()));
    if (is_new) {
      checkPlant(*item.plant);
      plants.emplace_back().plant = item.plant;
    }
    plants[entry->second].placements += item.world_from_plant.size();
    plant_of_item.push_back(entry->second);
    std::vector<Placement3>& places = placements.emplace_back();
    const Bounds box = bounds(*item.plant);
    const glm::vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
    for (const glm::mat4& instance : item.world_from_plant) {
      const glm::mat4 m = worldFromPlant(scene, item, instance);
      const glm::mat3 linear(m);
      places.push_back({m, glm::transpose(glm::inverse(linear)), glm::determinant(linear) < 0.0f});
      for (int row = 0; row < 3; ++row)
        least_size = std::max(least_size, std::abs(linear[0][row]) * reach.x +
                                              std::abs(linear[1][row]) * reach.y +
                                              std::abs(linear[2][row]) * reach.z);
    }
  }
}

/// Opaque triangles, triangles that the cut runs through, and those that it takes away (left out).
void RayScene::State::splitPlant(PlantParts& p) {
  const Plant& plant = *p.plant;
  for (std::uint32_t m = 0; m < plant.meshes.size(); ++m) {
    const Mesh& mesh = plant.meshes[m];
    static const Material kPlain;
    const Material& material =
        mesh.material < plant.materials.size() ? plant.materials[mesh.material] : kPlain;
    const bool textured = !mesh.uvs.empty() && material.base_color_texture >= 0;
    const bool cut = textured && material.alpha_mode != AlphaMode::kOpaque;
    p.textured.push_back(textured);
    std::optional<LeafSurface>& leaf = p.leaves.emplace_back();
    if (mesh.kind == PartKind::kFoliage)
      leaf.emplace(plant, material, !mesh.uvs.empty(), leaf_maps);
    p.cuts.push_back(nullptr);
    p.textures.push_back(textured ? TexelGrid(textureOf(plant, material.base_color_texture))
                                  : TexelGrid());
    if (mesh.triangleCount() == 0) continue;
    if (!cut) {
      p.parts.push_back({m, {}, nullptr});
      continue;
    }
    const Texture& texture = textureOf(plant, material.base_color_texture);
    const float cutoff = textureCutoff(material);
    std::unique_ptr<CutTable>& table = cut_tables[{&texture, cutoff}];
    if (table == nullptr) table = std::make_unique<CutTable>(texture, cutoff);
    p.cuts.back() = table.get();
    const auto uvsOf = [&mesh](std::size_t t) {
      const std::uint32_t* corner = &mesh.indices[3 * t];
      return std::array{mesh.uvs[corner[0]], mesh.uvs[corner[1]], mesh.uvs[corner[2]]};
    };
    std::vector<Cut> kinds(mesh.triangleCount());
    parallelFor(kinds.size(), 1024, [&](std::size_t t) { kinds[t] = table->classify(uvsOf(t)); });
    Part opaque{m, {}, nullptr}, mixed{m, {}, std::make_unique<CutPart>()};
    mixed.cut->table = table.get();
    for (std::uint32_t t = 0; t < kinds.size(); ++t) {
      if (kinds[t] == Cut::kOpaque) opaque.triangles.push_back(t);
      if (kinds[t] != Cut::kMixed) continue;
      mixed.triangles.push_back(t);
      mixed.cut->uvs.push_back(uvsOf(t));
    }
    if (!opaque.triangles.empty()) p.parts.push_back(std::move(opaque));
    if (!mixed.triangles.empty()) p.parts.push_back(std::move(mixed));
  }
}

RTCScene RayScene::State::newScene() const {
  const RTCScene scene = rtcNewScene(device);
  // Robust: no ray slips through the edge between two triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

void RayScene::State::attach(RTCScene scene, std::uint32_t id, const PlantParts& plant,
                             const Part& part, const glm::mat4* transform) const {
  const Mesh& mesh = plant.plant->meshes[part.mesh];
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.positions.size()));
  const std::size_t count = part.triangles.empty() ? mesh.triangleCount() : part.triangles.size();
  auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), count));
  if (positions == nullptr || corners == nullptr) {
    rtcReleaseGeometry(geometry);
    throw Error(plant.plant->name, deviceError(device), "use a smaller plant");
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    positions[v] = transform != nullptr ? glm::vec3(*transform * glm::vec4(mesh.positions[v], 1.0f))
                                        : mesh.positions[v];
  if (part.triangles.empty())
    std::copy_n(mesh.indices.begin(), 3 * count, corners);
  else
    for (std::size_t t = 0; t < count; ++t)
      std::copy_n(&mesh.indices[3 * std::size_t{part.triangles[t]}], 3, corners + 3 * t);
  if (part.cut != nullptr) {
    rtcSetGeometryUserData(geometry, part.cut.get());
    rtcSetGeometryIntersectFilterFunction(geometry, cutFilter);
    rtcSetGeometryOccludedFilterFunction(geometry, cutFilter);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void RayScene::State::commit(RTCScene scene) const {
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw Error("ray-traced scene",
                error == RTC_ERROR_OUT_OF_MEMORY
                    ? "does not fit into memory"
                    : fmt::format("Embree says error {}", static_cast<int>(error)),
                "use fewer or smaller plants");
}

void RayScene::State::build(const Scene& scene, const RaySceneOptions& options) {
  leaf_maps = options.leaf_maps;
  notePlants(scene);
  std::size_t instances = 0;
  for (const PlantParts& p : plants) instances += p.placements > 1 ? p.placements : 0;
  if (const std::size_t needed = estimatedBytes(plants, instances);
      needed > options.max_memory_bytes)
    throw Error("ray-traced scene",
                fmt::format("needs about {} MiB, more than the {} MiB allowed", needed >> 20,
                            options.max_memory_bytes >> 20),
                "use fewer or smaller plants, or allow more");

  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("ray-traced scene", deviceError(nullptr));
  rtcSetDeviceMemoryMonitorFunction(device, countBytes, &bytes);
  top = newScene();
  for (PlantParts& p : plants) {
    splitPlant(p);
    if (p.placements <= 1) continue;
    p.scene = newScene();
    for (std::uint32_t i = 0; i < p.parts.size(); ++i) attach(p.scene, i, p, p.parts[i], nullptr);
    commit(p.scene);
  }
  for (std::uint32_t i = 0; i < scene.items.size(); ++i) {
    const PlantParts& p = plants[plant_of_item[i]];
    for (std::uint32_t n = 0; n < placements[i].size(); ++n) {
      const glm::mat4& m = placements[i][n].world_from_plant;
      if (p.scene == nullptr) {
        for (std::uint32_t part = 0; part < p.parts.size(); ++part) {
          attach(top, static_cast<std::uint32_t>(top_geometries.size()), p, p.parts[part], &m);
          top_geometries.push_back({i, n, plant_of_item[i], part});
        }
        continue;
      }
      const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, p.scene);
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &m[0][0]);
      rtcCommitGeometry(instance);
      rtcAttachGeometryByID(top, instance, static_cast<std::uint32_t>(top_geometries.size()));
      rtcReleaseGeometry(instance);
      top_geometries.push_back({i, n, plant_of_item[i], 0});
    }
  }
  commit(top);
  ground = scene.ground;
  ground_height = scene.ground_height;
}

RayHit RayScene::State::located(const RTCRayHit& query) const {
  const RTCHit& hit = query.hit;
  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const TopGeometry& at = top_geometries[instanced ? hit.instID[0] : hit.geomID];
  const Part& part = plants[at.plant].parts[instanced ? hit.geomID : at.part];
  const Placement3& place = placements[at.item][at.instance];
  // The normal is that of the corners as they lie in the geometry: of an instance in the plant's
  // own space, else in the world, where a mirror has turned it round.
  glm::vec3 normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
  if (instanced)
    normal = place.normal_matrix * normal;
  else if (place.mirrored)
    normal = -normal;
  RayHit result;
  result.distance = query.ray.tfar;
  result.barycentric = {hit.u, hit.v};
  result.item = at.item;
  result.instance = at.instance;
  result.mesh = part.mesh;
  result.triangle = part.triangles.empty() ? hit.primID : part.triangles[hit.primID];
  result.front =
      glm::dot(normal, glm::vec3(query.ray.dir_x, query.ray.dir_y, query.ray.dir_z)) < 0.0f;
  return result;
}

std::optional<float> RayScene::State::groundDistance(const Ray& ray) const {
  if (!ground || !(ray.direction.y < 0.0f)) return std::nullopt;
  const float t = (ground_height - ray.origin.y) / ray.direction.y;
  if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
  return t;
}

namespace {

RTCRay embreeRay(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.t_min;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = 0.0f;
  r.tfar = ray.t_max;
  r.mask = 0xffffffffu;
  r.id = 0;
  r.flags = 0;
  return r;
}

}  // namespace

#if defined(__SSE2__)
RayThread::RayThread() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
}
RayThread::~RayThread() {
  _mm_setcsr(saved_);
}
#else
RayThread::RayThread() = default;
RayThread::~RayThread() = default;
#endif

RayScene::RayScene(const Scene& scene, const RaySceneOptions& options)
    : state_(std::make_unique<State>()) {
  state_->build(scene, options);
}

RayScene::RayScene(const Plant& plant, const RaySceneOptions& options)
    : state_(std::make_unique<State>()) {
  Scene scene;
  scene.items.emplace_back().plant = &plant;
  scene.ground = false;
  state_->build(scene, options);
}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

std::optional<RayHit> RayScene::trace(const Ray& ray) const {
  RTCRayHit query;
  query.ray = embreeRay(ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  const std::optional<float> ground = state_->groundDistance(ray);
  if (ground) query.ray.tfar = *ground;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(state_->top, &context, &query);
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) return state_->located(query);
  if (!ground) return std::nullopt;
  RayHit hit;
  hit.distance = *ground;
  return hit;
}

bool RayScene::occluded(const Ray& ray) const {
  if (state_->groundDistance(ray)) return true;
  RTCRay query = embreeRay(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(state_->top, &context, &query);
  return query.tfar < 0.0f;
}

void RayScene::visibility(std::span<const Ray> rays, std::span<std::uint8_t> free) const {
  VERDURE_CHECK_EQ(rays.size(), free.size());
  for (std::size_t i = 0; i < rays.size(); ++i) free[i] = occluded(rays[i]) ? 0 : 1;
}

std::optional<Hit> RayScene::closestHit(const Ray& ray) const {
  const std::optional<RayHit> hit = trace(ray);
  if (!hit) return std::nullopt;
  return Hit{*hit, surfaceAt(*hit, ray)};
}

SurfacePoint RayScene::surfaceAt(const RayHit& hit, const Ray& ray) const {
  SurfacePoint point;
  if (hit.ground()) {
    point.position = ray.origin + ray.direction * hit.distance;
    point.position.y = state_->ground_height;
    point.reflectance = shared::groundMeanColor();
    return point;
  }
  const PlantParts& p = state_->plants[state_->plant_of_item[hit.item]];
  const Placement3& place = state_->placements[hit.item][hit.instance];
  const Mesh& mesh = p.plant->meshes[hit.mesh];
  const std::uint32_t* corner = &mesh.indices[3 * std::size_t{hit.triangle}];
  const float b = hit.barycentric.x, c = hit.barycentric.y, a = 1.0f - b - c;
  const auto mixed = [&](const auto& values) {
    return a * values[corner[0]] + b * values[corner[1]] + c * values[corner[2]];
  };
  const auto unit = [](const glm::vec3& v, const glm::vec3& fallback) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : fallback;
  };
  point.position = glm::vec3(place.world_from_plant * glm::vec4(mixed(mesh.positions), 1.0f));
  const glm::vec3& first = mesh.positions[corner[0]];
  point.normal = unit(place.normal_matrix * unit(glm::cross(mesh.positions[corner[1]] - first,
                                                            mesh.positions[corner[2]] - first),
                                                 glm::vec3(0.0f, 1.0f, 0.0f)),
                      glm::vec3(0.0f, 1.0f, 0.0f));
  point.vertex_normal = unit(place.normal_matrix * mixed(mesh.normals), point.normal);
  static const Material kPlain;
  const Material& material =
      mesh.material < p.plant->materials.size() ? p.plant->materials[mesh.material] : kPlain;
  point.reflectance = glm::vec3(material.base_color);
  if (!mesh.uvs.empty()) point.uv = mixed(mesh.uvs);
  if (p.textured[hit.mesh])
    point.reflectance *= p.textures[hit.mesh].color(point.uv, p.cuts[hit.mesh] != nullptr);
  point.reflectance = glm::clamp(point.reflectance, 0.0f, 1.0f);
  if (const std::optional<LeafSurface>& leaf = p.leaves[hit.mesh]) {
    const LeafDiffuse diffuse = leaf->at(point.uv, point.reflectance, hit.front);
    point.reflectance = diffuse.reflectance;
    point.transmittance = diffuse.transmittance;
    point.foliage = true;
  }
  return point;
}

bool RayScene::cutAt(const RayHit& point) const {
  const PlantParts& p = state_->plants[state_->plant_of_item[point.item]];
  const CutTable* table = p.cuts[point.mesh];
  if (table == nullptr) return false;
  const Mesh& mesh = p.plant->meshes[point.mesh];
  const std::uint32_t* corner = &mesh.indices[3 * std::size_t{point.triangle}];
  const float b = point.barycentric.x, c = point.barycentric.y;
  return table->transparentAt(mesh.uvs[corner[0]] * (1.0f - b - c) + mesh.uvs[corner[1]] * b +
                              mesh.uvs[corner[2]] * c);
}

glm::vec3 RayScene::originOff(const glm::vec3& position, const glm::vec3& normal) const {
  return position + normal * originOffset(position);
}

float RayScene::originOffset(const glm::vec3& position) const {
  const glm::vec3 size = glm::abs(position);
  return std::max({size.x, size.y, size.z, state_->least_size, 1e-6f}) * 0x1p-21f;
}

std::size_t RayScene::memoryBytes() const {
  return static_cast<std::size_t>(std::max<std::int64_t>(state_->bytes.load(), 0));
}

}  // namespace verdure
