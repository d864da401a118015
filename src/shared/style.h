#ifndef VERDURE_SHARED_STYLE_H_
#define VERDURE_SHARED_STYLE_H_

#include "portable.h"

// What the drawn styles are made of: lines where pictures of depth and of normals jump (Saito and
// Takahashi, "Comprehensible Rendering of 3-D Shapes", SIGGRAPH 1990), even tones (Decaudin,
// "Cartoon Looking Rendering of 3D Scenes", 1996), and layers of pigment on paper with a blurred
// depth test (Luft and Deussen, "Real-Time Watercolor Illustrations of Plants Using a Blurred Depth
// Test", NPAR 2006). docs/styles.md says what differs from them.
//
// Depth is 1 / distance along the view, 1/m: over the picture of a plane it is linear, whatever the
// plane's slope, and 0 is infinitely far. Nine values are a pixel and its neighbours, in rows.

SHARED_BEGIN

/// First-order differential: change per pixel along the steepest way (Sobel). A step of height h
/// gives h / 2 in the two pixels beside it.
SHARED_FUNCTION float firstDifference(const float v[9]) {
  float x = v[2] + 2.0f * v[5] + v[8] - v[0] - 2.0f * v[3] - v[6];
  float y = v[6] + 2.0f * v[7] + v[8] - v[0] - 2.0f * v[1] - v[2];
  return sqrt(x * x + y * y) / 8.0f;
}

/// Second-order differential: 0 on planes, h in the pixels beside a straight step of height h, and
/// beside a straight crease the change of the slope per pixel.
SHARED_FUNCTION float secondDifference(const float v[9]) {
  float around = v[0] + v[1] + v[2] + v[3] + v[5] + v[6] + v[7] + v[8];
  return abs(8.0f * v[4] - around) / 3.0f;
}

/// How far a pixel is from one plane with its neighbours, as a share of its depth: where a near
/// thing's profile lies in front of a far one. The first-order differential alone would find
/// planes that are seen at a grazing angle; it counts only as far as the second-order one does.
SHARED_FUNCTION float profileStrength(float first, float second, float depth) {
  return min(first, second) / max(depth, 1e-9f);
}

/// How sharply a surface bends, from 0 to about 1 whatever its slope: an internal edge. `least`:
/// change of the depth per pixel, as a share of it, below which nothing is seen.
SHARED_FUNCTION float creaseStrength(float first, float second, float depth, float least) {
  return second / (second + first + max(least * depth, 1e-12f));
}

/// Signed distance to the border of where a picture's values exceed `threshold`, in pixels, inside
/// positive: `change` is the values' change per pixel.
SHARED_FUNCTION float borderDistance(float value, float threshold, float change) {
  return (value - threshold) / max(change, 1e-5f);
}

/// Share of a pixel inside a border that far away; the border is `width` > 0 pixels wide.
SHARED_FUNCTION float insideBorder(float distance, float width) {
  return clamp(distance / width + 0.5f, 0.0f, 1.0f);
}

/// Lightness in three even tones, whose borders are antialiased. `tone` in [0, 1], its change per
/// pixel; `borders` between dark, middle and light; `levels` their lightness.
SHARED_FUNCTION float evenTone(float tone, float change, vec2 borders, vec3 levels) {
  float middle = insideBorder(borderDistance(tone, borders.x, change), 1.5f);
  float light = insideBorder(borderDistance(tone, borders.y, change), 1.5f);
  return mix(mix(levels.x, levels.y, middle), levels.z, light);
}

/// Lightness of the light on a surface as a share of what a surface in the open gets that faces the
/// sun: the square root is about as even as the eye is.
SHARED_FUNCTION float lightness(float light, float full) {
  return sqrt(clamp(light / max(full, 1e-9f), 0.0f, 1.0f));
}

/// The blurred depth test: share in which something at `depth` is in front of a neighbourhood of
/// mean depth `around`. It goes over where they differ by less than the share `softness` of the
/// distance: things that meet flow into each other instead of cutting each other off.
SHARED_FUNCTION float blurredDepthTest(float depth, float around, float softness) {
  float nearer = (depth - around) / max(max(depth, around), 1e-9f);
  return smoothstep(-softness, softness, nearer);
}

/// Pigment that the drying water leaves at a layer's border, as a share of its own: 1 at the
/// border, less inside, in pixels.
SHARED_FUNCTION float pigmentAtBorder(float distance, float width) {
  float d = max(distance, 0.0f) / width;
  return exp(-d * d);
}

/// Pigment settles in the paper's valleys: a factor about 1. `height` in [0, 1].
SHARED_FUNCTION float granulated(float height, float amount) {
  return max(1.0f + 2.0f * amount * (0.5f - height), 0.0f);
}

/// Of light that goes through a layer to the paper and back: `color` is what a layer of density 1
/// leaves of white.
SHARED_FUNCTION vec3 throughPigment(vec3 color, float density) {
  vec3 c = clamp(color, 0.004f, 1.0f);
  return exp(log(c) * density);
}

/// In [0, 1) for a point of a lattice.
SHARED_FUNCTION float latticeNoise(int x, int y, int z) {
  uint h = uint(x) * 0x8da6b343u ^ uint(y) * 0xd8163841u ^ uint(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 16u)) * 0x21f0aaadu;
  h = (h ^ (h >> 15u)) * 0x735a2d97u;
  h = h ^ (h >> 15u);
  return float(h >> 8u) * exp2(-24.0f);
}

/// Smooth noise in [0, 1] with one value for each unit of length, between them interpolated.
SHARED_FUNCTION float smoothNoise(vec3 p) {
  vec3 corner = floor(p);
  vec3 f = p - corner;
  vec3 w = f * f * (vec3(3.0f) - 2.0f * f);
  int x = int(corner.x), y = int(corner.y), z = int(corner.z);
  float near = mix(mix(latticeNoise(x, y, z), latticeNoise(x + 1, y, z), w.x),
                   mix(latticeNoise(x, y + 1, z), latticeNoise(x + 1, y + 1, z), w.x), w.y);
  float far = mix(mix(latticeNoise(x, y, z + 1), latticeNoise(x + 1, y, z + 1), w.x),
                  mix(latticeNoise(x, y + 1, z + 1), latticeNoise(x + 1, y + 1, z + 1), w.x), w.y);
  return mix(near, far, w.z);
}

/// Noise that is fixed to places, in patches of about `size` > 0, m: two octaves next to that size
/// fade into each other, so that it neither swims nor jumps when `size` follows the camera.
SHARED_FUNCTION float placeNoise(vec3 p, float size) {
  float octave = log2(size);
  float whole = floor(octave);
  float scale = exp2(-whole);
  return mix(smoothNoise(p * scale), smoothNoise(p * (0.5f * scale)), octave - whole);
}

/// Push constants of the passes that compose a style.
struct StyleUniforms {
  vec4 picture;  ///< width, height, pixels; 1 / near plane, 1/m; half distance of the haze, m
  vec4 right;    ///< axes of the camera: what StyleNormals' colours are relative to
  vec4 up;
  vec4 back;
  vec4 background;  ///< linear RGB instead of paper; w = 1: there is one
};
SHARED_SIZE(StyleUniforms, 80);

/// Push constants of style_blur.
struct BlurUniforms {
  vec2 step;    ///< between taps, in texture coordinates
  vec2 texel;   ///< 1 / width, 1 / height of the target
  float sigma;  ///< of the Gaussian, steps
  int reach;    ///< taps on either side
};
SHARED_SIZE(BlurUniforms, 24);

SHARED_END

#endif  // VERDURE_SHARED_STYLE_H_
