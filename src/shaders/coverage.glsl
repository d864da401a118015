// Random numbers, and which samples an alpha-cut surface covers.

/// PCG's output hash.
uint scrambled(uint value) {
  uint random = value * 747796405u + 2891336453u;
  random = ((random >> ((random >> 28u) + 4u)) ^ random) * 277803737u;
  return (random >> 22u) ^ random;
}

/// Which of the four samples an alpha-cut surface covers. Written here rather than left to the
/// fixed alpha-to-coverage, whose rounding differs between drivers: alpha is steepened to an edge
/// about one pixel wide around the cutoff, and a fixed pattern of thresholds over the pixels
/// (Jimenez 2014, interleaved gradient noise) makes the mean coverage of large areas exact. Each
/// triangle shifts the pattern and turns the samples by its own random number, from `seed`: leaves
/// behind each other would else cover the same samples, and many of them no more than one.
int coverageMask(float alpha, float cutoff, uint seed) {
  uint random = scrambled(seed);
  float coverage = clamp((alpha - cutoff) / max(fwidth(alpha), 0.125) + 0.5, 0.0, 1.0);
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float threshold = fract(noise + float(random >> 8u) * exp2(-24.0));
  int count = int(floor(coverage * 4.0 + threshold));
  int mask = (1 << min(count, 4)) - 1;
  int turn = int(random & 3u);
  return ((mask << turn) | (mask >> (4 - turn))) & 15;
}
