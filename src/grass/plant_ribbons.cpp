#include "grass/plant_ribbons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "verdure/error.h"

namespace verdure {
namespace {

/// Farthest and highest of an arc that begins upright on the ground, over all of its lengths, leans
/// and bends. Both grow with the length, so only the longest is asked; angles are sampled.
PlantBounds arcBounds(const GrassPart& part) {
  constexpr int kSteps = 16;
  shared::GrassRibbon ribbon{};
  ribbon.up = glm::vec3(0, 1, 0);
  ribbon.side = glm::vec3(1, 0, 0);
  ribbon.span = part.length_m * (1.0f + part.length_spread);
  PlantBounds bounds;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const auto from = [](int k) { return 2.0f * static_cast<float>(k) / kSteps - 1.0f; };
      ribbon.lean = part.lean + part.lean_spread * from(i);
      ribbon.bend = part.bend + part.bend_spread * from(j);
      for (int k = 1; k <= kSteps; ++k) {
        const glm::vec3 p =
            shared::ribbonPoint(ribbon, static_cast<float>(k) / static_cast<float>(kSteps));
        bounds.aside_m = std::max(bounds.aside_m, std::abs(p.x));
        bounds.height_m = std::max(bounds.height_m, p.y);
      }
    }
  // A step of the angles misses less than its square's half of the length.
  const float step = (part.lean_spread + part.bend_spread + std::abs(part.bend)) / kSteps;
  bounds.aside_m += ribbon.span * 0.5f * step * step + 0.5f * part.width_m;
  bounds.height_m += ribbon.span * 0.5f * step * step + 0.5f * part.width_m;
  return bounds;
}

void checkRange(const std::string& where, const char* what, float value, float low, float high) {
  if (!(value >= low && value <= high))
    throw Error(where, fmt::format("{} is {}", what, value),
                fmt::format("give a number from {} to {}", low, high));
}

void checkColor(const std::string& where, const char* what, const glm::vec3& color) {
  for (int c = 0; c < 3; ++c) checkRange(where, what, color[c], 0.0f, 1.0f);
}

void checkPart(const GrassPart& part, const std::string& where) {
  if (part.profile > RibbonProfile::kCut)
    throw Error(where, "has an unknown profile", "see docs/grass.md");
  if (part.count < 1 || part.count > 1000)
    throw Error(where, fmt::format("count is {}", part.count), "give a number from 1 to 1000");
  checkRange(where, "length_m", part.length_m, 1e-4f, 10.0f);
  checkRange(where, "length_spread", part.length_spread, 0.0f, 1.0f);
  checkRange(where, "width_m", part.width_m, 1e-5f, 1.0f);
  checkRange(where, "lean", part.lean, -3.2f, 3.2f);
  checkRange(where, "lean_spread", part.lean_spread, 0.0f, 3.2f);
  checkRange(where, "bend", part.bend, -6.3f, 6.3f);
  checkRange(where, "bend_spread", part.bend_spread, 0.0f, 6.3f);
  checkColor(where, "root_color", part.root_color);
  checkColor(where, "tip_color", part.tip_color);
  checkRange(where, "color_spread", part.color_spread, 0.0f, 1.0f);
  checkRange(where, "transmitted", part.transmitted, 0.0f, 1.0f);
}

}  // namespace

std::vector<shared::GrassRibbonPart> ribbonParts(const GrassPlant& plant) {
  std::vector<shared::GrassRibbonPart> parts;
  parts.reserve(plant.parts.size());
  for (const GrassPart& p : plant.parts) {
    shared::GrassRibbonPart part{};
    part.size = glm::vec4(p.length_m, p.length_spread, p.width_m, plant.radius_m);
    part.turn = glm::vec4(p.lean, p.lean_spread, p.bend, p.bend_spread);
    part.root = glm::vec4(p.root_color, p.color_spread);
    part.tip = glm::vec4(p.tip_color, p.transmitted);
    part.kind =
        glm::uvec4(static_cast<std::uint32_t>(p.profile), p.on_stalk ? 1u : 0u,
                   static_cast<std::uint32_t>(p.count), static_cast<std::uint32_t>(parts.size()));
    parts.push_back(part);
  }
  return parts;
}

void appendRibbons(const std::vector<shared::GrassRibbonPart>& parts, std::uint32_t seed,
                   std::vector<DrawnRibbon>& ribbons) {
  const float rank = shared::plantRank(seed);
  for (const shared::GrassRibbonPart& part : parts) {
    const float brightness = shared::plantBrightness(part, seed);
    DrawnRibbon drawn;
    drawn.root_color = glm::min(shared::ribbonColor(part, 0.0f, brightness), glm::vec3(1.0f));
    drawn.tip_color = glm::min(shared::ribbonColor(part, 1.0f, brightness), glm::vec3(1.0f));
    drawn.transmitted = part.tip.w;
    drawn.rank = rank;
    for (std::uint32_t i = 0; i < part.kind.z; ++i) {
      drawn.ribbon = shared::ribbonOf(part, parts.front(), glm::vec3(0.0f), seed, i);
      ribbons.push_back(drawn);
    }
  }
}

void extend(RibbonExtent& extent, const shared::GrassRibbon& ribbon) {
  for (int k = 0; k < kRibbonStations; ++k) {
    const float s = static_cast<float>(k) / (kRibbonStations - 1);
    const float half = 0.5f * shared::ribbonWidth(ribbon.profile, ribbon.width, s);
    const glm::vec3 p = shared::ribbonPoint(ribbon, s);
    extent.x = std::max(extent.x, std::abs(p.x) + half);
    extent.z = std::max(extent.z, std::abs(p.z) + half);
    extent.y = std::max(extent.y, p.y + half);
  }
}

PlantBounds plantBounds(const GrassPlant& plant) {
  PlantBounds bounds, stalk;
  for (std::size_t i = 0; i < plant.parts.size(); ++i) {
    const GrassPart& part = plant.parts[i];
    PlantBounds reach = arcBounds(part);
    if (part.on_stalk) {
      // Wherever the stalk's end points to, no point of an arc is farther than its longest chord.
      const float least =
          std::clamp(std::abs(part.bend) - part.bend_spread, 0.0f, std::numbers::pi_v<float>);
      const float chord =
          part.length_m * (1.0f + part.length_spread) * shared::ribbonSinc(0.5f * least) +
          0.5f * part.width_m;
      reach = {stalk.aside_m + chord, stalk.height_m + chord};
    }
    if (i == 0) stalk = reach;
    bounds.aside_m = std::max(bounds.aside_m, plant.radius_m + reach.aside_m);
    bounds.height_m = std::max(bounds.height_m, reach.height_m);
  }
  return bounds;
}

void checkGrassSpecies(const GrassSpecies& species, const std::string& where) {
  checkRange(where, "height_m", species.height_m, 0.001f, 10.0f);
  checkRange(where, "spacing_m", species.spacing_m, 0.001f, 10.0f);
  checkRange(where, "tile_m", species.tile_m, 0.01f, 100.0f);
  checkRange(where, "litter", species.litter, 0.0f, 1.0f);
  checkColor(where, "soil_color", species.soil_color);
  checkColor(where, "litter_color", species.litter_color);
  if (species.plants.empty()) throw Error(where, "has no plants", "give at least one");
  for (const GrassPlant& plant : species.plants) {
    const std::string whose = where + ": " + (plant.name.empty() ? "plant" : plant.name);
    checkRange(whose, "per_m2", plant.per_m2, 0.0f, 1e6f);
    checkRange(whose, "radius_m", plant.radius_m, 0.0f, 10.0f);
    if (plant.parts.empty()) throw Error(whose, "has no parts", "give at least one");
    if (plant.parts.front().on_stalk)
      throw Error(whose, "part 0 is on a stalk, which it should be", "put the stalk first");
    for (std::size_t i = 0; i < plant.parts.size(); ++i)
      checkPart(plant.parts[i], fmt::format("{}: part {}", whose, i));
    const PlantBounds bounds = plantBounds(plant);
    if (bounds.height_m > species.height_m)
      throw Error(whose,
                  fmt::format("can grow {:.4f} m high, above the shell's {} m", bounds.height_m,
                              species.height_m),
                  "raise height_m or shorten its parts");
    if (bounds.aside_m > 0.5f * species.tile_m)
      throw Error(whose,
                  fmt::format("can reach {:.4f} m aside, over half of a tile of {} m",
                              bounds.aside_m, species.tile_m),
                  "raise tile_m or shorten its parts");
  }
}

}  // namespace verdure
