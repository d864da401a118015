#include "grass/grass_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// The texels of a row or column of `count` that become one of `half`, and their weights: the box
/// of an odd size covers parts of texels.
struct Taps {
  int first = 0, count = 0;
  float weights[3] = {};
};

std::vector<Taps> tapsOf(int count, int half) {
  std::vector<Taps> all(static_cast<std::size_t>(half));
  const double span = static_cast<double>(count) / half;
  for (int i = 0; i < half; ++i) {
    Taps& taps = all[static_cast<std::size_t>(i)];
    const double from = i * span, to = (i + 1) * span;
    taps.first = static_cast<int>(std::floor(from + 1e-9));
    for (int k = taps.first; k < std::min(count, static_cast<int>(std::ceil(to - 1e-9))); ++k)
      taps.weights[taps.count++] =
          static_cast<float>((std::min<double>(to, k + 1) - std::max<double>(from, k)) / span);
  }
  return all;
}

std::vector<glm::vec4> halved(const std::vector<glm::vec4>& from, int width,
                              const std::vector<Taps>& across, const std::vector<Taps>& down) {
  std::vector<glm::vec4> to(across.size() * down.size());
  parallelFor(down.size(), 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < across.size(); ++x) {
      glm::vec4 sum(0.0f);
      for (int j = 0; j < down[y].count; ++j) {
        glm::vec4 row(0.0f);
        const auto* texels =
            &from[static_cast<std::size_t>(down[y].first + j) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(across[x].first)];
        for (int i = 0; i < across[x].count; ++i) row += across[x].weights[i] * texels[i];
        sum += down[y].weights[j] * row;
      }
      to[y * across.size() + x] = sum;
    }
  });
  return to;
}

void checkMap(const GrassMap& map, const std::string& where, bool opaque) {
  if (map.width < 4 || map.height < 1 || map.width % 4 != 0)
    throw Error(where, fmt::format("is {} x {} texels", map.width, map.height),
                "make it four tiles wide, each of whole texels");
  if (map.color.size() != map.texelCount() || map.data.size() != map.texelCount())
    throw Error(where, "has not one colour and one data for each texel", "give both for all");
  for (std::size_t i = 0; i < map.texelCount(); ++i) {
    const glm::vec4& c = map.color[i];
    const glm::vec4& d = map.data[i];
    constexpr float kSlack = 1e-4f;
    const float most = c.a + kSlack;
    const bool good = c.a >= 0 && c.a <= 1 + kSlack && c.r >= 0 && c.r <= most && c.g >= 0 &&
                      c.g <= most && c.b >= 0 && c.b <= most &&
                      d.x * d.x + d.y * d.y <= most * most && d.z >= 0 && d.z <= most && d.w >= 0 &&
                      d.w <= most;
    if (!good)
      throw Error(where,
                  fmt::format("has a value out of range at texel ({}, {})",
                              i % static_cast<std::size_t>(map.width),
                              i / static_cast<std::size_t>(map.width)),
                  "colours and data are between 0 and alpha, normals shorter than that");
    if (opaque && c.a < 1 - kSlack)
      throw Error(where, "is not opaque everywhere", "fill its alpha with 1");
  }
}

void checkSlice(const GrassMap& slice, const GrassMap& first, const std::string& where) {
  if (slice.width != first.width || slice.height != first.height)
    throw Error(where,
                fmt::format("is {} x {} texels, others are {} x {}", slice.width, slice.height,
                            first.width, first.height),
                "make all of one size");
}

void checkLength(const std::string& where, const char* what, float value) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(where, fmt::format("{} is {}", what, value), "give a length above 0");
}

}  // namespace

void checkGrassSet(const GrassSet& set, const std::string& where) {
  checkLength(where, "height_m", set.height_m);
  checkLength(where, "spacing_m", set.spacing_m.x);
  checkLength(where, "spacing_m", set.spacing_m.y);
  checkLength(where, "tile_m", set.tile_m);
  if (set.slices.empty()) throw Error(where, "has no slices", "give at least one");
  if (set.slices.size() > 64)
    throw Error(where, fmt::format("has {} slices", set.slices.size()), "give 64 at most");
  for (std::size_t i = 0; i < set.slices.size(); ++i) {
    const std::string whose = fmt::format("{}: slice {}", where, i);
    const GrassMap& slice = set.slices[i];
    checkMap(slice, whose, false);
    checkSlice(slice, set.slices.front(), whose);
    if (std::all_of(slice.color.begin(), slice.color.end(),
                    [](const glm::vec4& c) { return c.a > 0.999f; }))
      throw Error(whose, "has no alpha: it is opaque everywhere",
                  "cut the grass out of its background");
  }
  checkMap(set.opaque, where + ": opaque", true);
  checkSlice(set.opaque, set.slices.front(), where + ": opaque");
  checkMap(set.ground, where + ": ground", true);
  if (set.ground.width != set.ground.height)
    throw Error(where + ": ground", "is not square", "make it 4 x 4 tiles");
  if (!set.middle.empty()) {
    checkMap(set.middle, where + ": middle", false);
    if (set.middle.width != set.middle.height)
      throw Error(where + ": middle", "is not square", "make it 4 x 4 tiles");
  }
}

std::vector<GrassMap> grassMips(const GrassMap& map) {
  std::vector<GrassMap> levels{map};
  while (levels.back().width > 1 || levels.back().height > 1) {
    const GrassMap& from = levels.back();
    GrassMap to;
    to.width = std::max(1, from.width / 2);
    to.height = std::max(1, from.height / 2);
    const std::vector<Taps> across = tapsOf(from.width, to.width);
    const std::vector<Taps> down = tapsOf(from.height, to.height);
    to.color = halved(from.color, from.width, across, down);
    to.data = halved(from.data, from.width, across, down);
    levels.push_back(std::move(to));
  }
  return levels;
}

GrassMap opaqueMap(const std::vector<GrassMap>& slices) {
  GrassMap map;
  map.width = slices.front().width;
  map.height = slices.front().height;
  map.color.resize(map.texelCount());
  map.data.resize(map.texelCount());
  const auto width = static_cast<std::size_t>(map.width);
  // What each row shows; where that is little, as much of it as of the rows near it.
  std::vector<glm::dvec4> color_sums(static_cast<std::size_t>(map.height), glm::dvec4(0.0));
  std::vector<glm::dvec4> data_sums(color_sums);
  parallelFor(color_sums.size(), 4, [&](std::size_t y) {
    for (const GrassMap& slice : slices)
      for (std::size_t x = 0; x < width; ++x) {
        color_sums[y] += glm::dvec4(slice.color[y * width + x]);
        data_sums[y] += glm::dvec4(slice.data[y * width + x]);
      }
  });
  std::vector<glm::vec4> color_means(color_sums.size()), data_means(color_sums.size());
  const double reach = 0.1 * static_cast<double>(map.height);
  for (std::size_t y = 0; y < color_sums.size(); ++y) {
    glm::dvec4 color(0.0, 0.0, 0.0, 1e-30), data(0.0);
    for (std::size_t k = 0; k < color_sums.size(); ++k) {
      const double away = (static_cast<double>(k) - static_cast<double>(y)) / reach;
      const double weight = std::exp(-0.5 * away * away) + 1e-12;
      color += weight * color_sums[k];
      data += weight * data_sums[k];
    }
    color_means[y] = glm::vec4(color / color.a);
    data_means[y] = glm::vec4(data / color.a);
  }
  parallelFor(color_means.size(), 4, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      glm::vec4 color(0.0f), data(0.0f);
      for (const GrassMap& slice : slices) {
        const float rest = 1.0f - color.a;
        color += rest * slice.color[y * width + x];
        data += rest * slice.data[y * width + x];
      }
      const float rest = 1.0f - color.a;
      map.color[y * width + x] = color + rest * color_means[y];
      map.data[y * width + x] = data + rest * data_means[y];
      map.color[y * width + x].a = 1.0f;
    }
  });
  return map;
}

GrassMap evenMap(int width, int height, const glm::vec3& color) {
  GrassMap map;
  map.width = width;
  map.height = height;
  map.color.assign(map.texelCount(), glm::vec4(color, 1.0f));
  map.data.assign(map.texelCount(), glm::vec4(0.0f));
  return map;
}

}  // namespace verdure
