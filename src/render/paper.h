#ifndef VERDURE_RENDER_PAPER_H_
#define VERDURE_RENDER_PAPER_H_

#include "verdure/image.h"

namespace verdure {

/// A sheet of cold-pressed paper that repeats both ways, `size` pixels a side: in red its height,
/// in green how unevenly water carries pigment over it, in blue how raggedly a wash ends on it;
/// each from 0 to 255 with a mean near 128. Alpha is 255.
Image makePaper(int size);

}  // namespace verdure

#endif  // VERDURE_RENDER_PAPER_H_
