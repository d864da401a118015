#ifndef VERDURE_RENDER_LOOK_H_
#define VERDURE_RENDER_LOOK_H_

#include <glm/glm.hpp>

// The constants of the picture's look, in one place.

namespace verdure::look {

// Coefficients of (1). k_a and k_d are the surface's colour times 1; sky and sun are in physical
// units. Leaves have a waxy, broad highlight, bark nearly none.
inline constexpr float kLeafSpecular = 0.06f;
inline constexpr float kLeafExponent = 12.0f;
inline constexpr float kWoodSpecular = 0.015f;
inline constexpr float kWoodExponent = 8.0f;

// Added to every luminance before its logarithm, kcd/m^2: far below a starlit sky.
inline constexpr float kLeastLuminance = 1e-9f;

// Ground: side of a tile of the texture, radius of the disc and distance at which haze hides half,
// the latter two in distances of the camera from its target (and at least in metres).
inline constexpr float kGroundTile_m = 2.4f;
inline constexpr float kGroundRadius = 2000.0f;
inline constexpr float kHazeHalf = 22.0f;
inline constexpr float kHazeHalfLeast_m = 80.0f;

}  // namespace verdure::look

#endif  // VERDURE_RENDER_LOOK_H_
