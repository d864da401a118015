#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "grass/draw_ribbons.h"
#include "grass/grass_maps.h"
#include "grass/plant_ribbons.h"
#include "grass/wang_plants.h"
#include "scratch.h"
#include "shared/grass.h"
#include "verdure/error.h"
#include "verdure/grass.h"
#include "verdure/image.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

/// A small set of bent tufts and ovals on stalks.
GrassSet smallSet(std::uint64_t seed = 3) {
  GrassSpecies species = grassSpecies("clover");
  species.spacing_m = 0.03f;
  species.tile_m = 0.3f;
  GrassGrowOptions options;
  options.seed = seed;
  options.texels_per_m = 160;
  options.kinds = 3;
  return growGrass(species, options);
}

glm::dvec4 meanOf(const std::vector<glm::vec4>& values) {
  glm::dvec4 sum(0.0);
  for (const glm::vec4& v : values) sum += glm::dvec4(v);
  return sum / static_cast<double>(values.size());
}

double largest(const glm::dvec4& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
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

}  // namespace
}  // namespace verdure
