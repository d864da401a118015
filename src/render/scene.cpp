#include "render/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "render/look.h"
#include "scene/leaf_surface.h"
#include "scene/scene.h"
#include "shared/density.h"
#include "shared/foliage_shadow.h"
#include "shared/leaf_visibility.h"
#include "verdure/error.h"

namespace verdure {
namespace {

// A buffer of transfer vectors takes at most 64 MiB: half of what every device allows.
constexpr std::size_t kTransferWords = std::size_t{1} << 24;
/// As much for the motion of all plants.
constexpr std::size_t kMotionWords = std::size_t{1} << 24;
/// And twice that for a forest's.
constexpr std::size_t kForestMotionWords = std::size_t{1} << 25;

/// Alpha as a grey picture.
Image alphaOf(const Image& image) {
  Image grey = image;
  for (std::size_t i = 0; i < grey.rgba.size(); ++i) grey.rgba[i] = image.rgba[i | 3];
  return grey;
}

class Packer {
 public:
  explicit Packer(const Scene& scene) : scene_(scene) {
    const std::uint8_t white[] = {255, 255, 255, 255}, flat[] = {128, 128, 255, 255};
    for (const auto& texel : {white, flat}) {
      Image image(1, 1);
      std::copy_n(texel, 4, image.rgba.begin());
      out_.textures.push_back(texel == white ? buildColorMips(image, {}) : buildLinearMips(image));
      out_.texture_is_linear.push_back(texel == flat);
      std::vector<gpu::MipLevel>& levels = out_.textures.back().levels;
      out_.leaf_arrays.push_back({{levels, levels, levels}, texel == flat});
    }
  }

  PackedScene pack() {
    bool any_baked = false;
    for (const SceneItem& item : scene_.items) any_baked = any_baked || item.light != nullptr;
    if (scene_.forest != nullptr)
      for (const ForestKind& kind : scene_.forest->kinds)
        any_baked = any_baked || kind.light != nullptr;
    out_.bounds = {glm::vec3(std::numeric_limits<float>::max()),
                   glm::vec3(std::numeric_limits<float>::lowest())};
    for (const SceneItem& item : scene_.items) noteTextureUse(*item.plant);
    for (const SceneItem& item : scene_.items) packItem(item, any_baked);
    const bool any_items = !out_.draws.empty();
    if (scene_.forest != nullptr && !scene_.forest->places.empty()) packTrees(any_baked);
    if (!any_items) out_.bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
    if (leaf_tint_.w > 0.0) out_.leaf_tint = glm::dvec3(leaf_tint_) / leaf_tint_.w;
    std::stable_partition(out_.draws.begin(), out_.draws.end(),
                          [](const Draw& draw) { return !draw.foliage; });
    for (Draw& draw : out_.draws) {
      if (!draw.forest) continue;
      out_.forest->draw_classes.push_back(*draw.forest);
      draw.forest = static_cast<std::uint32_t>(out_.forest->draw_classes.size() - 1);
    }
    out_.motions.finish();
    out_.ground = scene_.ground;
    out_.ground_height = scene_.ground_height;
    return std::move(out_);
  }

 private:
  // Before any texture is built: several meshes may share one.
  void noteTextureUse(const Plant& plant) {
    for (const Mesh& mesh : plant.meshes) {
      if (mesh.material >= plant.materials.size() || mesh.uvs.size() != mesh.positions.size())
        continue;
      const Material& material = plant.materials[mesh.material];
      if (material.alpha_mode == AlphaMode::kOpaque || material.base_color_texture < 0) continue;
      const Texture& texture = textureOf(plant, material.base_color_texture);
      used_[{&texture.image, TextureJob::Kind::kAlphaCut, textureCutoff(material)}].add(mesh);
    }
  }

  void packItem(const SceneItem& item, bool any_baked) {
    const Plant& plant = *item.plant;
    if (item.light != nullptr && item.light->meshes.size() != plant.meshes.size())
      throw Error(plant.name, "its baked light belongs to another plant", "bake this plant");
    checkTransfer(item);
    const auto first_instance = static_cast<std::uint32_t>(out_.instances.size());
    for (const glm::mat4& instance : item.world_from_plant) {
      const glm::mat4 rows = glm::transpose(worldFromPlant(scene_, item, instance));
      const auto number = static_cast<std::uint32_t>(out_.instances.size());
      out_.instances.push_back(
          {.rows = {rows[0], rows[1], rows[2]}, .motion = {0, 0, number, PackedInstance::kPlain}});
    }
    if (item.motion != nullptr) packMotion(item, first_instance);
    const std::size_t first_draw = out_.draws.size();
    for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
      const MeshLight* light = item.light != nullptr ? &item.light->meshes[m] : nullptr;
      Draw draw = packMesh(plant, plant.meshes[m], light, any_baked);
      draw.moving = item.motion != nullptr;
      if (draw.moving)
        out_.motions.addVertices(item.motion->tables->hangs[m]);
      else
        out_.motions.addStill(plant.meshes[m].positions.size());
      if (item.transfer != nullptr) {
        draw.transfer = true;
        packTransfer(item.transfer->meshes[m], item.transfer->bands, item.transfer->bounce_bands,
                     plant.meshes[m].positions.size(),
                     static_cast<std::uint32_t>(draw.vertex_offset), kTransferWords,
                     plant.name + ", mesh " + plant.meshes[m].name, out_.transfers);
      }
      draw.seen = item.seen;
      draw.first_instance = first_instance;
      draw.instance_count = static_cast<std::uint32_t>(item.world_from_plant.size());
      if (draw.index_count == 0 || draw.instance_count == 0) continue;
      out_.draws.push_back(draw);
    }
    shadeWood(first_draw);
    const Bounds box = bounds(plant);
    for (std::size_t i = first_instance; i < out_.instances.size(); ++i)
      growBounds(box, out_.instances[i], out_.bounds);
  }

  /// Wood stands in the shade of its own plant's leaves: those of the draws from there on, of which
  /// it returns the mean.
  glm::vec4 shadeWood(std::size_t first_draw) {
    glm::dvec4 leaves(0.0);
    double leaf_indices = 0.0;
    for (std::size_t d = first_draw; d < out_.draws.size(); ++d) {
      const Draw& draw = out_.draws[d];
      if (!draw.foliage) continue;
      leaves += double(draw.index_count) * glm::dvec4(draw.uniforms.leaf);
      leaf_indices += double(draw.index_count);
    }
    for (std::size_t d = first_draw; d < out_.draws.size(); ++d)
      if (!out_.draws[d].foliage)
        out_.draws[d].uniforms.leaf =
            leaf_indices > 0.0 ? glm::vec4(leaves / leaf_indices) : glm::vec4(1.0f);
    leaf_tint_ += glm::dvec4(glm::dvec3(leaves), leaf_indices);
    return leaf_indices > 0.0 ? glm::vec4(leaves / leaf_indices) : glm::vec4(1.0f);
  }

  void packTrees(bool any_baked) {
    const Forest& forest = *scene_.forest;
    PackedForest& packed = out_.forest.emplace(packForest(forest));
    std::size_t moving = 0;
    for (const ForestKind& kind : forest.kinds) moving += kind.motion != nullptr ? 1 : 0;
    std::size_t seats = kMostForestMeshes;
    for (const ForestKind& kind : forest.kinds) {
      noteTextureUse(*kind.plant);
      if (kind.motion == nullptr) continue;
      checkMotion(*kind.plant, *kind.motion);
      seats =
          std::min(seats, kForestMotionWords / moving / PackedMotions::motionWords(*kind.motion));
    }
    packed.motion_seats =
        moving > 0 ? static_cast<std::uint32_t>(std::max<std::size_t>(seats, 1)) : 0;
    if (moving > 0) packed.most_meshes = packed.motion_seats;
    for (std::size_t k = 0; k < forest.kinds.size(); ++k) {
      const ForestKind& kind = forest.kinds[k];
      PackedForestKind& to = packed.kinds[k];
      if (kind.motion != nullptr) {
        to.motion_item = static_cast<int>(out_.motions.items.size());
        to.tables = kind.motion->tables;
        out_.motions.addForest(*kind.motion, static_cast<std::uint32_t>(k),
                               static_cast<std::uint32_t>(k) * packed.motion_seats,
                               packed.motion_seats);
      }
      to.leaf = packTree(kind, kind.plant->meshes, nullptr, to.first_class, any_baked);
      if (kind.levels == nullptr) continue;
      for (std::size_t l = 0; l < kind.levels->meshes.size(); ++l)
        packTree(kind, kind.levels->meshes[l].meshes, &kind.levels->meshes[l],
                 to.first_class + static_cast<std::uint32_t>(l) + 1, any_baked);
    }
  }

  /// A level of a forest's kind; the plant itself without `level`.
  glm::vec4 packTree(const ForestKind& kind, const std::vector<Mesh>& meshes,
                     const PlantLevel* level, std::uint32_t forest_class, bool any_baked) {
    const Plant& plant = *kind.plant;
    if (kind.light != nullptr && kind.light->meshes.size() != plant.meshes.size())
      throw Error(plant.name, "its baked light belongs to another plant", "bake this plant");
    std::optional<CrownLight> gathered;
    if (level != nullptr && kind.light != nullptr) gathered = lightOf(*level, *kind.light);
    const CrownLight* const light = gathered ? &*gathered : kind.light;
    const std::size_t first_draw = out_.draws.size();
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      Draw draw =
          packMesh(plant, meshes[m], light != nullptr ? &light->meshes[m] : nullptr, any_baked);
      draw.forest = forest_class;
      draw.moving = kind.motion != nullptr;
      if (!draw.moving) {
        out_.motions.addStill(meshes[m].positions.size());
      } else {
        const std::vector<glm::uvec2>& hangs = kind.motion->tables->hangs[m];
        std::vector<glm::uvec2> own;
        if (level != nullptr)
          for (const std::uint32_t v : level->sources[m]) own.push_back(hangs[v]);
        out_.motions.addVertices(level != nullptr ? own : hangs);
      }
      if (draw.index_count > 0) out_.draws.push_back(draw);
    }
    return shadeWood(first_draw);
  }

  static void checkMotion(const Plant& plant, const PlantMotion& motion) {
    const auto& hangs = motion.tables->hangs;
    bool fits = hangs.size() == plant.meshes.size();
    for (std::size_t m = 0; fits && m < hangs.size(); ++m)
      fits = hangs[m].size() == plant.meshes[m].positions.size();
    if (!fits)
      throw Error(plant.name, "its motion belongs to another plant", "make one with plantMotion()");
  }

  void packMotion(const SceneItem& item, std::uint32_t first_instance) {
    checkMotion(*item.plant, *item.motion);
    std::vector<PackedMotions::Rows> rows;
    for (std::size_t i = first_instance; i < out_.instances.size(); ++i)
      rows.push_back(out_.instances[i].rows);
    const auto seats = out_.motions.add(*item.motion, first_instance, rows, kMotionWords);
    for (std::size_t k = 0; k < seats.size(); ++k) {
      out_.instances[first_instance + k].motion = seats[k];
      out_.instances[first_instance + k].motion.w = PackedInstance::kPlain;
    }
  }

  /// Transfer vectors know the directions of the world: a plant that was turned has others.
  void checkTransfer(const SceneItem& item) {
    if (item.transfer == nullptr) return;
    if (item.transfer->meshes.size() != item.plant->meshes.size())
      throw Error(item.plant->name, "its transfer vectors belong to another plant",
                  "compute them for this plant");
    const GroundTransfer& ground = item.transfer->ground;
    PackedGround packed{ground, item.transfer->bands, item.transfer->bounce_bands, {}};
    for (const glm::mat4& instance : item.world_from_plant) {
      const glm::mat4 world = worldFromPlant(scene_, item, instance);
      if (glm::mat3(world) != glm::mat3(1.0f))
        throw Error(item.plant->name, "has transfer vectors and is turned or scaled",
                    "draw it unturned or leave the vectors out");
      packed.places.emplace_back(world[3].x, world[3].z);
    }
    if (ground.size <= 0) return;
    if (ground.size > 4096 || !(ground.step > 0.0f))
      throw Error(item.plant->name, "its ground's transfer vectors lie on no grid",
                  "compute them again");
    // Their lengths are those of a mesh of as many vertices.
    std::vector<PackedTransfer> unused;
    packTransfer(ground.vectors, packed.bands, packed.bounce_bands,
                 static_cast<std::size_t>(ground.size) * static_cast<std::size_t>(ground.size), 0,
                 kTransferWords, item.plant->name + ", ground", unused);
    out_.grounds.push_back(std::move(packed));
  }

  Draw packMesh(const Plant& plant, const Mesh& mesh, const MeshLight* light, bool any_baked) {
    const std::size_t count = mesh.positions.size();
    const std::string where = plant.name + ", mesh " + mesh.name;
    if (mesh.normals.size() != count)
      throw Error(where, "has not one normal for each vertex", "load it with loadPlant");
    if (!mesh.uvs.empty() && mesh.uvs.size() != count)
      throw Error(where, "has not one texture coordinate for each vertex");
    if (light != nullptr && (light->normals.size() != count || light->ambient.size() != count))
      throw Error(where, "its baked light has another number of vertices", "bake this plant");
    const bool visibility = light != nullptr && !light->visibility.empty();
    if (visibility && light->visibility.size() != count)
      throw Error(where, "its leaf visibility has another number of vertices", "bake this plant");
    if (std::any_of(mesh.indices.begin(), mesh.indices.end(),
                    [count](std::uint32_t i) { return i >= count; }))
      throw Error(where, "has an index past its last vertex");
    if (out_.positions.size() + count > std::size_t{std::numeric_limits<std::int32_t>::max()})
      throw Error(where, "the scene has over 2^31 vertices", "use instances");
    if (out_.indices.size() + mesh.indices.size() > std::size_t{0xffffffffu})
      throw Error(where, "the scene has over 2^32 indices", "use instances");

    Draw draw;
    draw.foliage = mesh.kind == PartKind::kFoliage;
    draw.baked = light != nullptr;
    draw.visibility = visibility;
    draw.vertex_offset = static_cast<std::int32_t>(out_.positions.size());
    draw.first_index = static_cast<std::uint32_t>(out_.indices.size());
    draw.index_count = static_cast<std::uint32_t>(mesh.indices.size() / 3 * 3);
    describeMaterial(plant, mesh, draw);

    const std::size_t base = out_.positions.size();
    out_.positions.insert(out_.positions.end(), mesh.positions.begin(), mesh.positions.end());
    out_.indices.insert(out_.indices.end(), mesh.indices.begin(), mesh.indices.end());
    out_.uvs.insert(out_.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    out_.uvs.resize(base + count, glm::vec2(0.0f));
    out_.leaf_normals.resize(base + count);
    if (any_baked) out_.crown_normals.resize(base + count);
    parallelFor(count, 4096, [&](std::size_t v) {
      const float k = light != nullptr ? light->ambient[v] : 1.0f;
      const glm::vec2 seen = visibility ? light->visibility[v] : glm::vec2(1.0f);
      out_.leaf_normals[base + v] = packNormal(mesh.normals[v], k, seen);
      if (any_baked)
        out_.crown_normals[base + v] =
            packNormal(light != nullptr ? light->normals[v] : mesh.normals[v], k, seen);
    });
    return draw;
  }

  void describeMaterial(const Plant& plant, const Mesh& mesh, Draw& draw) {
    static const Material kPlain;
    const Material& material =
        mesh.material < plant.materials.size() ? plant.materials[mesh.material] : kPlain;
    const bool textured = !mesh.uvs.empty();
    draw.alpha_test =
        material.alpha_mode != AlphaMode::kOpaque && textured && material.base_color_texture >= 0;
    draw.normal_map = textured && material.normal_texture >= 0;
    const float cutoff = textureCutoff(material);
    MaterialSlot slot;
    slot.normal_map = 1;
    if (textured && material.base_color_texture >= 0) {
      const Texture& texture = textureOf(plant, material.base_color_texture);
      const TextureJob job = draw.alpha_test
                                 ? TextureJob{&texture.image, TextureJob::Kind::kAlphaCut, cutoff}
                                 : TextureJob{&texture.image, TextureJob::Kind::kColor, 0.0f};
      slot.base_color = addTexture(job);
      slot.base_clamp = {texture.clamp_u, texture.clamp_v};
    }
    if (draw.normal_map) {
      const Texture& texture = textureOf(plant, material.normal_texture);
      slot.normal_map = addTexture({&texture.image, TextureJob::Kind::kLinear, 0.0f});
      slot.normal_clamp = {texture.clamp_u, texture.clamp_v};
    }
    draw.thickness_map =
        textured && material.optical_thickness > 0.0f && material.thickness_texture >= 0;
    if (draw.thickness_map) {
      const Texture& texture = textureOf(plant, material.thickness_texture);
      slot.thickness_map = addTexture({&texture.image, TextureJob::Kind::kLinear, 0.0f});
      slot.thickness_clamp = {texture.clamp_u, texture.clamp_v};
    }
    if (draw.foliage && textured && material.leaf) describeLeaf(plant, material, draw, slot);
    if (draw.foliage && material.transmission && !draw.leaf_maps)
      describeTransmission(plant, *material.transmission, textured, draw, slot);
    draw.material = addMaterial(slot);
    const glm::vec3 mean =
        glm::vec3(material.base_color) * out_.textures[slot.base_color].mean_color;
    draw.uniforms.color = material.base_color;
    draw.uniforms.matt = glm::vec4(mean, material.optical_thickness);
    if (draw.foliage) {
      const glm::vec3 through = LeafSurface(plant, material, textured).meanTransmittance(mean);
      draw.uniforms.leaf = glm::vec4(shared::leafTint(through), shared::leafOpticalDepth(through));
    }
    draw.uniforms.surface = glm::vec4(cutoff, material.normal_scale, facingReflectance(material),
                                      material.surface.strength);
  }

  void describeLeaf(const Plant& plant, const Material& material, Draw& draw, MaterialSlot& slot) {
    const LeafTextures& maps = *material.leaf;
    draw.leaf_maps = true;
    slot.leaf_colors = addLeafArray(
        plant, material, {maps.back_color, maps.front_translucency, maps.back_translucency}, false);
    slot.leaf_vectors =
        addLeafArray(plant, material, {maps.back_normal, maps.front_light, maps.back_light}, true);
    draw.uniforms.leaf_light =
        glm::vec4(maps.front_scale, maps.front_offset, maps.back_scale, maps.back_offset);
    draw.uniforms.leaf_gloss =
        glm::vec4(maps.front_roughness, maps.back_roughness, maps.refractive_index,
                  material.normal_scale * bumpSlope(plant, material));
  }

  /// Root mean square slope of the normal maps of both sides, where the leaf is.
  static float bumpSlope(const Plant& plant, const Material& material) {
    if (material.normal_texture < 0) return 0.0f;
    const Image* cut = material.base_color_texture >= 0
                           ? &textureOf(plant, material.base_color_texture).image
                           : nullptr;
    double sum = 0.0, count = 0.0;
    for (const int index : {material.normal_texture, material.leaf->back_normal}) {
      const Image& image = textureOf(plant, index).image;
      const bool same_size =
          cut != nullptr && cut->width == image.width && cut->height == image.height;
      for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        if (same_size && cut->rgba[i + 3] < 128) continue;
        const glm::vec3 texel(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]);
        const glm::vec3 n = (texel - 128.0f) / 127.0f;
        sum += double{(n.x * n.x + n.y * n.y) / std::max(n.z * n.z, 0.0025f)};
        count += 1.0;
      }
    }
    return count > 0.0 ? static_cast<float>(std::sqrt(sum / count)) : 0.0f;
  }

  void describeTransmission(const Plant& plant, const DiffuseTransmission& stated, bool textured,
                            Draw& draw, MaterialSlot& slot) {
    draw.stated_transmission = true;
    draw.uniforms.transmission = glm::vec4(stated.color, stated.factor);
    const auto add = [&](int index, TextureJob::Kind kind, std::uint32_t& texture,
                         std::array<bool, 2>& clamp) {
      if (!textured || index < 0) return;
      const Texture& source = textureOf(plant, index);
      texture = addTexture({&source.image, kind, 0.0f});
      clamp = {source.clamp_u, source.clamp_v};
    };
    add(stated.factor_texture, TextureJob::Kind::kAlpha, slot.transmission_share, slot.share_clamp);
    add(stated.color_texture, TextureJob::Kind::kColor, slot.transmission_color, slot.tint_clamp);
  }

  std::uint32_t addLeafArray(const Plant& plant, const Material& material,
                             const std::array<int, 3>& textures, bool linear) {
    std::array<const Image*, 3> images;
    for (std::size_t k = 0; k < 3; ++k) {
      images[k] = &textureOf(plant, textures[k]).image;
      if (images[k]->width != images[0]->width || images[k]->height != images[0]->height)
        throw Error(plant.name + ", material " + material.name,
                    "the maps of its leaves have different sizes", "give them one size");
    }
    const auto [entry, is_new] =
        known_leaves_.try_emplace(images, static_cast<std::uint32_t>(out_.leaf_arrays.size()));
    if (is_new) {
      PackedLeafArray packed{{}, linear};
      for (std::size_t k = 0; k < 3; ++k)
        packed.layers[k] =
            (linear ? buildLinearMips(*images[k]) : buildColorMips(*images[k], {})).levels;
      out_.leaf_arrays.push_back(std::move(packed));
    }
    return entry->second;
  }

  std::uint32_t addTexture(const TextureJob& job) {
    const auto [entry, is_new] =
        known_textures_.try_emplace(job, static_cast<std::uint32_t>(out_.textures.size()));
    if (is_new) {
      using Kind = TextureJob::Kind;
      const bool linear = job.kind == Kind::kLinear || job.kind == Kind::kAlpha;
      out_.textures.push_back(job.kind == Kind::kAlpha    ? buildLinearMips(alphaOf(*job.image))
                              : job.kind == Kind::kLinear ? buildLinearMips(*job.image)
                              : job.kind == Kind::kAlphaCut
                                  ? buildColorMips(*job.image, job.cutoff, used_[job])
                                  : buildColorMips(*job.image, std::nullopt));
      out_.texture_is_linear.push_back(linear);
    }
    return entry->second;
  }

  std::uint32_t addMaterial(const MaterialSlot& slot) {
    const auto found = std::find(out_.materials.begin(), out_.materials.end(), slot);
    if (found != out_.materials.end())
      return static_cast<std::uint32_t>(found - out_.materials.begin());
    out_.materials.push_back(slot);
    return static_cast<std::uint32_t>(out_.materials.size() - 1);
  }

  const Scene& scene_;
  PackedScene out_;
  glm::dvec4 leaf_tint_{0.0};  // sum over the foliage's indices; w = their number
  std::map<TextureJob, UsedTexels> used_;
  std::map<TextureJob, std::uint32_t> known_textures_;
  std::map<std::array<const Image*, 3>, std::uint32_t> known_leaves_;
};

/// The scene's terrain, or its plane, with the grass on it.
PackedTerrain packTerrain(const Scene& scene) {
  PackedTerrain packed;
  if (scene.terrain != nullptr) {
    packed.terrain = *scene.terrain;
    checkTerrain(packed.terrain, "terrain");
  } else {
    if (!scene.ground)
      throw Error("scene", "has grass, but no ground for it to stand on", "set Scene::ground");
    packed.terrain = {2, 2, glm::vec2(-8.0f), glm::vec2(16.0f),
                      std::vector<float>(4, scene.ground_height)};
  }
  for (const GrassLayer& layer : scene.grass) packed.layers.push_back(packGrass(layer));
  return packed;
}

}  // namespace

PackedNormal packNormal(const glm::vec3& unit_normal, float ambient, const glm::vec2& visibility) {
  const glm::vec3 n = shared::encodeNormal(unit_normal, std::clamp(ambient, 0.0f, 1.0f));
  const auto component = [](float value) {
    return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
  };
  return {component(n.x), component(n.y), component(n.z),
          static_cast<std::int16_t>(shared::packVisibility(visibility))};
}

void growBounds(const Bounds& box, const PackedInstance& place, Bounds& all) {
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec4 p((corner & 1) != 0 ? box.max.x : box.min.x,
                      (corner & 2) != 0 ? box.max.y : box.min.y,
                      (corner & 4) != 0 ? box.max.z : box.min.z, 1.0f);
    const glm::vec3 q(glm::dot(place.rows[0], p), glm::dot(place.rows[1], p),
                      glm::dot(place.rows[2], p));
    all.min = glm::min(all.min, q);
    all.max = glm::max(all.max, q);
  }
}

PackedScene packScene(const Scene& scene) {
  for (const SceneItem& item : scene.items)
    if (item.plant == nullptr) throw Error("scene", "an item has no plant", "set SceneItem::plant");
  PackedScene packed = Packer(scene).pack();
  if (scene.terrain != nullptr || !scene.grass.empty()) packed.terrain = packTerrain(scene);
  return packed;
}

}  // namespace verdure
