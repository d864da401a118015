#ifndef VERDURE_RENDER_LOOK_H_
#define VERDURE_RENDER_LOOK_H_

#include <glm/glm.hpp>

#include "scene/look.h"

// The constants of the picture's look, in one place.

namespace verdure::look {

// Coefficients of (1). k_a and k_d are the surface's colour times 1; sky and sun are in physical
// units. Leaves have a waxy, broad highlight, bark nearly none.
inline constexpr float kLeafSpecular =
    kFacetReflectance / (4.0f * kLeafGlossWidth * kLeafGlossWidth);  // 0.06
inline constexpr float kLeafExponent = 12.0f;
inline constexpr float kWoodSpecular =
    kFacetReflectance / (4.0f * kWoodGlossWidth * kWoodGlossWidth);  // 0.015
inline constexpr float kWoodExponent = 8.0f;

// Radius of the ground's disc, in half distances of its haze.
inline constexpr float kGroundRadius = 2000.0f;

}  // namespace verdure::look

#endif  // VERDURE_RENDER_LOOK_H_
