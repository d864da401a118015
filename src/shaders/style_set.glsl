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
  return max(style.picture.y / 540.0, 0.5);
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

/// How much the normals that are seen change, in lengths of a unit normal per `unit` pixels.
float normalChange(float unit) {
  vec2 at = placeInPicture(), step = unit / style.picture.xy;
  vec3 x = vec3(0.0), y = vec3(0.0);
  for (int i = -1; i <= 1; ++i) {
    float weight = i == 0 ? 2.0 : 1.0;
    vec2 along = float(i) * step;
    x += weight * (textureLod(seen_normals, at + vec2(step.x, along.y), 0.0).xyz -
                   textureLod(seen_normals, at + vec2(-step.x, along.y), 0.0).xyz);
    y += weight * (textureLod(seen_normals, at + vec2(along.x, step.y), 0.0).xyz -
                   textureLod(seen_normals, at + vec2(along.x, -step.y), 0.0).xyz);
  }
  return sqrt(dot(x, x) + dot(y, y)) / 8.0;
}

/// Profiles and creases of the depths that are seen. Leaves lie at all depths of a crown, so that
/// only larger steps count among them.
float depthInk(float unit) {
  vec2 at = placeInPicture(), step = unit / style.picture.xy;
  float v[9];
  vec4 here = textureLod(seen_depths, at, 0.0);
  float nearest = 0.0, foliage = 0.0;
  for (int i = 0; i < 9; ++i) {
    vec4 near = textureLod(seen_depths, at + step * vec2(float(i % 3 - 1), float(i / 3 - 1)), 0.0);
    v[i] = near.w;
    nearest = max(nearest, near.w);
    foliage = max(foliage, near.x);
  }
  float first = firstDifference(v), second = secondDifference(v);
  float profile = profileStrength(first, second, nearest);
  float lines = smoothstep(mix(0.02, 0.12, foliage), mix(0.06, 0.4, foliage), profile);
  return lines;
}

/// To the display.
void writeLinear(vec3 linear) {
  vec3 level;
  for (int i = 0; i < 3; ++i)
    level[i] = ditheredLevel(srgbFromLinear(clamp(linear[i], 0.0, 1.0)),
                             ditherThreshold(floor(gl_FragCoord.x), floor(gl_FragCoord.y), float(i)));
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
