#include "scene/terrain_horizon.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "shared/horizon.h"

namespace verdure {

std::vector<float> terrainHorizon(const Terrain& terrain, const glm::vec3& eye) {
  // Far ground is drawn of larger triangles: within about a pixel of its true height.
  constexpr float kMargin = 0.002f;
  constexpr float kLowest = -1e30f;
  std::vector<float> horizon(std::size_t{shared::kHorizonTurns} * shared::kHorizonRings);
  std::vector<float> distances;
  for (std::uint32_t ring = 0; ring < shared::kHorizonRings; ++ring)
    distances.push_back(shared::horizonDistance(ring));
  parallelFor(shared::kHorizonTurns, 16, [&](std::size_t turn) {
    const float angle = 6.2831853f * static_cast<float>(turn) / shared::kHorizonTurns;
    const glm::vec2 way(std::sin(angle), std::cos(angle));
    float steepest = kLowest;
    for (std::size_t ring = 0; ring < shared::kHorizonRings; ++ring) {
      const glm::vec2 at = glm::vec2(eye.x, eye.z) + way * distances[ring];
      const float tangent = (terrain.heightAt(at) - eye.y) / distances[ring] - kMargin;
      steepest = std::max(steepest, tangent);
      horizon[turn * shared::kHorizonRings + ring] = steepest;
    }
  });
  return horizon;
}

}  // namespace verdure
