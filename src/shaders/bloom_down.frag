#version 460
// Half the size: four bilinear taps at the corners of the inner texels average 4 x 4 of them.
layout(set = 0, binding = 0) uniform sampler2D finer;
layout(set = 0, binding = 1) uniform sampler2D unused;
layout(location = 0) out vec4 out_color;

void main() {
  vec2 size = vec2(textureSize(finer, 0));
  vec2 target = max(floor(size * 0.5), vec2(1.0));
  vec2 at = gl_FragCoord.xy / target;
  vec2 step = 1.0 / size;
  out_color = 0.25 * (textureLod(finer, at - step, 0.0) + textureLod(finer, at + step, 0.0) +
                      textureLod(finer, at + vec2(step.x, -step.y), 0.0) +
                      textureLod(finer, at + vec2(-step.x, step.y), 0.0));
}
