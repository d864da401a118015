#include "scene/scene.h"

#include <algorithm>

#include "shared/gloss.h"
#include "shared/tone.h"
#include "verdure/error.h"

namespace verdure {

glm::mat4 worldFromPlant(const Scene& scene, const SceneItem& item, const glm::mat4& instance) {
  const glm::vec3 offset(item.plant->origin - scene.items.front().plant->origin);
  glm::mat4 moved = instance;
  moved[3] += glm::vec4(offset, 0.0f);
  return moved;
}

float textureCutoff(const Material& material) {
  const float cutoff =
      material.alpha_mode == AlphaMode::kMask ? material.alpha_cutoff : 0.5f;  // blended: as cut
  return std::clamp(cutoff / std::max(material.base_color.a, 1e-3f), 1.0f / 255.0f, 1.0f);
}

float facingReflectance(const Material& material) {
  const ClearSurface& surface = material.surface;
  return std::clamp(
      shared::facetReflectance(surface.refractive_index) * shared::luminanceOf(surface.color), 0.0f,
      1.0f);
}

const Texture& textureOf(const Plant& plant, int index) {
  if (index < 0 || static_cast<std::size_t>(index) >= plant.textures.size() ||
      plant.textures[static_cast<std::size_t>(index)].image.empty())
    throw Error(plant.name, "a material's texture " + std::to_string(index) + " is missing");
  return plant.textures[static_cast<std::size_t>(index)];
}

}  // namespace verdure
