#ifndef VERDURE_SHARED_FRAME_H_
#define VERDURE_SHARED_FRAME_H_

#include "portable.h"

// What the shaders of one frame share. Only mat4 and vec4: std140 and C++ agree on them.

SHARED_BEGIN

struct FrameUniforms {
  mat4 clip_from_world;
  mat4 shadow_from_world;  ///< x, y in [0, 1] over the shadow map, z = its depth
  vec4 eye;                ///< xyz
  vec4 to_sun;             ///< unit; w = size of a shadow map texel, m
  vec4 sun_color;          ///< w = 1 / size of the shadow map
  vec4 ambient_color;
  vec4 sky_horizon;
  vec4 sky_zenith;
  vec4
      ground;  ///< height, radius of the disc, half distance of the haze, size of a texture tile, m
  vec4 ray_right;  ///< ray through pixel (x, y) of [-1, 1]^2: forward + x right + y down
  vec4 ray_down;
  vec4 ray_forward;
};
SHARED_SIZE(FrameUniforms, 288);

/// Push constants of one draw.
struct DrawUniforms {
  vec4 color;    ///< linear RGB; w = alpha, both multiply the texture
  vec4 matt;     ///< colour without textures: the material's mean
  vec4 surface;  ///< alpha cutoff of the texture, normal map's scale, k_s, exponent
};
SHARED_SIZE(DrawUniforms, 48);

SHARED_END

#endif  // VERDURE_SHARED_FRAME_H_
