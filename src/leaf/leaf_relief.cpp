#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/tile_noise.h"
#include "leaf/grown_leaf.h"

namespace verdure {

void setNormals(LeafSide& side, int size, float mm_per_texel) {
  const auto n = static_cast<std::size_t>(size);
  side.normal.resize(n * n);
  parallelFor(n, 16, [&](std::size_t y) {
    const std::size_t up = y > 0 ? y - 1 : 0, down = std::min(y + 1, n - 1);
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t left = x > 0 ? x - 1 : 0, right = std::min(x + 1, n - 1);
      const float dx = (side.relief_mm[y * n + right] - side.relief_mm[y * n + left]) /
                       (static_cast<float>(right - left) * mm_per_texel);
      const float dy = (side.relief_mm[up * n + x] - side.relief_mm[down * n + x]) /
                       (static_cast<float>(down - up) * mm_per_texel);
      side.normal[y * n + x] = glm::normalize(glm::vec3(-dx, -dy, 1.0f));
    }
  });
}

void shapeRelief(const BladeFields& fields, const LeafSpecies& species, std::uint32_t seed,
                 LeafSet& set) {
  const LeafFrame& frame = fields.frame;
  const auto n = static_cast<std::size_t>(frame.size);
  const float mm = frame.mmPerTexel();
  const auto cells = [&](float size_mm) {
    return std::max(2, static_cast<int>(frame.extent_mm / size_mm));
  };
  const int waves = cells(16), grain = cells(0.3f), areoles = cells(species.areole_mm);
  const auto own = static_cast<std::uint32_t>(hash(seed + 80));

  // The blade bulges between its veins, which hold it back.
  std::vector<float> middle(n * n), groove = fields.ridge.height;
  blur(groove, frame.size, std::max(0.16f / mm, 0.6f));
  const auto bulge = [](float d, float reach) { return 1 - std::exp(-d * d / (reach * reach)); };
  parallelFor(n, 4, [&](std::size_t row) {
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t i = row * n + x;
      const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(n);
      const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(n);
      const float blade = 1 - fields.stalk[i];
      float h = species.quilt_mm * bulge(fields.major[i], species.quilt_reach_mm) +
                species.pillow_mm * bulge(fields.vein[i], 0.5f * species.veins.spacing_mm);
      h += species.wave_mm * (fractalNoise(u, v, waves, waves, 2, own) - 0.5f);
      if (fields.edge[i] > -4 * mm) {
        const Cell cell = cellNoise(u, v, areoles, areoles, own + 5);
        h += 0.2f * species.pillow_mm * glm::smoothstep(0.0f, 0.5f, cell.border);
        h += 0.004f * (valueNoise(u, v, grain, grain, own + 9) - 0.5f);
      }
      middle[i] = blade * h;
    }
  });
  blur(middle, frame.size, std::max(0.05f / mm, 0.5f));

  set.thickness_mm.resize(n * n);
  set.front.relief_mm.resize(n * n);
  set.back.relief_mm.resize(n * n);
  parallelFor(n, 16, [&](std::size_t row) {
    for (std::size_t i = row * n; i < (row + 1) * n; ++i) {
      const float blade = 1 - fields.stalk[i];
      const float rim = glm::smoothstep(0.0f, 0.5f, fields.edge[i]);
      const float sheet = species.thickness_mm * (0.72f + 0.28f * rim);
      const float front_vein =
          0.85f * (1 - blade) * fields.ridge.height[i] - blade * species.groove * groove[i];
      const float back_vein = glm::mix(0.85f, species.protrusion, blade) * fields.ridge.height[i] +
                              blade * species.groove * groove[i];
      set.front.relief_mm[i] = 0.5f * sheet + middle[i] + front_vein;
      set.back.relief_mm[i] = 0.5f * sheet - middle[i] + back_vein;
      set.thickness_mm[i] = set.front.relief_mm[i] + set.back.relief_mm[i];
    }
  });
  setNormals(set.front, frame.size, mm);
  setNormals(set.back, frame.size, mm);
}

}  // namespace verdure
