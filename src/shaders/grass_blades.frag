#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/sh.h"
#include "terms.glsl"
#include "dome.glsl"
#include "ground.glsl"
#include "sun_visibility.glsl"
#include "grass_set.glsl"
#include "grass_place.glsl"
#include "grass_light.glsl"

layout(location = 0) centroid in vec3 from_eye;
layout(location = 1) centroid in vec3 in_normal;
layout(location = 2) centroid in vec4 in_color;
layout(location = 3) centroid in vec3 place;
layout(location = 4) centroid in vec3 tint;
layout(location = 0) out vec4 out_color;

// A ribbon of a plant near the eye, lit as a texel of a slice is.
void main() {
  float distance = length(from_eye);
  vec3 direction = from_eye / distance;
  // Where a ribbon turns its edge to the eye, normals of its two sides cancel.
  vec3 normal = dot(in_normal, in_normal) > 1e-6 ? normalize(in_normal) : -direction;
  if (dot(normal, direction) > 0.0) normal = -normal;
  Met met = kNothingMet;
  meetFacing(met, vec4(clamp(in_color.rgb, 0.0, 1.0), 1.0), facingOf(normal), kTransmission ? in_color.a : 0.0, place.x, distance,
             tint, place.y, lightAt(from_eye, sidewaysLight(direction), direction));
  vec3 lit = met.color + met.sunlit * frame.sun_light.rgb * shadowAt(from_eye);
  float haze = hazeShare(distance, frame.ground.z);
  vec3 far = kBackground ? vec3(0.0) : domeLuminance(direction);
  out_color = vec4(storable(mix(lit, far, haze)), kBackground ? 1.0 - haze : 1.0);
}
