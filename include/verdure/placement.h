#ifndef VERDURE_PLACEMENT_H_
#define VERDURE_PLACEMENT_H_

#include <cstdint>
#include <glm/glm.hpp>

namespace verdure {

/// A plant at a place: rotation about +Y (radians), then uniform scale, then translation (m).
struct Placement {
  std::uint32_t plant = 0;  ///< index into the group's plants
  glm::vec3 position{0.0f};
  float angle = 0.0f;
  float scale = 1.0f;             ///< above 0
  std::uint32_t tint = 0xffffff;  ///< of its foliage: 0xRRGGBB, linear, times its colours
  std::uint32_t phase = 0;        ///< plants with different ones do not move in unison
};
static_assert(sizeof(Placement) == 32);

/// world_from_plant.
glm::mat4 matrixOf(const Placement& place);

}  // namespace verdure

#endif  // VERDURE_PLACEMENT_H_
