#include "grass/grass_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "grass/plant_ribbons.h"
#include "verdure/error.h"

namespace verdure {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAdvice = "see docs/grass.md";
constexpr std::array<const char*, 4> kProfiles{"blade", "stalk", "oval", "cut"};

Json colorToJson(const glm::vec3& color) {
  return Json::array({shortestNumber(color.r), shortestNumber(color.g), shortestNumber(color.b)});
}

GrassPart partFromJson(const Json& json, const std::string& where) {
  const GrassMembers members(json, where,
                             {"profile", "on_stalk", "count", "length_m", "length_spread",
                              "width_m", "lean", "lean_spread", "bend", "bend_spread", "root_color",
                              "tip_color", "color_spread", "transmitted"});
  GrassPart part;
  std::string profile = kProfiles[0];
  members.text("profile", profile);
  const auto found = std::find(kProfiles.begin(), kProfiles.end(), profile);
  if (found == kProfiles.end())
    throw Error(where, "has an unknown profile '" + profile + "'",
                fmt::format("choose one of {}", fmt::join(kProfiles, ", ")));
  part.profile = static_cast<RibbonProfile>(found - kProfiles.begin());
  members.flag("on_stalk", part.on_stalk);
  members.number("count", part.count);
  members.number("length_m", part.length_m);
  members.number("length_spread", part.length_spread);
  members.number("width_m", part.width_m);
  members.number("lean", part.lean);
  members.number("lean_spread", part.lean_spread);
  members.number("bend", part.bend);
  members.number("bend_spread", part.bend_spread);
  members.color("root_color", part.root_color);
  members.color("tip_color", part.tip_color);
  members.number("color_spread", part.color_spread);
  members.number("transmitted", part.transmitted);
  return part;
}

Json partToJson(const GrassPart& part) {
  return {{"profile", kProfiles[static_cast<std::size_t>(part.profile)]},
          {"on_stalk", part.on_stalk},
          {"count", part.count},
          {"length_m", shortestNumber(part.length_m)},
          {"length_spread", shortestNumber(part.length_spread)},
          {"width_m", shortestNumber(part.width_m)},
          {"lean", shortestNumber(part.lean)},
          {"lean_spread", shortestNumber(part.lean_spread)},
          {"bend", shortestNumber(part.bend)},
          {"bend_spread", shortestNumber(part.bend_spread)},
          {"root_color", colorToJson(part.root_color)},
          {"tip_color", colorToJson(part.tip_color)},
          {"color_spread", shortestNumber(part.color_spread)},
          {"transmitted", shortestNumber(part.transmitted)}};
}

}  // namespace

GrassMembers::GrassMembers(const Json& json, std::string where,
                           std::initializer_list<std::string_view> known)
    : json_(json), where_(std::move(where)) {
  if (!json.is_object()) throw Error(where_, "is no object", kAdvice);
  for (const auto& [key, value] : json.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw Error(where_, "has an unknown member '" + key + "'", kAdvice);
}

const Json& GrassMembers::at(const char* key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) throw Error(where_, fmt::format("has no {}", key), kAdvice);
  return *found;
}

void GrassMembers::number(const char* key, float& value) const {
  if (!has(key)) return;
  const Json& json = at(key);
  if (!json.is_number() || !std::isfinite(json.get<float>()))
    throw Error(where_, fmt::format("{} is no number", key), kAdvice);
  value = json.get<float>();
}

void GrassMembers::number(const char* key, int& value) const {
  if (!has(key)) return;
  const Json& json = at(key);
  if (!json.is_number_integer() || json.get<double>() < -1e9 || json.get<double>() > 1e9)
    throw Error(where_, fmt::format("{} is no whole number", key), kAdvice);
  value = json.get<int>();
}

void GrassMembers::flag(const char* key, bool& value) const {
  if (!has(key)) return;
  if (!at(key).is_boolean())
    throw Error(where_, fmt::format("{} is neither true nor false", key), kAdvice);
  value = at(key).get<bool>();
}

void GrassMembers::text(const char* key, std::string& value) const {
  if (!has(key)) return;
  if (!at(key).is_string()) throw Error(where_, fmt::format("{} is no text", key), kAdvice);
  value = at(key).get<std::string>();
}

void GrassMembers::color(const char* key, glm::vec3& value) const {
  if (!has(key)) return;
  const Json& json = at(key);
  if (!json.is_array() || json.size() != 3 ||
      !std::all_of(json.begin(), json.end(), [](const Json& c) { return c.is_number(); }))
    throw Error(where_, fmt::format("{} is no colour", key), "write [red, green, blue]");
  for (int c = 0; c < 3; ++c) value[c] = json[static_cast<std::size_t>(c)].get<float>();
}

const Json& GrassMembers::array(const char* key) const {
  static const Json empty = Json::array();
  if (!has(key)) return empty;
  if (!at(key).is_array()) throw Error(where_, fmt::format("{} is no list", key), kAdvice);
  return at(key);
}

Json speciesToJson(const GrassSpecies& species) {
  Json plants = Json::array();
  for (const GrassPlant& plant : species.plants) {
    Json parts = Json::array();
    for (const GrassPart& part : plant.parts) parts.push_back(partToJson(part));
    plants.push_back({{"name", plant.name},
                      {"per_m2", shortestNumber(plant.per_m2)},
                      {"radius_m", shortestNumber(plant.radius_m)},
                      {"parts", std::move(parts)}});
  }
  return {{"name", species.name},
          {"description", species.description},
          {"height_m", shortestNumber(species.height_m)},
          {"spacing_m", shortestNumber(species.spacing_m)},
          {"tile_m", shortestNumber(species.tile_m)},
          {"soil_color", colorToJson(species.soil_color)},
          {"litter", shortestNumber(species.litter)},
          {"litter_color", colorToJson(species.litter_color)},
          {"plants", std::move(plants)}};
}

GrassSpecies speciesFromJson(const Json& json, const std::string& where) {
  const GrassMembers members(json, where,
                             {"name", "description", "height_m", "spacing_m", "tile_m",
                              "soil_color", "litter", "litter_color", "plants"});
  GrassSpecies species;
  members.text("name", species.name);
  members.text("description", species.description);
  members.number("height_m", species.height_m);
  members.number("spacing_m", species.spacing_m);
  members.number("tile_m", species.tile_m);
  members.color("soil_color", species.soil_color);
  members.number("litter", species.litter);
  members.color("litter_color", species.litter_color);
  for (const Json& plant_json : members.array("plants")) {
    const GrassMembers plant_members(plant_json,
                                     fmt::format("{}: plant {}", where, species.plants.size()),
                                     {"name", "per_m2", "radius_m", "parts"});
    GrassPlant plant;
    plant_members.text("name", plant.name);
    plant_members.number("per_m2", plant.per_m2);
    plant_members.number("radius_m", plant.radius_m);
    for (const Json& part : plant_members.array("parts"))
      plant.parts.push_back(partFromJson(
          part, fmt::format("{}: part {}", plant_members.where(), plant.parts.size())));
    species.plants.push_back(std::move(plant));
  }
  checkGrassSpecies(species, where);
  return species;
}

double shortestNumber(float value) {
  const std::string digits = fmt::format("{}", value);
  double number = 0.0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

}  // namespace verdure
