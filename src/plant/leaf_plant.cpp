#include "verdure/leaf_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/color.h"
#include "verdure/error.h"

namespace verdure {
namespace {

template <typename Texel>
int addTexture(Plant& plant, const LeafSet& set, const char* what, Texel texel) {
  Texture texture{set.name + "_" + what, Image(set.width, set.height), true, true};
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    const glm::vec4 value = texel(i);
    for (int c = 0; c < 4; ++c)
      texture.image.rgba[4 * i + static_cast<std::size_t>(c)] = toByte(value[c]);
  }
  plant.textures.push_back(std::move(texture));
  return static_cast<int>(plant.textures.size() - 1);
}

int addColors(Plant& plant, const LeafSet& set, const char* what,
              const std::vector<glm::vec3>& colors, bool cut = false) {
  return addTexture(plant, set, what, [&](std::size_t i) {
    glm::vec4 out(1.0f);
    for (int c = 0; c < 3; ++c) out[c] = shared::srgbFromLinear(colors[i][c]);
    if (cut) out.w = set.opacity[i];
    return out;
  });
}

/// 128 is 0: a flat normal is exact (shared/normal_map.h).
int addNormals(Plant& plant, const LeafSet& set, const char* what,
               const std::vector<glm::vec3>& normals) {
  return addTexture(plant, set, what, [&](std::size_t i) {
    return glm::vec4((normals[i] * 127.0f + 128.0f) / 255.0f, 1.0f);
  });
}

int addCoefficients(Plant& plant, const LeafSet& set, const char* what,
                    const std::vector<glm::vec3>& light, float& scale, float& offset) {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (const glm::vec3& h : light)
    for (int c = 0; c < 3; ++c) {
      low = std::min(low, h[c]);
      high = std::max(high, h[c]);
    }
  offset = low;
  scale = std::max(high - low, 1e-6f);
  return addTexture(plant, set, what,
                    [&](std::size_t i) { return glm::vec4((light[i] - offset) / scale, 1.0f); });
}

/// A rectangle of these lengths, m, folded at its midrib and bent along it; lengths across and
/// along the midrib stay.
struct Sheet {
  float width, height, fold, bend;

  glm::vec3 at(float u, float v) const {
    const float x = (u - 0.5f) * width, y = (1.0f - v) * height;
    const float angle = bend * y / height;
    glm::vec3 rib(0.0f, y, 0.0f);
    if (std::abs(bend) > 1e-4f)
      rib = glm::vec3(0.0f, std::sin(angle), std::cos(angle) - 1.0f) * (height / bend);
    const glm::vec3 normal(0.0f, std::sin(angle), std::cos(angle));
    return rib + glm::vec3(x * std::cos(fold), 0.0f, 0.0f) +
           normal * (std::abs(x) * std::sin(fold));
  }
};

}  // namespace

std::uint32_t addLeafMaterial(Plant& plant, const LeafSet& set, const LeafTranslucency& light) {
  checkLeafSet(set, set.name);
  if (light.front.size() != set.texelCount() || light.back.size() != set.texelCount())
    throw Error(set.name, "its baked light has another size", "bake this leaf");
  Material material;
  material.name = set.name;
  material.alpha_mode = AlphaMode::kMask;
  material.double_sided = true;
  material.base_color_texture = addColors(plant, set, "front", set.front.albedo, true);
  material.normal_texture = addNormals(plant, set, "front_normal", set.front.normal);
  LeafTextures& leaf = material.leaf.emplace();
  leaf.back_color = addColors(plant, set, "back", set.back.albedo);
  leaf.back_normal = addNormals(plant, set, "back_normal", set.back.normal);
  leaf.front_translucency = addColors(plant, set, "front_translucency", set.front.translucency);
  leaf.back_translucency = addColors(plant, set, "back_translucency", set.back.translucency);
  leaf.front_light =
      addCoefficients(plant, set, "front_light", light.front, leaf.front_scale, leaf.front_offset);
  leaf.back_light =
      addCoefficients(plant, set, "back_light", light.back, leaf.back_scale, leaf.back_offset);
  leaf.front_roughness = set.optics.front_roughness;
  leaf.back_roughness = set.optics.back_roughness;
  leaf.refractive_index = set.optics.front_index;
  plant.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(plant.materials.size() - 1);
}

Plant leafPlant(const LeafSet& set, const LeafTranslucency& light,
                const LeafPlantOptions& options) {
  const auto demand = [](bool good, const char* what, const char* range) {
    if (!good) throw Error("leaf", std::string(what) + " is out of range", range);
  };
  demand(options.segments >= 1 && options.segments <= 1024, "segments", "choose 1 to 1024");
  demand(std::abs(options.fold_deg) < 90.0f, "fold_deg", "choose more than -90 and less than 90");
  demand(std::abs(options.bend_deg) <= 360.0f, "bend_deg", "choose -360 to 360");
  demand(options.scale > 0.0f && std::isfinite(options.scale), "scale", "choose more than 0");
  Plant plant;
  plant.name = set.name;
  Mesh mesh;
  mesh.name = "leaf";
  mesh.kind = PartKind::kFoliage;
  mesh.material = addLeafMaterial(plant, set, light);

  const float texel = 1e-3f * set.mm_per_texel * options.scale;
  const Sheet sheet{static_cast<float>(set.width) * texel, static_cast<float>(set.height) * texel,
                    glm::radians(options.fold_deg), glm::radians(options.bend_deg)};
  const int n = options.segments + options.segments % 2;  // an edge along the midrib
  const float step = 1.0f / static_cast<float>(n);
  for (int row = 0; row <= n; ++row)
    for (int column = 0; column <= n; ++column) {
      const float u = static_cast<float>(column) * step, v = static_cast<float>(row) * step;
      mesh.positions.push_back(sheet.at(u, v));
      mesh.uvs.emplace_back(u, v);
      const glm::vec3 across = sheet.at(u + 0.5f * step, v) - sheet.at(u - 0.5f * step, v);
      const glm::vec3 along = sheet.at(u, v - 0.5f * step) - sheet.at(u, v + 0.5f * step);
      mesh.normals.push_back(glm::normalize(glm::cross(across, along)));
    }
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const auto corner = static_cast<std::uint32_t>(row * (n + 1) + column);
      const auto below = corner + static_cast<std::uint32_t>(n + 1);
      for (const std::uint32_t index : {corner, below, corner + 1, corner + 1, below, below + 1})
        mesh.indices.push_back(index);
    }
  plant.meshes.push_back(std::move(mesh));
  findLeaves(plant);
  return plant;
}

}  // namespace verdure
