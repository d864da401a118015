#ifndef VERDURE_RENDER_PACKED_LIGHT_H_
#define VERDURE_RENDER_PACKED_LIGHT_H_

#include <vector>

#include "render/scene.h"

namespace verdure {

/// What another bake changes of a packed scene: its normals, as PackedScene has them.
struct PackedLight {
  std::vector<PackedNormal> leaf_normals, crown_normals;
};

/// Of the scene's items, in the order of packScene(); all of them must have light. Throws Error for
/// light of another plant.
PackedLight packLight(const Scene& scene);

}  // namespace verdure

#endif  // VERDURE_RENDER_PACKED_LIGHT_H_
