#ifndef VERDURE_TESTS_LIGHT_PATHS_H_
#define VERDURE_TESTS_LIGHT_PATHS_H_

#include <algorithm>

#include "bake/ray_directions.h"
#include "bake/ray_starts.h"
#include "verdure/occlusion.h"

/// Light by brute force: whole paths from a vertex, one surface after the other.
namespace verdure::test {

/// What `paths` paths from one side of a vertex of a plant find, as occlusion.h has it: calls
/// escape(direction, throughput, bounced) for each that leaves the scene.
template <class Escape>
void followPaths(const RayScene& scene, const RayStarts& starts, VertexId id,
                 const glm::vec3& normal, int paths, int bounces, bool ground, Random& random,
                 const Escape& escape) {
  const ShiftedLattice lattice(paths, random);
  for (int p = 0; p < paths; ++p) {
    const glm::vec2 u = lattice.point(p);
    Ray ray = starts.from(id, axesAround(normal) * cosineDirection(u.x, u.y));
    glm::vec3 throughput(1.0f);
    for (int bounced = 0; bounced <= bounces; ++bounced) {
      const std::optional<Hit> hit = scene.closestHit(ray);
      if (!hit) {
        if (!ground || ray.direction.y >= 0.0f) escape(ray.direction, throughput, bounced);
        break;
      }
      const bool front = glm::dot(hit->normal, ray.direction) < 0.0f;
      if (!hit->foliage && !front) break;
      glm::vec3 side = front ? hit->normal : -hit->normal;
      // A coin decides between the sides of a leaf.
      const bool reflected = !hit->foliage || random.uniform() < 0.5f;
      throughput *= reflected ? hit->reflectance : hit->transmittance;
      if (hit->foliage) throughput *= 2.0f;
      if (!reflected) side = -side;
      ray.origin = scene.originOff(hit->position, side);
      const float a = random.uniform(), b = random.uniform();
      ray.direction = axesAround(side) * cosineDirection(a, b);
    }
  }
}

}  // namespace verdure::test

#endif  // VERDURE_TESTS_LIGHT_PATHS_H_
