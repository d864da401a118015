#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/illumination.h"
#include "shared/leaf.h"
#include "shared/sh.h"
#include "terms.glsl"
#include "coverage.glsl"
#include "impostor_set.glsl"
#include "impostor.glsl"
#include "sun_visibility.glsl"
#include "haze.glsl"
layout(location = 0) out vec4 out_color;

/// By what faces all ways about a mean normal: the bands' shares shrink with its length.
vec3 meanIrradiance(vec3 normal) {
  float size = length(normal);
  vec3 n = size > 1e-4 ? normal / size : vec3(0.0, 1.0, 0.0);
  vec3 here = shIrradiance(n, frame.open_light), there = shIrradiance(-n, frame.open_light);
  vec3 even = frame.open_light[0].rgb * 0.28209479;
  return max(even + 0.5 * size * (here - there) + size * size * (0.5 * (here + there) - even),
             vec3(0.0));
}

void main() {
  ImpostorKind kind = kinds[job.kind];
  Shown shown = shownThere(kind);
  uint random = scrambled(seat.x ^ 0x5bd1e995u);
  int count = int(floor(shown.covered * 4.0 + pixelThreshold(random)));
  int turned = int(random & 3u), mask = (1 << min(count, 4)) - 1;
  mask = ((mask << turned) | (mask >> (4 - turned))) & 15 & fadeMask(seat);
  gl_SampleMask[0] = mask;
  if (mask == 0) discard;

  vec3 n = turnedToWorld(shown.normal), l = frame.to_sun.xyz;
  vec3 v = normalize(frame.eye.xyz - position);
  vec3 color = mix(vec3(1.0), tintOf(seat), shown.light.g) * shown.color;
  vec3 k_t = 2.0 * shown.light.b * leafTransmittance(color);
  float k_a = kAmbientSource == kConstant || kAmbientSource == kSky ? 1.0 : shown.light.r;
  vec3 ambient = vec3(0.0);
  if (kAmbient) {
    bool constant = kAmbientSource == kConstant;
    ambient = color * k_a * (constant ? frame.open_sky.rgb : meanIrradiance(n));
    if (kTransmission)
      ambient += k_t * k_a * (constant ? frame.open_sky.rgb : meanIrradiance(-n));
  }
  vec3 diffuse = vec3(0.0);
  if (kDiffuse) {
    diffuse = color * meanCosine(n, l);
    if (kTransmission) diffuse += k_t * meanCosine(-n, l);
  }
  vec3 visibility = vec3(1.0);
  vec3 surface = position + v * (shown.nearer * scale);
  if (kShadow) {
    // Beyond the maps only what the plant's own leaves leave open is known.
    vec2 at = abs(cascadePosition(int(frame.to_sun.w) - 1, surface).xy - 0.5);
    float mapped = 1.0 - smoothstep(0.42, 0.48, max(at.x, at.y));
    visibility = vec3(smoothstep(0.0, 0.6, shown.light.r));
    if (mapped > 0.0)
      visibility = mix(visibility, sunVisibility(surface, v, kind.leaf, false), mapped);
  }
  vec3 lit = illumination(ambient, frame.sun_light.rgb, visibility, diffuse, 0.0, 0.0);
  out_color = vec4(clamp(hazed(lit, position), vec3(0.0), vec3(65000.0)), 1.0);
}
