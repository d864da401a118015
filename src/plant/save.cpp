#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plant/gltf_attributes.h"
#include "plant/gltf_export.h"

namespace verdure {
namespace {

void checkLight(const Plant& plant, const CrownLight& light, const std::string& where) {
  if (light.meshes.size() != plant.meshes.size())
    throw Error(where,
                fmt::format("the light has {} meshes, the plant {}", light.meshes.size(),
                            plant.meshes.size()),
                "bake the light from this plant");
  for (std::size_t i = 0; i < light.meshes.size(); ++i) {
    const MeshLight& mesh = light.meshes[i];
    const std::size_t count = plant.meshes[i].positions.size();
    const auto fits = [count](std::size_t size) { return size == 0 || size == count; };
    if (!fits(mesh.normals.size()) || !fits(mesh.ambient.size()) || !fits(mesh.visibility.size()))
      throw Error(where, "the light of part '" + plant.meshes[i].name + "' has another length",
                  "bake the light from this plant");
    for (const glm::vec3& n : mesh.normals)
      if (!(std::abs(glm::length(n) - 1.0f) < 1e-3f))
        throw Error(where,
                    "the light of part '" + plant.meshes[i].name +
                        "' has normals that are not of unit length",
                    "normalise them");
    for (const float k : mesh.ambient)
      if (!(k >= 0.0f && k <= 1.0f))
        throw Error(where,
                    "the light of part '" + plant.meshes[i].name +
                        "' has ambient coefficients outside [0, 1]",
                    "clamp them");
    for (const glm::vec2& v : mesh.visibility)
      if (!(v.x >= 0.0f && v.x <= 1.0f && v.y >= 0.0f && v.y <= 1.0f))
        throw Error(
            where, "the light of part '" + plant.meshes[i].name + "' has visibility outside [0, 1]",
            "clamp it");
  }
}

}  // namespace

std::vector<std::uint8_t> ambientColors(const std::vector<float>& ambient) {
  std::vector<std::uint8_t> colors(ambient.size() * 4, 255);
  for (std::size_t i = 0; i < ambient.size(); ++i) {
    const auto k =
        static_cast<std::uint8_t>(std::lround(std::clamp(ambient[i], 0.0f, 1.0f) * 255.0f));
    std::fill_n(colors.begin() + static_cast<std::ptrdiff_t>(4 * i), 3, k);
  }
  return colors;
}

void savePlant(const Plant& plant, const CrownLight* light, const std::filesystem::path& path,
               const ExportOptions& options) {
  if (path.extension() != ".glb" && path.extension() != ".gltf")
    throw Error(path.string(), "is not a kind of file that can be written", "use .glb or .gltf");
  if (light != nullptr) checkLight(plant, *light, path.string());
  if (!matchesSource(plant))
    writeGltf(newDocument(plant, light, options), path);
  else if (light != nullptr)
    writeGltf(relitDocument(plant, *light, options), path);
  else
    writeGltf(plant.source->gltf, path);
}

}  // namespace verdure
