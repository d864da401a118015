#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"
#include "base/tile_noise.h"
#include "grass/draw_ribbons.h"
#include "grass/grass_maps.h"
#include "grass/wang_plants.h"
#include "verdure/error.h"
#include "verdure/grass.h"

namespace verdure {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Dead blades that lie on the soil and cover the species' share of it.
GrassPlant litterOf(const GrassSpecies& species) {
  GrassPart blade;
  blade.length_m = std::min(0.06f, 0.2f * species.tile_m);
  blade.length_spread = 0.5f;
  blade.width_m = 0.004f;
  blade.lean = 0.5f * kPi;
  blade.lean_spread = 0.0f;
  blade.bend = blade.bend_spread = 0.0f;
  blade.root_color = 0.7f * species.litter_color;
  blade.tip_color = species.litter_color;
  blade.color_spread = 0.4f;
  blade.transmitted = 0.3f;
  // Randomly placed areas cover 1 - exp(-their sum); a blade covers 0.64 of its rectangle.
  const float sum = -std::log(1.0f - std::min(species.litter, 0.98f));
  return {"litter", sum / (0.64f * blade.length_m * blade.width_m), 0.0f, {blade}};
}

/// Puts bare soil under what is drawn, the same in all tiles.
void addSoil(GrassMap& map, const glm::vec3& soil, float tile_m, std::uint32_t seed) {
  const int coarse = std::max(1, static_cast<int>(tile_m / 0.06f));
  const int fine = std::max(1, static_cast<int>(tile_m / 0.01f));
  const auto width = static_cast<std::size_t>(map.width);
  parallelFor(static_cast<std::size_t>(map.height), 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto tileAt = [](std::size_t i, int size) {
        const float at = 4.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(size);
        return at - std::floor(at);
      };
      const float u = tileAt(x, map.width), v = tileAt(y, map.height);
      const float noise = 0.5f * fractalNoise(u, v, coarse, coarse, 3, seed) +
                          0.5f * fractalNoise(u, v, fine, fine, 2, seed + 9);
      glm::vec4& color = map.color[y * width + x];
      color += glm::vec4(glm::min((0.3f + 1.4f * noise) * soil, glm::vec3(1.0f)), 1.0f) *
               (1.0f - color.a);
      color.a = 1.0f;
    }
  });
}

int texelsOf(float length_m, float texels_per_m) {
  return std::max(1, static_cast<int>(std::lround(length_m * texels_per_m)));
}

void checkOptions(const GrassSpecies& species, const GrassGrowOptions& options) {
  if (!(options.texels_per_m >= 16.0f && options.texels_per_m <= 4096.0f))
    throw Error("grass grow", fmt::format("texels_per_m is {}", options.texels_per_m),
                "give a number from 16 to 4096");
  if (options.kinds < 1 || options.kinds > 64)
    throw Error("grass grow", fmt::format("kinds is {}", options.kinds),
                "give a number from 1 to 64");
  if (4.0f * species.tile_m * options.texels_per_m > 16384.0f)
    throw Error("grass grow",
                fmt::format("four tiles of {} m at {} texels a metre are over 16384 texels",
                            species.tile_m, options.texels_per_m),
                "give fewer texels a metre");
}

}  // namespace

GrassSet growGrass(const GrassSpecies& species, const GrassGrowOptions& options) {
  checkGrassSpecies(species, "grass " + species.name);
  checkOptions(species, options);
  GrassSet set;
  set.name = species.name;
  set.height_m = species.height_m;
  set.spacing_m = glm::vec2(species.spacing_m);
  set.tile_m = species.tile_m;
  set.species = species;

  RibbonView side;
  side.width = 4 * texelsOf(species.tile_m, options.texels_per_m);
  side.height = texelsOf(species.height_m, options.texels_per_m);
  side.width_m = 4.0f * species.tile_m;
  side.height_m = side.top_m = species.height_m;
  std::vector<std::vector<DrawnRibbon>> slabs(static_cast<std::size_t>(options.kinds));
  parallelFor(slabs.size(), 1, [&](std::size_t k) {
    const Planting planting{species.plants, 0.25f * kPi, species.tile_m,
                            hash(options.seed ^ hash(k + 1))};
    // The last border is the first: the picture repeats.
    slabs[k] = plantsOfStrip(plantStrip(planting, species.spacing_m), kWangBorders, false);
  });
  for (const std::vector<DrawnRibbon>& slab : slabs) set.slices.push_back(drawRibbons(slab, side));
  set.opaque = opaqueMap(set.slices);

  RibbonView above = side;
  above.height = above.width;
  above.height_m = above.width_m;
  above.right = glm::vec3(1, 0, 0);
  above.up = glm::vec3(0, 0, -1);
  above.toward = glm::vec3(0, 1, 0);
  above.top_m = 0.0f;
  above.repeats_down = true;
  Planting planting{species.plants, 1.0f, species.tile_m, hash(options.seed)};
  planting.plants.push_back(litterOf(species));
  const std::vector<DrawnRibbon> square = plantSquare(planting);
  above.to_m = 0.5f * species.height_m;
  set.ground = drawRibbons(square, above);
  addSoil(set.ground, species.soil_color, species.tile_m, static_cast<std::uint32_t>(options.seed));
  above.from_m = above.to_m;
  above.to_m = 1e9f;
  set.middle = drawRibbons(square, above);
  return set;
}

}  // namespace verdure
