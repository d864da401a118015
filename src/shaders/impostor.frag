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
    // Of light from all around, leaves of an index of 1.45 mirror 0.09 on their glossy side.
    if (kGloss)
      ambient += 0.045 * shown.light.g * k_a * (constant ? frame.open_sky.rgb : meanIrradiance(n));
  }
  vec3 diffuse = vec3(0.0);
  if (kDiffuse) {
    diffuse = color * meanCosine(n, l);
    if (kTransmission) diffuse += k_t * meanCosine(-n, l);
  }
  vec3 visibility = vec3(1.0);
  if (kShadow) {
    // What shades it of its own crown is known on the mean; the maps tell the rest.
    vec3 ray = normalize(local - local_eye);
    vec3 from = (local - ray * shown.nearer - kind.crown.xyz) / kind.radii.xyz;
    vec3 to_sun = turnedToPlant(l) / kind.radii.xyz;
    float way = wayThroughCrown(from, to_sun);
    vec3 passed = vec3(0.0);  // by a leaf
    if (kShadowSource != kShadowMap) passed = exp(-kind.leaf.w * kind.leaf.rgb);
    visibility = exp(-kind.crown.w * way * (vec3(1.0) - passed) * shown.light.g);
    float out_m = (way / max(length(to_sun), 1e-6) + 0.02 * kind.sphere.w) * scale;
    vec3 outside = position + v * (shown.nearer * scale) + l * out_m;
    visibility *= sunVisibility(outside, l, kind.leaf, false);
  }
  // Leaves are glossy on their fronts: half of what facets mirror that face both ways.
  float mirrored = 0.0;
  if (kGloss) mirrored = 0.5 * shown.light.g * mirroredByLeaves(kind.radii.w, l, v);
  vec3 lit = illumination(ambient, frame.sun_light.rgb, visibility, diffuse, 1.0, mirrored);
  out_color = vec4(clamp(hazed(lit, position), vec3(0.0), vec3(65000.0)), 1.0);
}
