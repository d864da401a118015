// grass grow.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/grass_commands.h"
#include "app/json_numbers.h"
#include "base/progress.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

void listGrasses(bool json) {
  Json all = Json::array();
  for (const std::string& name : grassSpeciesNames()) {
    const GrassSpecies species = grassSpecies(name);
    if (json)
      all.push_back({{"name", name}, {"description", species.description}});
    else
      fmt::print("{:16}  {}\n", name, species.description);
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

/// The mean share of a slice that is covered.
double meanCover(const GrassSet& set) {
  double sum = 0;
  for (const GrassMap& slice : set.slices)
    for (const glm::vec4& color : slice.color) sum += static_cast<double>(color.a);
  return sum / static_cast<double>(set.slices.size() * set.slices.front().texelCount());
}

}  // namespace

void runGrassGrow(const GrassGrowCommand& command) {
  if (command.list) return listGrasses(command.json);
  if (command.output.empty())
    throw Error("grass grow", "no folder is named", "add -o FOLDER, or --list for the species");
  const GrassSpecies species = grassSpecies(command.species);
  Timer timer;
  const GrassSet set = growGrass(species, command.grow);
  const double seconds = timer.lap();
  saveGrass(set, command.output);
  const GrassMap& slice = set.slices.front();
  if (command.json) {
    const Json json{{"folder", command.output},
                    {"species", set.name},
                    {"seed", command.grow.seed},
                    {"slices", set.slices.size()},
                    {"width", slice.width},
                    {"height", slice.height},
                    {"ground", set.ground.width},
                    {"height_m", sixDigits(double{set.height_m})},
                    {"spacing_m", sixDigits(double{set.spacing_m.x})},
                    {"tile_m", sixDigits(double{set.tile_m})},
                    {"mean_cover", sixDigits(meanCover(set))},
                    {"seconds_grow", sixDigits(seconds)}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(
        "{}: {}, {} slices of {} x {} texels, ground of {} x {}, {:.0f} cm high, every {:.1f} cm, "
        "{:.0f} % covered; grown in {:.2f} s\n",
        command.output, set.name, set.slices.size(), slice.width, slice.height, set.ground.width,
        set.ground.height, 100 * set.height_m, 100 * set.spacing_m.x, 100 * meanCover(set),
        seconds);
  }
}

}  // namespace verdure::app
