#include "plant/bark_texture.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "base/tile_noise.h"

namespace verdure {
namespace {

struct Texel {
  float height;  ///< [0, 1]
  glm::vec3 color;
};

/// Marks of elliptic form, one in a cell with probability `share`: 1 inside, 0 outside. `fill` is
/// their half width by that of the cell, `aspect` their height by the cell's.
float marks(float u, float v, int nu, int nv, float share, float fill, float aspect,
            std::uint32_t seed) {
  const float x = u * static_cast<float>(nu), y = v * static_cast<float>(nv);
  const int x0 = floorOf(x), y0 = floorOf(y);
  float most = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const int cx = wrap(x0 + i, nu), cy = wrap(y0 + j, nv);
      if (latticeValue(cx, cy, seed) > share) continue;
      const float size = 0.35f + 0.65f * latticeValue(cx, cy, seed + 1);
      const float dx = x - static_cast<float>(x0 + i) - latticeValue(cx, cy, seed + 2);
      const float dy = y - static_cast<float>(y0 + j) - latticeValue(cx, cy, seed + 3);
      const float ex = dx / (fill * size), ey = dy / (aspect * (0.5f + 0.5f * size));
      const float d = std::sqrt(ex * ex + ey * ey);
      if (d >= 1) continue;
      most = std::max(most, 1 - glm::smoothstep(0.55f, 1.0f, d));
    }
  return most;
}

Texel lenticels(const BarkLook& look, float u, float v, std::uint32_t seed) {
  const float broad = fractalNoise(u, v, 3, 3, 4, seed);
  const float fine = fractalNoise(u, v, 24, 48, 3, seed + 10);
  const float wobble = 0.02f * (fractalNoise(u, v, 6, 6, 2, seed + 20) - 0.5f);
  const float dashes = marks(u, v + wobble, 7, 40, 0.5f, 0.42f, 0.3f, seed + 30);
  const float eyes = marks(u + wobble, v + wobble, 3, 5, 0.3f, 0.34f, 0.26f, seed + 40);
  const float scars = marks(u, v + 2 * wobble, 3, 7, 0.3f, 0.55f, 0.16f, seed + 50);
  const float dark = std::max({0.72f * dashes, eyes * (0.8f + 0.2f * fine), 0.8f * scars});
  glm::vec3 color = glm::mix(look.color, look.tint, glm::smoothstep(0.4f, 0.75f, broad));
  color *= 0.94f + 0.1f * fine;
  color = glm::mix(color, look.deep, 0.9f * dark);
  return {0.5f + 0.12f * fine + 0.1f * broad - 0.22f * dark, color};
}

Texel paper(const BarkLook& look, float u, float v, std::uint32_t seed) {
  const float broad = fractalNoise(u, v, 2, 3, 4, seed);
  const float strips = fractalNoise(u, v, 2, 28, 3, seed + 10);
  const float wobble = 0.03f * (fractalNoise(u, v, 4, 5, 3, seed + 20) - 0.5f);
  const float lines = marks(u, v + wobble, 4, 44, 0.42f, 0.48f, 0.2f, seed + 30);
  const float longer = marks(u, v + wobble, 2, 22, 0.3f, 0.5f, 0.13f, seed + 60);
  const float ragged = 0.16f * (fractalNoise(u, v, 14, 14, 3, seed + 40) - 0.5f);
  const float patches = marks(u + ragged, v + 0.7f * ragged, 3, 4, 0.4f, 0.5f, 0.3f, seed + 50);
  const float dark = std::max({0.62f * lines, 0.8f * longer, patches});
  glm::vec3 color = glm::mix(look.color, look.tint, 0.75f * glm::smoothstep(0.5f, 0.85f, broad));
  color *= 0.92f + 0.12f * strips;
  color = glm::mix(color, look.deep, 0.92f * dark);
  const float rough = fractalNoise(u, v, 20, 20, 3, seed + 70);
  return {0.5f + 0.2f * strips - 0.15f * lines - 0.15f * longer + patches * 0.3f * (rough - 0.5f),
          color};
}

/// Rough bark: `ridges` wandering ridges side by side, each cracked across into about `pieces`
/// pieces. `crack_depth` in [0, 1]: how far the cracks go down against the furrows.
Texel ridged(const BarkLook& look, float u, float v, int ridges, int pieces, float crack_depth,
             std::uint32_t seed) {
  const float fine = fractalNoise(u, v, 36, 16, 4, seed + 20);
  const float wander = 2.4f * (fractalNoise(u, v, 3, 4, 4, seed) - 0.5f);
  const float phase = u * static_cast<float>(ridges) + wander;
  const int ridge = floorOf(phase);
  const float x = phase - static_cast<float>(ridge);
  const int id = wrap(ridge, ridges);
  // Cracks lean, wander, and sit at other heights on each ridge.
  const float lean = 0.7f * (latticeValue(id, 1, seed + 5) - 0.5f) * (x - 0.5f);
  const float q = v * static_cast<float>(pieces) + latticeValue(id, 0, seed + 6) + lean +
                  0.9f * (fractalNoise(u, v, 5, 9, 3, seed + 7) - 0.5f);
  const int piece = floorOf(q);
  const float y = q - static_cast<float>(piece);
  const float value = latticeValue(id, wrap(piece, pieces), seed + 8);
  const float width = 0.3f + 0.4f * valueNoise(u, v, 4, 4, seed + 9);  // of the furrows
  const float rough = 0.5f * (fine - 0.5f);
  const float off_furrow = glm::smoothstep(0.0f, width, 2 * std::min(x, 1 - x) + rough);
  const float off_crack = glm::smoothstep(0.0f, 0.3f, 2 * std::min(y, 1 - y) + rough);
  const float top = off_furrow * (1 - crack_depth * (1 - off_crack));
  const float height = std::clamp(top * (0.62f + 0.2f * value) + 0.5f * (fine - 0.4f), 0.0f, 1.0f);
  const float lichen = glm::smoothstep(0.54f, 0.72f, fractalNoise(u, v, 4, 4, 4, seed + 40)) * top;
  glm::vec3 color = glm::mix(look.deep, look.color, glm::smoothstep(0.0f, 0.62f, height));
  color = glm::mix(color, look.tint, 0.55f * std::max(lichen, 0.6f * value * top));
  color *= 0.76f + 0.42f * fine;
  return {height, color};
}

Texel plates(const BarkLook& look, float u, float v, std::uint32_t seed) {
  const float warp_u = 0.07f * (fractalNoise(u, v, 5, 5, 3, seed) - 0.5f);
  const float warp_v = 0.07f * (fractalNoise(u, v, 5, 5, 3, seed + 5) - 0.5f);
  const Cell cell = cellNoise(u + warp_u, v + warp_v, 6, 3, seed + 10);
  // Flakes: thin layers with ragged steps inside each plate.
  const float layers = fractalNoise(u + warp_u, v + warp_v, 9, 9, 3, seed + 20) * 5 + cell.value;
  const float step = layers - std::floor(layers);
  const float fine = fractalNoise(u, v, 36, 36, 3, seed + 30);
  const float plate = glm::smoothstep(0.0f, 0.17f, cell.border + 0.14f * (fine - 0.5f));
  const float height = std::clamp(plate * (0.55f + 0.12f * std::floor(layers) / 5 +
                                           0.16f * glm::smoothstep(0.0f, 0.25f, step)) +
                                      0.12f * fine,
                                  0.0f, 1.0f);
  glm::vec3 flake =
      glm::mix(look.color, look.tint,
               glm::smoothstep(0.3f, 0.75f, 0.55f * cell.value + 0.45f * (std::floor(layers) / 5)));
  flake *= 0.93f + 0.08f * glm::smoothstep(0.0f, 0.5f, step);
  glm::vec3 color = glm::mix(look.deep, flake, plate);
  color *= 0.86f + 0.28f * fine;
  return {height, color};
}

Texel smooth(const BarkLook& look, float u, float v, std::uint32_t seed) {
  const float warp = 0.06f * (fractalNoise(u, v, 3, 2, 3, seed) - 0.5f);
  const float stripes = fractalNoise(u + warp, v, 22, 2, 4, seed + 10);
  const float broad = fractalNoise(u, v, 3, 3, 4, seed + 20);
  const float fine = fractalNoise(u, v, 40, 40, 3, seed + 30);
  const float pores = marks(u, v, 16, 26, 0.3f, 0.3f, 0.16f, seed + 40);
  glm::vec3 color = glm::mix(look.color, look.tint, glm::smoothstep(0.45f, 0.7f, broad));
  color = glm::mix(color, look.deep, 0.5f * glm::smoothstep(0.45f, 0.75f, stripes));
  color = glm::mix(color, look.deep, 0.45f * pores);
  color *= 0.88f + 0.22f * fine;
  return {0.5f + 0.2f * (0.5f - stripes) + 0.12f * fine + 0.12f * pores, color};
}

}  // namespace

BarkTexture makeBark(const BarkLook& look, int size, std::uint32_t seed) {
  const auto shade = [&](float u, float v) {
    switch (look.kind) {
      case BarkKind::kLenticels:
        return lenticels(look, u, v, seed);
      case BarkKind::kPaper:
        return paper(look, u, v, seed);
      case BarkKind::kFurrows:
        return ridged(look, u, v, 10, 5, 0.5f, seed);
      case BarkKind::kBlocks:
        return ridged(look, u, v, 9, 12, 0.9f, seed);
      case BarkKind::kPlates:
        return plates(look, u, v, seed);
      default:
        return smooth(look, u, v, seed);
    }
  };
  const auto n = static_cast<std::size_t>(size);
  BarkTexture bark{Image(size, size), Image(size, size)};
  std::vector<float> heights(n * n);
  parallelFor(n, 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < n; ++x) {
      const Texel texel = shade((static_cast<float>(x) + 0.5f) / static_cast<float>(size),
                                (static_cast<float>(y) + 0.5f) / static_cast<float>(size));
      heights[y * n + x] = texel.height;
      std::uint8_t* pixel = bark.color.at(static_cast<int>(x), static_cast<int>(y));
      for (int c = 0; c < 3; ++c) pixel[c] = toByte(texel.color[c]);
      pixel[3] = 255;
    }
  });
  // Central differences with wrap-around; the relief keeps its look at any size.
  const float scale = look.relief * 0.02f * static_cast<float>(size);
  parallelFor(n, 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < n; ++x) {
      const auto at = [&](std::size_t i, std::size_t j) { return heights[(j % n) * n + i % n]; };
      const float dx = 0.5f * (at(x + 1, y) - at(x + n - 1, y));
      const float dy = 0.5f * (at(x, y + 1) - at(x, y + n - 1));  // downwards in the image
      const glm::vec3 normal = glm::normalize(glm::vec3(-scale * dx, scale * dy, 1.0f));
      std::uint8_t* pixel = bark.normal.at(static_cast<int>(x), static_cast<int>(y));
      for (int c = 0; c < 3; ++c) pixel[c] = toByte(0.5f * normal[c] + 0.5f);
      pixel[3] = 255;
    }
  });
  return bark;
}

}  // namespace verdure
