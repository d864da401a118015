#include "verdure/leaf_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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
  /// Unit, out of the front, over a step of the size of what is drawn.
  glm::vec3 normal(float u, float v, float step_u, float step_v) const {
    const glm::vec3 across = at(u + 0.5f * step_u, v) - at(u - 0.5f * step_u, v);
    const glm::vec3 along = at(u, v - 0.5f * step_v) - at(u, v + 0.5f * step_v);
    return glm::normalize(glm::cross(across, along));
  }
};

/// Checks the options.
Sheet sheetOf(const LeafSet& set, const LeafPlantOptions& options) {
  const auto demand = [](bool good, const char* what, const char* range) {
    if (!good) throw Error("leaf", std::string(what) + " is out of range", range);
  };
  demand(options.segments >= 1 && options.segments <= 1024, "segments", "choose 1 to 1024");
  demand(std::abs(options.fold_deg) < 90.0f, "fold_deg", "choose more than -90 and less than 90");
  demand(std::abs(options.bend_deg) <= 360.0f, "bend_deg", "choose -360 to 360");
  demand(options.scale > 0.0f && std::isfinite(options.scale), "scale", "choose more than 0");
  const float texel = 1e-3f * set.mm_per_texel * options.scale;
  return {static_cast<float>(set.width) * texel, static_cast<float>(set.height) * texel,
          glm::radians(options.fold_deg), glm::radians(options.bend_deg)};
}

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
  const Sheet sheet = sheetOf(set, options);
  Plant plant;
  plant.name = set.name;
  Mesh mesh;
  mesh.name = "leaf";
  mesh.kind = PartKind::kFoliage;
  mesh.material = addLeafMaterial(plant, set, light);

  const int n = options.segments + options.segments % 2;  // an edge along the midrib
  const float step = 1.0f / static_cast<float>(n);
  for (int row = 0; row <= n; ++row)
    for (int column = 0; column <= n; ++column) {
      const float u = static_cast<float>(column) * step, v = static_cast<float>(row) * step;
      mesh.positions.push_back(sheet.at(u, v));
      mesh.uvs.emplace_back(u, v);
      mesh.normals.push_back(sheet.normal(u, v, step, step));
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

Plant leafReliefPlant(const LeafSet& set, const LeafPlantOptions& options) {
  checkLeafSet(set, set.name);
  const Sheet sheet = sheetOf(set, options);
  if (set.width < 2 || set.height < 2)
    throw Error(set.name, "has one row or column", "give it more texels");
  Plant plant;
  plant.name = set.name;
  const auto w = static_cast<float>(set.width), h = static_cast<float>(set.height);
  for (const bool front : {true, false}) {
    const LeafSide& side = front ? set.front : set.back;
    Material& material = plant.materials.emplace_back();
    material.name = front ? "front" : "back";
    material.alpha_mode = AlphaMode::kMask;
    material.base_color_texture = addColors(plant, set, material.name.c_str(), side.albedo, true);
    material.normal_texture =
        addNormals(plant, set, front ? "front_normal" : "back_normal", side.normal);
    Mesh& mesh = plant.meshes.emplace_back();
    mesh.name = material.name;
    mesh.kind = PartKind::kFoliage;
    mesh.material = front ? 0 : 1;
    for (int row = 0; row < set.height; ++row)
      for (int column = 0; column < set.width; ++column) {
        const std::size_t texel = mesh.positions.size();
        const float u = (static_cast<float>(column) + 0.5f) / w;
        const float v = (static_cast<float>(row) + 0.5f) / h;
        const glm::vec3 out = (front ? 1.0f : -1.0f) * sheet.normal(u, v, 1.0f / w, 1.0f / h);
        mesh.positions.push_back(sheet.at(u, v) +
                                 1e-3f * options.scale * side.relief_mm[texel] * out);
        mesh.normals.push_back(out);
        mesh.uvs.emplace_back(u, v);
      }
    for (int row = 0; row + 1 < set.height; ++row)
      for (int column = 0; column + 1 < set.width; ++column) {
        const auto corner = static_cast<std::uint32_t>(row * set.width + column);
        const std::uint32_t right = corner + 1,
                            below = corner + static_cast<std::uint32_t>(set.width);
        for (const auto& [a, b, c] :
             {std::tuple{corner, below, right}, {right, below, below + 1}}) {
          mesh.indices.push_back(a);
          mesh.indices.push_back(front ? b : c);
          mesh.indices.push_back(front ? c : b);
        }
      }
  }
  return plant;
}

}  // namespace verdure
