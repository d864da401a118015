// grow, inspect and bake.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
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

/// In the plant's frame: both may lie far from the origin.
Surface loadSurface(const std::string& path, const glm::dvec3& plant_origin) {
  const Plant mesh = loadPlant(path);
  Surface surface;
  for (const Mesh& part : mesh.meshes) {
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    surface.positions.insert(surface.positions.end(), part.positions.begin(), part.positions.end());
    surface.normals.insert(surface.normals.end(), part.normals.begin(), part.normals.end());
    for (const std::uint32_t i : part.indices) surface.indices.push_back(first + i);
  }
  const glm::vec3 offset(mesh.origin - plant_origin);
  for (glm::vec3& p : surface.positions) p += offset;
  return surface;
}

/// Progress of a bake on the terminal.
template <class Options>
void showProgress(Options& options, Progress& progress) {
  options.progress = [&progress](const char* step, double share) { progress.show(step, share); };
}

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
      place.angle = numberOf(value, where, key) * static_cast<float>(M_PI / 180.0);
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
    showProgress(options, progress);
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
  const Plant plant = loadPlant(command.input, command.load);
  const PlantReport report = inspectPlant(plant);
  if (command.json) {
    fmt::print("{}\n", jsonOf(report));
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
  if (report.branches > 0)
    fmt::print("  branches  {} in {} levels\n", report.branches, report.levels);
  else
    fmt::print("  branches  unknown\n");
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

BakeField BakeParameters::fieldOr(BakeField fallback) const {
  std::string given = metaball_option;
  if (normals == "surface-vertex" || normals == "surface-point" || normals == "ellipsoid")
    given = "--normals " + normals;
  if (field == "metaball") {
    if (normals == "optical-depth")
      throw Error("--normals optical-depth", "does not go with --field metaball",
                  "leave one of them out");
    return BakeField::kMetaball;
  }
  if (!field.empty() && field != "optical-depth")
    throw Error("--field", fmt::format("'{}' is unknown", field), "use metaball or optical-depth");
  const bool depth = field == "optical-depth" || normals == "optical-depth";
  if (depth && !given.empty())
    throw Error(given, "belongs to the metaball field, not to optical-depth",
                "leave it out, or use --field metaball");
  return depth ? BakeField::kOpticalDepth : given.empty() ? fallback : BakeField::kMetaball;
}

DepthOptions BakeParameters::checkedDepth() const {
  const DensityOptions common = [&] {
    BakeParameters named = *this;  // the rest is checked alike
    if (normals == "optical-depth") named.normals.clear();
    return named.checked();
  }();
  DepthOptions o;
  o.normals =
      common.normals == CrownNormals::kKeep ? CrownNormals::kKeep : CrownNormals::kOpticalDepth;
  o.blend = common.blend;
  o.seed = common.seed;
  o.max_memory_bytes = common.max_memory_bytes;
  o.fit = fit.value_or(true);
  return o;
}

DensityOptions BakeParameters::checked() const {
  DensityOptions o = options;
  if (norm == "inf") {
    o.norm = {Norm::Kind::kLinf, 0.0f};
  } else {
    const float p = parseNumbers("--norm", norm, 1)[0];
    if (!(p >= 1.0f)) throw Error("--norm", "the exponent must be at least 1", "use 1, 2 or inf");
    o.norm = p == 1.0f   ? Norm{Norm::Kind::kL1, 1.0f}
             : p == 2.0f ? Norm{Norm::Kind::kL2, 2.0f}
                         : Norm{Norm::Kind::kLp, p};
  }
  if (normals.empty())
    o.normals = CrownNormals::kSurfacePoint;
  else if (normals == "surface-vertex")
    o.normals = CrownNormals::kSurfaceVertex;
  else if (normals == "surface-point")
    o.normals = CrownNormals::kSurfacePoint;
  else if (normals == "ellipsoid")
    o.normals = CrownNormals::kEllipsoid;
  else if (normals == "keep")
    o.normals = CrownNormals::kKeep;
  else
    throw Error("--normals", fmt::format("'{}' is unknown", normals),
                "use optical-depth, surface-point, surface-vertex, ellipsoid or keep");
  if (!(max_memory_mib > 0.0)) throw Error("--max-memory", "must be above 0", "4096 is usual");
  o.max_memory_bytes = static_cast<std::size_t>(std::min(max_memory_mib, 1e12) * 1048576.0);
  return o;
}

namespace {

std::string lineOf(const DensityReport& r) {
  return fmt::format(
      "{} leaves, rho {:.3g} m, tau {:.3g}, d_min {:.3g}; surface of {} vertices{}; "
      "mean ambient {:.2f}{}; baked in {:.2f} s",
      r.leaves, r.rho, r.tau, r.d_min, r.surface_vertices,
      r.surface_vertices == 0 || r.watertight ? "" : ", not watertight", r.mean_ambient,
      r.fit ? fmt::format("; fitted to {} traced vertices, RMS {:.3f} (before {:.3f})",
                          r.fit->samples, r.fit->after.rms, r.fit->before.rms)
            : "",
      r.seconds_total);
}

std::string lineOf(const DepthReport& r) {
  return fmt::format(
      "optical depth of {} surfels, up to {:.2g}; mean openness {:.2f}, mean ambient "
      "{:.2f}{}; baked in {:.2f} s",
      r.surfels, r.depth_max, r.mean_openness, r.mean_ambient,
      r.fit ? fmt::format("; fitted to {} traced vertices, RMS {:.3f} (before {:.3f})",
                          r.fit->samples, r.fit->after.rms, r.fit->before.rms)
            : "",
      r.seconds_total);
}

Json jsonOf(const DepthModel& m) {
  return {{"a", m.a}, {"b", m.b}, {"k", m.k}};
}

Json jsonOf(const Agreement& a) {
  return {{"rms", a.rms}, {"rank", a.rank}};
}

}  // namespace

void runBake(const BakeCommand& command) {
  checkOutput(command.output, {".glb", ".gltf"});
  if (!command.report.empty()) checkWritable(command.report);
  if (command.rays.ambient != "density" && command.rays.ambient != "ray-traced")
    throw Error("--ambient", fmt::format("'{}' is unknown", command.rays.ambient),
                "use density or ray-traced");
  if (command.rays.transfer_bands != 0) checkWritable(transferPath(command.output));
  if (fs::path(command.report).lexically_normal() == fs::path(command.output).lexically_normal())
    throw Error("--report", "names the output file", "choose another file");
  if (!command.population.empty()) return bakePopulation(command);
  const BakeField field = command.bake.fieldOr(BakeField::kOpticalDepth);
  BakeParameters parameters = command.bake;
  if (parameters.normals == "bent")  // traceLight() finds them
    parameters.normals = field == BakeField::kMetaball ? "keep" : "";
  DensityOptions options = parameters.checked();
  DepthOptions depth_options = parameters.checkedDepth();
  const Plant plant = loadPlant(command.input, command.load);
  std::optional<Surface> surface;
  if (!command.surface.empty()) surface = loadSurface(command.surface, plant.origin);
  CrownLight light;
  Json report;
  std::string line;
  const std::string& normals = command.bake.normals;
  if (command.rays.ambient == "ray-traced" && (normals == "keep" || normals == "bent") &&
      !parameters.fit.value_or(false) && !surface) {
    // Rays give all that is written.
    for (const Mesh& mesh : plant.meshes) light.meshes.emplace_back().normals = mesh.normals;
    report = {{"kind", "none"}};
    line = "no field";
  } else {
    Progress progress("bake");
    if (field == BakeField::kMetaball) {
      showProgress(options, progress);
      std::optional<DensityFit> fit;
      if (parameters.fit.value_or(false)) options = fitDensity(plant, options, &fit.emplace());
      DensityBake bake = bakeDensity(plant, options, surface ? &*surface : nullptr);
      bake.report.fit = fit;
      light = std::move(bake.light);
      report = Json::parse(jsonOf(bake.report));
      line = lineOf(bake.report);
    } else {
      showProgress(depth_options, progress);
      DepthBake bake = bakeOpticalDepth(plant, depth_options);
      light = std::move(bake.light);
      report = Json::parse(jsonOf(bake.report));
      line = lineOf(bake.report);
    }
  }
  const std::optional<RayReport> rays = traceLight(command, plant, light);
  savePlant(plant, &light, command.output, {command.color1});
  if (rays && rays->transfer) saveTransfer(*rays->transfer, plant, command.output);
  if (rays) report["rays"] = Json::parse(jsonOf(*rays));
  const std::string json = report.dump(2);
  if (!command.report.empty()) writeFile(command.report, json + "\n");
  if (command.json) {
    fmt::print("{}\n", json);
    return;
  }
  for (const std::string& note : plant.notes) fmt::print("note: {}\n", note);
  fmt::print("{}: {}\n", command.output, line);
  if (!rays) return;
  fmt::print("traced {} rays a vertex, {} bounces", rays->rays, rays->bounces);
  if (rays->seconds_ambient > 0.0)
    fmt::print("; mean ambient {:.2f} in {:.2f} s", rays->mean_ambient, rays->seconds_ambient);
  if (rays->transfer)
    fmt::print("; {}, {} bands, in {:.2f} s", transferPath(command.output).string(),
               rays->transfer->bands, rays->seconds_transfer);
  fmt::print("\n");
}

std::string jsonOf(const DepthReport& r) {
  Json json = {{"kind", "optical-depth"},
               {"model",
                {{"leaf", jsonOf(r.models.leaf)},
                 {"wood", jsonOf(r.models.wood)},
                 {"crown_light", jsonOf(r.models.crown_light)},
                 {"wood_light", jsonOf(r.models.wood_light)},
                 {"near_gain", r.near_gain},
                 {"near_radius_m", r.near_radius}}},
               {"surfels", r.surfels},
               {"area_m2", r.area_m2},
               {"terms_per_vertex", r.terms_per_vertex},
               {"depth", {{"min", r.depth_min}, {"max", r.depth_max}}},
               {"vertices",
                {{"all", r.vertices},
                 {"foliage", r.foliage_vertices},
                 {"mean_openness", r.mean_openness},
                 {"mean_ambient", r.mean_ambient}}},
               {"seconds",
                {{"surfels", r.seconds_surfels},
                 {"field", r.seconds_field},
                 {"fit", r.seconds_fit},
                 {"light", r.seconds_light},
                 {"total", r.seconds_total}}}};
  if (r.fit)
    json["fit"] = {{"samples", r.fit->samples},
                   {"before", jsonOf(r.fit->before)},
                   {"after", jsonOf(r.fit->after)},
                   {"light_before", jsonOf(r.fit->light_before)},
                   {"light_after", jsonOf(r.fit->light_after)}};
  return json.dump(2);
}

std::string jsonOf(const DensityReport& r) {
  Json json = {{"kind", "metaball"},
               {"rho_m", r.rho},
               {"tau", r.tau},
               {"d_min", r.d_min},
               {"k_min", r.k_min},
               {"exponent", r.exponent},
               {"leaves", r.leaves},
               {"leaves_without_area", r.skipped_leaves},
               {"generators", r.generators},
               {"field",
                {{"largest_sum_at_leaves", r.field_max_at_generators},
                 {"min_at_vertices", r.field_min_at_vertices},
                 {"max_at_vertices", r.field_max_at_vertices}}},
               {"grid",
                {{"points", {r.grid_points.x, r.grid_points.y, r.grid_points.z}},
                 {"points_evaluated", r.grid_points_evaluated},
                 {"voxel_m", r.voxel_m},
                 {"bytes", r.grid_bytes}}},
               {"surface",
                {{"vertices", r.surface_vertices},
                 {"triangles", r.surface_triangles},
                 {"components", r.surface_components},
                 {"watertight", r.watertight},
                 {"degenerate_gradients", r.degenerate_gradients}}},
               {"vertices",
                {{"all", r.vertices},
                 {"foliage", r.foliage_vertices},
                 {"open", r.vertices_open},
                 {"core", r.vertices_core},
                 {"mean_ambient", r.mean_ambient}}},
               {"seconds",
                {{"generators", r.seconds_generators},
                 {"surface", r.seconds_surface},
                 {"ambient", r.seconds_ambient},
                 {"normals", r.seconds_normals},
                 {"total", r.seconds_total}}}};
  if (r.fit)
    json["fit"] = {{"samples", r.fit->samples},
                   {"full_openness", r.fit->full},
                   {"before", jsonOf(r.fit->before)},
                   {"after", jsonOf(r.fit->after)},
                   {"seconds", r.fit->seconds}};
  return json.dump(2);
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
                     {"parts", parts},
                     {"attributes", r.attributes},
                     {"notes", r.notes},
                     {"problems", r.problems}};
  // Names may hold bytes that are no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace verdure::app
