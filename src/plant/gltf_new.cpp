#include <fmt/format.h>

#include <algorithm>

#include "plant/gltf_accessor.h"
#include "plant/gltf_export.h"
#include "plant/gltf_leaf_material.h"
#include "plant/gltf_stems.h"
#include "plant/tangents.h"
#include "shared/leaf_basis.h"

namespace verdure {
namespace {

class DocumentBuilder {
 public:
  DocumentBuilder(const Plant& plant, const CrownLight* light, const ExportOptions& options)
      : plant_(plant), light_(light), options_(options) {}

  GltfDocument build() {
    Json& json = document_.json;
    document_.where = plant_.name;
    json["asset"] = {{"version", "2.0"}, {"generator", gltfGenerator()}};
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    Json root = {{"name", plant_.name.empty() ? "plant" : plant_.name}};
    if (plant_.origin != glm::dvec3(0.0))
      root["translation"] = {plant_.origin.x, plant_.origin.y, plant_.origin.z};
    json["nodes"] = Json::array({root});
    for (const char* key : {"materials", "meshes", "accessors"}) json[key] = Json::array();
    addTextures();
    for (const Material& material : plant_.materials) addMaterial(material);
    stem_ids_ = stemIds(plant_);
    Json children = Json::array();
    for (std::size_t i = 0; i < plant_.meshes.size(); ++i) {
      if (plant_.meshes[i].indices.empty()) continue;
      children.push_back(json["nodes"].size());
      json["nodes"].push_back({{"name", plant_.meshes[i].name}, {"mesh", json["meshes"].size()}});
      addMesh(i);
    }
    if (children.empty())
      throw Error(plant_.name, "the plant has no triangles to write", "grow or load one first");
    json["nodes"][0]["children"] = std::move(children);
    writeStems(plant_, document_);
    return std::move(document_);
  }

 private:
  void addTextures() {
    Json& json = document_.json;
    std::vector<std::pair<bool, bool>> samplers;
    texture_of_.assign(plant_.textures.size(), -1);
    for (std::size_t i = 0; i < plant_.textures.size(); ++i) {
      const Texture& texture = plant_.textures[i];
      if (texture.image.empty()) continue;
      const std::pair<bool, bool> wrap(texture.clamp_u, texture.clamp_v);
      auto sampler = std::find(samplers.begin(), samplers.end(), wrap);
      if (sampler == samplers.end()) {
        sampler = samplers.insert(samplers.end(), wrap);
        json["samplers"].push_back({{"magFilter", 9729},
                                    {"minFilter", 9987},
                                    {"wrapS", texture.clamp_u ? 33071 : 10497},
                                    {"wrapT", texture.clamp_v ? 33071 : 10497}});
      }
      const std::size_t view = appendView(document_, encodePng(texture.image), 0, 0);
      texture_of_[i] = static_cast<int>(json.contains("textures") ? json["textures"].size() : 0);
      json["textures"].push_back({{"sampler", sampler - samplers.begin()},
                                  {"source", json.contains("images") ? json["images"].size() : 0}});
      json["images"].push_back(
          {{"name", texture.name}, {"mimeType", "image/png"}, {"bufferView", view}});
    }
  }

  int textureOf(int texture) const {
    return texture < 0 ? -1 : texture_of_[static_cast<std::size_t>(texture)];
  }

  void addMaterial(const Material& material) {
    const glm::vec4& c = material.base_color;
    Json pbr = {
        {"baseColorFactor", {c.r, c.g, c.b, c.a}}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}};
    if (const int texture = textureOf(material.base_color_texture); texture >= 0)
      pbr["baseColorTexture"] = {{"index", texture}};
    Json json = {{"name", material.name}, {"pbrMetallicRoughness", std::move(pbr)}};
    if (const int texture = textureOf(material.normal_texture); texture >= 0)
      json["normalTexture"] = {{"index", texture}, {"scale", material.normal_scale}};
    if (material.alpha_mode == AlphaMode::kMask) {
      json["alphaMode"] = "MASK";
      json["alphaCutoff"] = material.alpha_cutoff;
    } else if (material.alpha_mode == AlphaMode::kBlend) {
      json["alphaMode"] = "BLEND";
    }
    if (material.double_sided) json["doubleSided"] = true;
    const auto texture_of = [this](int texture) { return textureOf(texture); };
    if (material.leaf)
      writeLeafMaterial(*material.leaf, transmittedBy(*material.leaf), texture_of, json);
    else if (material.transmission)
      writeDiffuseTransmission(*material.transmission, texture_of, json);
    if (!material.leaf) writeClearSurface(material.surface, json);
    if (json.contains("extensions"))
      for (const auto& [name, value] : json["extensions"].items()) {
        Json& used = document_.json["extensionsUsed"];
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
      }
    document_.json["materials"].push_back(std::move(json));
  }

  /// Share of even light from behind that gets through a leaf, over all of its map.
  float transmittedBy(const LeafTextures& leaf) const {
    const Image& light = plant_.textures[static_cast<std::size_t>(leaf.front_light)].image;
    double sum = 0.0;
    for (std::size_t i = 0; i < light.rgba.size(); i += 4) {
      glm::vec3 h;
      for (int c = 0; c < 3; ++c)
        h[c] = leaf.front_offset +
               leaf.front_scale * static_cast<float>(light.rgba[i + static_cast<std::size_t>(c)]) /
                   255.0f;
      sum += double{shared::leafEvenDirection(h).z};
    }
    return static_cast<float>(sum /
                              std::max<double>(static_cast<double>(light.rgba.size()) / 4.0, 1.0));
  }

  std::size_t addAccessor(std::vector<std::uint8_t> bytes, std::size_t count, const char* type,
                          int component_type, int target, bool normalized = false) {
    Json accessor = {{"bufferView", appendView(document_, std::move(bytes), target, 0)},
                     {"componentType", component_type},
                     {"count", count},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    document_.json["accessors"].push_back(std::move(accessor));
    return document_.json["accessors"].size() - 1;
  }

  void addMesh(std::size_t index) {
    const Mesh& mesh = plant_.meshes[index];
    const MeshLight* light = light_ == nullptr ? nullptr : &light_->meshes[index];
    const std::vector<glm::vec3>& normals =
        light != nullptr && !light->normals.empty() ? light->normals : mesh.normals;
    const std::size_t count = mesh.positions.size();
    Json attributes = Json::object();
    const auto add = [&](const char* name, std::vector<std::uint8_t> bytes, const char* type) {
      attributes[name] = addAccessor(std::move(bytes), count, type, kFloat, kArrayBuffer);
    };
    add("POSITION", bytesOf(mesh.positions), "VEC3");
    Bounds box{mesh.positions[0], mesh.positions[0]};
    for (const glm::vec3& p : mesh.positions) box = {glm::min(box.min, p), glm::max(box.max, p)};
    Json& position = document_.json["accessors"].back();
    position["min"] = {box.min.x, box.min.y, box.min.z};
    position["max"] = {box.max.x, box.max.y, box.max.z};
    if (!normals.empty()) add("NORMAL", bytesOf(normals), "VEC3");
    if (!mesh.uvs.empty()) add("TEXCOORD_0", bytesOf(mesh.uvs), "VEC2");
    // A normal map without tangents would be read differently by every program.
    const Material& material = plant_.materials[mesh.material];
    if (textureOf(material.normal_texture) >= 0 && !mesh.uvs.empty() && !normals.empty())
      add("TANGENT", bytesOf(vertexTangents(mesh, normals)), "VEC4");
    if (!stem_ids_.empty()) add(kStemId, bytesOf(stem_ids_[index]), "SCALAR");
    if (light != nullptr && !light->ambient.empty()) {
      add("_AO", bytesOf(light->ambient), "SCALAR");
      if (!light->visibility.empty()) add("_VISIBILITY", bytesOf(light->visibility), "VEC2");
      if (options_.color1) {
        attributes["COLOR_0"] = addAccessor(std::vector<std::uint8_t>(count * 4, 255), count,
                                            "VEC4", kUnsignedByte, kArrayBuffer, true);
        attributes["COLOR_1"] = addAccessor(ambientColors(light->ambient), count, "VEC4",
                                            kUnsignedByte, kArrayBuffer, true);
      }
    }
    Json primitive = {{"attributes", std::move(attributes)},
                      {"indices", addIndices(mesh)},
                      {"material", mesh.material}};
    const char* kind = mesh.kind == PartKind::kFoliage ? "foliage" : "wood";
    document_.json["meshes"].push_back({{"name", mesh.name},
                                        {"primitives", Json::array({std::move(primitive)})},
                                        {"extras", {{"verdure", {{"kind", kind}}}}}});
  }

  std::size_t addIndices(const Mesh& mesh) {
    if (mesh.positions.size() > 65535)
      return addAccessor(bytesOf(mesh.indices), mesh.indices.size(), "SCALAR", kUnsignedInt,
                         kElementArrayBuffer);
    std::vector<std::uint16_t> narrow(mesh.indices.size());
    std::transform(mesh.indices.begin(), mesh.indices.end(), narrow.begin(),
                   [](std::uint32_t i) { return static_cast<std::uint16_t>(i); });
    return addAccessor(bytesOf(narrow), narrow.size(), "SCALAR", kUnsignedShort,
                       kElementArrayBuffer);
  }

  const Plant& plant_;
  const CrownLight* light_;
  const ExportOptions& options_;
  GltfDocument document_;
  std::vector<int> texture_of_;
  std::vector<std::vector<float>> stem_ids_;
};

}  // namespace

std::string gltfGenerator() {
  return "verdure " VERDURE_VERSION;
}

GltfDocument newDocument(const Plant& plant, const CrownLight* light,
                         const ExportOptions& options) {
  return DocumentBuilder(plant, light, options).build();
}

}  // namespace verdure
