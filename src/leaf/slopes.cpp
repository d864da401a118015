#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "leaf/leaf_maps.h"
#include "leaf/plane_transform.h"

namespace verdure {

std::vector<float> heightsFromSlopes(const std::vector<glm::vec2>& slopes, int width, int height,
                                     float step_mm) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  // Least squares over the rises between neighbours, each the mean of the two slopes: a Poisson
  // equation with the five-point Laplacian and no flow over the border. Mirrored at the border, it
  // is periodic: the even extension's transform is the cosine transform.
  const std::size_t w2 = 2 * w, h2 = 2 * h;
  std::vector<std::complex<float>> plane(w2 * h2);
  parallelFor(h, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const std::size_t i = y * w + x;
      float divergence = 0;
      if (x + 1 < w) divergence += slopes[i].x + slopes[i + 1].x;
      if (x > 0) divergence -= slopes[i].x + slopes[i - 1].x;
      if (y + 1 < h) divergence += slopes[i].y + slopes[i + w].y;
      if (y > 0) divergence -= slopes[i].y + slopes[i - w].y;
      divergence *= 0.5f * step_mm;
      for (const std::size_t row : {y, h2 - 1 - y})
        for (const std::size_t column : {x, w2 - 1 - x}) plane[row * w2 + column] = divergence;
    }
  });
  transformPlane(plane, static_cast<int>(w2), static_cast<int>(h2), false);
  const double turn_x = 2 * std::numbers::pi / static_cast<double>(w2);
  const double turn_y = 2 * std::numbers::pi / static_cast<double>(h2);
  parallelFor(h2, 16, [&](std::size_t v) {
    const double of_y = 2 * std::cos(turn_y * static_cast<double>(v)) - 2;
    for (std::size_t u = 0; u < w2; ++u) {
      const double laplacian = 2 * std::cos(turn_x * static_cast<double>(u)) - 2 + of_y;
      const double scale = laplacian * static_cast<double>(w2 * h2);
      plane[v * w2 + u] *= u + v == 0 ? 0.0f : static_cast<float>(1 / scale);
    }
  });
  transformPlane(plane, static_cast<int>(w2), static_cast<int>(h2), true);
  std::vector<float> heights(w * h);
  for (std::size_t y = 0; y < h; ++y)
    for (std::size_t x = 0; x < w; ++x) heights[y * w + x] = plane[y * w2 + x].real();
  return heights;
}

std::vector<glm::vec2> slopesFromHeights(const std::vector<float>& heights_mm,
                                         const std::vector<bool>& inside, int width, int height,
                                         float step_mm) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  std::vector<glm::vec2> slopes(w * h, glm::vec2(0));
  const auto rise = [&](std::size_t i, std::size_t stride, bool has_before, bool has_after) {
    const std::size_t before = has_before && inside[i - stride] ? i - stride : i;
    const std::size_t after = has_after && inside[i + stride] ? i + stride : i;
    if (before == after) return 0.0f;
    const auto steps = static_cast<float>((after - before) / stride);
    return (heights_mm[after] - heights_mm[before]) / (steps * step_mm);
  };
  parallelFor(h, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const std::size_t i = y * w + x;
      if (inside[i]) slopes[i] = {rise(i, 1, x > 0, x + 1 < w), rise(i, w, y > 0, y + 1 < h)};
    }
  });
  return slopes;
}

}  // namespace verdure
