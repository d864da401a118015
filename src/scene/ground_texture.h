#ifndef VERDURE_SCENE_GROUND_TEXTURE_H_
#define VERDURE_SCENE_GROUND_TEXTURE_H_

#include "verdure/image.h"

namespace verdure {

/// A tile of short grass seen from above, size x size, sRGB, repeating without seams; its mean in
/// linear light is shared::groundMeanColor(). Always the same.
Image makeGroundTexture(int size);

/// A repeating cloud of fractal noise in all colour channels, linear, mean about 0.5: where grass
/// is lighter, darker or drier.
Image makeGroundNoise(int size);

}  // namespace verdure

#endif  // VERDURE_SCENE_GROUND_TEXTURE_H_
