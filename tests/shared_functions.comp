#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared_functions.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Inputs { vec4 inputs[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Results { SharedResults results[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  results[i] = evaluateShared(inputs[2 * i], inputs[2 * i + 1]);
}
