#ifndef VERDURE_PLANT_LEAF_TEXTURE_H_
#define VERDURE_PLANT_LEAF_TEXTURE_H_

#include <cstdint>
#include <glm/glm.hpp>

#include "plant/leaf_shape.h"
#include "verdure/image.h"

namespace verdure {

struct LeafLook {
  glm::vec3 color{0.3f, 0.45f, 0.2f};  ///< sRGB, [0, 1]
  glm::vec3 other{0.4f, 0.5f, 0.2f};   ///< sRGB: what some leaves and patches turn to
  glm::vec3 vein{0.5f, 0.6f, 0.35f};   ///< sRGB: midrib, veins and stalk
};

/// 2 x 2 variants of a leaf, `size` pixels a side altogether: sRGB colour with the outline in
/// alpha. In each quarter the foot of the stalk is at the middle of the lower edge and the tip at
/// the middle of the upper one. Colours go on outside the outline, so that filtering shows no
/// fringe. `leaf_scale_x`: width of the leaf by its length. The same for any number of threads.
Image makeLeafTexture(LeafShape shape, const LeafLook& look, float leaf_scale_x, int size,
                      std::uint32_t seed);

}  // namespace verdure

#endif  // VERDURE_PLANT_LEAF_TEXTURE_H_
