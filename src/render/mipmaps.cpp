#include "render/mipmaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
float coverageScale(const gpu::MipLevel& level, float cutoff, double wanted,
                    const UsedTexels& used) {
  float low = 0.0f, high = 64.0f;
  for (int step = 0; step < 18; ++step) {
    const float middle = 0.5f * (low + high);
    (alphaCoverage(level, cutoff, kCoverageSlope, middle, used) < wanted ? low : high) = middle;
  }
  return 0.5f * (low + high);
}

}  // namespace

void UsedTexels::add(const Mesh& mesh) {
  if (mesh.uvs.empty()) return;
  cells_.resize(std::size_t{kSize} * kSize);
  constexpr std::size_t kMostTriangles = 4096;
  const std::size_t step = std::max<std::size_t>(mesh.triangleCount() / kMostTriangles, 1);
  for (std::size_t t = 0; t < mesh.triangleCount(); t += step) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    if (std::max(corner[0], std::max(corner[1], corner[2])) >= mesh.uvs.size()) continue;
    const glm::vec2 a = mesh.uvs[corner[0]] * static_cast<float>(kSize),
                    b = mesh.uvs[corner[1]] * static_cast<float>(kSize),
                    c = mesh.uvs[corner[2]] * static_cast<float>(kSize);
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const glm::vec2 low = glm::floor(glm::min(a, glm::min(b, c))),
                    high = glm::floor(glm::max(a, glm::max(b, c)));
    // Far from 0 floats are coarser than cells, and integers end.
    const float farthest = std::max(glm::length(low), glm::length(high));
    if (area == 0.0f || high.x - low.x > kSize || high.y - low.y > kSize || !(farthest < 1e6f))
      continue;
    for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
      for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
        const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const auto side = [&](const glm::vec2& u, const glm::vec2& v) {
          return ((v.x - u.x) * (p.y - u.y) - (v.y - u.y) * (p.x - u.x)) / area;
        };
        if (side(a, b) >= 0.0f && side(b, c) >= 0.0f && side(c, a) >= 0.0f)
          cells_[static_cast<std::size_t>((y & (kSize - 1)) * kSize + (x & (kSize - 1)))] = 1;
      }
  }
  // Triangles smaller than a cell mark nothing; without any mark, nothing is known.
  if (std::find(cells_.begin(), cells_.end(), 1) == cells_.end()) cells_.clear();
}

bool UsedTexels::at(float u, float v) const {
  if (cells_.empty()) return true;
  const auto cell = [](float t) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(t * kSize), 0, kSize - 1));
  };
  return cells_[cell(v) * kSize + cell(u)] != 0;
}

double alphaCoverage(const gpu::MipLevel& level, float cutoff, float slope, float scale,
                     const UsedTexels& used) {
  const auto w = static_cast<std::size_t>(level.width), h = static_cast<std::size_t>(level.height);
  // Samples per texel and direction: at least as fine as the raster of use.
  const std::size_t sub = std::max<std::size_t>(2, UsedTexels::kSize / std::min(w, h));
  std::vector<std::pair<double, std::size_t>> rows(h);
  parallelFor(h, kRowsAtOnce, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x) {
      const auto alpha = [&](std::size_t i, std::size_t j) {
        return static_cast<float>(level.rgba[4 * ((j % h) * w + i % w) + 3]) / 255.0f;
      };
      const float a00 = alpha(x, y), a10 = alpha(x + 1, y), a01 = alpha(x, y + 1),
                  a11 = alpha(x + 1, y + 1);
      for (std::size_t j = 0; j < sub; ++j)
        for (std::size_t i = 0; i < sub; ++i) {
          // Between the centres of this texel and the next ones.
          const float s = (static_cast<float>(i) + 0.5f) / static_cast<float>(sub);
          const float t = (static_cast<float>(j) + 0.5f) / static_cast<float>(sub);
          const float u = (static_cast<float>(x) + 0.5f + s) / static_cast<float>(w),
                      v = (static_cast<float>(y) + 0.5f + t) / static_cast<float>(h);
          if (!used.at(u - std::floor(u), v - std::floor(v))) continue;
          const float a =
              std::min(1.0f, scale * glm::mix(glm::mix(a00, a10, s), glm::mix(a01, a11, s), t));
          const float covered =
              std::isinf(slope) ? (a >= cutoff ? 1.0f : 0.0f) : (a - cutoff) * slope + 0.5f;
          rows[y].first += static_cast<double>(std::clamp(covered, 0.0f, 1.0f));
          ++rows[y].second;
        }
    }
  });
  double sum = 0.0;
  std::size_t count = 0;
  for (const auto& [covered, samples] : rows) {
    sum += covered;
    count += samples;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

MipChain buildColorMips(const Image& image, std::optional<float> alpha_cutoff,
                        const UsedTexels& used) {
  const bool alpha = alpha_cutoff.has_value();
  std::vector<Level> levels = allLevels(fromImage(image, true, alpha));
  if (alpha) fillTransparent(levels);
  MipChain chain;
  chain.mean_color = glm::vec3(levels.back().texels[0]);
  for (const Level& level : levels) chain.levels.push_back(toBytes(level, true, alpha));
  if (alpha) {
    const double wanted = alphaCoverage(chain.levels[0], *alpha_cutoff,
                                        std::numeric_limits<float>::infinity(), 1.0f, used);
    for (std::size_t i = 1; i < chain.levels.size(); ++i)
      scaleAlpha(chain.levels[i], coverageScale(chain.levels[i], *alpha_cutoff, wanted, used));
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
