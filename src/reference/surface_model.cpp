#include "reference/surface_model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/ground_texture.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "shared/gloss.h"
#include "shared/ground.h"
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

float Scatterer::diffuse(const glm::vec3& direction, bool reflected) const {
  const float seen = glm::dot(facing(), out);
  return mirroredSum(direction, reflected ? normal : -normal, [&](const glm::vec3&, float cosine) {
    return (gloss != nullptr ? gloss->passed(seen, cosine) : 1.0f) * cosine / glm::pi<float>();
  });
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
  const float below = (1.0f - reflected) * (meanOf(reflectance) + meanOf(transmittance));
  return reflected / (reflected + below);
}

float Scatterer::reflectedShare() const {
  const float r = meanOf(reflectance), t = meanOf(transmittance);
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
  const float spread =
      mirroredSum(direction, reflected ? normal : -normal,
                  [](const glm::vec3&, float cosine) { return cosine / glm::pi<float>(); });
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
    if (!(meanOf(reflected ? reflectance : transmittance) > 0.0f)) return std::nullopt;
    direction = cosineDirection(reflected ? normal : -normal, random);
    if ((glm::dot(direction, side) > 0.0f) != reflected) direction = mirrored(direction, side);
  }
  const float chance = density(direction);
  if (!(chance > 0.0f)) return std::nullopt;
  return Sample{direction, value(direction) / chance};
}

SurfaceModel::SurfaceModel(const Scene& scene, const RayScene& rays, bool normal_maps, bool gloss)
    : scene_(scene), rays_(rays) {
  if (gloss) {
    leaf_gloss_.emplace(shared::facetReflectance(), look::kLeafGlossWidth);
    wood_gloss_.emplace(shared::facetReflectance(), look::kWoodGlossWidth);
  }
  if (scene.ground) {
    ground_.image = makeGroundTexture(look::kGroundTextureSize);
    ground_noise_.image = makeGroundNoise(look::kGroundNoiseSize);
  }
  for (const SceneItem& item : scene.items) {
    std::vector<MeshNormals>& normals = normals_.emplace_back();
    for (const Mesh& mesh : item.plant->meshes) {
      MeshNormals& entry = normals.emplace_back();
      if (!normal_maps || mesh.uvs.empty() || mesh.material >= item.plant->materials.size())
        continue;
      const Material& material = item.plant->materials[mesh.material];
      if (material.normal_texture < 0) continue;
      entry.map.emplace(textureOf(*item.plant, material.normal_texture));
      entry.scale = material.normal_scale;
    }
    std::vector<glm::mat4>& worlds = worlds_.emplace_back();
    for (const glm::mat4& instance : item.world_from_plant)
      worlds.push_back(worldFromPlant(scene, item, instance));
  }
}

glm::vec3 SurfaceModel::mappedNormal(const RayHit& hit, const glm::vec2& uv,
                                     const glm::vec3& normal) const {
  const MeshNormals& entry = normals_[hit.item][hit.mesh];
  if (!entry.map) return normal;
  const Mesh& mesh = scene_.items[hit.item].plant->meshes[hit.mesh];
  const std::uint32_t* corner = &mesh.indices[std::size_t{3} * hit.triangle];
  const glm::mat3 world(worlds_[hit.item][hit.instance]);
  const glm::vec3 origin = mesh.positions[corner[0]];
  const glm::vec2 uv_origin = mesh.uvs[corner[0]];
  return shared::mappedNormal(
      shared::textureFrame(normal, world * (mesh.positions[corner[1]] - origin),
                           world * (mesh.positions[corner[2]] - origin),
                           mesh.uvs[corner[1]] - uv_origin, mesh.uvs[corner[2]] - uv_origin),
      entry.map->data(uv), entry.scale);
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
  const float facing = glm::dot(surface.normal, ray.direction) > 0.0f ? -1.0f : 1.0f;
  scatterer.side = facing * surface.normal;
  scatterer.normal = mappedNormal(hit, surface.uv, facing * surface.vertex_normal);
  scatterer.reflectance = glm::clamp(surface.reflectance, 0.0f, 1.0f);
  scatterer.out = -glm::normalize(ray.direction);
  if (const std::optional<Gloss>& gloss = surface.foliage ? leaf_gloss_ : wood_gloss_)
    scatterer.gloss = &*gloss;
  scatterer.transmittance = surface.transmittance;
  return point;
}

}  // namespace verdure
