#ifndef VERDURE_RENDER_CAMERA_H_
#define VERDURE_RENDER_CAMERA_H_

#include "shared/frame.h"
#include "verdure/render.h"

namespace verdure {

/// Unit direction of an azimuth from +Z (south) towards +X (east) and an elevation, radians.
glm::vec3 directionOf(float azimuth, float elevation);

/// Fills clip_from_world (depth reversed, far plane at infinity), eye and rays. Throws Error for a
/// camera that looks nowhere or a field of view outside (0, pi).
void setCamera(shared::FrameUniforms& uniforms, const Camera& camera, float aspect);

}  // namespace verdure

#endif  // VERDURE_RENDER_CAMERA_H_
