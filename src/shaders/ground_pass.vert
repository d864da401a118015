#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"

// A disc around the eye, as a fan of kSlices triangles; no vertex buffers.
const int kSlices = 64;

void main() {
  int corner = gl_VertexIndex % 3;
  float angle = float(gl_VertexIndex / 3 + (corner == 2 ? 1 : 0)) * (6.28318531 / float(kSlices));
  vec2 rim = corner == 0 ? vec2(0.0) : vec2(cos(angle), sin(angle)) * frame.ground.y;
  gl_Position = frame.clip_from_world *
                vec4(frame.eye.x + rim.x, frame.ground.x, frame.eye.z + rim.y, 1.0);
}
