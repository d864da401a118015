#include "render/mipmaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "shared/color.h"

namespace verdure {
namespace {

/// A level in floats: RGB linear, w = alpha. Where w is 0 the colour means nothing.
struct Level {
  int width = 0, height = 0;
  std::vector<glm::vec4> texels;
  const glm::vec4& at(int x, int y) const {
    return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

constexpr std::size_t kRowsAtOnce = 8;

template <class Body>
void forEachTexel(Level& level, const Body& body) {
  parallelFor(static_cast<std::size_t>(level.height), kRowsAtOnce, [&](std::size_t y) {
    for (int x = 0; x < level.width; ++x)
      level.texels[y * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x)] =
          body(x, static_cast<int>(y));
  });
}

Level makeLevel(int width, int height) {
  return {
      width, height,
      std::vector<glm::vec4>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
}

std::array<float, 256> byteTable(bool srgb) {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i) {
    const float s = static_cast<float>(i) / 255.0f;
    table[i] = srgb ? shared::linearFromSrgb(s) : s;
  }
  return table;
}

Level fromImage(const Image& image, bool srgb, bool alpha) {
  const std::array<float, 256> color = byteTable(srgb), linear = byteTable(false);
  Level level = makeLevel(image.width, image.height);
  forEachTexel(level, [&](int x, int y) {
    const std::uint8_t* p = image.at(x, y);
    return glm::vec4(color[p[0]], color[p[1]], color[p[2]], alpha ? linear[p[3]] : 1.0f);
  });
  return level;
}

/// Texels of the finer level under a texel of the coarser one, in one dimension, with weights: odd
/// sizes overlap by parts.
struct Span {
  int first = 0, count = 0;
  std::array<float, 4> weight{};
};

Span sourceSpan(int target, int target_size, int source_size) {
  const double begin = static_cast<double>(target) * source_size / target_size;
  const double end = static_cast<double>(target + 1) * source_size / target_size;
  Span span;
  span.first = static_cast<int>(begin);
  for (int s = span.first; s < end - 1e-9 && s < source_size; ++s) {
    const double overlap = std::min<double>(end, s + 1) - std::max<double>(begin, s);
    span.weight[static_cast<std::size_t>(span.count++)] =
        static_cast<float>(overlap / (end - begin));
  }
  return span;
}

Level halve(const Level& fine) {
  Level coarse = makeLevel(std::max(fine.width / 2, 1), std::max(fine.height / 2, 1));
  forEachTexel(coarse, [&](int x, int y) {
    const Span h = sourceSpan(x, coarse.width, fine.width);
    const Span v = sourceSpan(y, coarse.height, fine.height);
    glm::vec3 color(0.0f);
    float alpha = 0.0f;
    for (int j = 0; j < v.count; ++j)
      for (int i = 0; i < h.count; ++i) {
        const glm::vec4& t = fine.at(h.first + i, v.first + j);
        const float weight =
            h.weight[static_cast<std::size_t>(i)] * v.weight[static_cast<std::size_t>(j)] * t.w;
        color += weight * glm::vec3(t);
        alpha += weight;
      }
    return alpha > 0.0f ? glm::vec4(color / alpha, alpha) : glm::vec4(0.0f);
  });
  return coarse;
}

std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

gpu::MipLevel toBytes(const Level& level, bool srgb, bool alpha) {
  gpu::MipLevel out{static_cast<std::uint32_t>(level.width),
                    static_cast<std::uint32_t>(level.height),
                    std::vector<std::uint8_t>(level.texels.size() * 4)};
  parallelFor(level.texels.size(), 4096, [&](std::size_t i) {
    const glm::vec4& t = level.texels[i];
    for (int c = 0; c < 3; ++c)
      out.rgba[4 * i + static_cast<std::size_t>(c)] =
          toByte(srgb ? shared::srgbFromLinear(t[c]) : t[c]);
    out.rgba[4 * i + 3] = alpha ? toByte(t.w) : 255;
  });
  return out;
}

std::vector<Level> allLevels(Level first) {
  std::vector<Level> levels;
  levels.push_back(std::move(first));
  while (levels.back().width > 1 || levels.back().height > 1)
    levels.push_back(halve(levels.back()));
  return levels;
}

/// Gives transparent texels the colour of the coarser level, from the coarsest down.
void fillTransparent(std::vector<Level>& levels) {
  for (std::size_t i = levels.size() - 1; i-- > 0;) {
    const Level& coarse = levels[i + 1];
    Level& fine = levels[i];
    forEachTexel(fine, [&](int x, int y) {
      const glm::vec4 t = fine.at(x, y);
      if (t.w > 0.0f) return t;
      return glm::vec4(glm::vec3(coarse.at(std::min(x / 2, coarse.width - 1),
                                           std::min(y / 2, coarse.height - 1))),
                       0.0f);
    });
  }
}

void scaleAlpha(gpu::MipLevel& level, float scale) {
  for (std::size_t i = 3; i < level.rgba.size(); i += 4)
    level.rgba[i] = toByte(static_cast<float>(level.rgba[i]) / 255.0f * scale);
}

/// The scale of alpha at which the level covers `wanted`; coverage grows with the scale.
float coverageScale(const gpu::MipLevel& level, float cutoff, double wanted) {
  float low = 0.0f, high = 8.0f;
  for (int step = 0; step < 14; ++step) {
    const float middle = 0.5f * (low + high);
    (alphaCoverage(level, cutoff, kCoverageSlope, middle) < wanted ? low : high) = middle;
  }
  return 0.5f * (low + high);
}

}  // namespace

double alphaCoverage(const gpu::MipLevel& level, float cutoff, float slope, float scale) {
  constexpr int kSub = 2;  // samples per texel and direction
  const auto w = static_cast<std::size_t>(level.width), h = static_cast<std::size_t>(level.height);
  std::vector<double> rows(h, 0.0);
  parallelFor(h, kRowsAtOnce, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const auto alpha = [&](std::size_t i, std::size_t j) {
        return static_cast<float>(level.rgba[4 * ((j % h) * w + i % w) + 3]) / 255.0f;
      };
      const float a00 = alpha(x, y), a10 = alpha(x + 1, y), a01 = alpha(x, y + 1),
                  a11 = alpha(x + 1, y + 1);
      for (int j = 0; j < kSub; ++j)
        for (int i = 0; i < kSub; ++i) {
          const float s = (static_cast<float>(i) + 0.5f) / kSub;
          const float t = (static_cast<float>(j) + 0.5f) / kSub;
          const float a =
              std::min(1.0f, scale * glm::mix(glm::mix(a00, a10, s), glm::mix(a01, a11, s), t));
          const float covered =
              std::isinf(slope) ? (a >= cutoff ? 1.0f : 0.0f) : (a - cutoff) * slope + 0.5f;
          rows[y] += static_cast<double>(std::clamp(covered, 0.0f, 1.0f));
        }
    }
  });
  double sum = 0.0;
  for (const double row : rows) sum += row;
  return sum / static_cast<double>(w * h * kSub * kSub);
}

MipChain buildColorMips(const Image& image, std::optional<float> alpha_cutoff) {
  const bool alpha = alpha_cutoff.has_value();
  std::vector<Level> levels = allLevels(fromImage(image, true, alpha));
  if (alpha) fillTransparent(levels);
  MipChain chain;
  chain.mean_color = glm::vec3(levels.back().texels[0]);
  for (const Level& level : levels) chain.levels.push_back(toBytes(level, true, alpha));
  if (alpha) {
    const double wanted =
        alphaCoverage(chain.levels[0], *alpha_cutoff, std::numeric_limits<float>::infinity());
    for (std::size_t i = 1; i < chain.levels.size(); ++i)
      scaleAlpha(chain.levels[i], coverageScale(chain.levels[i], *alpha_cutoff, wanted));
  }
  return chain;
}

MipChain buildLinearMips(const Image& image) {
  MipChain chain;
  for (const Level& level : allLevels(fromImage(image, false, false)))
    chain.levels.push_back(toBytes(level, false, false));
  return chain;
}

}  // namespace verdure
