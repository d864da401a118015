#ifndef VERDURE_SHARED_COLOR_H_
#define VERDURE_SHARED_COLOR_H_

#include "portable.h"

// The sRGB transfer functions (IEC 61966-2-1), one channel, both sides in [0, 1].

SHARED_BEGIN

SHARED_FUNCTION float linearFromSrgb(float s) {
  return s <= 0.04045f ? s / 12.92f : pow((s + 0.055f) / 1.055f, 2.4f);
}

SHARED_FUNCTION float srgbFromLinear(float l) {
  return l <= 0.0031308f ? l * 12.92f : 1.055f * pow(l, 1.0f / 2.4f) - 0.055f;
}

SHARED_END

#endif  // VERDURE_SHARED_COLOR_H_
