#include "plant/gltf_leaf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verdure {
namespace {

struct LeafTextureMember {
  const char* key;
  int LeafTextures::*texture;
  float LeafTextures::*scale;  ///< null: of colours and normals
  float LeafTextures::*offset;
};
constexpr std::array<LeafTextureMember, 6> kTextures{{
    {"backColorTexture", &LeafTextures::back_color, nullptr, nullptr},
    {"backNormalTexture", &LeafTextures::back_normal, nullptr, nullptr},
    {"frontTranslucencyTexture", &LeafTextures::front_translucency, nullptr, nullptr},
    {"backTranslucencyTexture", &LeafTextures::back_translucency, nullptr, nullptr},
    {"frontLightTexture", &LeafTextures::front_light, &LeafTextures::front_scale,
     &LeafTextures::front_offset},
    {"backLightTexture", &LeafTextures::back_light, &LeafTextures::back_scale,
     &LeafTextures::back_offset},
}};

struct LeafNumber {
  const char* key;
  float LeafTextures::*value;
  double least, most;
};
constexpr std::array<LeafNumber, 3> kNumbers{{
    {"frontRoughness", &LeafTextures::front_roughness, 0.0, 1.0},
    {"backRoughness", &LeafTextures::back_roughness, 0.0, 1.0},
    {"refractiveIndex", &LeafTextures::refractive_index, 1.0, 10.0},
}};

/// Reflects all, to seven digits.
constexpr float kMirrorIndex = 1e8f;

}  // namespace

void writeLeafMaterial(const LeafTextures& leaf, float transmitted,
                       const std::function<int(int)>& texture_of, Json& material) {
  Json own = Json::object();
  for (const LeafTextureMember& entry : kTextures) {
    Json use = {{"index", texture_of(leaf.*entry.texture)}};
    if (entry.scale != nullptr) {
      use["scale"] = leaf.*entry.scale;
      use["offset"] = leaf.*entry.offset;
    }
    own[entry.key] = std::move(use);
  }
  for (const LeafNumber& number : kNumbers) own[number.key] = leaf.*number.value;
  material["extras"]["verdure"]["leaf"] = std::move(own);

  // glTF's roughness squared is the width of its facets' slopes, as m is of Beckmann's.
  material["pbrMetallicRoughness"]["roughnessFactor"] =
      leaf.front_roughness > 0.0f ? std::sqrt(leaf.front_roughness) : 1.0f;
  material["extensions"]["KHR_materials_ior"] = {{"ior", leaf.refractive_index}};
  material["extensions"][kDiffuseTransmission] = {
      {"diffuseTransmissionFactor", std::clamp(transmitted, 0.0f, 1.0f)},
      {"diffuseTransmissionColorTexture", {{"index", texture_of(leaf.front_translucency)}}}};
}

std::optional<LeafTextures> readLeafMaterial(const GltfDocument& document, const Json& material,
                                             const std::string& who,
                                             const std::function<int(const Json&)>& texture_of) {
  const Json* extras = member(material, "extras");
  const Json* verdure = extras == nullptr ? nullptr : member(*extras, "verdure");
  const Json* own = verdure == nullptr ? nullptr : member(*verdure, "leaf");
  if (own == nullptr) return std::nullopt;
  LeafTextures leaf;
  for (const LeafTextureMember& entry : kTextures) {
    const Json* use = member(*own, entry.key);
    if (use == nullptr)
      document.fail(who + ": its leaf has no " + entry.key, "write the plant again with verdure");
    leaf.*entry.texture = texture_of(*use);
    if (entry.scale == nullptr) continue;
    leaf.*entry.scale = static_cast<float>(readNumber(document, *use, "scale", 1.0, who));
    leaf.*entry.offset = static_cast<float>(readNumber(document, *use, "offset", 0.0, who));
  }
  for (const LeafNumber& number : kNumbers) {
    const double value = readNumber(document, *own, number.key, double{leaf.*number.value}, who);
    if (value < number.least || value > number.most)
      document.fail(who + ": its leaf's " + number.key + " is out of range");
    leaf.*number.value = static_cast<float>(value);
  }
  return leaf;
}

void writeDiffuseTransmission(const DiffuseTransmission& stated,
                              const std::function<int(int)>& texture_of, Json& material) {
  Json out = {{"diffuseTransmissionFactor", stated.factor}};
  if (const int texture = texture_of(stated.factor_texture); texture >= 0)
    out["diffuseTransmissionTexture"] = {{"index", texture}};
  if (stated.color != glm::vec3(1.0f))
    out["diffuseTransmissionColorFactor"] = {stated.color.r, stated.color.g, stated.color.b};
  if (const int texture = texture_of(stated.color_texture); texture >= 0)
    out["diffuseTransmissionColorTexture"] = {{"index", texture}};
  material["extensions"][kDiffuseTransmission] = std::move(out);
}

std::optional<DiffuseTransmission> readDiffuseTransmission(
    const GltfDocument& document, const Json& material, const std::string& who,
    const std::function<int(const Json&)>& texture_of) {
  const Json* in = extension(material, kDiffuseTransmission);
  if (in == nullptr) return std::nullopt;
  const auto share = [&](double value, const char* key) {
    if (!(value >= 0.0 && value <= 1.0))
      document.fail(fmt::format("{}: its {} of {} is outside of [0, 1]", who, key, value),
                    "give shares of the light");
    return static_cast<float>(value);
  };
  DiffuseTransmission stated;
  const char* key = "diffuseTransmissionFactor";
  stated.factor = share(readNumber(document, *in, key, 0.0, who), key);
  glm::dvec3 color(1.0);
  key = "diffuseTransmissionColorFactor";
  readNumbers(document, *in, key, {&color[0], 3}, who);
  for (int c = 0; c < 3; ++c) stated.color[c] = share(color[c], key);
  for (const auto& [name, texture] :
       {std::pair{"diffuseTransmissionTexture", &stated.factor_texture},
        std::pair{"diffuseTransmissionColorTexture", &stated.color_texture}})
    if (const Json* use = member(*in, name)) {
      *texture = texture_of(*use);
      if (*texture < 0) return std::nullopt;
    }
  return stated;
}

void writeClearSurface(const ClearSurface& surface, Json& material) {
  const ClearSurface plain;
  if (surface.refractive_index != plain.refractive_index)
    material["extensions"]["KHR_materials_ior"] = {{"ior", surface.refractive_index}};
  Json specular = Json::object();
  if (surface.strength != plain.strength) specular["specularFactor"] = surface.strength;
  if (surface.color != plain.color)
    specular["specularColorFactor"] = {surface.color.r, surface.color.g, surface.color.b};
  if (!specular.empty()) material["extensions"]["KHR_materials_specular"] = std::move(specular);
}

ClearSurface readClearSurface(const GltfDocument& document, const Json& material,
                              const std::string& who) {
  const auto checked = [&](double value, const char* key, bool good, const char* range) {
    if (!good) document.fail(fmt::format("{}: its {} of {} is not {}", who, key, value, range));
    return static_cast<float>(value);
  };
  ClearSurface surface;
  if (const Json* in = extension(material, "KHR_materials_ior")) {
    const double index = readNumber(document, *in, "ior", 1.5, who);
    // 0 stands for a mirror, of which index there is none.
    surface.refractive_index =
        index == 0.0 ? kMirrorIndex : checked(index, "ior", index >= 1.0, "0, or at least 1");
  }
  if (const Json* in = extension(material, "KHR_materials_specular")) {
    const double factor = readNumber(document, *in, "specularFactor", 1.0, who);
    surface.strength =
        checked(factor, "specularFactor", factor >= 0.0 && factor <= 1.0, "in [0, 1]");
    glm::dvec3 color(1.0);
    readNumbers(document, *in, "specularColorFactor", {&color[0], 3}, who);
    for (int c = 0; c < 3; ++c)
      surface.color[c] = checked(color[c], "specularColorFactor", color[c] >= 0.0, "at least 0");
  }
  return surface;
}

}  // namespace verdure
