#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "terms.glsl"
#include "dome.glsl"

layout(location = 0) out vec4 out_color;

/// Share of a pixel that the sun's disk covers: a ramp two pixels wide, scaled so that the disk's
/// light is the same however coarse the pixels are and wherever it lies between them.
float sunCoverage(vec3 direction) {
  float radius = frame.sun_disk.w;
  float pixel = max(length(dFdx(direction)), length(dFdy(direction)));
  float angle = 2.0 * asin(min(0.5 * length(direction - frame.to_sun.xyz), 1.0));
  float drawn = max(radius, pixel);  // a smaller disk would fall between the pixels
  float ramp = clamp((drawn - angle) / (2.0 * pixel) + 0.5, 0.0, 1.0);
  return ramp * radius * radius / (drawn * drawn + pixel * pixel / 3.0);
}

void main() {
  if (kBackground) {
    out_color = vec4(0.0);
    return;
  }
  vec3 direction = pixelDirection();
  float coverage = sunCoverage(direction);
  vec3 color = domeLuminance(direction);
  if (direction.y >= 0.0) color += frame.sun_disk.rgb * coverage;
  out_color = vec4(storable(color), 1.0);
}
