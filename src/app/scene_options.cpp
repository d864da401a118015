#include "app/scene_options.h"

#include <fmt/format.h>

#include <cmath>

#include "app/commands.h"
#include "plant/normals.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

float radians(float degrees) {
  return degrees * static_cast<float>(M_PI / 180.0);
}

}  // namespace

float groundHeight(const Plant& plant) {
  constexpr float kMostBelow = 0.25f;  // share of the height
  const Bounds box = bounds(plant);
  const bool from_zero = plant.origin == glm::dvec3(0.0) && box.min.y <= 0.0f &&
                         -box.min.y < kMostBelow * box.size().y;
  return from_zero ? 0.0f : box.min.y;
}

std::pair<int, int> SceneOptions::sizeInPixels() const {
  return parseSize(size);
}

void SceneOptions::checkCamera() const {
  if (!(fov_deg > 0.0 && fov_deg < 170.0))
    throw Error("--fov", "must lie between 0 and 170 degrees", "34 is usual");
}

Camera SceneOptions::cameraFor(const Scene& scene, float aspect) const {
  const float fov = radians(static_cast<float>(fov_deg));
  if (camera == "auto") return automaticCamera(scene, radians(35.0f), radians(4.0f), aspect, fov);
  const std::vector<float> n = parseNumbers("--camera", camera, 0);
  if (n.size() == 2) return automaticCamera(scene, radians(n[0]), radians(n[1]), aspect, fov);
  if (n.size() == 6) return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, fov};
  throw Error("--camera", "needs 2 or 6 numbers", "AZIMUTH,ELEVATION or X,Y,Z,TX,TY,TZ");
}

Scene SceneOptions::sceneOf(const Plant& plant, const CrownLight* light) const {
  Scene scene;
  scene.ground = !no_ground;
  scene.ground_height = groundHeight(plant);
  scene.items.push_back({&plant, light});
  return scene;
}

Wind WindOptions::wind(bool film) const {
  Wind wind;
  wind.speed = speed.value_or(film || time ? 5.0f : 0.0f);
  if (!(wind.speed >= 0.0f && wind.speed <= 60.0f))
    throw Error("--wind", fmt::format("{:g} m/s is out of range", wind.speed), "choose 0 to 60");
  if (!std::isfinite(from_deg))
    throw Error("--wind-from", "must be a finite number", "0 is from +Z, 90 from +X");
  wind.from = radians(from_deg);
  if (!(gusts >= 0.0f && gusts <= 1.0f))
    throw Error("--gusts", fmt::format("{:g} is out of range", gusts), "choose 0 to 1");
  wind.gusts = gusts;
  if (time && !std::isfinite(*time))
    throw Error("--time", "must be a finite number", "write seconds, like 2.5");
  return wind;
}

PlantMotion motionFor(Plant& plant) {
  if (plant.branches.empty()) findBranches(plant);
  return plantMotion(plant);
}

void restoreLeafNormals(Plant& plant) {
  for (Mesh& mesh : plant.meshes)
    if (mesh.kind == PartKind::kFoliage && !mesh.ambient.empty())
      mesh.normals = angleWeightedNormals(mesh.positions, mesh.indices);
}

}  // namespace verdure::app
