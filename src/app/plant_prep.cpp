#include "app/plant_prep.h"

#include <algorithm>
#include <array>
#include <memory>

#include "base/progress.h"
#include "motion/motion_tables.h"
#include "plant/normals.h"
#include "verdure/leaf_visibility.h"

namespace verdure::app {

std::optional<CrownLight> lightOfFile(const Plant& plant) {
  CrownLight light;
  bool any = false;
  for (const Mesh& mesh : plant.meshes) {
    MeshLight part{mesh.normals, mesh.ambient, mesh.visibility};
    any = any || !mesh.ambient.empty() || !mesh.visibility.empty();
    if (part.ambient.empty()) part.ambient.assign(mesh.positions.size(), 1.0f);
    for (float& k : part.ambient) k = std::clamp(k, 1.0f / 255.0f, 1.0f);
    light.meshes.push_back(std::move(part));
  }
  if (!any) return std::nullopt;
  return light;
}

double addLeafVisibility(const Plant& plant, CrownLight& light,
                         const std::function<void(double share)>& progress) {
  if (std::any_of(light.meshes.begin(), light.meshes.end(),
                  [](const MeshLight& mesh) { return !mesh.visibility.empty(); }))
    return 0.0;
  Timer timer;
  LeafVisibilityOptions looks;
  looks.progress = [&progress](double share) {
    if (progress) progress(share);
    return true;
  };
  setLeafVisibility(plant, leafVisibility(plant, looks), light);
  return timer.seconds();
}

void restoreLeafNormals(Plant& plant) {
  for (Mesh& mesh : plant.meshes)
    if (mesh.kind == PartKind::kFoliage && !mesh.ambient.empty())
      mesh.normals = angleWeightedNormals(mesh.positions, mesh.indices);
}

PlantMotion motionFor(Plant& plant, const MotionSettings& settings) {
  if (plant.branches.empty()) findBranches(plant);
  return motionOf(plant, settings);
}

PlantMotion motionOf(const Plant& plant, const MotionSettings& settings) {
  MotionOptions options;
  options.flexibility = settings.flexibility;
  for (std::size_t level = 0; level < options.damping_ratio.size(); ++level)
    options.damping_ratio[level] = settings.damping_ratio[static_cast<glm::length_t>(level)];
  PlantMotion motion = plantMotion(plant, options);
  std::vector<float> factors;
  for (const MotionBranch& branch : motion.tree.branches)
    factors.push_back(settings.level_flexibility[branch.level]);
  for (const MotionSettings::BranchFlexibility& one : settings.branches)
    if (one.branch < factors.size()) factors[one.branch] *= one.flexibility;
  if (std::all_of(factors.begin(), factors.end(), [](float factor) { return factor == 1.0f; }))
    return motion;
  auto tables = std::make_shared<MotionTables>(*motion.tables);
  for (std::size_t b = 0; b < factors.size(); ++b) {
    motion.branches[b].mean *= factors[b];
    motion.branches[b].swing *= factors[b];
    tables->drives[b].mean *= factors[b];
    tables->drives[b].swing *= factors[b];
  }
  motion.tables = std::move(tables);
  return motion;
}

float groundHeight(const Plant& plant) {
  constexpr float kMostBelow = 0.25f;  // share of the height
  const Bounds box = bounds(plant);
  const bool from_zero = plant.origin == glm::dvec3(0.0) && box.min.y <= 0.0f &&
                         -box.min.y < kMostBelow * box.size().y;
  return from_zero ? 0.0f : box.min.y;
}

namespace {

/// A piece of wood in one colour: each triangle with corners of its own.
Mesh pieceOf(const std::vector<std::array<glm::vec3, 3>>& triangles, std::uint32_t material) {
  Mesh mesh;
  mesh.material = material;
  for (const std::array<glm::vec3, 3>& corners : triangles) {
    const glm::vec3 normal =
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (const glm::vec3& corner : corners) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
      mesh.normals.push_back(normal);
    }
  }
  return mesh;
}

/// A pyramid with a square base at `foot` and its point `up` from there; `reach`: of its corners.
std::vector<std::array<glm::vec3, 3>> pyramid(const glm::vec3& foot, float up, float reach) {
  const std::array<glm::vec3, 4> base{foot + glm::vec3(reach, 0, 0), foot + glm::vec3(0, 0, -reach),
                                      foot + glm::vec3(-reach, 0, 0),
                                      foot + glm::vec3(0, 0, reach)};
  const glm::vec3 point = foot + glm::vec3(0, up, 0);
  std::vector<std::array<glm::vec3, 3>> triangles;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 &a = base[i], &b = base[(i + 1) % 4];
    triangles.push_back(up > 0.0f ? std::array{a, b, point} : std::array{b, a, point});
  }
  return triangles;
}

}  // namespace

Plant missingPlantMarker() {
  Plant plant;
  plant.name = "missing plant";
  plant.materials = {{.name = "post", .base_color = {0.35f, 0.35f, 0.35f, 1.0f}},
                     {.name = "sign", .base_color = {0.9f, 0.02f, 0.35f, 1.0f}}};
  // A needle of a post that carries two pyramids, foot to foot.
  plant.meshes.push_back(pieceOf(pyramid(glm::vec3(0.0f), 1.6f, 0.08f), 0));
  plant.meshes.back().name = "post";
  const glm::vec3 middle(0.0f, 1.8f, 0.0f);
  std::vector<std::array<glm::vec3, 3>> sign = pyramid(middle, 0.5f, 0.4f);
  for (const auto& triangle : pyramid(middle, -0.5f, 0.4f)) sign.push_back(triangle);
  plant.meshes.push_back(pieceOf(sign, 1));
  plant.meshes.back().name = "sign";
  return plant;
}

}  // namespace verdure::app
