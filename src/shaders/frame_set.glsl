#include "shared/frame.h"
// Descriptor set 0, the same for every pass.
layout(set = 0, binding = 0, std140) uniform FrameBlock { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DArrayShadow shadow_map;  // by cascade
layout(set = 0, binding = 2) uniform sampler2D ground_texture;
layout(set = 0, binding = 3) uniform sampler2D ground_noise;
layout(set = 0, binding = 4) uniform sampler2D sky_image;     // upper half of the dome, frame units
layout(set = 0, binding = 5) uniform sampler2D ground_light;  // irradiance / pi, frame units
layout(set = 0, binding = 6) uniform sampler2DArray foliage_map;   // shared/foliage_shadow.h
layout(set = 0, binding = 7) uniform sampler2DArray blocker_map;   // blocker_pass.frag
