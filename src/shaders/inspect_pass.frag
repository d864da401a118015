#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame_set.glsl"
#include "shared/color.h"
#include "terms.glsl"
#include "coverage.glsl"
#include "cascades.glsl"
#include "foliage_shadow.glsl"
// One quantity of a surface instead of its light; Inspection of render/inspect_pass.h.
layout(set = 1, binding = 0) uniform sampler2D base_color;
layout(push_constant) uniform DrawBlock { DrawUniforms draw; };
layout(location = 0) in vec3 position;
layout(location = 1) centroid in vec4 in_normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint seed;
layout(location = 4) flat in int level;
layout(location = 5) flat in uvec2 seat;
layout(location = 0) out vec4 out_color;

layout(constant_id = 21) const int kInspect = 0;  // behind those of terms.glsl
const int kNormals = 1, kCoefficient = 2, kLayers = 3, kLevel = 4, kTexels = 5, kColor = 6;
const float kMostLayers = 12.0;
// Okabe and Ito's colours, told apart by all eyes: trunk, then its branches, theirs, and the rest.
const vec3 kLevelColors[4] =
    vec3[](vec3(0.84, 0.37, 0.0), vec3(0.94, 0.89, 0.26), vec3(0.0, 0.62, 0.45), vec3(0.34, 0.71, 0.91));

/// From blue over white to red as x goes from 0 to 1.
vec3 blueToRed(float x) {
  float t = clamp(x, 0.0, 1.0);
  vec3 low = mix(vec3(0.13, 0.35, 0.75), vec3(0.95), min(2.0 * t, 1.0));
  return mix(low, vec3(0.76, 0.12, 0.12), max(2.0 * t - 1.0, 0.0));
}

/// How many leaves the sun's light has gone through.
float leafLayersAt(vec3 world_position) {
  int cascade = chooseCascades(world_position).coarse;
  vec3 at = cascadePosition(cascade, world_position);
  if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return 0.0;
  LeafLayers layers = leafLayers(foliageTap(cascade, at.xy));
  return layers.covered * spreadDepth(layers, at.z) / max(draw.leaf.w, 1e-3);
}

/// The colour as the display's values.
vec3 inspected(vec4 texel, float footprint) {
  vec3 n = dot(in_normal.xyz, in_normal.xyz) > 1e-12 ? normalize(in_normal.xyz) : vec3(0, 1, 0);
  if (kFlipNormal && !gl_FrontFacing) n = -n;
  if (kInspect == kNormals) return 0.5 + 0.5 * n;
  if (kInspect == kCoefficient) return vec3(in_normal.w);
  if (kInspect == kLayers) return blueToRed(leafLayersAt(position) / kMostLayers);
  if (kInspect == kLevel)
    return (level < 0 ? vec3(0.6) : kLevelColors[min(level, 3)]) * (kFoliage ? 0.75 : 1.0);
  // White: one texel a pixel; red: four and more, wasted; blue: a quarter and less, blurred.
  if (kInspect == kTexels) return blueToRed(0.5 + 0.25 * log2(max(footprint, 1e-6)));
  vec3 color = texel.rgb * draw.color.rgb;
  for (int i = 0; i < 3; ++i) color[i] = srgbFromLinear(clamp(color[i], 0.0, 1.0));
  return color;
}

void main() {
  vec2 uv_x = dFdx(uv), uv_y = dFdy(uv);
  vec4 texel = textureGrad(base_color, uv, uv_x, uv_y);
  int mask = kForest ? fadeMask(seat) : 15;
  if (kAlphaTest) mask &= coverageMask(texel.a, draw.surface.x, seed);
  gl_SampleMask[0] = mask;
  if (mask == 0) discard;
  vec2 size = vec2(textureSize(base_color, 0));
  vec3 shown = inspected(texel, max(length(uv_x * size), length(uv_y * size)));
  vec3 linear;
  for (int i = 0; i < 3; ++i) linear[i] = linearFromSrgb(clamp(shown[i], 0.0, 1.0));
  out_color = vec4(linear * frame.eye.w, 1.0);  // in frame units, 1 where it is to be white
}
