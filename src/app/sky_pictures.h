#ifndef VERDURE_APP_SKY_PICTURES_H_
#define VERDURE_APP_SKY_PICTURES_H_

#include <functional>
#include <glm/glm.hpp>

#include "verdure/image.h"

namespace verdure::app {

/// Light for a unit direction (+Y up).
using Light = std::function<glm::vec3(const glm::vec3&)>;

/// The upper half as seen lying on one's back: zenith in the middle, horizon at the rim, angles
/// from the zenith even along the radius, north (-Z) at the top, east (+X) at left. Black outside.
HdrImage drawFisheye(const Light& light, int size);

/// All directions by latitude and longitude: zenith at the top, north (-Z) in the middle, east (+X)
/// at right; twice as wide as high.
HdrImage drawPanorama(const Light& light, int height);

/// Mean of the image's luminance over its pixels that are not black.
float meanLuminance(const HdrImage& image);

/// For the eye: luminance over `mean` to Reinhard's x / (1 + x) with a key of 0.6, each colour with
/// its hue, then sRGB. Negative values are black.
Image toneMapped(const HdrImage& image, float mean);

}  // namespace verdure::app

#endif  // VERDURE_APP_SKY_PICTURES_H_
