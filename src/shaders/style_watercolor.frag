#version 460
#extension GL_GOOGLE_include_directive : require
#include "style_set.glsl"
// A painting in watercolour: washes of the sky and the ground, wood, and three layers of foliage,
// each of which lets through what is below it.

/// A pigment of a colour's hue that leaves the luminance `l` of white; `pure`: share of its chroma.
vec3 pigment(vec3 color, float l, float pure) {
  vec3 hue = max(color, vec3(1e-4));
  vec3 p = mix(vec3(l), hue * (l / luminanceOf(hue)), pure);
  float top = max(max(p.r, p.g), p.b);
  return top <= 0.97 ? p : mix(vec3(l), p, (0.97 - l) / max(top - l, 1e-4));
}

/// A layer of pigment: denser at its border, in pixels, which dries last.
float glaze(float distance, float softness, float rim, float unit) {
  float inside = insideBorder(distance, softness * unit);
  return inside * (1.0 + rim * pigmentAtBorder(distance, 1.8 * unit));
}

void main() {
  float unit = unitInPixels();
  vec2 at = placeInPicture();
  vec4 sheet = paperHere();
  float grain = granulated(sheet.r, 0.14);

  Layer fine = layerAt(foliage_fine, at), broad = layerAt(foliage_broad, at);
  Layer wide = layerAt(foliage_wide, at), wood = layerAt(wood_layer, at);

  // Borders waver with the places that they cover.
  float waver = broad.noise - 0.5;
  float distance = borderOf(foliage_fine, at, foliageThreshold(wide) * (1.0 - 0.4 * waver), 0.02);
  float shape = insideBorder(distance, 1.6 * unit);

  vec3 color = bareSheet(sheet.r, unit);
  // The wash ends before the sheet does, here and there with too little water for the valleys.
  vec2 inside = min(gl_FragCoord.xy, style.picture.xy - gl_FragCoord.xy) / unit;
  float rim = min(inside.x, inside.y) - 8.0 - 34.0 * sheet.b * sheet.b + 4.0 * (sheet.r - 0.5);
  float washed = glaze(rim * unit, 2.5, 0.35, unit);
  vec3 sky = linearBackdrop(at);
  float wet = mix(0.35, 1.35, sheet.g);
  // White is the paper's own.
  float light = luminanceOf(sky);
  vec3 wash = pigment(sky, mix(0.38, 0.80, sqrt(light)) + 0.2 * pow(light, 8.0), 1.15);
  // Painted around the plants rather than under them.
  color *= throughPigment(wash, washed * wet * grain * (1.0 - 0.85 * shape));

  // Wood sinks into the foliage in front of it.
  vec4 bark = textureLod(wood_color, at, 0.0);
  float open = mix(1.0, blurredDepthTest(wood.depth, broad.depth * 1.03, 0.05),
                   min(1.4 * broad.cover, 1.0));
  vec3 brown = bark.rgb / max(bark.a, 1e-4);
  float wooden = wood.cover * open * grain * mix(0.3, 1.0, nearness(wood.depth));
  float pale = smoothstep(0.12, 0.5, luminanceOf(brown));
  color *= throughPigment(pigment(brown, mix(0.36, 0.85, pale), 1.0),
                          wooden * mix(0.8, 1.2, sheet.g));
  float shaded = insideBorder(borderDistance(0.52, wood.tone, 0.04), 3.0);
  color *= throughPigment(pigment(brown * vec3(0.8, 0.9, 1.2), mix(0.30, 0.62, pale), 0.9),
                          wooden * shaded);

  if (shape > 0.0) {
    vec4 c = textureLod(foliage_color, at, 0.0);
    vec3 green = c.rgb / max(c.a, 1e-4);
    float near = nearness(broad.depth);
    float flow = (1.0 + 0.8 * waver) * grain * mix(0.4, 1.0, near);
    green = mix(luminanceOf(green) * vec3(0.8, 1.0, 1.5), green, mix(0.4, 1.0, near));
    // Warmer here, cooler there: pigments part as they flow.
    green *= vec3(1.0 + 0.5 * waver, 1.0, 1.0 - 0.5 * waver);
    float tone = foliageTone(broad, broad, wide) + 0.06 * waver;
    color *= throughPigment(pigment(green * vec3(1.25, 1.02, 0.85), 0.64, 0.75),
                            flow * glaze(distance, 1.6, 0.55, unit));
    float d2 = borderDistance(0.62, tone, max(toneSlope(foliage_broad, at), 0.004));
    color *= throughPigment(pigment(green, 0.55, 0.58), flow * shape * glaze(d2, 2.5, 0.45, unit));
    float dark = foliageTone(fine, broad, wide);
    float d3 = borderDistance(0.38, dark, max(toneSlope(foliage_fine, at), 0.012));
    color *= throughPigment(pigment(green * vec3(0.8, 0.88, 1.7), 0.40, 0.5),
                            flow * shape * glaze(d3, 1.8, 0.35, unit));
  }
  // The pencil drawing below shows through.
  float pencil = max(0.6 * normalInk(unit), barkInk(wood, at, 1.2 * unit) * open);
  color *= 1.0 - 0.45 * pencil * mix(0.5, 1.0, 1.0 - sheet.r);
  writeLinear(color);
}
