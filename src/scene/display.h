#ifndef VERDURE_SCENE_DISPLAY_H_
#define VERDURE_SCENE_DISPLAY_H_

#include "verdure/image.h"

namespace verdure {

/// Log-average of the luminances, kcd/m^2: (1) of Reinhard et al. 2002.
float averageLuminance(const HdrImage& image);

/// The white point that the renderer finds for such a picture (shared/tone.h), for displayed().
float automaticWhite(const HdrImage& image, float average, float key);

/// An HDR image (kcd/m^2) as the renderer shows it without bloom (shared/tone.h): `average` comes
/// to `key`, `white` is the smallest scaled luminance that becomes pure white; sRGB, dithered. The
/// renderer maps its four samples a pixel one by one, this the pixel's mean: edges against a bright
/// sky come out a little lighter.
Image displayed(const HdrImage& image, float average, float key, float white);

}  // namespace verdure

#endif  // VERDURE_SCENE_DISPLAY_H_
