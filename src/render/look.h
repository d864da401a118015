#ifndef VERDURE_RENDER_LOOK_H_
#define VERDURE_RENDER_LOOK_H_

#include <glm/glm.hpp>

#include "scene/look.h"

// The constants of the picture's look, in one place.

namespace verdure::look {

// Radius of the ground's disc, in half distances of its haze.
inline constexpr float kGroundRadius = 2000.0f;

}  // namespace verdure::look

#endif  // VERDURE_RENDER_LOOK_H_
