// leaf import, leaf bake: maps of leaves, and light through them.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/commands.h"
#include "app/json_numbers.h"
#include "base/files.h"
#include "base/progress.h"
#include "verdure/error.h"
#include "verdure/leaf_translucency.h"
#include "verdure/plant_io.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void printSet(const LeafSet& set) {
  fmt::print("{}: {} x {} texels of {:g} mm\n", set.name, set.width, set.height, set.mm_per_texel);
  for (const std::string& note : set.notes) fmt::print("  {}\n", note);
}

/// An output folder that cannot be is told before long work starts.
void checkFolder(const std::string& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (!fs::is_directory(folder, problem))
    throw Error(folder, "is no folder and cannot be made one", "choose another folder");
}

Json jsonOfReport(const LeafSet& set, const LeafBakeReport& r, const std::string& method) {
  return {{"name", set.name},
          {"width", set.width},
          {"height", set.height},
          {"mm_per_texel", sixDigits(double{set.mm_per_texel})},
          {"method", method},
          {"leaf_texels", r.texels},
          {"thickness_mm", {sixDigits(r.least_thickness_mm), sixDigits(r.most_thickness_mm)}},
          {"clamped_texels", r.clamped},
          {"surface_reflection", r.surface_reflection},
          {"kernel_radius_mm", r.radius_mm},
          {"terms", r.terms},
          {"fit_residual", r.residual},
          {"conserved", {{"front", r.conserved[0]}, {"back", r.conserved[1]}}},
          {"seconds",
           {{"horizon", r.horizon_seconds},
            {"projection", r.projection_seconds},
            {"fit", r.fit_seconds},
            {"convolution", r.convolution_seconds}}}};
}

Json jsonOfErrors(const LeafErrors& e) {
  return {{"elevation_deg", glm::degrees(e.elevation)},
          {"mean", e.mean},
          {"mean_absolute", e.mean_absolute},
          {"rms", e.rms},
          {"percentile_5", e.low},
          {"percentile_95", e.high},
          {"dark_share", e.dark},
          {"histogram_from", -0.5},
          {"histogram_to", 0.5},
          {"histogram", e.histogram}};
}

}  // namespace

void runLeafImport(const LeafImportCommand& command) {
  const fs::path source = command.input;
  const std::string kind = source.extension().string();
  const bool gltf = kind == ".glb" || kind == ".gltf";
  if (!gltf && !command.material.empty())
    throw Error("--material", "is for .glb and .gltf files", "leave it out");
  const LeafSet set = gltf ? importLeafMaterial(source, command.material, command.options)
                           : importLeafSet(source, command.options);
  checkFolder(command.output);
  writeLeafSet(set, command.output);
  printSet(set);
}

void runLeafBake(const LeafBakeCommand& command) {
  LeafBakeOptions options;
  options.directions = command.directions;
  options.surface_reflection = command.surface_reflection;
  const std::vector<float> rgb = parseNumbers("--wavelength", command.wavelength, 3);
  const float sum = rgb[0] + rgb[1] + rgb[2];
  if (!(std::min({rgb[0], rgb[1], rgb[2]}) >= 0 && sum > 0))
    throw Error("--wavelength", "'" + command.wavelength + "' weighs nothing, or less",
                "give three numbers of at least 0, as 0,1,0");
  options.wavelength = glm::vec3(rgb[0], rgb[1], rgb[2]) / sum;
  if (command.method == "direct")
    options.method = LeafBakeMethod::kDirect;
  else if (command.method != "gaussians")
    throw Error("--method", "'" + command.method + "' is no method", "use gaussians or direct");
  const LeafSet set = readLeafSet(command.input);
  const std::string output = command.output.empty() ? command.input : command.output;
  if (!command.report.empty()) checkWritable(command.report);
  checkFolder(output);
  Progress progress("leaf bake");
  progress.show("light through the leaf");
  Timer timer;
  const LeafTranslucency baked = bakeLeafTranslucency(set, options);
  const double seconds = timer.seconds();
  std::error_code ignored;
  if (!fs::equivalent(output, command.input, ignored)) writeLeafSet(set, output);
  writeLeafTranslucency(baked, output);
  const LeafBakeReport& r = baked.report;
  Json json = jsonOfReport(set, r, command.method);
  json["seconds"]["all"] = seconds;
  if (!command.report.empty() || command.json) {
    progress.show("errors of the basis");
    for (const LeafErrors& errors : measureLeafErrors(set, baked, options))
      json["errors"].push_back(jsonOfErrors(errors));
  }
  if (!command.report.empty()) writeFile(command.report, json.dump(2) + "\n");
  if (command.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  printSet(set);
  fmt::print("  {} texels of leaf, {:.3f} to {:.3f} mm thick", r.texels, r.least_thickness_mm,
             r.most_thickness_mm);
  if (r.clamped > 0)
    fmt::print("; {} are thinner than the model holds and count as 1.2 mean free paths", r.clamped);
  fmt::print("\n  {:.2f} s", seconds);
  if (r.terms > 0) fmt::print(", {} Gaussians, residual {:.1e}", r.terms, r.residual);
  fmt::print("; light kept: {:.4f} front, {:.4f} back\n", r.conserved[0], r.conserved[1]);
}

}  // namespace verdure::app
