#include "app/view/surface_overlay.h"

#include <algorithm>

#include "scene/camera.h"

namespace verdure::app {

std::vector<OverlayTriangle> overlayTriangles(const Surface& surface,
                                              const glm::mat4& world_from_plant,
                                              const Camera& camera, float aspect) {
  const glm::mat4 clip_from_plant = clipFromWorld(camera, aspect) * world_from_plant;
  const glm::vec3 eye(glm::inverse(world_from_plant) * glm::vec4(camera.eye, 1.0f));
  std::vector<OverlayTriangle> triangles;
  for (std::size_t t = 0; t + 2 < surface.indices.size(); t += 3) {
    OverlayTriangle triangle;
    std::array<glm::vec3, 3> corners;
    bool seen = true;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t index = surface.indices[t + c];
      corners[c] = surface.positions[index];
      const glm::vec4 clip = clip_from_plant * glm::vec4(corners[c], 1.0f);
      seen = seen && clip.w > 0.0f && clip.z < clip.w;  // behind the near plane
      triangle.corners[c] = 0.5f + 0.5f * glm::vec2(clip) / clip.w;
      const glm::vec3 to_eye = glm::normalize(eye - corners[c]);
      triangle.facing[c] = index < surface.normals.size()
                               ? std::clamp(glm::dot(surface.normals[index], to_eye), 0.0f, 1.0f)
                               : 1.0f;
    }
    const glm::vec3 face = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (!seen || glm::dot(face, eye - corners[0]) <= 0.0f) continue;
    const auto [a, b, c] = triangle.corners;
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    if (high.x < 0.0f || high.y < 0.0f || low.x > 1.0f || low.y > 1.0f) continue;
    triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace verdure::app
