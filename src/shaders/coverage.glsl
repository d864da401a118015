// Which samples an alpha-cut surface covers, and one that fades.
#include "shared/forest.h"
#include "shared/random.h"

/// Thresholds over the pixels (Jimenez 2014, interleaved gradient noise), shifted by a random
/// number: [0, 1).
float pixelThreshold(uint random) {
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  return fract(noise + float(random >> 8u) * exp2(-24.0));
}

/// Of a tree of a forest, `seat`: the last two words of instance.glsl.
int fadeMask(uvec2 seat) {
  uint fade = seat.y >> 24;
  if (fade == kForestWhole) return 15;
  return int(keptSamples(fade, pixelThreshold(scrambled(seat.x))));
}

/// Linear RGB that the tree's leaves are multiplied with.
vec3 tintOf(uvec2 seat) {
  return vec3((seat.yyy >> uvec3(16u, 8u, 0u)) & 0xffu) / 255.0;
}

/// Which of the four samples an alpha-cut surface covers. Written here rather than left to the
/// fixed alpha-to-coverage, whose rounding differs between drivers: alpha is steepened to an edge
/// about one pixel wide around the cutoff, and a fixed pattern of thresholds over the pixels
/// makes the mean coverage of large areas exact. Each
/// triangle shifts the pattern and turns the samples by its own random number, from `seed`: leaves
/// behind each other would else cover the same samples, and many of them no more than one.
int coverageMask(float alpha, float cutoff, uint seed) {
  uint random = scrambled(seed);
  float coverage = clamp((alpha - cutoff) / max(fwidth(alpha), 0.125) + 0.5, 0.0, 1.0);
  int count = int(floor(coverage * 4.0 + pixelThreshold(random)));
  int mask = (1 << min(count, 4)) - 1;
  int turn = int(random & 3u);
  return ((mask << turn) | (mask >> (4 - turn))) & 15;
}
