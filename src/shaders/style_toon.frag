#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A cartoon: shapes with a line around them, in three even tones.
const vec2 kBorders = vec2(0.46, 0.68);
const vec3 kLevels = vec3(0.34, 0.64, 1.0);

/// Reflectance as a clear colour.
vec3 clearColor(vec3 color) {
  vec3 bright = vec3(1.0) - exp(-3.4 * color);
  float l = luminanceOf(bright);
  return clamp(mix(vec3(l), bright, 1.25), 0.0, 1.0);
}

/// Shadows are bluer, light is warmer.
vec3 toned(vec3 color, float level) {
  return color * mix(vec3(0.86, 0.95, 1.12), vec3(1.06, 1.02, 0.92), level) * level;
}

float slopeOf(sampler2D layer, vec2 at, vec2 step, bool tone) {
  Layer l = layerAt(layer, at - vec2(step.x, 0.0)), r = layerAt(layer, at + vec2(step.x, 0.0));
  Layer u = layerAt(layer, at - vec2(0.0, step.y)), d = layerAt(layer, at + vec2(0.0, step.y));
  return tone ? 0.5 * length(vec2(r.tone - l.tone, d.tone - u.tone))
              : 0.5 * length(vec2(r.cover - l.cover, d.cover - u.cover));
}

void main() {
  float unit = unitInPixels();
  vec2 at = placeInPicture(), step = 1.0 / style.picture.xy;
  vec3 color = linearBackdrop(at);

  vec4 bark = textureLod(wood_layer, at, 0.0);
  Layer wood = layerOf(bark);
  Layer leaves = layerAt(foliage_fine, at), broad = layerAt(foliage_broad, at);
  Layer wide = layerAt(foliage_wide, at);
  float lines = 0.0;
  if (wood.cover > 0.0) {
    vec3 wood_tone = toned(clearColor(textureLod(wood_color, at, 0.0).rgb / max(wood.cover, 1e-4)),
                           evenTone(wood.tone, 0.05, kBorders, kLevels));
    color = mix(color, wood_tone, wood.cover);
  }
  float threshold = clamp(0.6 * wide.cover, 0.08, 0.45);
  float distance = borderDistance(leaves.cover, threshold, slopeOf(foliage_fine, at, step, false));
  float shape = insideBorder(distance, 1.2);
  float front = wood.cover * blurredDepthTest(wood.depth, broad.depth, 0.01);
  if (shape > 0.0) {
    vec4 c = textureLod(foliage_color, at, 0.0);
    float level = evenTone(broad.tone, slopeOf(foliage_broad, at, step, true), kBorders, kLevels);
    vec3 leaf = toned(clearColor(c.rgb / max(c.a, 1e-4)), level);
    color = mix(color, leaf, shape * (1.0 - front));
    lines = shape * (1.0 - insideBorder(distance - 1.6 * unit, 1.2)) * (1.0 - front);
  }
  lines = max(lines, depthInk(max(round(unit), 1.0)) * max(wood.cover, 1.0 - shape));
  writeLinear(color * mix(1.0, 0.06, lines));
}
