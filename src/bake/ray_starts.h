#ifndef VERDURE_BAKE_RAY_STARTS_H_
#define VERDURE_BAKE_RAY_STARTS_H_

#include <vector>

#include "bake/vertex_fans.h"
#include "rays/ray_scene.h"
#include "verdure/occlusion.h"

namespace verdure {

/// Where rays leave the vertices of a plant, as occlusion.h has it.
class RayStarts {
 public:
  /// `scene`: the rays' scene with the plant at its own place.
  RayStarts(const Plant& plant, const RayScene& scene, std::optional<float> ground_height);

  Ray from(VertexId id, const glm::vec3& direction) const;

 private:
  /// Of a foliage mesh; empty for wood.
  struct Fans {
    VertexFans fans;
    std::vector<glm::vec3> normals;  ///< of VertexFans::triangles(), unit, or 0 of no area
  };

  const Plant& plant_;
  const RayScene& scene_;
  std::vector<Fans> fans_;
  std::optional<float> ground_height_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_RAY_STARTS_H_
