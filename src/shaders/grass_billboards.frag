#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/sh.h"
#include "terms.glsl"
#include "dome_light.glsl"
#include "ground.glsl"
#include "sun_visibility.glsl"
#include "grass_set.glsl"
#include "grass_place.glsl"
#include "grass_light.glsl"

// What grass_pass.frag composites along a ray, one polygon at a time: the baseline of table 2.1 of
// Habel 2009.
layout(location = 0) centroid in vec3 from_eye;
layout(location = 1) centroid in vec4 picture;
layout(location = 2) centroid in vec4 tint;
layout(location = 3) centroid in vec4 sideways;
layout(location = 4) centroid in vec4 haze;
layout(location = 5) flat in uvec2 slice;
layout(location = 0) out vec4 out_color;

void main() {
  float t = length(from_eye), density = tint.w;
  vec3 direction = from_eye / t;
  bool across_u = slice.y == 0u;
  vec3 right = axisOf(across_u), up = vec3(0.0, 1.0, 0.0), toward = cross(right, up);
  float across = dot(toward, direction);
  float lod = sliceLod(t, abs(across));
  float at_rest = picture.y / sideways.w * picture.z;
  vec3 uv = slicePicture(across_u, slice.x, picture.x - picture.w * bendShape(at_rest, grass.shell.x),
                         at_rest);
  vec4 color = textureLod(slice_colors, uv, lod);
  if (color.a <= 0.0) discard;
  vec4 data = unpackGrassData(textureLod(slice_data, uv, lod));
  thin(color, data, density, 0.0, lod);
  if (color.a <= 0.002) discard;
  Met met = kNothingMet;
  bool behind = across > 0.0;
  meet(met, color, data, right, up, behind ? -toward : toward, behind, picture.y, t, tint.rgb, density,
       lightAt(from_eye, sideways.rgb, direction));
  vec3 lit = met.color + met.sunlit * frame.sun_light.rgb * shadowAt(from_eye);
  out_color = vec4(storable(lit * (1.0 - haze.w) + haze.rgb * met.alpha),
                   kBackground ? met.alpha * (1.0 - haze.w) : met.alpha);
}
