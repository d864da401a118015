#include "verdure/terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scene/terrain_levels.h"
#include "shared/terrain.h"
#include "verdure/error.h"
#include "verdure/image.h"

namespace verdure {
namespace {

/// Places and heights are at most so far from the origin, and samples so near to each other: slopes
/// and their squares are finite.
constexpr float kMostTerrainM = 1e7f, kLeastSpacingM = 1e-4f;
/// With fewer, the level place about the origin would reach the edges of a grown terrain.
constexpr int kLeastGrownSamples = 9;

bool isFinite(const glm::vec2& v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}

void checkSize(const glm::vec2& size_m, const std::string& where) {
  if (!isFinite(size_m) || !(size_m.x > 0.0f && size_m.y > 0.0f))
    throw Error(where, "the ground's size is not above 0 and finite",
                "give its metres along x and along z");
}

void checkPlace(const Terrain& terrain, const std::string& where) {
  const glm::vec2 last =
      terrain.corner + terrain.spacing_m * glm::vec2(terrain.width - 1, terrain.height - 1);
  const auto isNear = [](const glm::vec2& v) {
    return std::abs(v.x) <= kMostTerrainM && std::abs(v.y) <= kMostTerrainM;
  };
  if (!isNear(terrain.corner) || !isNear(last))
    throw Error(where, "the ground reaches beyond 10,000 km from the origin", "make it smaller");
  if (!(terrain.spacing_m.x >= kLeastSpacingM && terrain.spacing_m.y >= kLeastSpacingM))
    throw Error(where, "its samples are less than 0.1 mm apart",
                "give a larger size or fewer samples");
}

std::size_t texelCount(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

glm::uvec2 sampleCounts(const Terrain& terrain) {
  return {static_cast<unsigned>(terrain.width), static_cast<unsigned>(terrain.height)};
}

/// Values of a picture's first channel, 0 is black and 1 is white.
std::vector<double> firstChannel(const Image16& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<double> values(texelCount(image.width, image.height));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = image.values[i * channels] / 65535.0;
  return values;
}

/// Gradient noise (Perlin, "An Image Synthesizer", SIGGRAPH 1985) with the smoother fade of his
/// "Improving Noise" (2002); cells have the side 1. About [-1, 1].
double hillNoise(const glm::dvec2& p, std::uint64_t seed) {
  const glm::dvec2 before = glm::floor(p), f = p - before;
  const auto x = static_cast<std::int64_t>(before.x), y = static_cast<std::int64_t>(before.y);
  const auto slopeFrom = [&](std::int64_t i, std::int64_t j) {
    const std::uint64_t row = hash(seed ^ hash(static_cast<std::uint64_t>(y + j)));
    const std::uint64_t bits = hash(row ^ static_cast<std::uint64_t>(x + i));
    const glm::dvec2 slope(static_cast<double>(bits & 0xffffffffu) * 0x1p-31 - 1.0,
                           static_cast<double>(bits >> 32) * 0x1p-31 - 1.0);
    return glm::dot(slope, f - glm::dvec2(i, j));
  };
  const glm::dvec2 share = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  return glm::mix(glm::mix(slopeFrom(0, 0), slopeFrom(1, 0), share.x),
                  glm::mix(slopeFrom(0, 1), slopeFrom(1, 1), share.x), share.y);
}

/// Shape of hills: a sum of noise, from the largest hills down to what samples resolve.
class Hills {
 public:
  Hills(std::uint64_t seed, double largest_m, double finest_m)
      : seed_(hash(seed)), largest_m_(largest_m) {
    constexpr int kMostOctaves = 6;
    for (double size = largest_m; octaves_ < kMostOctaves && size >= finest_m; size *= 0.5)
      ++octaves_;
  }

  double at(glm::dvec2 place) const {
    // With a half, slopes would be as great at all sizes; rain has rounded what is small.
    constexpr double kNextOctave = 0.25;
    double sum = 0.0, weight = 1.0;
    place /= largest_m_;
    for (int octave = 0; octave < octaves_; ++octave) {
      const std::uint64_t bits = hash(seed_ + static_cast<std::uint64_t>(octave));
      const glm::dvec2 offset(static_cast<double>(bits & 0xffffu) * 0x1p-16,
                              static_cast<double>((bits >> 16) & 0xffffu) * 0x1p-16);
      sum += weight * hillNoise(place + offset, bits);
      weight *= kNextOctave;
      // Turned by the angle of a triangle of sides 3, 4 and 5, so that lattices do not show.
      place = 2.0 * glm::dvec2(0.8 * place.x - 0.6 * place.y, 0.6 * place.x + 0.8 * place.y);
    }
    return sum;
  }

 private:
  std::uint64_t seed_;
  double largest_m_;
  int octaves_ = 0;
};

/// Stretches heights so that their highest and lowest differ by `relief_m` exactly and 0 stays 0.
void stretchTo(float relief_m, std::vector<float>& heights) {
  const auto [lowest, highest] = std::ranges::minmax(heights);
  if (relief_m == 0.0f) {
    std::ranges::fill(heights, 0.0f);
    return;
  }
  VERDURE_CHECK_LT(lowest, highest);
  // Multiples of the relief's last bit: floats hold them and their differences exactly.
  const double bit = std::max(std::ldexp(1.0, std::ilogb(relief_m) - 23),
                              double{std::numeric_limits<float>::denorm_min()});
  const double scale = double{relief_m} / (double{highest} - double{lowest});
  const auto stretched = [&](float height) { return bit * std::round(height * scale / bit); };
  const double low = stretched(lowest), high = low + double{relief_m};
  for (float& height : heights)
    height =
        static_cast<float>(height == highest ? high : std::clamp(stretched(height), low, high));
}

}  // namespace

float Terrain::heightAt(const glm::vec2& place) const {
  const auto [before, share] = shared::terrainCell(place, corner, spacing_m, sampleCounts(*this));
  const float* first = &heights[before.y * static_cast<std::size_t>(width) + before.x];
  return shared::bilinearHeight({first[0], first[1], first[width], first[width + 1]}, share);
}

glm::vec3 Terrain::normalAt(const glm::vec2& place) const {
  const glm::uvec2 samples = sampleCounts(*this);
  const auto [before, share] = shared::terrainCell(place, corner, spacing_m, samples);
  const int x = static_cast<int>(before.x), z = static_cast<int>(before.y);
  const glm::vec2 slope = shared::bilinearSlope(
      terrainSlope(*this, x, z), terrainSlope(*this, x + 1, z), terrainSlope(*this, x, z + 1),
      terrainSlope(*this, x + 1, z + 1), share);
  return shared::slopeNormal(slope * shared::slopeLeft(place, corner, spacing_m, samples));
}

float CoverMap::at(const glm::vec2& place) const {
  const glm::vec2 texels(width, height);
  const glm::vec2 texel =
      glm::clamp((place - corner) / size_m * texels - 0.5f, glm::vec2(0.0f), texels - 1.0f);
  const glm::ivec2 before(texel), after = glm::min(before + 1, glm::ivec2(width - 1, height - 1));
  const auto value = [this](int x, int y) {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  };
  return shared::bilinearHeight({value(before.x, before.y), value(after.x, before.y),
                                 value(before.x, after.y), value(after.x, after.y)},
                                texel - glm::vec2(before));
}

Terrain readTerrain(const std::filesystem::path& path, const TerrainOptions& options) {
  checkSize(options.size_m, path.string());
  if (!std::isfinite(options.lowest_m) || !std::isfinite(options.highest_m))
    throw Error(path.string(), "the heights of black and white are not finite",
                "give both in metres");
  const Image16 image = decodeImage16(readFile(path), path.string());
  if (image.width < 2 || image.height < 2)
    throw Error(path.string(),
                "a height field of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " texels has no slope",
                "use a picture of 2 x 2 texels or more");
  Terrain terrain;
  terrain.width = image.width;
  terrain.height = image.height;
  terrain.corner = -0.5f * options.size_m;
  terrain.spacing_m = options.size_m / glm::vec2(image.width - 1, image.height - 1);
  terrain.heights.reserve(texelCount(image.width, image.height));
  for (const double white : firstChannel(image))
    terrain.heights.push_back(
        static_cast<float>(glm::mix(double{options.lowest_m}, double{options.highest_m}, white)));
  checkTerrain(terrain, path.string());
  return terrain;
}

CoverMap readCoverMap(const std::filesystem::path& path, const glm::vec2& size_m) {
  checkSize(size_m, path.string());
  const Image16 image = decodeImage16(readFile(path), path.string());
  const std::vector<double> values = firstChannel(image);
  CoverMap map{image.width, image.height, -0.5f * size_m, size_m, {}};
  map.values.assign(values.begin(), values.end());
  checkCoverMap(map, path.string());
  return map;
}

Terrain growTerrain(const TerrainGrowOptions& options) {
  const std::string where = "terrain";
  checkSize(options.size_m, where);
  if (!(options.relief_m >= 0.0f && options.relief_m <= kMostTerrainM))
    throw Error(where, "its relief is not a length up to 10,000 km", "give 0 m or more");
  if (!std::isfinite(options.hill_m) || !(options.hill_m > 0.0f))
    throw Error(where, "the size of its hills is not above 0", "give it in metres");
  if (options.samples < kLeastGrownSamples || options.samples > 8193)
    throw Error(where, std::to_string(options.samples) + " samples along a side",
                "give " + std::to_string(kLeastGrownSamples) + " to 8193");

  Terrain terrain;
  terrain.width = terrain.height = options.samples;
  terrain.spacing_m = options.size_m / static_cast<float>(options.samples - 1);
  terrain.corner = -0.5f * options.size_m;
  checkPlace(terrain, where);

  // Hills that samples do not resolve cannot be shown; those far larger than the ground are slopes.
  const glm::dvec2 size(options.size_m), spacing(terrain.spacing_m);
  const double finest = 2.0 * std::max(spacing.x, spacing.y);
  const double largest = std::clamp(double{options.hill_m}, finest, 4.0 * std::max(size.x, size.y));
  const Hills hills(options.seed, largest, finest);
  // A level place of 3 m about the origin, with all samples that reach into it.
  const double level = std::min(3.0, 0.15 * std::min(size.x, size.y)) + glm::length(spacing);
  const double around = hills.at(glm::dvec2(0.0));

  const auto n = static_cast<std::size_t>(options.samples);
  terrain.heights.resize(n * n);
  parallelFor(n, 16, [&](std::size_t z) {
    for (std::size_t x = 0; x < n; ++x) {
      const glm::dvec2 place =
          size * (glm::dvec2(x, z) / static_cast<double>(options.samples - 1) - 0.5);
      const double rise = glm::smoothstep(level, level + 0.5 * largest, glm::length(place));
      terrain.heights[z * n + x] = static_cast<float>(rise * (hills.at(place) - around));
    }
  });
  stretchTo(options.relief_m, terrain.heights);
  return terrain;
}

void checkTerrain(const Terrain& terrain, const std::string& where) {
  if (terrain.width < 2 || terrain.height < 2)
    throw Error(where, "a height field has fewer than 2 samples along x or z",
                "give at least 2 x 2");
  if (terrain.heights.size() != texelCount(terrain.width, terrain.height))
    throw Error(where, "the number of heights is not width x height", "give one for each sample");
  checkPlace(terrain, where);
  if (!std::ranges::all_of(terrain.heights, [](float h) { return std::abs(h) <= kMostTerrainM; }))
    throw Error(where, "a height is not finite or beyond 10,000 km", "use heights in metres");
}

void checkCoverMap(const CoverMap& map, const std::string& where) {
  if (map.width < 1 || map.height < 1)
    throw Error(where, "a cover map has no texels", "give at least one");
  if (map.values.size() != texelCount(map.width, map.height))
    throw Error(where, "the number of values is not width x height", "give one for each texel");
  checkSize(map.size_m, where);
  if (!isFinite(map.corner))
    throw Error(where, "its corner is not finite", "give x and z in metres");
  if (!std::ranges::all_of(map.values, [](float v) { return v >= 0.0f && v <= 1.0f; }))
    throw Error(where, "a value is outside [0, 1]", "use shares of what grows at most");
}

}  // namespace verdure
