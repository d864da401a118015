#include "leaf/fill_outside.h"

#include <algorithm>

#include "base/parallel.h"

namespace verdure {

void fillOutside(std::vector<glm::vec3>& texels, const std::vector<std::uint8_t>& inside, int width,
                 int height) {
  if (std::find(inside.begin(), inside.end(), 0) == inside.end() || (width == 1 && height == 1))
    return;
  const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
  const auto w = static_cast<std::size_t>(width), hw = static_cast<std::size_t>(half_width);
  std::vector<glm::vec3> coarse(hw * static_cast<std::size_t>(half_height));
  std::vector<std::uint8_t> known(coarse.size());
  parallelFor(static_cast<std::size_t>(half_height), 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < hw; ++x) {
      glm::vec3 sum(0);
      float count = 0;
      for (std::size_t v = 2 * y; v < std::min(2 * y + 2, static_cast<std::size_t>(height)); ++v)
        for (std::size_t u = 2 * x; u < std::min(2 * x + 2, w); ++u)
          if (inside[v * w + u] != 0) {
            sum += texels[v * w + u];
            count += 1;
          }
      if (count > 0) coarse[y * hw + x] = sum / count;
      known[y * hw + x] = count > 0 ? 1 : 0;
    }
  });
  fillOutside(coarse, known, half_width, half_height);
  parallelFor(static_cast<std::size_t>(height), 16, [&](std::size_t y) {
    // Three quarters of the coarse texel that holds this one, a quarter of the next.
    const auto next = [](int i, int count) {
      return static_cast<std::size_t>(std::clamp(i / 2 + (i % 2 == 0 ? -1 : 1), 0, count - 1));
    };
    const std::size_t near_y = y / 2, far_y = next(static_cast<int>(y), half_height);
    for (std::size_t x = 0; x < w; ++x) {
      if (inside[y * w + x] != 0) continue;
      const std::size_t near_x = x / 2, far_x = next(static_cast<int>(x), half_width);
      texels[y * w + x] =
          0.75f * (0.75f * coarse[near_y * hw + near_x] + 0.25f * coarse[near_y * hw + far_x]) +
          0.25f * (0.75f * coarse[far_y * hw + near_x] + 0.25f * coarse[far_y * hw + far_x]);
    }
  });
}

}  // namespace verdure
