#ifndef VERDURE_APP_VIEW_SURFACE_OVERLAY_H_
#define VERDURE_APP_VIEW_SURFACE_OVERLAY_H_

#include <array>
#include <vector>

#include "verdure/field.h"
#include "verdure/scene.h"

namespace verdure::app {

/// A triangle as it lies in a picture: corners from (0, 0), top left, to (1, 1), and how much the
/// surface faces the eye there, 0 at its outline to 1.
struct OverlayTriangle {
  std::array<glm::vec2, 3> corners{};
  std::array<float, 3> facing{};
};

/// The triangles of a surface that face the eye, as a camera sees them in a picture of `aspect` =
/// width / height. Those that reach behind the eye or wholly miss the picture are left out; none
/// hides another.
std::vector<OverlayTriangle> overlayTriangles(const Surface& surface,
                                              const glm::mat4& world_from_plant,
                                              const Camera& camera, float aspect);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_SURFACE_OVERLAY_H_
