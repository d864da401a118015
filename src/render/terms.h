#ifndef VERDURE_RENDER_TERMS_H_
#define VERDURE_RENDER_TERMS_H_

#include "gpu/pipeline.h"
#include "verdure/render.h"

namespace verdure {

/// What a draw is, as far as its pipeline depends on it.
struct DrawKind {
  AmbientSource ambient_source = AmbientSource::kConstant;
  bool formula_sky = false;  ///< the dome is drawn from its formula, not from an image
  bool background = false;   ///< there is no dome
  bool transmission = false;
  bool flip_normal = false;  ///< leaf normals: turned over on back faces
  bool alpha_test = false;
  bool normal_map = false;
  bool foliage = false;
  bool scattering = false;
  bool thickness_map = false;
  LeafModel leaf = LeafModel::kColor;
  bool stated_transmission = false;
  bool moving = false;  ///< in wind
  bool forest = false;  ///< of a forest: fades, has a tint and haze
  auto operator<=>(const DrawKind&) const = default;
};

/// The specialisation constants, numbered as in src/shaders/terms.glsl.
inline gpu::Constants termConstants(const Terms& terms, const DrawKind& kind) {
  return {terms.ambient,
          terms.diffuse,
          terms.specular,
          terms.shadow,
          terms.textures,
          static_cast<std::uint32_t>(kind.ambient_source),
          kind.formula_sky,
          kind.background,
          kind.transmission,
          kind.flip_normal,
          kind.alpha_test,
          kind.normal_map,
          terms.gloss,
          static_cast<std::uint32_t>(terms.shadow_source),
          kind.foliage,
          kind.scattering,
          kind.thickness_map,
          static_cast<std::uint32_t>(kind.leaf),
          kind.stated_transmission,
          kind.moving,
          kind.forest};
}

}  // namespace verdure

#endif  // VERDURE_RENDER_TERMS_H_
