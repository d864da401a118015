#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "base/random.h"
#include "grass/draw_ribbons.h"
#include "grass/grass_maps.h"
#include "grass/plant_ribbons.h"
#include "grass/wang_plants.h"
#include "grass_sets.h"
#include "shared/grass.h"
#include "verdure/error.h"
#include "verdure/grass.h"

namespace verdure {
namespace {

/// Upright ribbons of even width, one a plant.
GrassSpecies uprightSpecies(RibbonProfile profile, float per_m2) {
  GrassPart blade;
  blade.profile = profile;
  blade.length_m = 0.09f;
  blade.length_spread = 0.0f;
  blade.width_m = 0.006f;
  blade.lean = blade.lean_spread = blade.bend = blade.bend_spread = 0.0f;
  blade.color_spread = 0.0f;
  blade.root_color = blade.tip_color = glm::vec3(0.1f, 0.2f, 0.05f);
  GrassSpecies species;
  species.name = "upright";
  species.height_m = 0.1f;
  species.spacing_m = 0.05f;
  species.tile_m = 0.5f;
  species.plants = {{"blade", per_m2, 0.0f, {blade}}};
  return species;
}

TEST(GrassSet, EverySpeciesGrowsAndIsValid) {
  for (const std::string& name : grassSpeciesNames()) {
    GrassGrowOptions options;
    options.texels_per_m = 64;
    options.kinds = 2;
    const GrassSet set = growGrass(grassSpecies(name), options);
    EXPECT_NO_THROW(checkGrassSet(set, name));
    EXPECT_EQ(set.slices.size(), 2u) << name;
    EXPECT_EQ(set.slices[0].width % 4, 0) << name;
    EXPECT_EQ(set.ground.width, set.slices[0].width) << name;
    EXPECT_EQ(set.middle.width, set.ground.width) << name;
    EXPECT_FALSE(grassSpecies(name).description.empty());
  }
  EXPECT_THROW(grassSpecies("bamboo"), Error);
}

TEST(GrassSet, ThinRibbonsStayInTheirColours) {
  // Slivers of triangles, seen edge-on: nothing may be drawn that lies outside of their corners.
  GrassSpecies species = uprightSpecies(RibbonProfile::kBlade, 20000);
  GrassPart& blade = species.plants[0].parts[0];
  blade.width_m = 1e-4f;
  blade.lean_spread = 0.3f;
  blade.bend_spread = 1.5f;
  blade.length_m = 0.08f;
  species.soil_color = species.litter_color = blade.root_color;
  GrassGrowOptions options;
  options.texels_per_m = 128;
  options.kinds = 2;
  const GrassSet set = growGrass(species, options);
  EXPECT_NO_THROW(checkGrassSet(set, "thin"));
  for (const GrassMap& slice : set.slices)
    for (const glm::vec4& c : slice.color)
      ASSERT_LT(glm::length(glm::vec3(c) - c.a * blade.root_color), 1e-4f);
}

TEST(GrassSet, MipsKeepTheMean) {
  const GrassSet set = smallSet();
  for (const GrassMap* map : {&set.slices[0], &set.ground, &set.middle, &set.opaque}) {
    const std::vector<GrassMap> levels = grassMips(*map);
    EXPECT_EQ(levels.back().texelCount(), 1u);
    for (const GrassMap& level : levels) {
      EXPECT_LT(largest(meanOf(level.color) - meanOf(map->color)), 1e-5);
      EXPECT_LT(largest(meanOf(level.data) - meanOf(map->data)), 1e-5);
    }
  }
}

TEST(GrassSet, ThreadsChangeNothing) {
  const GrassSet all = smallSet();
  setThreadCount(1);
  const GrassSet one = smallSet();
  setThreadCount(0);
  for (std::size_t k = 0; k < all.slices.size(); ++k) {
    EXPECT_EQ(all.slices[k].color, one.slices[k].color);
    EXPECT_EQ(all.slices[k].data, one.slices[k].data);
  }
  EXPECT_EQ(all.ground.color, one.ground.color);
  EXPECT_EQ(all.middle.data, one.middle.data);
  EXPECT_EQ(all.opaque.color, one.opaque.color);
  EXPECT_NE(smallSet(4).slices[0].color, all.slices[0].color);
}

TEST(GrassSet, ExtinctionIsThatOfRandomRibbons) {
  // Round stalks are seen in full; flat blades of all azimuths in 2 / pi of their width.
  for (const bool round : {true, false}) {
    const GrassSpecies species =
        uprightSpecies(round ? RibbonProfile::kStalk : RibbonProfile::kCut, 4000);
    GrassGrowOptions options;
    options.kinds = 32;
    options.texels_per_m = 256;
    const GrassSet set = growGrass(species, options);
    double sum = 0;
    const int row = set.slices[0].height / 2;
    for (const GrassMap& slice : set.slices)
      for (int x = 0; x < slice.width; ++x)
        sum += static_cast<double>(slice.color[static_cast<std::size_t>(row * slice.width + x)].a);
    const double cover = sum / (32.0 * set.slices[0].width);
    // The twist about the middle line does not change the mean over azimuths.
    const double shown = round ? 1.0 : 2.0 / std::numbers::pi;
    const double depth = 4000 * std::numbers::pi / 4 * 0.05 * 0.006 * shown;
    EXPECT_NEAR(cover, 1 - std::exp(-depth), 0.01) << round;
  }
}

/// Leaning ribbons, one a plant, that reach up to 0.09 m aside.
Planting leaningPlanting(std::uint64_t seed, float per_m2) {
  GrassPart blade;
  blade.length_m = 0.1f;
  blade.width_m = 0.005f;
  blade.lean = 0.5f;
  blade.lean_spread = 0.5f;
  blade.bend = 0.5f;
  Planting planting;
  planting.plants = {{"blade", per_m2, 0.0f, {blade}}};
  planting.tile_m = 0.25f;
  planting.seed = seed;
  return planting;
}

TEST(GrassSet, TilesMatchInAnySequence) {
  const Planting planting = leaningPlanting(5, 4000);
  const StripPlants strip = plantStrip(planting, 0.05f);
  const auto draw = [&](const std::vector<std::uint32_t>& borders) {
    const auto tiles = static_cast<int>(borders.size()) - 1;
    RibbonView view;
    view.width = 64 * tiles;
    view.height = 36;
    view.width_m = planting.tile_m * static_cast<float>(tiles);
    view.height_m = view.top_m = 0.14f;
    return drawRibbons(plantsOfStrip(strip, borders, false), view);
  };
  const GrassMap picture = draw(kWangBorders);
  const std::vector<std::uint32_t> borders{0, 0, 0, 1, 0, 1, 1, 1, 0, 0, 1, 0};
  const GrassMap whole = draw(borders);
  int unequal = 0;
  for (int tile = 0; tile < whole.width / 64; ++tile) {
    const auto at = static_cast<std::size_t>(tile);
    const int column = static_cast<int>(shared::wangColumn(borders[at], borders[at + 1]));
    for (int y = 0; y < whole.height; ++y)
      for (int x = 0; x < 64; ++x) {
        const auto texel = [&](const GrassMap& map, int t) {
          return map.color[static_cast<std::size_t>(y * map.width + t * 64 + x)];
        };
        unequal += largest(glm::dvec4(texel(whole, tile) - texel(picture, column))) > 0.01;
      }
  }
  // Positions that are rounded elsewhere move a sample now and then.
  EXPECT_LT(unequal, static_cast<int>(whole.texelCount()) / 500);
  // What is checked is not empty: blades cross every border.
  for (int tile = 0; tile < 4; ++tile) {
    double cover = 0;
    for (int y = 0; y < picture.height; ++y)
      cover += static_cast<double>(
          picture.color[static_cast<std::size_t>(y * picture.width + 64 * tile)].a);
    EXPECT_GT(cover, 1.0);
  }
}

TEST(GrassSet, GroundTilesShareWhatCrossesTheirBorders) {
  const Planting planting = leaningPlanting(6, 1500);
  const std::vector<DrawnRibbon> square = plantSquare(planting);
  // Roots of what crosses the i-th border between columns or rows, relative to that.
  const auto crossing = [&](int i, bool rows) {
    std::vector<std::pair<int, int>> roots;
    for (const DrawnRibbon& drawn : square) {
      shared::GrassRibbon r = drawn.ribbon;
      const glm::vec3 root = r.root;
      r.root = glm::vec3(0.0f);
      RibbonExtent extent;
      extend(extent, r);
      const float offset = (rows ? root.z : root.x) - static_cast<float>(i) * planting.tile_m;
      // Rounded to 0.1 mm, and away from where rounding or the rule might go either way.
      if (std::abs(offset) < (rows ? extent.z : extent.x) - 1e-4f)
        roots.emplace_back(std::lround(offset * 1e4f),
                           std::lround((rows ? root.x : root.z) * 1e4f));
    }
    std::sort(roots.begin(), roots.end());
    return roots;
  };
  const auto shared_of = [](const auto& a, const auto& b) {
    std::size_t found = 0;
    for (const auto& p : a)
      for (const auto& q : b)
        if (std::abs(p.first - q.first) <= 1 && std::abs(p.second - q.second) <= 1) {
          ++found;
          break;
        }
    return found;
  };
  for (const bool rows : {false, true}) {
    // The borders have the colours 0, 0, 1, 1. The first lies on the picture's edge.
    const auto zero = crossing(1, rows), one = crossing(2, rows), again = crossing(3, rows);
    EXPECT_GT(one.size(), 50u);
    EXPECT_EQ(shared_of(one, again), one.size());
    EXPECT_EQ(one.size(), again.size());
    EXPECT_LT(shared_of(zero, one), one.size());
    EXPECT_GT(shared_of(zero, one), 0u);  // corners
  }
}

TEST(GrassSet, DensityIsEvenAcrossBorders) {
  constexpr int kBins = 20;
  std::vector<double> bins(kBins);
  double all = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Planting planting = leaningPlanting(seed, 6000);
    for (const DrawnRibbon& r : plantsOfStrip(plantStrip(planting, 0.1f), kWangBorders, false)) {
      const float tiles = r.ribbon.root.x / planting.tile_m + 4.0f;
      bins[static_cast<std::size_t>((tiles - std::floor(tiles)) * kBins) % kBins] += 1;
      all += 1;
    }
  }
  EXPECT_NEAR(all, 60 * 4 * 0.25 * 0.1 * 6000, 0.02 * all);
  // Borders are drawn twice each and tiles once: bins hold 900 plants or more that are independent.
  for (const double bin : bins) EXPECT_NEAR(bin, all / kBins, 0.14 * all / kBins);
}

TEST(GrassSet, NothingGrowsHigherOrFartherThanItsBounds) {
  for (const std::string& name : grassSpeciesNames()) {
    const GrassSpecies species = grassSpecies(name);
    float highest = 0;
    for (const GrassPlant& plant : species.plants) {
      const std::vector<shared::GrassRibbonPart> parts = ribbonParts(plant);
      const PlantBounds bounds = plantBounds(plant);
      RibbonExtent extent;
      for (std::uint32_t seed = 0; seed < 2000; ++seed) {
        std::vector<DrawnRibbon> ribbons;
        appendRibbons(parts, seed * 7919u, ribbons);
        for (const DrawnRibbon& r : ribbons) extend(extent, r.ribbon);
      }
      EXPECT_LE(extent.y, bounds.height_m) << name << " " << plant.name;
      EXPECT_LE(std::max(extent.x, extent.z), bounds.aside_m) << name << " " << plant.name;
      highest = std::max(highest, extent.y);
    }
    EXPECT_LE(highest, species.height_m);
    EXPECT_GE(highest, 0.7f * species.height_m) << name << ": the shell is much too high";
  }
}

TEST(GrassSet, RanksAreUniformAndOneForAPlant) {
  const std::vector<shared::GrassRibbonPart> parts =
      ribbonParts(grassSpecies("clover").plants.front());
  std::vector<int> bins(10);
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    std::vector<DrawnRibbon> ribbons;
    appendRibbons(parts, random.next(), ribbons);
    for (const DrawnRibbon& r : ribbons) EXPECT_EQ(r.rank, ribbons.front().rank);
    ASSERT_LT(ribbons.front().rank, 1.0f);
    ++bins[static_cast<std::size_t>(ribbons.front().rank * 10)];
  }
  for (const int bin : bins) EXPECT_NEAR(bin, 2000, 200);
}

TEST(GrassSet, BadSpeciesAndOptionsAreRefused) {
  const auto refuses = [](const std::function<void(GrassSpecies&, GrassGrowOptions&)>& spoil) {
    GrassSpecies species = uprightSpecies(RibbonProfile::kBlade, 100);
    GrassGrowOptions options;
    options.texels_per_m = 32;
    options.kinds = 1;
    spoil(species, options);
    EXPECT_THROW(growGrass(species, options), Error);
  };
  refuses([](auto&, auto& o) { o.texels_per_m = 15; });
  refuses([](auto&, auto& o) { o.texels_per_m = std::nanf(""); });
  refuses([](auto& s, auto& o) { s.tile_m = 4, o.texels_per_m = 4096; });
  refuses([](auto&, auto& o) { o.kinds = 0; });
  refuses([](auto&, auto& o) { o.kinds = 65; });
  refuses([](auto& s, auto&) { s.height_m = 0; });
  refuses([](auto& s, auto&) { s.height_m = 0.08f; });  // lower than its blades
  refuses([](auto& s, auto&) { s.spacing_m = std::nanf(""); });
  refuses([](auto& s, auto&) { s.tile_m = -1; });
  refuses([](auto& s, auto&) { s.litter = 1.5f; });
  refuses([](auto& s, auto&) { s.plants.clear(); });
  refuses([](auto& s, auto&) { s.plants[0].parts.clear(); });
  refuses([](auto& s, auto&) { s.plants[0].per_m2 = -1; });
  refuses([](auto& s, auto&) { s.plants[0].parts[0].on_stalk = true; });
  refuses([](auto& s, auto&) { s.plants[0].parts[0].count = 0; });
  refuses([](auto& s, auto&) { s.plants[0].parts[0].width_m = 0; });
  refuses([](auto& s, auto&) { s.plants[0].radius_m = 0.3f; });  // farther than half a tile
  refuses([](auto& s, auto&) { s.plants[0].parts[0].tip_color.g = 2; });
}

TEST(GrassSet, GroundShowsTheSoilThatNothingCovers) {
  GrassSpecies species = uprightSpecies(RibbonProfile::kStalk, 0);
  species.litter = 0;
  GrassGrowOptions options;
  options.texels_per_m = 64;
  options.kinds = 1;
  const GrassSet bare = growGrass(species, options);
  const glm::dvec4 mean = meanOf(bare.ground.color);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean[c], static_cast<double>(species.soil_color[c]), 0.2 * mean[c]);
  // Litter covers the share that it should.
  species.litter = 0.6f;
  species.litter_color = glm::vec3(1.0f, 0.0f, 0.0f);
  species.soil_color = glm::vec3(0.0f, 0.1f, 0.0f);
  const GrassSet covered = growGrass(species, options);
  EXPECT_NEAR(meanOf(covered.ground.color).g / (meanOf(bare.ground.color).g / 0.045 * 0.1), 0.4,
              0.05);
}

}  // namespace
}  // namespace verdure
