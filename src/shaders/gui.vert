#version 460
// Panels over the picture; positions are pixels of the window.
layout(push_constant) uniform PlaceBlock {
  vec2 origin;
  vec2 clip_per_pixel;
};
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 color;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

void main() {
  out_uv = uv;
  out_color = color;
  gl_Position = vec4((position - origin) * clip_per_pixel - 1.0, 0.0, 1.0);
}
