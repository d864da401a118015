// leaf grow.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/json_numbers.h"
#include "base/progress.h"
#include "verdure/error.h"
#include "verdure/leaf_files.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

void listLeaves(bool json) {
  Json all = Json::array();
  for (const LeafSpeciesInfo& s : leafSpeciesList()) {
    if (json)
      all.push_back({{"name", s.name}, {"title", s.title}});
    else
      fmt::print("{:16}  {}\n", s.name, s.title);
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

}  // namespace

void runLeafGrow(const LeafGrowCommand& command) {
  if (command.list) return listLeaves(command.json);
  if (command.output.empty())
    throw Error("leaf grow", "no folder is named", "add -o FOLDER, or --list for the species");
  Timer timer;
  const LeafSet leaf = growLeaf(command.grow);
  const double seconds = timer.lap();
  writeLeafSet(leaf, command.output);
  double area = 0, thickness = 0;
  for (std::size_t i = 0; i < leaf.texelCount(); ++i) {
    area += static_cast<double>(leaf.opacity[i]);
    thickness += static_cast<double>(leaf.opacity[i] * leaf.thickness_mm[i]);
  }
  thickness /= area;
  area *= static_cast<double>(leaf.mm_per_texel) * static_cast<double>(leaf.mm_per_texel);
  if (command.json) {
    const Json json{{"folder", command.output},
                    {"species", leaf.name},
                    {"seed", command.grow.seed},
                    {"age", sixDigits(double{command.grow.age})},
                    {"size", leaf.width},
                    {"mm_per_texel", sixDigits(double{leaf.mm_per_texel})},
                    {"area_mm2", sixDigits(area)},
                    {"mean_thickness_mm", sixDigits(thickness)},
                    {"seconds_grow", sixDigits(seconds)}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(
        "{}: {}, {} x {} texels of {:.3f} mm, {:.0f} mm^2, {:.2f} mm thick; grown in {:.2f} s\n",
        command.output, leaf.name, leaf.width, leaf.height, leaf.mm_per_texel, area, thickness,
        seconds);
  }
}

}  // namespace verdure::app
