#ifndef VERDURE_SHARED_TONE_H_
#define VERDURE_SHARED_TONE_H_

#include "portable.h"

// From luminance to a display: Reinhard, Stark, Shirley, Ferwerda, "Photographic Tone Reproduction
// for Digital Images", SIGGRAPH 2002 (equation numbers are that paper's; the global operator), and
// dithering to 8 bits.

SHARED_BEGIN

/// Luminance of linear sRGB (Rec. 709).
SHARED_FUNCTION float luminanceOf(vec3 color) {
  return dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
}

/// (4): display luminance of the scaled luminance l = key / average * L (2), both at least 0.
/// `white` > 0 is the smallest l that becomes pure white, 1; more is above 1.
SHARED_FUNCTION float reinhard(float l, float white) {
  return l * (1.0f + l / (white * white)) / (1.0f + l);
}

/// Display colour in [0, 1], linear, of a scaled colour. Its luminance is that of (4), cut at 1; a
/// colour too bright for the display at that luminance is mixed with grey, which keeps luminance
/// and hue.
SHARED_FUNCTION vec3 toneMapped(vec3 scaled, float white) {
  float l = luminanceOf(scaled);
  if (l <= 0.0f) {
    return vec3(0.0f);
  }
  float d = min(reinhard(l, white), 1.0f);
  vec3 color = scaled * (d / l);
  float top = max(max(color.x, color.y), color.z);
  return top <= 1.0f ? color : vec3(d) + (color - vec3(d)) * ((1.0f - d) / (top - d));
}

/// A picture's pixels are counted in bins of their luminance, eight for each factor of two around 1
/// in whatever unit, and its bright luminance is the one that this share of them exceeds: few
/// enough that the sky around the sun counts, too many for the sun's disk and for highlights.
const int kLuminanceBins = 512;
const float kBrightShare = 0.01f;

SHARED_FUNCTION int luminanceBin(float l) {
  float at = 8.0f * log2(max(l, 2.4e-10f)) + 0.5f * float(kLuminanceBins);
  return clamp(int(floor(at)), 0, kLuminanceBins - 1);
}

/// The luminance in a bin that `above` in [0, 1] of the bin's pixels exceed, if they lie evenly.
SHARED_FUNCTION float luminanceInBin(int bin, float above) {
  return exp2((float(bin) + 1.0f - above - 0.5f * float(kLuminanceBins)) * 0.125f);
}

/// The white point of a picture of which kBrightShare is brighter than the scaled luminance
/// `bright`: the one for which (4) shows that as 0.8. (The paper takes the largest luminance, so
/// that nothing burns out, but that is the sun's disk where it is seen.) At least 2, with which
/// pictures without such lights look best; at most 10, near which the curve hardly depends on it.
SHARED_FUNCTION float automaticWhite(float bright) {
  float room = 0.8f - 0.2f * bright;  // bright^2 / white^2, where positive
  return room > 0.0f ? clamp(bright / sqrt(room), 2.0f, 10.0f) : 10.0f;
}

/// kcd/m^2 that an exposure value at ISO 100 stands for: reflected-light meters with K = 12.5 (ISO
/// 2720).
SHARED_FUNCTION float meteredLuminance(float ev) {
  return 0.125e-3f * pow(2.0f, ev);
}

/// Threshold of a pixel's channel (0 to 2) for dithering: fixed, evenly spread over [0, 1) even
/// among few neighbours (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced
/// Warfare", SIGGRAPH 2014 courses: interleaved gradient noise); each channel has its own.
SHARED_FUNCTION float ditherThreshold(float x, float y, float channel) {
  float inner = 0.06711056f * x + 0.00583715f * y + 0.357f * channel;
  float outer = 52.9829189f * (inner - floor(inner));
  return outer - floor(outer);
}

/// The 8-bit level, 0 to 255, of s in [0, 1]: its mean over all thresholds is 255 s, and levels
/// that 8 bits hold exactly stay as they are (the outermost 1/256 of the thresholds absorb
/// rounding).
SHARED_FUNCTION float ditheredLevel(float s, float threshold) {
  return floor(255.0f * s + mix(1.0f / 256.0f, 255.0f / 256.0f, threshold));
}

SHARED_END

#endif  // VERDURE_SHARED_TONE_H_
