// What the passes that compose a style read.
#include "shared/color.h"
#include "shared/style.h"
#include "shared/tone.h"
layout(set = 0, binding = 0) uniform sampler2D seen_normals;  // style_merge.frag, blurred
layout(set = 0, binding = 1) uniform sampler2D seen_depths;   // style_merge.frag
layout(set = 0, binding = 2) uniform sampler2D wood_color;    // style_layers.frag
layout(set = 0, binding = 3) uniform sampler2D wood_layer;
layout(set = 0, binding = 4) uniform sampler2D foliage_color;  // broadly blurred
layout(set = 0, binding = 5) uniform sampler2D foliage_fine;   // style_layers.frag's layer, blurred
layout(set = 0, binding = 6) uniform sampler2D foliage_broad;
layout(set = 0, binding = 7) uniform sampler2D foliage_wide;
layout(set = 0, binding = 8) uniform sampler2D backdrop;  // sky and ground, sRGB, broadly blurred
layout(set = 0, binding = 9) uniform sampler2D paper;     // repeats: makePaper()
layout(set = 0, binding = 10) uniform sampler2D sharp_normals;  // style_merge.frag
layout(push_constant) uniform StyleBlock { StyleUniforms style; };
layout(location = 0) out vec4 out_color;

/// Lines, borders and grain are as wide in a picture of any size: this many pixels for one of 540
/// lines' height.
float unitInPixels() {
  return max(style.picture.y / 540.0, 0.7);
}

/// A layer's values where it is.
struct Layer {
  float cover, tone, depth, noise;
};

Layer layerOf(vec4 v) {
  float c = max(v.x, 1e-4);
  return Layer(v.x, v.y / c, v.z / c, v.w / c);
}

Layer layerAt(sampler2D layer, vec2 at) {
  return layerOf(textureLod(layer, at, 0.0));
}

vec2 placeInPicture() {
  return gl_FragCoord.xy / style.picture.xy;
}

/// A layer's border, in pixels: inside is positive.
float borderOf(sampler2D layer, vec2 at, float threshold, float least_slope) {
  vec2 step = 1.0 / style.picture.xy;
  float x = textureLod(layer, at + vec2(step.x, 0.0), 0.0).x -
            textureLod(layer, at - vec2(step.x, 0.0), 0.0).x;
  float y = textureLod(layer, at + vec2(0.0, step.y), 0.0).x -
            textureLod(layer, at - vec2(0.0, step.y), 0.0).x;
  return borderDistance(textureLod(layer, at, 0.0).x, threshold,
                        max(0.5 * length(vec2(x, y)), least_slope));
}

/// Change per pixel of a layer's lightness.
float toneSlope(sampler2D layer, vec2 at) {
  vec2 step = 1.0 / style.picture.xy;
  float x = layerAt(layer, at + vec2(step.x, 0.0)).tone -
            layerAt(layer, at - vec2(step.x, 0.0)).tone;
  float y = layerAt(layer, at + vec2(0.0, step.y)).tone -
            layerAt(layer, at - vec2(0.0, step.y)).tone;
  return 0.5 * length(vec2(x, y));
}

/// Where foliage ends: a share of the coverage around it, so that thin crowns keep their shape.
float foliageThreshold(Layer wide) {
  return clamp(0.55 * wide.cover, 0.05, 0.42);
}

/// Lightness of foliage, darker where nearer foliage surrounds it: so clumps stand out from those
/// behind (Luft, Colditz and Deussen, "Image Enhancement by Unsharp Masking the Depth Buffer",
/// 2006).
float foliageTone(Layer leaves, Layer broad, Layer wide) {
  float nearer = (broad.depth - wide.depth) / max(wide.depth, 1e-9);
  return leaves.tone + clamp(2.2 * nearer, -0.12, 0.10);
}

/// Aerial perspective: share of its own colour that something keeps, at a depth. A painter lets it
/// begin sooner than haze does.
float nearness(float depth) {
  float far = 6.0 / (max(depth, 1e-9) * style.picture.w);
  return 1.0 / (1.0 + far * far);
}

/// A line along a border, `width` pixels wide.
float lineAlong(float distance, float width) {
  return insideBorder(0.5 * width - abs(distance), 1.0);
}

/// How much the normals of what covers change over `unit` pixels; what is not there has none.
float normalChange(vec2 at, float unit) {
  vec2 step = unit / style.picture.xy;
  vec3 x = vec3(0.0), y = vec3(0.0);
  float least = 1.0;
  for (int i = 0; i < 9; ++i) {
    if (i == 4) continue;
    vec2 to = vec2(float(i % 3 - 1), float(i / 3 - 1));
    vec4 seen = textureLod(seen_normals, at + step * to, 0.0);
    vec3 n = seen.xyz / max(seen.w, 1e-3);
    vec2 weights = to * (2.0 - abs(to.yx));
    x += weights.x * n;
    y += weights.y * n;
    least = min(least, seen.w);
  }
  return sqrt(dot(x, x) + dot(y, y)) / 8.0 * smoothstep(0.25, 0.7, least);
}

/// Lines where normals change most: along the ridges of their change, so that what turns evenly, as
/// a trunk does, has none.
float normalInk(float unit) {
  vec2 at = placeInPicture(), step = 1.6 * unit / style.picture.xy;
  float change = normalChange(at, unit);
  float beside = 0.25 * (normalChange(at + vec2(step.x, 0.0), unit) +
                         normalChange(at - vec2(step.x, 0.0), unit) +
                         normalChange(at + vec2(0.0, step.y), unit) +
                         normalChange(at - vec2(0.0, step.y), unit));
  return smoothstep(0.06, 0.17, change) * smoothstep(0.005, 0.05, change - beside);
}

/// Profiles and creases of the depths that are seen, of wood before wood and of ground before
/// ground: leaves lie at all depths of a crown, and borders of layers have lines of their own
/// (lineAlong()). Far off they fade, and with them the horizon.
float depthInk(float unit) {
  vec2 at = placeInPicture(), step = unit / style.picture.xy;
  float v[9];
  float nearest = 8.0 / style.picture.w;
  vec3 low = vec3(1.0), high = vec3(0.0);  // shares of foliage, of wood, of both
  for (int i = 0; i < 9; ++i) {
    vec4 near = textureLod(seen_depths, at + step * vec2(float(i % 3 - 1), float(i / 3 - 1)), 0.0);
    v[i] = near.w;
    nearest = max(nearest, near.w);
    vec3 shares = vec3(near.xy, near.x + near.y);
    low = min(low, shares);
    high = max(high, shares);
  }
  // Lines of the ground are lighter.
  float alike = max(smoothstep(0.6, 0.95, low.y), 0.45 * (1.0 - smoothstep(0.0, 0.1, high.z)));
  float first = firstDifference(v), second = secondDifference(v);
  float profile = smoothstep(0.02, 0.07, profileStrength(first, second, nearest));
  float crease = smoothstep(0.6, 0.8, creaseStrength(first, second, nearest, 0.004));
  return alike * max(profile, 0.7 * crease);
}

/// Lines around wood that is seen; twigs, which are a line themselves, have lighter ones.
float barkInk(Layer wood, vec2 at, float width) {
  float line = lineAlong(borderOf(wood_layer, at, 0.5, 0.05), width);
  return line * mix(0.6, 1.0, smoothstep(0.5, 1.0, wood.cover));
}

/// To the display.
void writeLinear(vec3 linear) {
  vec3 level;
  for (int i = 0; i < 3; ++i)
    level[i] = ditheredLevel(srgbFromLinear(clamp(linear[i], 0.0, 1.0)),
                             ditherThreshold(floor(gl_FragCoord.x), floor(gl_FragCoord.y),
                                             float(i)));
  out_color = vec4(level / 255.0, 1.0);
}

vec3 linearBackdrop(vec2 at) {
  vec3 s = textureLod(backdrop, at, 0.0).rgb;
  return vec3(linearFromSrgb(s.r), linearFromSrgb(s.g), linearFromSrgb(s.b));
}

/// The sheet of paper at this pixel: height, turbulence of pigment, ragged borders, fine fibres.
vec4 paperHere() {
  return textureLod(paper, gl_FragCoord.xy / (512.0 * max(style.picture.y / 640.0, 0.5)), 0.0);
}

/// Reflectance of the bare sheet, lit from its upper left.
vec3 bareSheet(float height, float unit) {
  vec3 white = style.background.w > 0.5 ? style.background.rgb : vec3(0.955, 0.94, 0.905);
  float across = textureLod(paper, (gl_FragCoord.xy + unit) /
                                       (512.0 * max(style.picture.y / 640.0, 0.5)), 0.0).r;
  return white * (1.0 + 0.10 * (across - height));
}
