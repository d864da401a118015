#ifndef VERDURE_TESTS_EVEN_LEAF_H_
#define VERDURE_TESTS_EVEN_LEAF_H_

#include <glm/glm.hpp>
#include <tuple>
#include <type_traits>
#include <vector>

#include "shared/color.h"
#include "verdure/leaf_plant.h"

namespace verdure::test {

/// A leaf 2 m wide that is the same everywhere.
inline LeafSet evenSet() {
  LeafSet set;
  set.name = "even";
  set.width = set.height = 8;
  set.mm_per_texel = 250.0f;
  const auto fill = [&set](const auto& value) {
    return std::vector<std::remove_cvref_t<decltype(value)>>(set.texelCount(), value);
  };
  set.front = {fill(glm::vec3(0.05f, 0.12f, 0.03f)), fill(glm::vec3(0.6f, 0.8f, 0.2f)),
               fill(glm::vec3(0, 0, 1)), fill(0.1f)};
  set.back = {fill(glm::vec3(0.2f, 0.3f, 0.15f)), fill(glm::vec3(0.5f, 0.7f, 0.3f)),
              fill(glm::vec3(0, 0, 1)), fill(0.1f)};
  set.thickness_mm = fill(0.2f);
  set.opacity = fill(1.0f);
  return set;
}

inline LeafTranslucency evenLight(const glm::vec3& front_h, const glm::vec3& back_h) {
  return {8, 8, std::vector<glm::vec3>(64, front_h), std::vector<glm::vec3>(64, back_h), {}};
}

/// It, in z = 0 facing +z, around the origin.
inline Plant evenLeaf(const glm::vec3& front_h, const glm::vec3& back_h) {
  LeafPlantOptions options;
  options.segments = 2;
  Plant plant = leafPlant(evenSet(), evenLight(front_h, back_h), options);
  LeafTextures& leaf = *plant.materials[0].leaf;
  leaf.front_roughness = leaf.back_roughness = 0.0f;
  // An even map has no range of its own.
  leaf.front_scale = leaf.back_scale = 1.0f;
  for (const auto& [texture, h, offset] :
       {std::tuple{leaf.front_light, front_h, &leaf.front_offset},
        std::tuple{leaf.back_light, back_h, &leaf.back_offset}}) {
    *offset = -0.2f;
    Image& image = plant.textures[static_cast<std::size_t>(texture)].image;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
      if (i % 4 != 3) image.rgba[i] = toByte(h[static_cast<int>(i % 4)] + 0.2f);
  }
  for (glm::vec3& p : plant.meshes[0].positions) p.y -= 1.0f;
  return plant;
}

/// What a texture holds, linear.
inline glm::vec3 held(const Plant& plant, int texture, bool srgb) {
  const Image& image = plant.textures[static_cast<std::size_t>(texture)].image;
  glm::vec3 out;
  for (int c = 0; c < 3; ++c) {
    const float value = static_cast<float>(image.rgba[static_cast<std::size_t>(c)]) / 255.0f;
    out[c] = srgb ? shared::linearFromSrgb(value) : value;
  }
  return out;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_EVEN_LEAF_H_
