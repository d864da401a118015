#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "terms.glsl"
#include "instance.glsl"
#include "motion.glsl"

layout(push_constant) uniform CascadeBlock { layout(offset = 112) uint cascade; };
layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uint out_mirrored;

void main() {
  vec3 moved = movedVertex(position, vec3(0.0, 1.0, 0.0), false).position;
  vec3 at = (frame.shadow_from_world[cascade] * vec4(worldFromPlant(moved), 1.0)).xyz;
  gl_Position = vec4(at.xy * 2.0 - 1.0, at.z, 1.0);
  out_uv = uv;
  out_mirrored = isMirrored() ? 1u : 0u;
}
