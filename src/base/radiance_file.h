#ifndef VERDURE_BASE_RADIANCE_FILE_H_
#define VERDURE_BASE_RADIANCE_FILE_H_

#include "verdure/image.h"

namespace verdure {

/// Decodes a Radiance picture: Ward, "Real Pixels", Graphics Gems II, 1991, and the format's
/// description in the Radiance manual; rows from the top, RGBE. Throws Error naming `where`.
HdrImage decodeRadiance(std::span<const std::uint8_t> file, const std::string& where);

}  // namespace verdure

#endif  // VERDURE_BASE_RADIANCE_FILE_H_
