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

// The ground that grass grows on, without its slices.
layout(location = 0) centroid in vec3 from_eye;
layout(location = 0) out vec4 out_color;

void main() {
  float t = length(from_eye);
  vec3 direction = from_eye / t;
  vec2 at = vec2(dot(grass.rows.xy, from_eye.xz), dot(grass.rows.zw, from_eye.xz));
  Met met = kNothingMet;
  meetLevel(met, grass.eye.zw + at, t, direction, 0.0, 1.0, terrainNormal(from_eye.xz), 0.0,
            clamp(coverAt(from_eye.xz), 0.0, 1.0), 0.0, grassTint(frame.eye.xz + from_eye.xz, t),
            lightAt(from_eye, sidewaysLight(direction), direction));
  vec3 lit = met.color + met.sunlit * frame.sun_light.rgb * shadowAt(from_eye);
  float haze = hazeShare(t, frame.ground.z);
  vec3 far = kBackground ? vec3(0.0) : domeLuminance(direction);
  out_color = vec4(storable(mix(lit, far, haze)), kBackground ? 1.0 - haze : 1.0);
}
