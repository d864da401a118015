// What the command bake traces by rays.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/progress.h"
#include "verdure/error.h"
#include "verdure/leaf_visibility.h"

namespace verdure::app {
namespace {

/// Foliage takes the mean of its open directions; where nothing or everything is open, a leaf keeps
/// its normal.
void bendNormals(const Plant& plant, const RayOptions& options, CrownLight& light) {
  constexpr float kLeastLength = 1e-2f;
  std::vector<VertexId> leaves;
  for (const VertexId& id : allVertices(plant))
    if (plant.meshes[id.mesh].kind == PartKind::kFoliage) leaves.push_back(id);
  const std::vector<Openness> open = traceOpenness(plant, leaves, options);
  for (std::size_t i = 0; i < leaves.size(); ++i)
    if (const float length = glm::length(open[i].direction); length > kLeastLength)
      light.meshes[leaves[i].mesh].normals[leaves[i].vertex] = open[i].direction / length;
}

}  // namespace

std::optional<RayReport> traceLight(const BakeCommand& command, const Plant& plant,
                                    CrownLight& light) {
  const RayParameters& parameters = command.rays;
  const bool ambient = parameters.ambient == "ray-traced", bent = command.bake.normals == "bent",
             visible = parameters.ambient == "leaf-visibility";
  if (!ambient && !bent && !visible && parameters.transfer_bands == 0) return std::nullopt;
  Progress progress("bake");
  const char* step = "";
  RayOptions options;
  options.rays = parameters.rays.value_or(options.rays);
  options.bounces = parameters.bounces;
  options.progress = [&](double share) {
    progress.show(step, share);
    return true;
  };
  RayReport report;
  report.rays = options.rays;
  report.bounces = options.bounces;
  Timer timer;
  if (bent) {
    step = "open directions";
    bendNormals(plant, options, light);
    report.seconds_normals = timer.lap();
  }
  if (ambient) {
    step = "ambient light";
    light = bakeAmbient(plant, options, &light);
    report.seconds_ambient = timer.lap();
  }
  if (visible) {
    step = "leaf visibility";
    timer.lap();
    LeafVisibilityOptions looks;
    looks.directions = parameters.directions;
    looks.rays = report.leaf_rays = parameters.rays.value_or(looks.rays);
    looks.progress = options.progress;
    setLeafVisibility(plant, leafVisibility(plant, looks), light);
    report.seconds_visibility = timer.lap();
  }
  std::size_t vertices = 0;
  for (const MeshLight& mesh : light.meshes)
    for (const float k : mesh.ambient) {
      report.mean_ambient += static_cast<double>(k);
      ++vertices;
    }
  if (vertices > 0) report.mean_ambient /= static_cast<double>(vertices);
  if (parameters.transfer_bands != 0) {
    step = "transfer";
    timer.lap();
    TransferOptions transfer;
    transfer.rays = options;
    transfer.rays.ground_height = groundHeight(plant);
    transfer.bands = parameters.transfer_bands;
    transfer.bounce_bands = std::min(transfer.bounce_bands, transfer.bands);
    report.transfer = bakeTransfer(plant, transfer);
    report.seconds_transfer = timer.lap();
  }
  return report;
}

std::string jsonOf(const RayReport& r) {
  nlohmann::ordered_json json = {{"rays", r.rays},
                                 {"leaf_rays", r.leaf_rays},
                                 {"bounces", r.bounces},
                                 {"mean_ambient", r.mean_ambient},
                                 {"transfer_bands", r.transfer ? r.transfer->bands : 0},
                                 {"seconds",
                                  {{"normals", r.seconds_normals},
                                   {"ambient", r.seconds_ambient},
                                   {"visibility", r.seconds_visibility},
                                   {"transfer", r.seconds_transfer}}}};
  return json.dump(2);
}

}  // namespace verdure::app
