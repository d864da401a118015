#include "scene/leaf_surface.h"

#include <algorithm>

#include "scene/scene.h"
#include "shared/leaf.h"
#include "shared/leaf_basis.h"

namespace verdure {

LeafSurface::LeafSurface(const Plant& plant, const Material& material, bool textured, bool maps)
    : plant_(plant), material_(material), textured_(textured) {
  if (!textured) return;
  const auto grid = [&plant](int texture) { return TexelGrid(textureOf(plant, texture)); };
  if (material.leaf && maps) {
    const LeafTextures& leaf = *material.leaf;
    back_color_ = grid(leaf.back_color);
    sides_ = {Side{grid(leaf.front_translucency), grid(leaf.front_light), leaf.front_scale,
                   leaf.front_offset},
              Side{grid(leaf.back_translucency), grid(leaf.back_light), leaf.back_scale,
                   leaf.back_offset}};
  } else if (material.transmission) {
    const DiffuseTransmission& stated = *material.transmission;
    if (stated.factor_texture >= 0) share_ = grid(stated.factor_texture);
    if (stated.color_texture >= 0) tint_ = grid(stated.color_texture);
  }
}

LeafDiffuse LeafSurface::at(const glm::vec2& uv, const glm::vec3& color, bool front) const {
  if (back_color_) {
    const Side& side = sides_[front ? 0 : 1];
    const glm::vec3 h = side.light.data(uv) * side.scale + side.offset;
    const float even = std::clamp(shared::leafEvenDirection(h).z, 0.0f, 1.0f);
    const glm::vec3 back = back_color_->color(uv, false) * glm::vec3(material_.base_color);
    return {front ? color : glm::clamp(back, 0.0f, 1.0f),
            side.translucency.color(uv, false) * even};
  }
  if (!material_.transmission) return {color, shared::leafTransmittance(color)};
  const DiffuseTransmission& stated = *material_.transmission;
  const float share = stated.factor * (share_ ? share_->share(uv) : 1.0f);
  const glm::vec3 tint = stated.color * (tint_ ? tint_->color(uv, false) : glm::vec3(1.0f));
  return {color * (1.0f - share), tint * share};
}

glm::vec3 LeafSurface::meanTransmittance(const glm::vec3& color) const {
  const bool varies = back_color_ || share_ || tint_;
  if (!varies) return at(glm::vec2(0.0f), color, true).transmittance;
  std::optional<TexelGrid> base;
  if (textured_ && material_.base_color_texture >= 0)
    base.emplace(textureOf(plant_, material_.base_color_texture));
  const bool cut = base && material_.alpha_mode != AlphaMode::kOpaque;
  const TexelGrid& size = base ? *base : tint_ ? *tint_ : share_ ? *share_ : *back_color_;
  const int width = std::min(size.width(), 256), height = std::min(size.height(), 256);
  glm::dvec3 sum(0.0);
  std::size_t count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
      if (cut && base->share(uv) < textureCutoff(material_)) continue;
      for (const bool front : {true, false}) sum += glm::dvec3(at(uv, color, front).transmittance);
      count += 2;
    }
  return count > 0 ? glm::vec3(sum / static_cast<double>(count))
                   : at(glm::vec2(0.5f), color, true).transmittance;
}

}  // namespace verdure
