#ifndef VERDURE_SCENE_CAMERA_H_
#define VERDURE_SCENE_CAMERA_H_

#include "verdure/scene.h"

namespace verdure {

/// Right, up and backward axes of a camera.
glm::mat3 cameraAxes(const Camera& camera);

/// The rays of a picture: through the point (x, y) of [-1, 1]^2, x to the right and y down, goes
/// forward + x right + y down (not unit).
struct CameraRays {
  glm::vec3 eye{0.0f}, right{0.0f}, down{0.0f}, forward{0.0f};
};

/// `aspect` = width / height. Throws Error for a camera that looks nowhere or a field of view
/// outside (0, pi).
CameraRays cameraRays(const Camera& camera, float aspect);

/// Depth reversed, far plane at infinity, y down. Throws as cameraRays.
glm::mat4 clipFromWorld(const Camera& camera, float aspect);

}  // namespace verdure

#endif  // VERDURE_SCENE_CAMERA_H_
