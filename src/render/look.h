#ifndef VERDURE_RENDER_LOOK_H_
#define VERDURE_RENDER_LOOK_H_

#include <glm/glm.hpp>

#include "scene/look.h"

// The constants of the picture's look, in one place.

namespace verdure::look {

// Exponents of the sun's highlight in (1). k_a and k_d are the surface's colour times 1, k_s
// follows from the gloss (shared/gloss.h); sky and sun are in physical units.
inline constexpr float kLeafExponent = 12.0f;
inline constexpr float kWoodExponent = 8.0f;

// Radius of the ground's disc, in half distances of its haze.
inline constexpr float kGroundRadius = 2000.0f;

}  // namespace verdure::look

#endif  // VERDURE_RENDER_LOOK_H_
