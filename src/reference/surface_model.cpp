#include "reference/surface_model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/ground_texture.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "shared/gloss.h"
#include "shared/ground.h"
#include "shared/leaf_basis.h"
#include "shared/normal_map.h"

namespace verdure {
namespace {

float meanOf(const glm::vec3& c) {
  return (c.x + c.y + c.z) / 3.0f;
}

glm::vec3 mirrored(const glm::vec3& v, const glm::vec3& unit_normal) {
  return v - 2.0f * glm::dot(v, unit_normal) * unit_normal;
}

/// A unit direction with density cos / pi around `axis`: a point of the unit sphere on top of it.
glm::vec3 cosineDirection(const glm::vec3& axis, Random& random) {
  const float z = random.uniform(-1.0f, 1.0f), turn = random.uniform(0.0f, glm::two_pi<float>());
  const float ring = std::sqrt(std::max(1.0f - z * z, 0.0f));
  const glm::vec3 sum = axis + glm::vec3(ring * std::cos(turn), ring * std::sin(turn), z);
  const float length = glm::length(sum);
  return length > 1e-6f ? sum / length : axis;
}

}  // namespace

template <class Lobe>
float Scatterer::mirroredSum(const glm::vec3& direction, const glm::vec3& axis,
                             const Lobe& lobe) const {
  const glm::vec3 other = mirrored(direction, side);
  const float here = glm::dot(axis, direction), there = glm::dot(axis, other);
  return (here > 0.0f ? lobe(direction, here) : 0.0f) + (there > 0.0f ? lobe(other, there) : 0.0f);
}

glm::vec3 Scatterer::axis(bool reflected) const {
  if (reflected) return normal;
  if (!through) return -normal;
  const float length = glm::length(through->vector);
  return length > 0.0f ? through->vector / length : -side;
}

float Scatterer::diffuse(const glm::vec3& direction, bool reflected) const {
  if (!reflected && through) return transmitted(direction);
  const float seen = glm::dot(facing(), out);
  return mirroredSum(direction, axis(reflected), [&](const glm::vec3&, float cosine) {
    return (gloss != nullptr ? gloss->passed(seen, cosine) : 1.0f) * cosine / glm::pi<float>();
  });
}

/// (3.23) of Habel 2009. Each side's gloss takes what it mirrors; what passes both, for one side
/// and for the other, is never more than what arrives.
float Scatterer::transmitted(const glm::vec3& direction) const {
  float passed = 1.0f, mean = 0.0f;
  for (const auto& [surface, cosine] : {std::pair{gloss, glm::dot(facing(), out)},
                                        std::pair{through->gloss, -glm::dot(side, direction)}}) {
    if (surface != nullptr) passed *= 1.0f - surface->reflected(cosine);
    mean = std::max(mean, surface != nullptr ? surface->meanPassed() : 1.0f);
  }
  return std::max(glm::dot(through->vector, direction), 0.0f) * passed / mean / glm::pi<float>();
}

float Scatterer::meanTransmitted() const {
  return meanOf(transmittance) * (through ? glm::length(through->vector) : 1.0f);
}

float Scatterer::highlight(const glm::vec3& direction) const {
  if (gloss == nullptr || !(glm::dot(direction, side) > 0.0f)) return 0.0f;
  const glm::vec3& n = facing();
  return mirroredSum(direction, n,
                     [&](const glm::vec3& d, float) { return gloss->value(n, out, d); });
}

float Scatterer::glossShare() const {
  if (gloss == nullptr) return 0.0f;
  const float reflected = gloss->reflected(glm::dot(facing(), out));
  const float below = (1.0f - reflected) * (meanOf(reflectance) + meanTransmitted());
  return reflected / (reflected + below);
}

float Scatterer::reflectedShare() const {
  const float r = meanOf(reflectance), t = meanTransmitted();
  return r + t > 0.0f ? r / (r + t) : 0.0f;
}

glm::vec3 Scatterer::value(const glm::vec3& direction) const {
  const bool reflected = glm::dot(direction, side) > 0.0f;
  return (reflected ? reflectance : transmittance) * diffuse(direction, reflected) +
         highlight(direction);
}

float Scatterer::density(const glm::vec3& direction) const {
  const bool reflected = glm::dot(direction, side) > 0.0f;
  const float share = reflectedShare(), glossy = glossShare();
  const float spread = mirroredSum(direction, axis(reflected), [](const glm::vec3&, float cosine) {
    return cosine / glm::pi<float>();
  });
  float density = (1.0f - glossy) * (reflected ? share : 1.0f - share) * spread;
  if (glossy > 0.0f && reflected) {
    const glm::vec3& n = facing();
    density += glossy * mirroredSum(direction, n, [&](const glm::vec3& d, float) {
                 return gloss->density(n, out, d);
               });
  }
  return density;
}

std::optional<Scatterer::Sample> Scatterer::sample(Random& random) const {
  const float share = reflectedShare(), glossy = glossShare();
  glm::vec3 direction;
  if (glossy > 0.0f && random.uniform() < glossy) {
    direction = gloss->sample(facing(), out, random);
    if (!(glm::dot(direction, facing()) > 0.0f)) return std::nullopt;
    if (!(glm::dot(direction, side) > 0.0f)) direction = mirrored(direction, side);
  } else {
    const bool reflected = random.uniform() < share;
    if (!((reflected ? meanOf(reflectance) : meanTransmitted()) > 0.0f)) return std::nullopt;
    direction = cosineDirection(axis(reflected), random);
    if ((glm::dot(direction, side) > 0.0f) != reflected) direction = mirrored(direction, side);
  }
  const float chance = density(direction);
  if (!(chance > 0.0f)) return std::nullopt;
  return Sample{direction, value(direction) / chance};
}

SurfaceModel::SurfaceModel(const Scene& scene, const RayScene& rays, const Options& options)
    : scene_(scene), rays_(rays), options_(options) {
  if (scene.ground) {
    ground_.image = makeGroundTexture(look::kGroundTextureSize);
    ground_noise_.image = makeGroundNoise(look::kGroundNoiseSize);
  }
  for (const SceneItem& item : scene.items) {
    std::vector<MeshMaps>& maps = maps_.emplace_back();
    for (const Mesh& mesh : item.plant->meshes) {
      MeshMaps& entry = maps.emplace_back();
      static const Material kPlain;
      const Material& material = mesh.material < item.plant->materials.size()
                                     ? item.plant->materials[mesh.material]
                                     : kPlain;
      if (options.gloss) entry.gloss = glossOf(material, mesh.kind == PartKind::kFoliage);
      if (mesh.uvs.empty()) continue;
      entry.normal_scale = material.normal_scale;
      if (options.normal_maps && material.normal_texture >= 0)
        entry.normal.emplace(textureOf(*item.plant, material.normal_texture));
      if (options.leaf_maps && mesh.kind == PartKind::kFoliage && material.leaf)
        entry.leaf = leafMaps(*item.plant, material);
    }
    std::vector<glm::mat4>& worlds = worlds_.emplace_back();
    for (const glm::mat4& instance : item.world_from_plant)
      worlds.push_back(worldFromPlant(scene, item, instance));
  }
}

const Gloss* SurfaceModel::glossOf(const Material& material, bool foliage) {
  const float strength = material.surface.strength;
  if (!(strength > 0.0f)) return nullptr;
  const std::array key{facingReflectance(material), shared::glossWidth(foliage), strength};
  auto found = glosses_.find(key);
  if (found == glosses_.end()) found = glosses_.emplace(key, Gloss(key[0], key[1], key[2])).first;
  return &found->second;
}

SurfaceModel::LeafMaps SurfaceModel::leafMaps(const Plant& plant, const Material& material) {
  const LeafTextures& leaf = *material.leaf;
  const auto grid = [&plant](int index) { return TexelGrid(textureOf(plant, index)); };
  const auto gloss_of = [&](float roughness) -> const Gloss* {
    if (!options_.gloss || !(roughness > 0.0f)) return nullptr;
    const std::pair key{roughness, leaf.refractive_index};
    auto found = leaf_glosses_.find(key);
    if (found == leaf_glosses_.end())
      found = leaf_glosses_.emplace(key, Gloss::cookTorrance(key.first, key.second)).first;
    return &found->second;
  };
  LeafMaps maps;
  maps.back_color = grid(leaf.back_color);
  if (options_.normal_maps) maps.back_normal = grid(leaf.back_normal);
  maps.factor = material.base_color;
  maps.sides = {LeafSideMaps{grid(leaf.front_translucency), grid(leaf.front_light),
                             leaf.front_scale, leaf.front_offset, gloss_of(leaf.front_roughness)},
                LeafSideMaps{grid(leaf.back_translucency), grid(leaf.back_light), leaf.back_scale,
                             leaf.back_offset, gloss_of(leaf.back_roughness)}};
  return maps;
}

glm::mat3 SurfaceModel::textureFrame(const RayHit& hit, const glm::vec3& normal) const {
  const Mesh& mesh = scene_.items[hit.item].plant->meshes[hit.mesh];
  const std::uint32_t* corner = &mesh.indices[std::size_t{3} * hit.triangle];
  const glm::mat3 world(worlds_[hit.item][hit.instance]);
  const glm::vec3 origin = mesh.positions[corner[0]];
  const glm::vec2 uv_origin = mesh.uvs[corner[0]];
  return shared::textureFrame(normal, world * (mesh.positions[corner[1]] - origin),
                              world * (mesh.positions[corner[2]] - origin),
                              mesh.uvs[corner[1]] - uv_origin, mesh.uvs[corner[2]] - uv_origin);
}

glm::vec3 SurfaceModel::groundReflectance(const glm::vec3& position) const {
  const TexelGrid grass(ground_), noise(ground_noise_);
  const shared::GroundLookup at =
      shared::groundLookup({position.x, position.z}, look::kGroundTile_m);
  return glm::min(
      shared::groundColor(grass.color(at.blades, false), grass.color(at.turned_blades, false),
                          noise.data(at.fine).x, noise.data(at.middle).x, noise.data(at.broad).x),
      1.0f);
}

SurfaceModel::Point SurfaceModel::at(const RayHit& hit, const Ray& ray) const {
  const SurfacePoint surface = rays_.surfaceAt(hit, ray);
  Point point{surface.position, {}};
  Scatterer& scatterer = point.scatterer;
  if (hit.ground()) {
    scatterer.reflectance = groundReflectance(surface.position);
    return point;
  }
  const bool front = !(glm::dot(surface.normal, ray.direction) > 0.0f);
  const MeshMaps& maps = maps_[hit.item][hit.mesh];
  scatterer.side = front ? surface.normal : -surface.normal;
  scatterer.normal = front ? surface.vertex_normal : -surface.vertex_normal;
  scatterer.reflectance = glm::clamp(surface.reflectance, 0.0f, 1.0f);
  scatterer.out = -glm::normalize(ray.direction);
  scatterer.gloss = maps.gloss;
  scatterer.transmittance = surface.transmittance;
  if (!maps.normal && !maps.leaf) return point;

  const glm::mat3 frame = textureFrame(hit, scatterer.normal);
  const std::optional<TexelGrid>& normals =
      maps.leaf && !front ? maps.leaf->back_normal : maps.normal;
  if (normals)
    scatterer.normal = shared::mappedNormal(frame, normals->data(surface.uv), maps.normal_scale);
  if (maps.leaf) lightThroughMaps(*maps.leaf, front, surface.uv, frame, scatterer);
  return point;
}

void SurfaceModel::lightThroughMaps(const LeafMaps& maps, bool front, const glm::vec2& uv,
                                    const glm::mat3& frame, Scatterer& scatterer) {
  const LeafSideMaps &near = maps.sides[front ? 0 : 1], &far = maps.sides[front ? 1 : 0];
  if (!front)
    scatterer.reflectance = glm::clamp(maps.back_color.color(uv, false) * maps.factor, 0.0f, 1.0f);
  const glm::vec3 h = near.light.data(uv) * near.scale + near.offset;
  const glm::vec3 through = shared::leafThrough(frame, shared::leafDirection(h));
  // Maps that hold more than there is must not make light.
  const float most = std::max(glm::length(through), 1e-6f);
  scatterer.transmittance =
      glm::min(near.translucency.color(uv, false), (1.0f - scatterer.reflectance) / most);
  scatterer.gloss = near.gloss;
  scatterer.through = {through, far.gloss};
}

}  // namespace verdure
