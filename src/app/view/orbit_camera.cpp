#include "app/view/orbit_camera.h"

#include <algorithm>
#include <cmath>

#include "scene/camera.h"

namespace verdure::app {

Camera orbited(const Camera& camera, float turn, float rise) {
  const glm::vec3 away = camera.eye - camera.target;
  const float distance = glm::length(away);
  if (!(distance > 0.0f)) return camera;
  const float azimuth = std::atan2(away.x, away.z) + turn;
  const float elevation = std::clamp(std::asin(std::clamp(away.y / distance, -1.0f, 1.0f)) + rise,
                                     -kMostOrbitElevation, kMostOrbitElevation);
  Camera moved = camera;
  moved.eye = camera.target + distance * directionOf(azimuth, elevation);
  return moved;
}

Camera panned(const Camera& camera, float right, float down) {
  const glm::mat3 axes = cameraAxes(camera);
  const float height =
      2.0f * std::tan(0.5f * camera.vertical_fov) * glm::length(camera.eye - camera.target);
  const glm::vec3 step = height * (down * axes[1] - right * axes[0]);
  Camera moved = camera;
  moved.eye += step;
  moved.target += step;
  return moved;
}

Camera zoomed(const Camera& camera, float factor, float least, float most) {
  const glm::vec3 away = camera.eye - camera.target;
  const float distance = glm::length(away);
  if (!(distance > 0.0f)) return camera;
  Camera moved = camera;
  moved.eye = camera.target + away * (std::clamp(distance * factor, least, most) / distance);
  return moved;
}

Camera raisedTo(const Camera& camera, float least_height) {
  Camera moved = camera;
  moved.eye.y = std::max(moved.eye.y, least_height);
  // Straight up or down has no azimuth to keep, and an eye in its target sees nothing.
  if (glm::length(moved.eye - moved.target) < 1e-6f) moved.eye.z += 1e-3f;
  return moved;
}

}  // namespace verdure::app
