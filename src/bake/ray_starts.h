#ifndef VERDURE_BAKE_RAY_STARTS_H_
#define VERDURE_BAKE_RAY_STARTS_H_

#include <vector>

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
  /// Of a foliage mesh: unit normals of the triangles that meet at each vertex; those of vertices
  /// at one position are shared. Empty for wood.
  struct Fans {
    std::vector<std::uint32_t> fan_of_vertex;
    std::vector<std::uint32_t> first;  ///< of each fan, and the end
    std::vector<glm::vec3> normals;
  };
  static Fans fansOf(const Mesh& mesh);

  const Plant& plant_;
  const RayScene& scene_;
  std::vector<Fans> fans_;
  std::optional<float> ground_height_;
};

}  // namespace verdure

#endif  // VERDURE_BAKE_RAY_STARTS_H_
