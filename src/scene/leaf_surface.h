#ifndef VERDURE_SCENE_LEAF_SURFACE_H_
#define VERDURE_SCENE_LEAF_SURFACE_H_

#include <array>
#include <optional>

#include "scene/texel_grid.h"
#include "verdure/plant.h"

namespace verdure {

/// What one side of a leaf does with diffuse light, linear RGB in [0, 1].
struct LeafDiffuse {
  glm::vec3 reflectance{0.0f};
  glm::vec3 transmittance{0.0f};  ///< share of even light on the other side that leaves here
};

/// What foliage of one material does with diffuse light anywhere on its textures: by the maps of
/// its two sides, by what its file states, or by its colour (shared/leaf.h). As plant_pass.frag has
/// it.
class LeafSurface {
 public:
  /// Plant and material must outlive it. `textured`: whether the mesh has texture coordinates.
  /// Without `maps`, those of both sides do not count. Throws Error for textures that the plant
  /// lacks.
  LeafSurface(const Plant& plant, const Material& material, bool textured, bool maps = true);

  /// By the base colour at `uv`, [0, 1]: of the front.
  LeafDiffuse at(const glm::vec2& uv, const glm::vec3& color, bool front) const;

  /// Mean transmittance of both sides, over what the alpha cut leaves of the textures; those larger
  /// than 256 texels a side are sampled. `color`: the mean of the base colour.
  glm::vec3 meanTransmittance(const glm::vec3& color) const;

 private:
  struct Side {
    TexelGrid translucency, light;
    float scale = 1.0f, offset = 0.0f;
  };

  const Plant& plant_;
  const Material& material_;
  bool textured_ = false;
  std::optional<TexelGrid> back_color_;  ///< with the maps of both sides
  std::array<Side, 2> sides_;            ///< front, back
  std::optional<TexelGrid> share_, tint_;
};

}  // namespace verdure

#endif  // VERDURE_SCENE_LEAF_SURFACE_H_
