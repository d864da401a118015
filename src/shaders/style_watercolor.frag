#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A painting in watercolour: washes of the sky and the ground, wood, and three layers of foliage,
// each of which lets through what is below it.

/// A pigment of the hue of `color` that leaves the luminance `l` of white.
vec3 pigment(vec3 color, float l) {
  vec3 hue = max(color, vec3(1e-4));
  vec3 p = hue * (l / luminanceOf(hue));
  float top = max(max(p.r, p.g), p.b);
  return top <= 0.98 ? p : mix(vec3(l), p, (0.98 - l) / max(top - l, 1e-4));
}

vec2 slopesOf(sampler2D layer, vec2 at, vec2 step) {  // of cover and tone, per pixel
  Layer l = layerAt(layer, at - vec2(step.x, 0.0)), r = layerAt(layer, at + vec2(step.x, 0.0));
  Layer u = layerAt(layer, at - vec2(0.0, step.y)), d = layerAt(layer, at + vec2(0.0, step.y));
  return 0.5 * vec2(length(vec2(r.cover - l.cover, d.cover - u.cover)),
                    length(vec2(r.tone - l.tone, d.tone - u.tone)));
}

void main() {
  float unit = unitInPixels();
  vec2 at = placeInPicture(), step = 1.0 / style.picture.xy;
  vec4 sheet = paperHere();
  float grain = granulated(sheet.r, 0.30);

  Layer fine = layerAt(foliage_fine, at), broad = layerAt(foliage_broad, at);
  Layer wide = layerAt(foliage_wide, at), wood = layerAt(wood_layer, at);
  vec2 fine_slopes = slopesOf(foliage_fine, at, step), broad_slopes = slopesOf(foliage_broad, at, step);

  // Where foliage is; its border wavers with the places that it covers.
  float waver = broad.noise - 0.5;
  float threshold = clamp(0.55 * wide.cover, 0.05, 0.42);
  float distance = borderDistance(fine.cover * (1.0 + 0.5 * waver), threshold,
                                  max(fine_slopes.x, 0.01));
  float shape = insideBorder(distance, 1.8 * unit);

  // The sheet's rim stays white.
  vec2 inside = min(gl_FragCoord.xy, style.picture.xy - gl_FragCoord.xy) / unit;
  float rim = min(inside.x, inside.y) - 14.0 - 26.0 * sheet.b + 5.0 * (sheet.r - 0.5);
  float washed = insideBorder(rim, 2.5) * (1.0 + 0.5 * pigmentAtBorder(rim, 3.0));

  vec3 color = bareSheet(sheet.r, unit);
  vec3 wash = linearBackdrop(at);
  float wet = mix(0.75, 1.25, sheet.g);
  // Painted around the plants rather than under them.
  color *= throughPigment(mix(wash, vec3(1.0), 0.12), washed * wet * grain * (1.0 - 0.8 * shape));

  // Wood sinks into the foliage in front of it.
  vec4 bark = textureLod(wood_color, at, 0.0);
  float open = mix(1.0, blurredDepthTest(wood.depth, broad.depth, 0.06), min(1.4 * broad.cover, 1.0));
  float wooden = wood.cover * open;
  if (wooden > 0.0) {
    vec3 brown = bark.rgb / max(bark.a, 1e-4);
    float shade = insideBorder(borderDistance(0.52, wood.tone, 0.04), 3.0);
    color *= throughPigment(pigment(brown, 0.42), wooden * wet * grain);
    color *= throughPigment(pigment(brown * vec3(0.9, 0.95, 1.15), 0.30), wooden * shade * grain);
  }

  if (shape > 0.0) {
    vec4 c = textureLod(foliage_color, at, 0.0);
    vec3 green = c.rgb / max(c.a, 1e-4);
    float flow = 1.0 + 0.9 * waver;
    float rimmed = 1.0 + 0.55 * pigmentAtBorder(distance, 2.2 * unit);
    color *= throughPigment(pigment(green * vec3(1.15, 1.1, 0.75), 0.62),
                            shape * flow * rimmed * grain);
    float d2 = borderDistance(0.66 + 0.10 * waver, broad.tone, max(broad_slopes.y, 0.002));
    float m2 = insideBorder(d2, 2.5 * unit) * shape;
    color *= throughPigment(pigment(green, 0.52),
                            m2 * flow * (1.0 + 0.4 * pigmentAtBorder(d2, 2.5 * unit)) * grain);
    float d3 = borderDistance(0.45 + 0.08 * waver, fine.tone, max(fine_slopes.y, 0.01));
    float m3 = insideBorder(d3, 2.0 * unit) * shape;
    color *= throughPigment(pigment(green * vec3(0.8, 0.95, 1.25), 0.42),
                            m3 * (1.0 + 0.3 * pigmentAtBorder(d3, 2.0 * unit)) * grain);
  }
  writeLinear(color);
}
