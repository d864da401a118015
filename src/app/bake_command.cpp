// bake: one plant.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/files.h"
#include "base/progress.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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
  if (command.rays.ambient != "density" && command.rays.ambient != "ray-traced" &&
      command.rays.ambient != "leaf-visibility")
    throw Error("--ambient", fmt::format("'{}' is unknown", command.rays.ambient),
                "use density, ray-traced or leaf-visibility");
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
  if (rays->seconds_visibility > 0.0)
    fmt::print("leaves looked at from {} sides, {} rays each; mean ambient {:.2f} in {:.2f} s\n",
               command.rays.directions, rays->leaf_rays, rays->mean_ambient,
               rays->seconds_visibility);
  if (!(rays->seconds_ambient > 0.0 || rays->seconds_normals > 0.0 || rays->transfer)) return;
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

}  // namespace verdure::app
