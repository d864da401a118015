#ifndef VERDURE_RENDER_GROUND_TEXTURE_H_
#define VERDURE_RENDER_GROUND_TEXTURE_H_

#include "verdure/image.h"

namespace verdure {

/// A tile of short grass seen from above, size x size, sRGB, repeating without seams; its mean in
/// linear light is shared::groundMeanColor(). Always the same.
Image makeGroundTexture(int size);

}  // namespace verdure

#endif  // VERDURE_RENDER_GROUND_TEXTURE_H_
