#ifndef VERDURE_RENDER_LOOK_H_
#define VERDURE_RENDER_LOOK_H_

#include <glm/glm.hpp>

#include "scene/look.h"

// The constants of the picture's look, in one place.

namespace verdure::look {

// Coefficients of (1). k_a and k_d are the surface's colour times 1: the balance of sky and sun
// lies in View's light colours. Leaves have a waxy, broad highlight, bark nearly none.
inline constexpr float kLeafSpecular = 0.06f;
inline constexpr float kLeafExponent = 12.0f;
inline constexpr float kWoodSpecular = 0.015f;
inline constexpr float kWoodExponent = 8.0f;

// A clear summer sky, linear RGB.
inline constexpr glm::vec3 kSkyHorizon{0.66f, 0.78f, 0.90f};
inline constexpr glm::vec3 kSkyZenith{0.13f, 0.32f, 0.72f};

// Radius of the ground's disc, in half distances of its haze.
inline constexpr float kGroundRadius = 2000.0f;

}  // namespace verdure::look

#endif  // VERDURE_RENDER_LOOK_H_
