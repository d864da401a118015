// bake --population: a group in one field.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/files.h"
#include "base/progress.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A member of a layout: a finite number that a float can hold.
float numberOf(const Json& value, const std::string& where, const std::string& key) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(std::abs(number) <= double{std::numeric_limits<float>::max()}))
    throw Error(where, fmt::format("\"{}\" is no usable number", key), "see docs/population.md");
  return static_cast<float>(number);
}

Placement readPlacement(const Json& entry, std::size_t plants, const std::string& where) {
  if (!entry.is_object()) throw Error(where, "is no object", "see docs/population.md");
  Placement place;
  for (const auto& [key, value] : entry.items()) {
    if (key == "plant") {
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= plants)
        throw Error(where, fmt::format("\"plant\" is {}", value.dump()),
                    fmt::format("the plants are numbered 0 to {}", plants - 1));
      place.plant = value.get<std::uint32_t>();
    } else if (key == "position") {
      if (!value.is_array() || value.size() != 3)
        throw Error(where, "\"position\" is no list of three numbers", "write [x, y, z] in m");
      for (int a = 0; a < 3; ++a)
        place.position[a] = numberOf(value[static_cast<std::size_t>(a)], where, key);
    } else if (key == "angle_deg") {
      place.angle = glm::radians(numberOf(value, where, key));
    } else if (key == "scale") {
      place.scale = numberOf(value, where, key);
      if (!(place.scale > 0.0f)) throw Error(where, "\"scale\" is not above 0", "1 is usual");
    } else {
      throw Error(where, fmt::format("\"{}\" is unknown", key),
                  "use plant, position, angle_deg and scale");
    }
  }
  return place;
}

struct Population {
  std::vector<Plant> plants;  ///< the command's own plant first
  std::vector<Placement> placements;
};

Population readPopulation(const BakeCommand& command) {
  const auto bytes = readFile(command.population);
  const Json layout = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const auto refuse = [&](const char* what) {
    throw Error(command.population, std::string("is no population layout: ") + what,
                "see docs/population.md");
  };
  if (layout.is_discarded()) refuse("it is not JSON");
  if (!layout.is_object() || !layout.contains("placements") || !layout["placements"].is_array() ||
      layout["placements"].empty())
    refuse("it needs a list \"placements\"");
  for (const auto& [key, value] : layout.items()) {
    if (key != "plants" && key != "placements") refuse("it may hold \"plants\" and \"placements\"");
    if (key != "plants") continue;
    if (!value.is_array()) refuse("\"plants\" is no list of files");
    for (const Json& file : value)
      if (!file.is_string()) refuse("\"plants\" is no list of files");
  }
  const Json files = layout.value("plants", Json::array());
  Population population;
  for (std::size_t i = 0; i < layout["placements"].size(); ++i)
    population.placements.push_back(
        readPlacement(layout["placements"][i], 1 + files.size(),
                      fmt::format("{}: placement {}", command.population, i)));
  population.plants.push_back(loadPlant(command.input, command.load));
  for (const Json& file : files)
    population.plants.push_back(loadPlant(
        fs::path(command.population).parent_path() / file.get<std::string>(), command.load));
  return population;
}

/// "grove.glb" to "grove-007.glb".
fs::path placementFile(const fs::path& output, std::size_t placement) {
  fs::path file = output;
  return file.replace_filename(
      fmt::format("{}-{:03}{}", output.stem().string(), placement, output.extension().string()));
}

}  // namespace

void bakePopulation(const BakeCommand& command) {
  if (!command.surface.empty())
    throw Error("--surface", "cannot be used with --population", "leave one of them out");
  if (command.rays.ambient != "density" || command.rays.transfer_bands > 0 ||
      command.bake.normals == "bent")
    throw Error("--population",
                "cannot be used with rays (--ambient, --transfer, --normals bent): they see one "
                "plant without its neighbours",
                "bake each plant alone, or leave the rays out");
  command.bake.fieldOr(BakeField::kMetaball);  // the optical-depth field knows no neighbours
  if (command.bake.fit.value_or(false))
    throw Error("--fit", "cannot be used with --population",
                "fit one plant and pass its parameters");
  DensityOptions options = command.bake.checked();
  const auto [plants, placements] = readPopulation(command);
  for (std::size_t i = 0; i < placements.size(); ++i)
    checkWritable(placementFile(command.output, i));
  std::vector<const Plant*> pointers;
  for (const Plant& plant : plants) pointers.push_back(&plant);
  const auto bakes = [&] {
    Progress progress("bake");
    options.progress = [&progress](const char* step, double share) { progress.show(step, share); };
    return bakeDensityPopulation(pointers, placements, options);
  }();
  Json reports = Json::array();
  for (std::size_t i = 0; i < bakes.size(); ++i) {
    const fs::path file = placementFile(command.output, i);
    savePlant(plants[placements[i].plant], &bakes[i].light, file, {command.color1});
    reports.push_back(Json::parse(jsonOf(bakes[i].report)));
    reports.back()["file"] = file.filename().string();
  }
  if (!command.report.empty()) writeFile(command.report, reports.dump(2) + "\n");
  if (command.json)
    fmt::print("{}\n", reports.dump(2));
  else
    fmt::print(
        "{} plants baked in one field, each with a mesh of its own: {} and on.\n"
        "They can no longer be instanced: every plant's light depends on its neighbours.\n",
        bakes.size(), placementFile(command.output, 0).string());
}

}  // namespace verdure::app
