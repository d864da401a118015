#ifndef VERDURE_SCENE_SCENE_H_
#define VERDURE_SCENE_SCENE_H_

#include "verdure/scene.h"

namespace verdure {

/// world_from_plant of an instance with the item's own origin taken into account.
glm::mat4 worldFromPlant(const Scene& scene, const SceneItem& item, const glm::mat4& instance);

/// Opacity below which a texel is cut, in the texture's own alpha: (0, 1]. Blended materials are
/// cut at a half.
float textureCutoff(const Material& material);

/// Luminance of what the facets of a material's gloss reflect that are looked at squarely, before
/// its strength, [0, 1].
float facingReflectance(const Material& material);

/// Throws Error if the plant lacks it or its image is empty.
const Texture& textureOf(const Plant& plant, int index);

}  // namespace verdure

#endif  // VERDURE_SCENE_SCENE_H_
