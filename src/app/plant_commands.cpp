// grow and inspect.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/skeleton_file.h"
#include "base/progress.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

const char* kindName(PartKind kind) {
  return kind == PartKind::kFoliage ? "foliage" : "wood";
}

void listSpecies(bool json) {
  Json all = Json::array();
  for (const SpeciesInfo& s : speciesList()) {
    if (json)
      all.push_back({{"name", s.name}, {"title", s.title}, {"source", s.source}});
    else
      fmt::print("{:16}  {}\n", s.name, s.title);
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

void listParameters(const std::string& species, bool json) {
  Json all = Json::array();
  for (const ParameterInfo& p : speciesParameters(species)) {
    if (json)
      all.push_back({{"name", p.name}, {"value", p.value}, {"help", p.help}});
    else
      fmt::print("{:16} {:>10}  {}\n", p.name, p.value, p.help);
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

}  // namespace

void runGrow(GrowCommand command) {
  if (command.list) return listSpecies(command.json);
  if (command.parameters) return listParameters(command.grow.species, command.json);
  if (command.output.empty())
    throw Error("grow", "no output file is named", "add -o FILE.glb, or --list for the species");
  if (command.leaves == "card")
    command.grow.leaf_form = LeafForm::kCard;
  else if (command.leaves != "mesh")
    throw Error("--leaves", fmt::format("'{}' is unknown", command.leaves), "use mesh or card");
  for (const std::string& text : command.assignments) {
    const std::size_t at = text.find('=');
    if (at == std::string::npos || at == 0)
      throw Error("--set", fmt::format("'{}' is no assignment", text), "write Param=value");
    command.grow.set.push_back({text.substr(0, at), text.substr(at + 1)});
  }
  checkOutput(command.output, {".glb", ".gltf"});
  Timer timer;
  const Plant plant = grow(command.grow);
  const double seconds = timer.lap();
  savePlant(plant, nullptr, command.output);
  const PlantReport report = inspectPlant(plant);
  if (command.json) {
    Json json = Json::parse(jsonOf(report));
    json["seconds_grow"] = seconds;
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}: {}, {:.1f} m high, {} branches, {} leaves, {} vertices; grown in {:.2f} s\n",
               command.output, plant.name, report.bounds.size().y, report.branches, report.leaves,
               report.vertices, seconds);
  }
}

void runInspect(const InspectCommand& command) {
  if (!command.skeleton.empty()) checkOutput(command.skeleton, {".obj", ".png"});
  Plant plant = loadPlant(command.input, command.load);
  Timer timer;
  const bool known = !plant.branches.empty();
  if (!known) findBranches(plant);
  const double seconds = timer.lap();
  const PlantReport report = inspectPlant(plant);
  if (!command.skeleton.empty()) writeSkeleton(plant, command.skeleton);
  if (command.json) {
    Json json = Json::parse(jsonOf(report));
    json["seconds_branches"] = seconds;
    fmt::print("{}\n", json.dump(2));
    return;
  }
  const glm::vec3 size = report.bounds.size();
  fmt::print("{}\n", command.input);
  fmt::print("  size      {:.3g} x {:.3g} x {:.3g} m (x, height, z)\n", size.x, size.y, size.z);
  if (report.origin != glm::dvec3(0.0))
    fmt::print("  origin    {:.3f}, {:.3f}, {:.3f}\n", report.origin.x, report.origin.y,
               report.origin.z);
  fmt::print("  vertices  {}\n  triangles {}\n", report.vertices, report.triangles);
  fmt::print("  leaves    {} (mean size {:.3g} m, {:.4g} m^2 in all, one side)\n", report.leaves,
             report.mean_leaf_size_m, report.leaf_area_m2);
  fmt::print("  branches  {} in {} levels, {}\n", report.branches, report.levels,
             known ? "known" : "found");
  for (std::size_t level = 0; level < report.by_level.size(); ++level)
    fmt::print("    level {}: {}, {:.4g} m in all\n", level, report.by_level[level].branches,
               report.by_level[level].length_m);
  fmt::print("  parts\n");
  for (const PartReport& part : report.parts)
    fmt::print("    {:8} {} (material {}): {} vertices, {} triangles{}{}\n", kindName(part.kind),
               part.name.empty() ? "(unnamed)" : part.name,
               part.material.empty() ? "(unnamed)" : part.material, part.vertices, part.triangles,
               part.leaves > 0 ? fmt::format(", {} leaves", part.leaves) : "",
               part.has_uvs ? "" : ", no UVs");
  if (!report.attributes.empty()) {
    fmt::print("  attributes");
    for (const std::string& name : report.attributes) fmt::print(" {}", name);
    fmt::print("\n");
  }
  for (const std::string& note : report.notes) fmt::print("  note      {}\n", note);
  for (const std::string& problem : report.problems) fmt::print("  problem   {}\n", problem);
}

std::string jsonOf(const PlantReport& r) {
  Json parts = Json::array();
  for (const PartReport& part : r.parts)
    parts.push_back({{"name", part.name},
                     {"material", part.material},
                     {"kind", kindName(part.kind)},
                     {"vertices", part.vertices},
                     {"triangles", part.triangles},
                     {"leaves", part.leaves},
                     {"uvs", part.has_uvs}});
  Json levels = Json::array();
  for (const LevelReport& level : r.by_level)
    levels.push_back({{"branches", level.branches}, {"length_m", level.length_m}});
  const auto vector = [](const auto& v) { return Json::array({v.x, v.y, v.z}); };
  const Json json = {{"bounds", {{"min", vector(r.bounds.min)}, {"max", vector(r.bounds.max)}}},
                     {"origin", vector(r.origin)},
                     {"vertices", r.vertices},
                     {"triangles", r.triangles},
                     {"leaves", r.leaves},
                     {"leaf_area_m2", r.leaf_area_m2},
                     {"mean_leaf_size_m", r.mean_leaf_size_m},
                     {"branches", r.branches},
                     {"levels", r.levels},
                     {"branches_by_level", levels},
                     {"parts", parts},
                     {"attributes", r.attributes},
                     {"notes", r.notes},
                     {"problems", r.problems}};
  // Names may hold bytes that are no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace verdure::app
