#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/parallel.h"
#include "plant/gltf_accessor.h"
#include "plant/gltf_leaf_material.h"
#include "plant/gltf_scene.h"
#include "plant/gltf_stems.h"
#include "plant/load.h"

namespace verdure {
namespace {

constexpr std::size_t kMaxVertices = 100'000'000;  ///< of a whole plant, instances expanded

/// Extensions that may be required: read, or harmless to geometry and base colour.
const std::set<std::string>& readableExtensions() {
  static const std::set<std::string> kNames = {"KHR_mesh_quantization",
                                               "KHR_texture_transform",
                                               "EXT_mesh_gpu_instancing",
                                               "EXT_meshopt_compression",
                                               "KHR_draco_mesh_compression",
                                               "KHR_lights_punctual",
                                               "KHR_materials_anisotropy",
                                               "KHR_materials_clearcoat",
                                               "KHR_materials_diffuse_transmission",
                                               "KHR_materials_dispersion",
                                               "KHR_materials_emissive_strength",
                                               "KHR_materials_ior",
                                               "KHR_materials_iridescence",
                                               "KHR_materials_pbrSpecularGlossiness",
                                               "KHR_materials_sheen",
                                               "KHR_materials_specular",
                                               "KHR_materials_transmission",
                                               "KHR_materials_unlit",
                                               "KHR_materials_variants",
                                               "KHR_materials_volume"};
  return kNames;
}

void checkRequired(const GltfDocument& document) {
  for (const Json& name : document.list("extensionsRequired")) {
    if (!name.is_string()) document.fail("'extensionsRequired' is not a list of names");
    if (!readableExtensions().contains(name.get<std::string>()))
      document.fail(
          "requires the extension " + name.get<std::string>() + ", which verdure cannot read",
          "export without it");
  }
}

/// A texture as a material names it: where it looks and how its UVs are transformed.
struct TextureUse {
  int texture = -1;  ///< Plant::textures
  int uv_set = 0;
  glm::dvec2 offset{0.0}, scale{1.0};
  double rotation = 0.0;

  bool sameUvs(const TextureUse& other) const {
    return uv_set == other.uv_set && offset == other.offset && scale == other.scale &&
           rotation == other.rotation;
  }
  /// KHR_texture_transform: scale, then rotation (counter-clockwise as seen in the image), then
  /// offset.
  glm::vec2 transform(const glm::vec2& uv) const {
    if (offset == glm::dvec2(0.0) && scale == glm::dvec2(1.0) && rotation == 0.0) return uv;
    const glm::dvec2 p = glm::dvec2(uv) * scale;
    const double c = std::cos(rotation), s = std::sin(rotation);
    return glm::vec2(glm::dvec2(c * p.x + s * p.y, c * p.y - s * p.x) + offset);
  }
};

class GltfImporter {
 public:
  explicit GltfImporter(const std::filesystem::path& path)
      : source_(std::make_shared<SourceDocument>()), document_(source_->gltf) {
    document_ = readGltf(path);
    checkRequired(document_);
    decompressGltf(document_);
  }

  RawPlant import() {
    readMaterials();
    const GltfScene scene = readScene(document_);
    for (const std::size_t node : scene.mesh_nodes) readNode(scene, node);
    if (raw_.parts.empty())
      document_.fail("its scene has no triangles", "export the plant's mesh with the scene");
    if (default_material_ >= 0) plant().notes.push_back("parts without a material are white");
    decodeTextures();
    noteUnread();
    raw_.stems = readStems(document_, plant().notes);
    plant().source = source_;
    return std::move(raw_);
  }

 private:
  Plant& plant() { return raw_.plant; }

  // --- materials and textures

  TextureUse readTexture(const Json* info, const std::string& who) {
    TextureUse use;
    if (info == nullptr) return use;
    const auto texture = readIndex(document_, *info, "index", "textures", who);
    use.uv_set = static_cast<int>(
        std::min<std::size_t>(readSize(document_, *info, "texCoord", who).value_or(0), 99));
    if (const Json* transform = extension(*info, "KHR_texture_transform")) {
      readNumbers(document_, *transform, "offset", {&use.offset[0], 2}, who);
      readNumbers(document_, *transform, "scale", {&use.scale[0], 2}, who);
      use.rotation = readNumber(document_, *transform, "rotation", 0.0, who);
      if (const auto set = readSize(document_, *transform, "texCoord", who))
        use.uv_set = static_cast<int>(std::min<std::size_t>(*set, 99));
    }
    if (texture) use.texture = plantTexture(*texture);
    return use;
  }

  /// Plant::textures index of a glTF texture, -1 if its image cannot be read.
  int plantTexture(std::size_t texture) {
    if (const auto known = texture_of_.find(texture); known != texture_of_.end())
      return known->second;
    const std::string who = document_.label("textures", "texture", texture);
    const Json& json = document_.list("textures")[texture];
    auto image = readIndex(document_, json, "source", "images", who);
    for (const char* name :
         {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"})
      if (extension(json, name) != nullptr && !image)
        plant().notes.push_back(who + " is left out: verdure cannot read " + name);
    int index = -1;
    if (image) {
      Texture t;
      t.name = readString(json, "name", readString(document_.list("images")[*image], "name"));
      if (const auto sampler = readIndex(document_, json, "sampler", "samplers", who)) {
        const Json& s = document_.list("samplers")[*sampler];
        t.clamp_u = readSize(document_, s, "wrapS", who).value_or(10497) == 33071;
        t.clamp_v = readSize(document_, s, "wrapT", who).value_or(10497) == 33071;
      }
      if (t.name.empty()) t.name = fmt::format("image {}", *image);
      index = static_cast<int>(plant().textures.size());
      plant().textures.push_back(std::move(t));
      image_of_.push_back(*image);
    }
    texture_of_[texture] = index;
    return index;
  }

  void readMaterials() {
    const Json& materials = document_.list("materials");
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const Json& json = materials[i];
      const std::string who = document_.label("materials", "material", i);
      Material m;
      m.name = readString(json, "name", fmt::format("material {}", i));
      const Json* base = member(json, "pbrMetallicRoughness");
      const char *factor = "baseColorFactor", *texture = "baseColorTexture";
      if (const Json* old = extension(json, "KHR_materials_pbrSpecularGlossiness")) {
        base = old;
        factor = "diffuseFactor";
        texture = "diffuseTexture";
      }
      TextureUse color, bump;
      if (base != nullptr) {
        glm::dvec4 rgba(1.0);
        readNumbers(document_, *base, factor, {&rgba[0], 4}, who);
        m.base_color = glm::vec4(rgba);
        color = readTexture(member(*base, texture), who);
      }
      if (const Json* normal = member(json, "normalTexture")) {
        bump = readTexture(normal, who);
        m.normal_scale = static_cast<float>(readNumber(document_, *normal, "scale", 1.0, who));
      }
      m.base_color_texture = color.texture;
      m.normal_texture = bump.texture;
      if (color.texture < 0) color = bump;  // the normal map's UVs are then the ones that matter
      if (bump.texture >= 0 && !bump.sameUvs(color)) {
        plant().notes.push_back(who + ": its normal map uses other UVs than its colour; left out");
        m.normal_texture = -1;
      }
      if (const Json* volume = extension(json, "KHR_materials_volume"))
        readThickness(*volume, color, who, m);
      m.leaf = readLeafMaterial(document_, json, who, [&](const Json& info) {
        const TextureUse map = readTexture(&info, who);
        return map.sameUvs(color) ? map.texture : -1;
      });
      m.transmission = readDiffuseTransmission(document_, json, who, [&](const Json& info) {
        const TextureUse map = readTexture(&info, who);
        if (color.texture < 0) color = map;  // the only UVs
        return map.sameUvs(color) ? map.texture : -1;
      });
      if (!m.transmission && extension(json, kDiffuseTransmission) != nullptr) noteGuessed(m);
      if (!m.leaf) m.surface = readClearSurface(document_, json, who);
      if (const Json* specular = extension(json, "KHR_materials_specular"))
        for (const char* key : {"specularTexture", "specularColorTexture"})
          if (member(*specular, key) != nullptr)
            plant().notes.push_back(who + ": its " + key + " is left out, its factor is not");
      const std::string mode = readString(json, "alphaMode", "OPAQUE");
      m.alpha_mode = mode == "MASK"    ? AlphaMode::kMask
                     : mode == "BLEND" ? AlphaMode::kBlend
                                       : AlphaMode::kOpaque;
      m.alpha_cutoff = static_cast<float>(readNumber(document_, json, "alphaCutoff", 0.5, who));
      m.double_sided = readBool(json, "doubleSided");
      plant().materials.push_back(std::move(m));
      uvs_of_.push_back(color);
    }
  }

  /// A volume without attenuation is clear, and no leaf.
  void readThickness(const Json& volume, const TextureUse& color, const std::string& who,
                     Material& m) {
    const double thickness = readNumber(document_, volume, "thicknessFactor", 0.0, who);
    const double distance = readNumber(document_, volume, "attenuationDistance", 0.0, who);
    if (!(thickness > 0.0 && distance > 0.0)) return;
    m.optical_thickness = static_cast<float>(std::min(thickness / distance, 100.0));
    const TextureUse map = readTexture(member(volume, "thicknessTexture"), who);
    if (map.texture >= 0 && color.texture >= 0 && !map.sameUvs(color))
      plant().notes.push_back(who + ": its thickness map uses other UVs than its colour; left out");
    else
      m.thickness_texture = map.texture;
  }

  /// Decodes the images that are used, in parallel; those that cannot be are left out and noted.
  void decodeTextures() {
    std::vector<std::string> failures(plant().textures.size());
    parallelFor(plant().textures.size(), 1, [&](std::size_t i) {
      const std::string who = document_.label("images", "image", image_of_[i]);
      try {
        plant().textures[i].image = decodeImage(imageBytes(document_, image_of_[i]), who);
      } catch (const Error& e) {
        failures[i] = e.what();
      }
    });
    std::vector<int> kept(plant().textures.size(), -1);
    std::vector<Texture> textures;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (!failures[i].empty()) {
        plant().notes.push_back("texture left out: " + failures[i]);
        continue;
      }
      kept[i] = static_cast<int>(textures.size());
      textures.push_back(std::move(plant().textures[i]));
    }
    plant().textures = std::move(textures);
    for (Material& m : plant().materials) {
      if (m.leaf) keepLeaf(kept, m);
      if (m.transmission) keepTransmission(kept, m);
      if (m.base_color_texture >= 0)
        m.base_color_texture = kept[static_cast<std::size_t>(m.base_color_texture)];
      if (m.normal_texture >= 0)
        m.normal_texture = kept[static_cast<std::size_t>(m.normal_texture)];
      if (m.thickness_texture >= 0)
        m.thickness_texture = kept[static_cast<std::size_t>(m.thickness_texture)];
    }
  }

  /// A leaf with one map missing is lit as one without any.
  void keepLeaf(const std::vector<int>& kept, Material& m) {
    LeafTextures& leaf = *m.leaf;
    bool whole = true;
    for (int* texture : {&leaf.back_color, &leaf.back_normal, &leaf.front_translucency,
                         &leaf.back_translucency, &leaf.front_light, &leaf.back_light}) {
      *texture = *texture >= 0 ? kept[static_cast<std::size_t>(*texture)] : -1;
      whole = whole && *texture >= 0;
    }
    if (whole) return;
    m.leaf.reset();
    plant().notes.push_back("material '" + m.name +
                            "': a map of its leaves cannot be read; all are left out");
  }

  /// What core glTF says of the light through a leaf is for those without maps of their own.
  void keepTransmission(const std::vector<int>& kept, Material& m) {
    if (m.leaf) return m.transmission.reset();
    for (int* texture : {&m.transmission->factor_texture, &m.transmission->color_texture}) {
      if (*texture < 0) continue;
      *texture = kept[static_cast<std::size_t>(*texture)];
      if (*texture >= 0) continue;
      noteGuessed(m);
      return m.transmission.reset();
    }
  }

  void noteGuessed(const Material& m) {
    plant().notes.push_back("material '" + m.name +
                            "': a texture of the light through it cannot be read; that light is "
                            "guessed from its colour");
  }

  // --- meshes

  void readNode(const GltfScene& scene, std::size_t node) {
    const std::string node_label = document_.label("nodes", "node", node);
    const std::size_t mesh =
        *readIndex(document_, document_.list("nodes")[node], "mesh", "meshes", node_label);
    const Json& json = document_.list("meshes")[mesh];
    const std::string mesh_label = document_.label("meshes", "mesh", mesh);
    const Json* primitives = member(json, "primitives");
    if (primitives == nullptr || !primitives->is_array())
      document_.fail(mesh_label + " has no primitives");
    for (std::size_t p = 0; p < primitives->size(); ++p) {
      const std::string who = fmt::format("{} primitive {}", mesh_label, p);
      const Json& primitive = (*primitives)[p];
      if (!primitive.is_object()) document_.fail(who + " is not an object");
      const std::size_t mode = readSize(document_, primitive, "mode", who).value_or(4);
      if (mode < 4 || mode > 6) {
        if (noted_.insert(who).second) plant().notes.push_back(who + " has no triangles: left out");
        continue;
      }
      readPrimitive(scene, node, mesh, p, primitive, mode, primitives->size() > 1, who);
    }
    if (const auto instances = readInstances(document_, node); !instances.empty())
      plant().notes.push_back(
          fmt::format("{} has {} instances: expanded (saving light writes each as a node)",
                      node_label, withCommas(instances.size())));
  }

  std::vector<std::uint32_t> readTriangles(const Json& primitive, std::size_t mode,
                                           std::size_t vertices, const std::string& who) {
    std::vector<std::uint32_t> corners;
    if (const auto accessor = readIndex(document_, primitive, "indices", "accessors", who)) {
      corners = readIndices(document_, *accessor, who);
      for (std::size_t i = 0; i < corners.size(); ++i)
        if (corners[i] >= vertices)
          document_.fail(fmt::format("{}: index {} of {} is {}, but there are {} vertices", who, i,
                                     document_.label("accessors", "accessor", *accessor),
                                     corners[i], vertices));
    } else {
      corners.resize(vertices);
      for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint32_t>(i);
    }
    if (mode == 4) {
      corners.resize(corners.size() / 3 * 3);
      return corners;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      const std::uint32_t a = corners[mode == 6 ? 0 : i];
      const std::uint32_t b = corners[i + 1], c = corners[i + 2];
      if (a == b || b == c || c == a) continue;  // strips are joined by empty triangles
      const bool odd = mode == 5 && i % 2 == 1;
      triangles.insert(triangles.end(), {a, odd ? c : b, odd ? b : c});
    }
    return triangles;
  }

  void readPrimitive(const GltfScene& scene, std::size_t node, std::size_t mesh,
                     std::size_t primitive_index, const Json& primitive, std::size_t mode,
                     bool several, const std::string& who) {
    const Json* attributes = member(primitive, "attributes");
    const auto position_accessor =
        attributes == nullptr ? std::nullopt
                              : readIndex(document_, *attributes, "POSITION", "accessors", who);
    if (!position_accessor) document_.fail(who + " has no POSITION");
    const auto positions = readFloats(document_, *position_accessor, 3, who);
    const std::size_t count = positions.size() / 3;
    checkFinite(positions, *position_accessor);
    std::vector<std::uint32_t> triangles = readTriangles(primitive, mode, count, who);
    if (triangles.empty()) {
      if (noted_.insert(who).second) plant().notes.push_back(who + " has no triangles: left out");
      return;
    }

    MeshSource from;
    from.node = node;
    from.mesh = mesh;
    from.primitive = primitive_index;
    from.accessor_count = count;
    from.vertex_of = dropUnused(triangles, count);
    const std::size_t used = from.vertex_of.empty() ? count : from.vertex_of.size();
    from.vertices_per_instance = used;
    const NodePlacement place = placement(document_, scene, node, primitive, who);
    if (place.skinned && place.world_from_local.size() != count)
      document_.fail(who + ": JOINTS_0 and POSITION differ in length");
    total_vertices_ += used * place.instances();
    if (total_vertices_ > kMaxVertices)
      document_.fail(fmt::format("shows more than {} vertices", withCommas(kMaxVertices)),
                     "use a smaller plant");

    RawPart part;
    std::vector<float> normals;
    if (const auto accessor = readIndex(document_, *attributes, "NORMAL", "accessors", who)) {
      normals = readFloats(document_, *accessor, 3, who);
      if (normals.size() != positions.size())
        document_.fail(who + ": NORMAL and POSITION differ in length");
    }
    part.world.resize(used * place.instances());
    if (!normals.empty()) part.mesh.normals.resize(part.world.size());
    const auto vertex = [&](std::size_t i) {
      return from.vertex_of.empty() ? i : from.vertex_of[i];
    };
    for (std::size_t k = 0; k < place.instances(); ++k) {
      const glm::dmat3 to_normal =
          place.skinned ? glm::dmat3(1.0) : normalTransform(place.world_from_local[k]);
      parallelFor(used, 4096, [&](std::size_t i) {
        const std::size_t v = vertex(i);
        const glm::dmat4& m = place.transform(k, v);
        const glm::dvec4 p(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 1.0);
        part.world[k * used + i] = glm::dvec3(m * p);
        if (normals.empty()) return;
        const glm::dvec3 n(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
        const glm::dvec3 world = (place.skinned ? normalTransform(m) : to_normal) * n;
        const double length = glm::length(world);
        part.mesh.normals[k * used + i] =
            length > 1e-30 && std::isfinite(length) ? glm::vec3(world / length) : glm::vec3(0.0f);
      });
    }
    part.mesh.indices.reserve(triangles.size() * place.instances());
    for (std::size_t k = 0; k < place.instances(); ++k) {
      const bool mirrored =
          glm::determinant(glm::dmat3(place.transform(k, vertex(triangles[0])))) < 0.0;
      const auto base = static_cast<std::uint32_t>(k * used);
      for (std::size_t t = 0; t < triangles.size(); t += 3) {
        part.mesh.indices.push_back(base + triangles[t]);
        part.mesh.indices.push_back(base + triangles[t + (mirrored ? 2 : 1)]);
        part.mesh.indices.push_back(base + triangles[t + (mirrored ? 1 : 2)]);
      }
    }
    part.mesh.material = materialOf(primitive, who);
    readUvs(*attributes, part.mesh, from, count, place.instances(), who);
    readLight(*attributes, part.mesh, from, count, place.instances(), who);
    readStemIds(*attributes, part.mesh, from, count, place.instances(), who);
    namePart(part, node, mesh, several);
    noteAttributes(*attributes, primitive, who);
    raw_.parts.push_back(std::move(part));
    source_->meshes.push_back(std::move(from));
  }

  void checkFinite(const std::vector<float>& positions, std::size_t accessor) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (!std::isfinite(positions[i]))
        document_.fail(fmt::format("{}: position {} is not finite",
                                   document_.label("accessors", "accessor", accessor), i / 3));
  }

  /// Renumbers the triangles so that only vertices they use remain; returns the accessor's vertex
  /// of each, or nothing if all are used.
  static std::vector<std::uint32_t> dropUnused(std::vector<std::uint32_t>& triangles,
                                               std::size_t count) {
    std::vector<std::uint32_t> number(count, kNone);
    std::vector<std::uint32_t> vertex_of;
    for (const std::uint32_t v : triangles) number[v] = 0;
    for (std::size_t v = 0; v < count; ++v) {
      if (number[v] == kNone) continue;
      number[v] = static_cast<std::uint32_t>(vertex_of.size());
      vertex_of.push_back(static_cast<std::uint32_t>(v));
    }
    if (vertex_of.size() == count) return {};
    for (std::uint32_t& v : triangles) v = number[v];
    return vertex_of;
  }

  std::uint32_t materialOf(const Json& primitive, const std::string& who) {
    if (const auto material = readIndex(document_, primitive, "material", "materials", who))
      return static_cast<std::uint32_t>(*material);
    if (default_material_ < 0) {
      default_material_ = static_cast<int>(plant().materials.size());
      plant().materials.emplace_back().name = "default";
      uvs_of_.emplace_back();
    }
    return static_cast<std::uint32_t>(default_material_);
  }

  void readUvs(const Json& attributes, Mesh& mesh, const MeshSource& from, std::size_t count,
               std::size_t instances, const std::string& who) {
    const TextureUse& use = uvs_of_[mesh.material];
    const auto accessor = readIndex(
        document_, attributes, fmt::format("TEXCOORD_{}", use.uv_set).c_str(), "accessors", who);
    if (!accessor) return;
    const auto values = readFloats(document_, *accessor, 2, who);
    if (values.size() != count * 2)
      document_.fail(who + ": TEXCOORD and POSITION differ in length");
    const std::size_t used = from.vertices_per_instance;
    std::size_t bad = 0;
    mesh.uvs.resize(used * instances);
    for (std::size_t i = 0; i < used; ++i) {
      const std::size_t v = from.vertex_of.empty() ? i : from.vertex_of[i];
      glm::vec2 uv = use.transform({values[2 * v], values[2 * v + 1]});
      if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
        uv = glm::vec2(0.0f);
        ++bad;
      }
      for (std::size_t k = 0; k < instances; ++k) mesh.uvs[k * used + i] = uv;
    }
    if (bad > 0)
      plant().notes.push_back(
          fmt::format("{} has {} UVs that are not finite: taken as 0", who, withCommas(bad)));
  }

  /// The light of an earlier bake: shares in [0, 1], 1 where the file's are not finite.
  void readLight(const Json& attributes, Mesh& mesh, const MeshSource& from, std::size_t count,
                 std::size_t instances, const std::string& who) {
    const std::size_t used = from.vertices_per_instance;
    const auto read = [&](const char* name, std::size_t components, const auto& store) {
      const auto accessor = readIndex(document_, attributes, name, "accessors", who);
      if (!accessor) return;
      const auto values = readFloats(document_, *accessor, components, who);
      if (values.size() != count * components)
        document_.fail(fmt::format("{}: {} and POSITION differ in length", who, name));
      for (std::size_t i = 0; i < used * instances; ++i) {
        const std::size_t v = from.vertex_of.empty() ? i % used : from.vertex_of[i % used];
        store([&](std::size_t c) {
          const float share = values[components * v + c];
          return std::isfinite(share) ? std::clamp(share, 0.0f, 1.0f) : 1.0f;
        });
      }
    };
    read("_AO", 1, [&](const auto& share) { mesh.ambient.push_back(share(0)); });
    read("_VISIBILITY", 2,
         [&](const auto& share) { mesh.visibility.emplace_back(share(0), share(1)); });
  }

  /// Stems by number, of leaves too: keepStems() sorts them out.
  void readStemIds(const Json& attributes, Mesh& mesh, const MeshSource& from, std::size_t count,
                   std::size_t instances, const std::string& who) {
    if (!namesStems(document_)) return;
    const auto accessor = readIndex(document_, attributes, kStemId, "accessors", who);
    if (!accessor) return;
    const auto values = readFloats(document_, *accessor, 1, who);
    if (values.size() != count)
      document_.fail(fmt::format("{}: {} and POSITION differ in length", who, kStemId));
    const std::size_t used = from.vertices_per_instance;
    for (std::size_t i = 0; i < used * instances; ++i) {
      const float id = values[from.vertex_of.empty() ? i % used : from.vertex_of[i % used]];
      mesh.branch_of_vertex.push_back(
          id >= 0.0f && id < 16777216.0f ? static_cast<std::uint32_t>(id) : kNone);
    }
  }

  void namePart(RawPart& part, std::size_t node, std::size_t mesh, bool several) {
    const Json& json = document_.list("meshes")[mesh];
    part.names.node = readString(document_.list("nodes")[node], "name");
    part.names.mesh = readString(json, "name");
    const std::string& material = plant().materials[part.mesh.material].name;
    std::string name = !part.names.mesh.empty() ? part.names.mesh : part.names.node;
    if (name.empty())
      name = material;
    else if (several)
      name += "/" + material;
    part.mesh.name = name;
    const Json* extras = member(json, "extras");
    const Json* own = extras == nullptr ? nullptr : member(*extras, "verdure");
    const std::string kind = own == nullptr ? "" : readString(*own, "kind");
    if (kind == "foliage") part.names.recorded = PartKind::kFoliage;
    if (kind == "wood") part.names.recorded = PartKind::kWood;
  }

  void noteAttributes(const Json& attributes, const Json& primitive, const std::string& who) {
    for (auto it = attributes.begin(); it != attributes.end(); ++it) {
      auto& names = source_->attributes;
      if (std::find(names.begin(), names.end(), it.key()) == names.end()) names.push_back(it.key());
    }
    if (member(primitive, "targets") != nullptr && noted_.insert(who + " targets").second)
      plant().notes.push_back(who + " has morph targets: the rest shape is used");
  }

  void noteUnread() {
    if (const Json& scenes = document_.list("scenes"); scenes.size() > 1)
      plant().notes.push_back(
          fmt::format("the file has {} scenes: the default one is used", scenes.size()));
    if (!document_.list("skins").empty())
      plant().notes.push_back("the file has a skin: its rest pose is used");
  }

  std::shared_ptr<SourceDocument> source_;
  GltfDocument& document_;
  RawPlant raw_;
  std::map<std::size_t, int> texture_of_;  // glTF texture -> Plant texture
  std::vector<std::size_t> image_of_;      // by Plant texture
  std::vector<TextureUse> uvs_of_;         // by Plant material
  std::set<std::string> noted_;
  std::size_t total_vertices_ = 0;
  int default_material_ = -1;
};

}  // namespace

RawPlant importGltf(const std::filesystem::path& path) {
  return GltfImporter(path).import();
}

}  // namespace verdure
