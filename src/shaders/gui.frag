#version 460
// Colours are sRGB values, as the window takes them, and blended as such.
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 out_color;

void main() {
  vec4 covered = color * texture(image, uv);
  out_color = vec4(covered.rgb * covered.a, covered.a);
}
