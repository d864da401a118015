#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "terms.glsl"
#include "instance.glsl"
#include "motion.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec3 out_now;   // clip x, y, w
layout(location = 2) out vec3 out_last;

void main() {
  vec3 up = vec3(0.0, 1.0, 0.0);
  vec4 now = frame.clip_from_world * vec4(worldFromPlant(movedVertex(position, up, false).position), 1.0);
  vec4 last =
      frame.last_clip_from_world * vec4(worldFromPlant(movedVertex(position, up, true).position), 1.0);
  out_uv = uv;
  out_now = now.xyw;
  out_last = last.xyw;
  gl_Position = now;
}
