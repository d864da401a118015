#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A cartoon: shapes with a line around them, in three even tones.
const vec2 kBorders = vec2(0.46, 0.68);
const vec3 kLevels = vec3(0.36, 0.66, 1.0);

/// Reflectance as a clear colour.
vec3 clearColor(vec3 color) {
  vec3 bright = vec3(1.0) - exp(-3.6 * color);
  float l = luminanceOf(bright);
  return clamp(mix(vec3(l), bright, 1.2), 0.0, 1.0);
}

/// Shadows are bluer, light is warmer.
vec3 toned(vec3 color, float level) {
  return color * mix(vec3(0.86, 0.95, 1.15), vec3(1.08, 1.02, 0.90), level) * level;
}

void main() {
  float unit = unitInPixels();
  vec2 at = placeInPicture();
  vec3 behind = linearBackdrop(at);
  vec3 color = mix(vec3(luminanceOf(behind)), behind, 1.25);
  color = 1.25 * color / (1.0 + 0.25 * color);

  vec4 bark = textureLod(wood_layer, at, 0.0);
  Layer wood = layerOf(bark);
  Layer broad = layerAt(foliage_broad, at), wide = layerAt(foliage_wide, at);
  if (wood.cover > 0.0) {
    vec3 brown = textureLod(wood_color, at, 0.0).rgb / max(wood.cover, 1e-4);
    color = mix(color, toned(clearColor(brown), evenTone(wood.tone, 0.05, kBorders, kLevels)),
                wood.cover);
  }
  float distance = borderOf(foliage_fine, at, foliageThreshold(wide), 0.004);
  float shape = insideBorder(distance, 1.2);
  // Twigs among the leaves are hidden; what is clearly in front is not.
  float front = smoothstep(0.4, 1.0, wood.cover) *
                blurredDepthTest(wood.depth, 1.05 * broad.depth, 0.02);
  vec4 c = textureLod(foliage_color, at, 0.0);
  float level = evenTone(foliageTone(broad, broad, wide), toneSlope(foliage_broad, at), kBorders,
                         kLevels);
  vec3 leaf = toned(clearColor(c.rgb / max(c.a, 1e-4)), level);
  leaf = mix(behind, leaf, mix(0.55, 1.0, nearness(broad.depth)));
  color = mix(color, leaf, shape * (1.0 - front));
  float lines = lineAlong(distance, 2.0 * unit) * (1.0 - front);
  lines *= 1.0 - 0.8 * smoothstep(0.55, 0.85, wide.cover);
  lines = max(lines, max(barkInk(wood, at, 1.8 * unit), depthInk(max(round(unit), 1.0))) *
                         max(front, 1.0 - shape));
  writeLinear(color * mix(1.0, 0.06, lines));
}
