#include "render/paper.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/tile_noise.h"

namespace verdure {
namespace {

/// Spreads noise around 1/2, of which sums of octaves leave little at either end.
std::uint8_t spread(float noise, float contrast) {
  const float v = 0.5f + (noise - 0.5f) * contrast;
  return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

Image makePaper(int size) {
  Image paper(size, size);
  parallelFor(static_cast<std::size_t>(size), 8, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
    for (int x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(size);
      // The felt leaves dimples a few pixels wide. A lattice askew hides the rows of the other.
      const float felt = 0.5f * fractalNoise(u, v, 83, 83, 3, 11) +
                         0.5f * fractalNoise(u + v, u - v + 1.0f, 59, 59, 3, 7);
      std::uint8_t* texel = paper.at(x, y);
      texel[0] = spread(felt, 2.2f);
      texel[1] = spread(fractalNoise(u, v, 5, 5, 5, 25), 1.7f);
      texel[2] = spread(fractalNoise(u, v, 7, 7, 4, 41), 1.7f);
      texel[3] = 255;
    }
  });
  return paper;
}

}  // namespace verdure
