#include "shared/frame.h"
// Descriptor set 0, the same for every pass.
layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = 2) uniform sampler2D ground_texture;
layout(set = 0, binding = 3) uniform sampler2D ground_noise;
layout(set = 0, binding = 4) uniform sampler2D sky_image;     // upper half of the dome, frame units
layout(set = 0, binding = 5) uniform sampler2D ground_light;  // irradiance / pi, frame units
layout(set = 0, binding = 6) uniform sampler2D foliage_map;   // light_depth_pass, shared/foliage_shadow.h
