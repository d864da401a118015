#include "render/packed_grass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shared/color.h"
#include "verdure/error.h"

namespace verdure {
namespace {

/// What a map becomes: colours are sRGB, premultiplied.
struct PackedMips {
  std::vector<gpu::MipLevel> colors, data;
};
PackedMips packMips(const GrassMap& map) {
  PackedMips packed;
  for (const GrassMap& mip : grassMips(map)) {
    gpu::MipLevel colors{static_cast<std::uint32_t>(mip.width),
                         static_cast<std::uint32_t>(mip.height),
                         std::vector<std::uint8_t>(mip.texelCount() * 4)};
    gpu::MipLevel data = colors;
    parallelFor(mip.texelCount(), 1 << 14, [&](std::size_t i) {
      const glm::vec4& color = mip.color[i];
      for (int c = 0; c < 3; ++c)
        colors.rgba[i * 4 + static_cast<std::size_t>(c)] = toByte(shared::srgbFromLinear(color[c]));
      colors.rgba[i * 4 + 3] = toByte(color.a);
      const auto bytes = packGrassData(mip.data[i]);
      std::copy(bytes.begin(), bytes.end(), data.rgba.begin() + static_cast<std::ptrdiff_t>(i * 4));
    });
    packed.colors.push_back(std::move(colors));
    packed.data.push_back(std::move(data));
  }
  return packed;
}

void addLayer(const GrassMap& map, std::vector<std::vector<gpu::MipLevel>>& colors,
              std::vector<std::vector<gpu::MipLevel>>& data) {
  PackedMips packed = packMips(map);
  colors.push_back(std::move(packed.colors));
  data.push_back(std::move(packed.data));
}

constexpr int kColumns = shared::kFarColumns, kRows = shared::kFarRows;
std::size_t farTexel(int x, int y) {
  return static_cast<std::size_t>(y * kColumns + x);
}

/// Means of a slice's texels, or the nearest of a coarser one's: premultiplied.
std::vector<glm::vec4> farTexels(const GrassMap& slice) {
  std::vector<glm::vec4> texels(kColumns * kRows);
  for (int y = 0; y < kRows; ++y) {
    const int top = y * slice.height / kRows;
    const int bottom = std::max((y + 1) * slice.height / kRows, top + 1);
    for (int x = 0; x < kColumns; ++x) {
      const int left = x * slice.width / kColumns;
      const int right = std::max((x + 1) * slice.width / kColumns, left + 1);
      glm::vec4 sum(0.0f);
      for (int j = top; j < bottom; ++j)
        for (int i = left; i < right; ++i)
          sum += slice.color[static_cast<std::size_t>(j) * static_cast<std::size_t>(slice.width) +
                             static_cast<std::size_t>(i)];
      texels[farTexel(x, y)] = sum / static_cast<float>((bottom - top) * (right - left));
    }
  }
  return texels;
}

/// Colours are not premultiplied, and alpha is its root: what little stands at the top of the grass
/// is all that is seen of it from afar. Where nothing is, the colour is that of the row below.
gpu::MipLevel packFar(const std::vector<glm::vec4>& texels) {
  gpu::MipLevel packed{kColumns, kRows, std::vector<std::uint8_t>(kColumns * kRows * 4)};
  glm::vec3 below(0.0f);
  for (int y = kRows - 1; y >= 0; --y) {
    glm::vec4 row(0.0f);
    for (int x = 0; x < kColumns; ++x) row += texels[farTexel(x, y)];
    if (row.a > 0.0f) below = glm::vec3(row) / row.a;
    for (int x = 0; x < kColumns; ++x) {
      const glm::vec4& texel = texels[farTexel(x, y)];
      const glm::vec3 color = texel.a > 1e-6f ? glm::vec3(texel) / texel.a : below;
      std::uint8_t* const bytes = packed.rgba.data() + farTexel(x, y) * 4;
      for (int c = 0; c < 3; ++c) bytes[c] = toByte(shared::srgbFromLinear(color[c]));
      bytes[3] = toByte(std::sqrt(texel.a));
    }
  }
  return packed;
}

/// shared::kFarLevels pictures, each mixed twice as widely along its rows as the last one.
void addFar(std::vector<glm::vec4> texels, std::vector<std::vector<gpu::MipLevel>>& layers) {
  for (int level = 0; level < shared::kFarLevels; ++level) {
    layers.push_back({packFar(texels)});
    const int step = 1 << level;
    std::vector<glm::vec4> wider(texels.size());
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x)
        wider[farTexel(x, y)] = 0.5f * texels[farTexel(x, y)] +
                                0.25f * (texels[farTexel((x + step) % kColumns, y)] +
                                         texels[farTexel((x + kColumns - step) % kColumns, y)]);
    texels = std::move(wider);
  }
}

/// GrassUniforms::canopy: what slices that are crossed at random leave open above even heights.
void setCanopy(const GrassSet& set, shared::GrassUniforms& u) {
  const int rows = set.slices[0].height;
  std::vector<double> alpha(static_cast<std::size_t>(rows), 0.0);
  for (const GrassMap& slice : set.slices)
    for (std::size_t i = 0; i < slice.texelCount(); ++i)
      alpha[i / static_cast<std::size_t>(slice.width)] += double{slice.color[i].a};
  const double texels = static_cast<double>(set.slices.size()) * set.slices[0].width;
  const auto rowAt = [&](double share) {  // of the height, from below
    const double row = std::clamp((1.0 - share) * rows - 0.5, 0.0, rows - 1.0);
    const auto low = static_cast<std::size_t>(row);
    const std::size_t high = std::min(low + 1, alpha.size() - 1);
    return std::min(std::lerp(alpha[low], alpha[high], row - static_cast<double>(low)) / texels,
                    0.98);
  };
  constexpr int kPerStep = 16;
  double depth = 0.0;
  for (int step = shared::kCanopySteps; step >= 0; --step) {
    double open = 0.0, sum = 0.0;
    for (int e = 0; e < 16; ++e)
      for (int a = 0; a < 16; ++a) {
        const double elevation = (e + 0.5) / 16.0 * glm::half_pi<double>();
        const double azimuth = (a + 0.5) / 16.0 * glm::half_pi<double>();
        const double weight = std::sin(elevation) * std::cos(elevation);
        const glm::dvec2 aside =
            glm::dvec2(std::cos(azimuth), std::sin(azimuth)) / std::tan(elevation);
        open += weight * std::exp(-depth * (aside.x / double{set.spacing_m.x} +
                                            aside.y / double{set.spacing_m.y}));
        sum += weight;
      }
    u.canopy[step] = glm::vec4(depth, open / sum, 0.0, 0.0);
    for (int k = 0; k < kPerStep && step > 0; ++k) {
      const double share = (step - (k + 0.5) / kPerStep) / shared::kCanopySteps;
      depth -=
          std::log(1.0 - rowAt(share)) * double{set.height_m} / (shared::kCanopySteps * kPerStep);
    }
  }
  // The inverse of the depth.
  for (int i = 0; i <= shared::kCanopySteps; ++i) {
    const float root = static_cast<float>(i) / shared::kCanopySteps;
    const float wanted = u.canopy[0].x * root * root;
    int step = shared::kCanopySteps;  // the highest whose lower neighbour is as deep
    while (step > 1 && u.canopy[step - 1].x < wanted) --step;
    const float low = u.canopy[step].x, high = u.canopy[step - 1].x;
    const float share = high > low ? std::clamp((wanted - low) / (high - low), 0.0f, 1.0f) : 0.0f;
    u.canopy[i].z = (static_cast<float>(step) - share) / shared::kCanopySteps;
  }
}

/// How far plants are drawn one by one: so that their ribbons in a picture a sixth of a turn wide
/// are about as many as that.
float bladeDistance(const std::vector<GrassPlant>& plants) {
  constexpr float kRibbons = 60000.0f;
  float per_m2 = 0.0f;
  for (const GrassPlant& plant : plants)
    for (const GrassPart& part : plant.parts)
      per_m2 += plant.per_m2 * static_cast<float>(part.count);
  if (per_m2 <= 0.0f) return 0.0f;
  return std::clamp(std::sqrt(kRibbons * 6.0f / (glm::pi<float>() * per_m2)), 1.0f, 10.0f);
}

/// Nothing is seen above, with a texel for what filters add.
float highestPlant(const GrassSet& set) {
  std::size_t first = static_cast<std::size_t>(set.slices[0].height);
  for (const GrassMap& slice : set.slices) {
    const auto covered = std::find_if(slice.color.begin(), slice.color.end(),
                                      [](const glm::vec4& texel) { return texel.a > 0.0f; });
    first = std::min(first, static_cast<std::size_t>(covered - slice.color.begin()) /
                                static_cast<std::size_t>(slice.width));
  }
  const float rows = static_cast<float>(set.slices[0].height);
  return set.height_m * std::min((rows - static_cast<float>(first) + 1.0f) / rows, 1.0f);
}

void setMean(const GrassSet& set, shared::GrassUniforms& u) {
  glm::dvec4 color(0.0);
  double through = 0.0;
  for (const GrassMap& slice : set.slices)
    for (std::size_t i = 0; i < slice.texelCount(); ++i) {
      color += glm::dvec4(slice.color[i]);
      through += double{slice.data[i].z};
    }
  const double covered = std::max(color.a, 1e-9);
  u.mean = glm::vec4(glm::vec3(color) / static_cast<float>(covered), through / covered);
}

}  // namespace

std::array<std::uint8_t, 4> packGrassData(const glm::vec4& data) {
  const auto sign = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 127.0f) + 128);
  };
  return {sign(data.x), sign(data.y), toByte(data.z), toByte(data.w)};
}

PackedGrass packGrass(const GrassLayer& layer) {
  if (layer.set == nullptr) throw Error("grass", "a layer has no set", "set GrassLayer::set");
  const GrassSet& set = *layer.set;
  checkGrassSet(set, set.name);
  const auto demand = [](bool good, const char* what, const char* range) {
    if (!good) throw Error("grass", std::string(what) + " is out of range", range);
  };
  demand(layer.density >= 0.0f && layer.density <= 1.0f, "density", "choose 0 to 1");
  demand(std::isfinite(layer.turn), "turn", "give a finite angle");
  demand(layer.most_slices >= 1 && layer.most_slices <= 256, "most_slices", "choose 1 to 256");
  demand(layer.scatter >= 0.0f && layer.scatter <= 0.9f, "scatter", "choose 0 to 0.9");
  demand(layer.variation >= 0.0f && layer.variation <= 1.0f, "variation", "choose 0 to 1");
  if (layer.cover != nullptr) checkCoverMap(*layer.cover, "cover of " + set.name);

  PackedGrass packed;
  std::vector<glm::vec4> mean(kColumns * kRows, glm::vec4(0.0f));
  for (const GrassMap& slice : set.slices) {
    addLayer(slice, packed.slice_colors, packed.slice_data);
    const std::vector<glm::vec4> texels = farTexels(slice);
    addFar(texels, packed.far_colors);
    for (std::size_t i = 0; i < texels.size(); ++i)
      mean[i] += texels[i] / static_cast<float>(set.slices.size());
  }
  addFar(mean, packed.far_colors);
  addLayer(set.opaque, packed.slice_colors, packed.slice_data);
  addLayer(set.ground, packed.ground_colors, packed.ground_data);
  if (!set.middle.empty()) addLayer(set.middle, packed.ground_colors, packed.ground_data);
  packed.cover = layer.cover != nullptr ? *layer.cover
                                        : CoverMap{1, 1, glm::vec2(0.0f), glm::vec2(1.0f), {1.0f}};
  packed.ends_at_depth = layer.ends_at_depth;
  packed.medium = layer.medium;
  shared::GrassUniforms& u = packed.uniforms;
  u.shell = glm::vec4(set.height_m, set.spacing_m, set.tile_m);
  const bool middle = layer.middle && !set.middle.empty();
  u.limits = glm::vec4(layer.most_slices, 0.49f, middle, set.slices.size());
  const GrassMap& slice = set.slices[0];
  u.texels = glm::vec4(static_cast<float>(slice.width) / (4.0f * set.tile_m),
                       static_cast<float>(slice.height) / set.height_m,
                       static_cast<float>(set.ground.width) / (4.0f * set.tile_m), 0.0f);
  const float c = std::cos(layer.turn), s = std::sin(layer.turn);
  u.rows = layer.mirrored ? glm::vec4(c, s, s, -c) : glm::vec4(c, s, -s, c);
  u.cover_size = glm::vec4(packed.cover.width, packed.cover.height, layer.density, layer.variation);
  if (layer.blades) {
    packed.plants = set.species.plants;
    std::erase_if(packed.plants, [](const GrassPlant& plant) { return plant.per_m2 <= 0.0f; });
    const float far = bladeDistance(packed.plants);
    u.blades = glm::vec4(0.5f * far, far, 0.0f, 0.0f);
  }
  u.placing = glm::vec4(layer.scatter, highestPlant(set), 0.0f, 0.0f);
  u.soil = glm::vec4(set.species.soil_color, 0.0f);
  setCanopy(set, u);
  setMean(set, u);
  return packed;
}

}  // namespace verdure
