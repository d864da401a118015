#ifndef VERDURE_SCENE_LOOK_H_
#define VERDURE_SCENE_LOOK_H_

// What the renderer and the reference must agree on so that their pictures compare.

namespace verdure::look {

// Ground: textures' sides in pixels, side of a tile, and the distance at which haze hides half, in
// distances of the camera from its target (and at least in metres).
inline constexpr int kGroundTextureSize = 512;
inline constexpr int kGroundNoiseSize = 128;
inline constexpr float kGroundTile_m = 2.4f;
inline constexpr float kHazeHalf = 22.0f;
inline constexpr float kHazeHalfLeast_m = 80.0f;

// Added to every luminance before its logarithm, kcd/m^2: far below a starlit sky.
inline constexpr float kLeastLuminance = 1e-9f;

}  // namespace verdure::look

#endif  // VERDURE_SCENE_LOOK_H_
