#include "dome_light.glsl"

/// Unit direction from the eye through the pixel's centre. Interpolated positions would not do: at
/// the horizon a pixel's centre may lie off the triangle that covers some of its samples, where the
/// plane of the ground is behind the eye.
vec3 pixelDirection() {
  vec2 at = gl_FragCoord.xy * vec2(frame.ray_right.w, frame.ray_down.w) - 1.0;
  return normalize(frame.ray_forward.xyz + at.x * frame.ray_right.xyz + at.y * frame.ray_down.xyz);
}
