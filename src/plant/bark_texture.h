#ifndef VERDURE_PLANT_BARK_TEXTURE_H_
#define VERDURE_PLANT_BARK_TEXTURE_H_

#include <cstdint>
#include <glm/glm.hpp>

#include "verdure/image.h"

namespace verdure {

enum class BarkKind {
  kLenticels,  ///< smooth and pale, dark eyes and short horizontal marks: aspen
  kPaper,      ///< white, long thin horizontal lines, black patches: birch
  kFurrows,    ///< long interlacing ridges: oak, willow
  kBlocks,     ///< small rough blocks: tupelo
  kPlates,     ///< large flaking plates: pine
  kSmooth      ///< faint stripes: maple, shrubs
};

struct BarkLook {
  BarkKind kind = BarkKind::kSmooth;
  glm::vec3 color{0.5f};  ///< sRGB, [0, 1]: the raised surface
  glm::vec3 deep{0.2f};   ///< sRGB: furrows and marks
  glm::vec3 tint{0.5f};   ///< sRGB: patches (lichen, flakes)
  float relief = 1;       ///< depth of the normal map
  float width_m = 0.5f;   ///< what one texture spans
};

struct BarkTexture {
  Image color;   ///< sRGB, opaque
  Image normal;  ///< linear, tangent space, +Y up
};

/// Bark that tiles in both directions, `size` pixels a side; v runs along the stem. The same for
/// any number of threads.
BarkTexture makeBark(const BarkLook& look, int size, std::uint32_t seed);

}  // namespace verdure

#endif  // VERDURE_PLANT_BARK_TEXTURE_H_
