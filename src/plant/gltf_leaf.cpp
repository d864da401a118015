#include <fmt/format.h>

#include <cmath>

#include "leaf/leaf_maps.h"
#include "plant/classify.h"
#include "plant/gltf_document.h"
#include "shared/color.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

/// The maps of one material of a document.
class MaterialMaps {
 public:
  explicit MaterialMaps(const std::filesystem::path& path) : document_(readGltf(path)) {
    decompressGltf(document_);
  }

  std::size_t find(const std::string& pattern) const {
    std::vector<std::size_t> found;
    std::string names;
    const Json& materials = document_.list("materials");
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const Json* base = member(materials[i], "pbrMetallicRoughness");
      if (base == nullptr || member(*base, "baseColorTexture") == nullptr) continue;
      const std::string name = readString(materials[i], "name", fmt::format("material {}", i));
      if (!pattern.empty() && !matchesPattern(name, pattern)) continue;
      found.push_back(i);
      names += (names.empty() ? "'" : ", '") + name + "'";
    }
    if (found.empty())
      document_.fail(pattern.empty()
                         ? "no material has a texture of its colour"
                         : "no material with a texture of its colour is named '" + pattern + "'",
                     "see verdure inspect");
    if (found.size() > 1)
      document_.fail("several materials may be meant: " + names, "name one with --material");
    return found[0];
  }

  LeafMaps read(std::size_t material) {
    const Json& json = document_.list("materials")[material];
    const std::string who = document_.label("materials", "material", material);
    LeafMaps maps;
    maps.where = document_.where + ": " + who;
    maps.name = readString(json, "name", fmt::format("material {}", material));
    readColors(json, who, maps);
    if (const Json* normal = member(json, "normalTexture")) {
      LeafMap map = texture(*normal, who);
      const double scale = readNumber(document_, *normal, "scale", 1.0, who);
      for (std::size_t i = 0; i < map.values.size(); i += static_cast<std::size_t>(map.channels))
        for (std::size_t c = i; c < i + 2 && map.channels >= 3; ++c)
          map.values[c] = 0.5f + (map.values[c] - 0.5f) * static_cast<float>(scale);
      maps.sides[0].normal = std::move(map);
    }
    if (const Json* volume = extension(json, "KHR_materials_volume")) {
      const auto mm =
          static_cast<float>(1000.0 * readNumber(document_, *volume, "thicknessFactor", 0.0, who));
      if (const Json* info = member(*volume, "thicknessTexture"); info != nullptr && mm > 0) {
        maps.thickness = green(texture(*info, who));
        maps.thickness_range_mm = LeafRange{0.0f, mm};
      } else if (mm > 0) {
        maps.thickness_mm = mm;
      }
    }
    return maps;
  }

 private:
  LeafMap texture(const Json& info, const std::string& who) const {
    const auto index = readIndex(document_, info, "index", "textures", who);
    if (!index) document_.fail(who + ": a texture has no index");
    const auto image = readIndex(document_, document_.list("textures")[*index], "source", "images",
                                 document_.label("textures", "texture", *index));
    if (!image) document_.fail(who + ": a texture has no PNG or JPEG image");
    return decodeLeafMap(imageBytes(document_, *image),
                         document_.where + ": " + document_.label("images", "image", *image));
  }

  /// glTF keeps thickness in the green channel.
  static LeafMap green(LeafMap map) {
    std::vector<float> values;
    for (std::size_t i = 0; i < map.texelCount(); ++i) values.push_back(map.color(i).y);
    map.values = std::move(values);
    map.channels = 1;
    return map;
  }

  static glm::vec3 linear(const glm::vec3& c) {
    return {shared::linearFromSrgb(c.x), shared::linearFromSrgb(c.y), shared::linearFromSrgb(c.z)};
  }

  void readColors(const Json& json, const std::string& who, LeafMaps& maps) const {
    const Json& base = *member(json, "pbrMetallicRoughness");
    LeafMap color = texture(*member(base, "baseColorTexture"), who);
    glm::dvec4 factor(1.0);
    readNumbers(document_, base, "baseColorFactor", {&factor[0], 4}, who);
    const std::size_t n = color.texelCount();
    LeafMap albedo = color;
    albedo.channels = 3;
    albedo.physical = true;
    albedo.values.resize(3 * n);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::vec3 c = linear(color.color(i)) * glm::vec3(factor);
      for (int k = 0; k < 3; ++k) albedo.values[3 * i + static_cast<std::size_t>(k)] = c[k];
    }
    if (const std::string mode = readString(json, "alphaMode", "OPAQUE");
        color.hasAlpha() && mode != "OPAQUE") {
      const double cutoff = readNumber(document_, json, "alphaCutoff", 0.5, who);
      LeafMap opacity = color;
      opacity.channels = 1;
      opacity.values.resize(n);
      for (std::size_t i = 0; i < n; ++i) {
        const float alpha = color.alpha(i) * static_cast<float>(factor.w);
        // Masked leaves are cut at the cutoff, which need not be one half.
        opacity.values[i] =
            mode == "MASK" ? (alpha >= static_cast<float>(cutoff) ? 1.0f : 0.0f) : alpha;
      }
      maps.opacity = std::move(opacity);
    }
    if (const Json* through = extension(json, "KHR_materials_diffuse_transmission"))
      splitLight(*through, who, albedo, maps);
    maps.sides[0].albedo = std::move(albedo);
  }

  /// Of the diffuse light, a share goes through, in a colour of its own.
  void splitLight(const Json& through, const std::string& who, LeafMap& albedo,
                  LeafMaps& maps) const {
    const auto share =
        static_cast<float>(readNumber(document_, through, "diffuseTransmissionFactor", 0.0, who));
    glm::dvec3 factor(1.0);
    readNumbers(document_, through, "diffuseTransmissionColorFactor", {&factor[0], 3}, who);
    std::optional<LeafMap> shares, colors;
    if (const Json* info = member(through, "diffuseTransmissionTexture"))
      shares = texture(*info, who);
    if (const Json* info = member(through, "diffuseTransmissionColorTexture"))
      colors = texture(*info, who);
    for (const auto* map : {&shares, &colors})
      if (*map && ((*map)->width != albedo.width || (*map)->height != albedo.height))
        document_.fail(
            fmt::format("{}: {} has {} x {} texels, {} {} x {}", who, albedo.where, albedo.width,
                        albedo.height, (*map)->where, (*map)->width, (*map)->height),
            "give all maps the same size");
    LeafMap translucency = albedo;
    for (std::size_t i = 0; i < albedo.texelCount(); ++i) {
      const float s =
          glm::clamp(share * (shares && shares->hasAlpha() ? shares->alpha(i) : 1.0f), 0.0f, 1.0f);
      const glm::vec3 color =
          (colors ? linear(colors->color(i)) : glm::vec3(1)) * glm::vec3(factor);
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = 3 * i + static_cast<std::size_t>(k);
        translucency.values[at] = s * color[k];
        albedo.values[at] *= 1.0f - s;
      }
    }
    maps.sides[0].translucency = std::move(translucency);
  }

  GltfDocument document_;
};

/// Width of a texel on the meshes that wear a material, by their areas; nothing if they have none.
std::optional<float> texelWidth(const Plant& plant, std::size_t material, const LeafMap& map) {
  double mm2 = 0, texels = 0;
  for (const Mesh& mesh : plant.meshes) {
    if (mesh.material != material || mesh.uvs.empty()) continue;
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
      const std::uint32_t a = mesh.indices[t], b = mesh.indices[t + 1], c = mesh.indices[t + 2];
      const glm::dvec3 p = mesh.positions[b] - mesh.positions[a];
      const glm::dvec3 q = mesh.positions[c] - mesh.positions[a];
      const glm::dvec2 u = mesh.uvs[b] - mesh.uvs[a], v = mesh.uvs[c] - mesh.uvs[a];
      mm2 += 1e6 * glm::length(glm::cross(p, q));
      texels += std::abs(u.x * v.y - u.y * v.x) * map.width * map.height;
    }
  }
  if (!(mm2 > 0 && texels > 0)) return std::nullopt;
  return static_cast<float>(std::sqrt(mm2 / texels));
}

}  // namespace

LeafSet importLeafMaterial(const std::filesystem::path& path, const std::string& material,
                           const LeafImportOptions& options) {
  MaterialMaps source(path);
  const std::size_t index = source.find(material);
  LeafMaps maps = source.read(index);
  if (!options.mm_per_texel && !options.width_mm) {
    maps.mm_per_texel = texelWidth(loadPlant(path), index, *maps.sides[0].albedo);
    if (maps.mm_per_texel)
      maps.notes.push_back(
          fmt::format("a texel is {:.4g} mm wide on the meshes that wear it", *maps.mm_per_texel));
  }
  return makeLeafSet(std::move(maps), options);
}

}  // namespace verdure
