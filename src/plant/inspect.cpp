#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plant/axis_fit.h"
#include "plant/gltf_document.h"
#include "plant/load.h"

namespace verdure {
namespace {

std::size_t emptyTriangles(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[t]]);
    const glm::dvec3 b(mesh.positions[mesh.indices[t + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[t + 2]]);
    if (!(glm::length(glm::cross(b - a, c - a)) > 0.0)) ++count;
  }
  return count;
}

void findPartProblems(const Plant& plant, std::size_t index, PlantReport& report) {
  const Mesh& mesh = plant.meshes[index];
  const auto problem = [&](const std::string& text) {
    report.problems.push_back(fmt::format("part '{}': {}", mesh.name, text));
  };
  const Material& material = plant.materials[mesh.material];
  if (mesh.uvs.empty())
    problem(material.base_color_texture >= 0 ? "has a texture but no UVs" : "has no UVs");
  if (const std::size_t count = emptyTriangles(mesh); count > 0)
    problem(withCommas(count) + " triangles without area");
  if (mesh.kind != PartKind::kFoliage) return;
  std::size_t flat = 0, leaves = 0, largest = 0;
  for (const Leaf& leaf : plant.leaves) {
    if (leaf.mesh != index) continue;
    ++leaves;
    if (!(leaf.area > 0.0f)) ++flat;
    largest = std::max<std::size_t>(largest, leaf.triangle_count);
  }
  if (flat > 0) problem(withCommas(flat) + " leaves without area");
  // One giant among leaves: cards welded to each other or to a trunk.
  if (largest > 64 && 2 * largest > mesh.triangleCount())
    problem(fmt::format("one connected piece has {} of {} triangles: leaves cannot be told apart",
                        withCommas(largest), withCommas(mesh.triangleCount())));
  if (material.alpha_mode == AlphaMode::kBlend)
    problem("is alpha-blended; an alpha mask is sharper and needs no sorting");
}

}  // namespace

PlantReport inspectPlant(const Plant& plant) {
  PlantReport report;
  report.bounds = bounds(plant);
  report.origin = plant.origin;
  report.vertices = vertexCount(plant);
  report.triangles = triangleCount(plant);
  report.leaves = plant.leaves.size();
  report.branches = plant.branches.size();
  for (const Branch& branch : plant.branches) {
    const auto level = static_cast<std::size_t>(branch.level);
    report.by_level.resize(std::max(report.by_level.size(), level + 1));
    ++report.by_level[level].branches;
    report.by_level[level].length_m += static_cast<double>(axisLength(branch.points));
  }
  report.levels = static_cast<int>(report.by_level.size());
  std::vector<std::size_t> leaves_of(plant.meshes.size(), 0);
  for (const Leaf& leaf : plant.leaves) {
    report.leaf_area_m2 += static_cast<double>(leaf.area);
    ++leaves_of[leaf.mesh];
  }
  if (!plant.leaves.empty())
    report.mean_leaf_size_m =
        std::sqrt(report.leaf_area_m2 / static_cast<double>(plant.leaves.size()));
  bool any_foliage = false;
  for (std::size_t i = 0; i < plant.meshes.size(); ++i) {
    const Mesh& mesh = plant.meshes[i];
    report.parts.push_back({mesh.name, plant.materials[mesh.material].name, mesh.kind,
                            mesh.positions.size(), mesh.triangleCount(), leaves_of[i],
                            !mesh.uvs.empty()});
    any_foliage = any_foliage || mesh.kind == PartKind::kFoliage;
    findPartProblems(plant, i, report);
  }
  if (!any_foliage) report.problems.push_back("no part is foliage; name it with --foliage");
  if (plant.origin != glm::dvec3(0.0))
    report.problems.push_back(fmt::format("lies far from the origin, at ({}, {}, {})",
                                          plant.origin.x, plant.origin.y, plant.origin.z));
  const float height = report.bounds.size().y;
  if (height > 90.0f)
    report.problems.push_back(
        fmt::format("is {:.0f} m tall: its unit may not be the metre", height));
  for (const std::string& note : plant.notes)
    if (note.find("mended") != std::string::npos || note.find("left out") != std::string::npos)
      report.problems.push_back(note);
  if (plant.source) report.attributes = plant.source->attributes;
  report.notes = plant.notes;
  return report;
}

}  // namespace verdure
