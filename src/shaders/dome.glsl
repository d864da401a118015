#include "shared/sky.h"
#include "shared/sky_formula.h"

/// Unit direction from the eye through the pixel's centre. Interpolated positions would not do: at
/// the horizon a pixel's centre may lie off the triangle that covers some of its samples, where the
/// plane of the ground is behind the eye.
vec3 pixelDirection() {
  vec2 at = gl_FragCoord.xy * vec2(frame.ray_right.w, frame.ray_down.w) - 1.0;
  return normalize(frame.ray_forward.xyz + at.x * frame.ray_right.xyz + at.y * frame.ray_down.xyz);
}

/// Luminance of the sky towards a unit direction, frame units, without the sun's disk.
vec3 domeLuminance(vec3 direction) {
  vec3 d = domeDirection(direction);
  if (kFormulaSky) return skyLuminance(d, frame.sky) * frame.eye.w;
  // Level 0: the seam of the azimuths must not look like a long footprint.
  return textureLod(sky_image, domeCoordinates(d), 0.0).rgb;
}

/// What a colour target of half floats may hold.
vec3 storable(vec3 color) {
  return min(color, vec3(65000.0));
}
