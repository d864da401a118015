// export: wind data for other programs.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/files.h"
#include "verdure/error.h"
#include "verdure/wind_files.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

void listTargets(bool json) {
  Json all = Json::array();
  for (const WindTarget& target : windTargets()) {
    if (json)
      all.push_back({{"name", target.name}, {"what", target.what}});
    else
      fmt::print("{:26}  {}\n", target.name, target.what);
  }
  if (json) fmt::print("{}\n", all.dump(2));
}

Json jsonOf(const WindFiles& files, const std::vector<std::string>& notes) {
  Json json = {{"files", Json::array()},
               {"branches", files.branches},
               {"leaves", files.leaves},
               {"attributes", files.attributes}};
  for (const auto& [path, bytes] : files.files)
    json["files"].push_back({{"path", path.string()}, {"bytes", bytes}});
  json["notes"] = notes;
  return json;
}

ClipOptions clipOf(const ExportCommand& command) {
  ClipOptions clip;
  clip.seconds = command.seconds;
  clip.fps = command.fps;
  clip.joints = command.joints;
  clip.wind.speed = static_cast<float>(command.wind_speed);
  clip.wind.from = static_cast<float>(glm::radians(command.wind_from_deg));
  clip.wind.gusts = static_cast<float>(command.gusts);
  return clip;
}

/// Before the plant is loaded: what is wrong with the options is told at once.
void checkRange(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(option, fmt::format("{} is out of range", value),
                fmt::format("choose {} to {}", low, high));
}

void checkOptions(const ExportCommand& command) {
  if (command.input.empty())
    throw Error("export", "no plant is named", "name a file, or use --list for the targets");
  if (command.output.empty()) throw Error("export", "no output file is named", "add -o FILE.glb");
  if (command.skin && !command.wind.empty())
    throw Error("--skin", "does not go with --wind", "export them to two files");
  if (!command.skin && !command.clip_option.empty())
    throw Error(command.clip_option, "belongs to a clip", "add --skin, or leave it out");
  const std::string target = command.wind.empty() ? "attributes" : command.wind;
  const std::vector<WindTarget>& targets = windTargets();
  if (std::none_of(targets.begin(), targets.end(),
                   [&](const WindTarget& known) { return known.name == target; })) {
    std::string names;
    for (const WindTarget& known : targets) names += (names.empty() ? "" : ", ") + known.name;
    throw Error("--wind", "'" + target + "' is unknown", "use one of " + names);
  }
  checkRange("--seconds", command.seconds, 0.5, 60.0);
  checkRange("--fps", command.fps, 5.0, 120.0);
  checkRange("--joints", command.joints, 8.0, 4096.0);
  checkRange("--wind-speed", command.wind_speed, 0.0, 60.0);
  checkRange("--wind-from", command.wind_from_deg, -360.0, 360.0);
  checkRange("--gusts", command.gusts, 0.0, 1.0);
  checkOutput(command.output, {".glb", ".gltf"});
}

}  // namespace

void runExport(const ExportCommand& command) {
  if (command.list) return listTargets(command.json);
  checkOptions(command);
  Plant plant = loadPlant(command.input, command.load);
  if (plant.branches.empty()) findBranches(plant);
  std::vector<std::string> notes = plant.notes;
  MotionOptions options;
  options.seed = command.seed;
  const PlantMotion motion = plantMotion(plant, options);
  if (!command.skin) {
    const WindFiles files = exportWind(
        plant, motion, command.wind.empty() ? "attributes" : command.wind, command.output);
    notes.insert(notes.end(), files.notes.begin(), files.notes.end());
    if (command.json) {
      fmt::print("{}\n", jsonOf(files, notes).dump(2, ' ', false, Json::error_handler_t::replace));
      return;
    }
    for (const std::string& note : notes) fmt::print("note: {}\n", note);
    for (const auto& [path, bytes] : files.files)
      fmt::print("{}: {} bytes\n", path.string(), bytes);
    fmt::print("{} branches, {} leaves:", files.branches, files.leaves);
    for (const std::string& name : files.attributes) fmt::print(" {}", name);
    fmt::print("\n");
    return;
  }
  const ClipFiles clip = exportClip(plant, motion, clipOf(command), command.output);
  notes.insert(notes.end(), clip.notes.begin(), clip.notes.end());
  if (command.json) {
    Json json = jsonOf(clip, notes);
    json["clip"] = {{"joints", clip.joints},
                    {"bent_branches", clip.bent_branches},
                    {"frames", clip.frames},
                    {"fps", command.fps},
                    {"seconds", static_cast<double>(clip.frames) / command.fps},
                    {"error_wood_rms_m", clip.wood_rms},
                    {"error_leaves_rms_m", clip.leaf_rms},
                    {"error_largest_m", clip.largest},
                    {"motion_rms_m", clip.motion_rms}};
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
    return;
  }
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
  for (const auto& [path, bytes] : clip.files) fmt::print("{}: {} bytes\n", path.string(), bytes);
  fmt::print(
      "{} joints for {} of {} branches, {} frames; off the true motion ({:.3g} m): wood {:.2g} m, "
      "leaves {:.2g} m, at most {:.2g} m\n",
      clip.joints, clip.bent_branches, clip.branches, clip.frames, clip.motion_rms, clip.wood_rms,
      clip.leaf_rms, clip.largest);
}

}  // namespace verdure::app
