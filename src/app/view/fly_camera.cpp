#include "app/view/fly_camera.h"

#include <algorithm>
#include <cmath>

#include "app/view/orbit_camera.h"
#include "scene/camera.h"

namespace verdure::app {

Camera lookedAround(const Camera& camera, float turn, float rise) {
  const glm::vec3 ahead = camera.target - camera.eye;
  const float distance = glm::length(ahead);
  if (!(distance > 0.0f)) return camera;
  // Azimuths go against the clock, a turn to the right with it.
  const float azimuth = std::atan2(ahead.x, ahead.z) - turn;
  const float elevation = std::clamp(std::asin(std::clamp(ahead.y / distance, -1.0f, 1.0f)) + rise,
                                     -kMostOrbitElevation, kMostOrbitElevation);
  Camera turned = camera;
  turned.target = camera.eye + distance * directionOf(azimuth, elevation);
  return turned;
}

Camera flown(const Camera& camera, float right, float up, float forward) {
  const glm::mat3 axes = cameraAxes(camera);
  const glm::vec3 step = right * axes[0] + up * glm::vec3(0, 1, 0) - forward * axes[2];
  Camera moved = camera;
  moved.eye += step;
  moved.target += step;
  return moved;
}

}  // namespace verdure::app
