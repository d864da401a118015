#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/sky.h"

layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 out_color;

void main() {
  out_color = vec4(skyColor(normalize(ray), frame.sky_horizon.rgb, frame.sky_zenith.rgb), 1.0);
}
