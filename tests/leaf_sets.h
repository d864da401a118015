#ifndef VERDURE_TESTS_LEAF_SETS_H_
#define VERDURE_TESTS_LEAF_SETS_H_

#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "base/random.h"
#include "leaf/leaf_maps.h"
#include "verdure/leaf.h"

namespace verdure::test {

inline LeafSet flatLeaf(int width, int height, float mm_per_texel, float thickness, float albedo) {
  LeafSet set;
  set.name = "flat";
  set.width = width;
  set.height = height;
  set.mm_per_texel = mm_per_texel;
  const std::size_t n = set.texelCount();
  for (LeafSide* side : {&set.front, &set.back}) {
    side->albedo.assign(n, glm::vec3(albedo));
    side->translucency.assign(n, glm::vec3(0.3f));
    side->normal.assign(n, glm::vec3(0, 0, 1));
    side->relief_mm.assign(n, 0.5f * thickness);
  }
  set.thickness_mm.assign(n, thickness);
  set.opacity.assign(n, 1.0f);
  return set;
}

/// Bumps, veins that are thicker, holes, both sides different.
inline LeafSet roughLeaf(int width, int height, float mm_per_texel) {
  LeafSet set = flatLeaf(width, height, mm_per_texel, 0.2f, 0.1f);
  Random random(11);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      const float u = static_cast<float>(x) * mm_per_texel,
                  v = static_cast<float>(y) * mm_per_texel;
      const float vein = std::exp(-8 * std::pow(std::sin(1.1f * u + 0.4f * v), 2.0f));
      set.thickness_mm[i] = 0.15f + 0.35f * vein;
      set.front.relief_mm[i] = 0.1f + 0.15f * std::sin(2 * u) * std::cos(1.6f * v);
      set.back.relief_mm[i] = set.thickness_mm[i] - set.front.relief_mm[i];
      set.front.albedo[i] = glm::vec3(0.05f + 0.2f * random.uniform());
      set.back.albedo[i] = glm::vec3(0.15f + 0.2f * random.uniform());
      const float du = static_cast<float>(x) / static_cast<float>(width) - 0.5f;
      const float dv = static_cast<float>(y) / static_cast<float>(height) - 0.5f;
      set.opacity[i] = du * du + dv * dv < 0.23f && std::hypot(u - 2, v - 2) > 0.3f ? 1.0f : 0.0f;
    }
  std::vector<bool> inside;
  for (const float o : set.opacity) inside.push_back(o > 0.5f);
  for (LeafSide* side : {&set.front, &set.back}) {
    const auto slopes = slopesFromHeights(side->relief_mm, inside, width, height, mm_per_texel);
    for (std::size_t i = 0; i < slopes.size(); ++i)
      side->normal[i] = glm::normalize(glm::vec3(-slopes[i].x, slopes[i].y, 1));
  }
  return set;
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_LEAF_SETS_H_
