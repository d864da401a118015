#ifndef VERDURE_SHARED_FRAME_H_
#define VERDURE_SHARED_FRAME_H_

#include "cascade.h"
#include "portable.h"
#include "sky_formula.h"

// What the shaders of one frame share. Only mat4 and vec4: std140 and C++ agree on them.
// Light is in frame units: kcd/m^2 times a power of two that brings the brightest thing (the sun's
// disk by day) just below the largest half float.

SHARED_BEGIN

/// Half-shadows are at most this wide, texels: few taps further apart would be seen one by one.
const float kWidestShadow = 24.0f;

struct FrameUniforms {
  mat4 clip_from_world;
  mat4 shadow_from_world[kMostCascades];  ///< x, y in [0, 1] over each layer, z = its depth
  vec4 cascade[kMostCascades];  ///< size of a texel, m; that of the next cascade / it; origin
  vec4 eye;                     ///< xyz; w = frame units of 1 kcd/m^2
  vec4 to_sun;                  ///< unit; w = number of cascades
  vec4 sun_light;  ///< irradiance / pi of a surface facing the sun; w = 1 / size of the map
  vec4 sun_disk;   ///< luminance; w = angular radius
  vec4 open_sky;   ///< irradiance / pi of open ground by the sky; w = exponent of leaf visibility
  vec4
      ground;  ///< height, radius of the disc, half distance of the haze, size of a texture tile, m
  vec4 ground_map;  ///< corner x, z of the map of light on the ground, 1 / its size, m; 0 = none
  vec4 ray_right;   ///< ray through (x, y) of [-1, 1]^2: forward + x right + y down; w = 2 / width
  vec4 ray_down;    ///< w = 2 / height, pixels
  vec4 ray_forward;
  vec4 open_light[9];         ///< shIrradiance() / pi by the open sky and the open ground
  vec4 leaf_tint;             ///< leafTint() of the scene's foliage, mean
  SkyFormula sky;             ///< kcd/m^2, where the sky has one
  mat4 last_clip_from_world;  ///< of the last frame
};
SHARED_SIZE(FrameUniforms, 896);

/// Push constants of one draw. Behind them, for the vertex stage of maps seen from the sun: uint
/// cascade.
struct DrawUniforms {
  vec4 color;  ///< linear RGB; w = alpha, both multiply the texture
  vec4 matt;   ///< colour without textures: the material's mean; w = optical thickness, 0 = unknown
  vec4 surface;  ///< alpha cutoff of the texture, normal map's scale; of its gloss what facets
                 ///< reflect squarely, and the strength of all
  vec4 leaf;     ///< leafTint() of the plant's foliage; w = leafOpticalDepth()
  vec4
      leaf_light;  ///< of LeafTextures: scale and offset of the front's coefficients, of the back's
  vec4 leaf_gloss;    ///< roughness of the front, of the back, refractive index; w = slope of its
                      ///< bumps
  vec4 transmission;  ///< DiffuseTransmission: colour; w = factor
};
SHARED_SIZE(DrawUniforms, 112);

/// Push constants of tone_pass.
struct ToneUniforms {
  vec4 background;  ///< linear display RGB
  float key;        ///< scaled luminance of the average
  float white;      ///< smallest scaled luminance that is pure white; 0 = automaticWhite()
  float average;    ///< frame units; 0 = as measured
  float bloom;      ///< share of light that is spread
};
SHARED_SIZE(ToneUniforms, 32);

/// Push constants of transfer_pass. A vertex has, for its front and (two-sided) its back, `pairs`
/// words for each colour channel, then `bounce_pairs`.
struct TransferUniforms {
  uint count;                ///< vertices of this part
  uint first_vertex;         ///< of the light that is written
  uint pairs;                ///< of coefficients by the sky
  uint bounce_pairs;         ///< of the bounced part's, by the sun
  uint first_weight;         ///< of the sky's weights for this number of bands
  uint first_bounce_weight;  ///< of the sun's
  uint two_sided;            ///< 0 or 1
};
SHARED_SIZE(TransferUniforms, 28);

SHARED_END

#endif  // VERDURE_SHARED_FRAME_H_
