#ifndef VERDURE_REFERENCE_SURFACE_MODEL_H_
#define VERDURE_REFERENCE_SURFACE_MODEL_H_

#include <optional>
#include <vector>

#include "base/random.h"
#include "rays/ray_scene.h"
#include "reference/gloss.h"
#include "scene/texel_grid.h"

namespace verdure {

/// Diffuse reflection on the side of `side` and diffuse transmission to the other, both with the
/// cosine to a shading normal, and gloss over them. The part of a lobe on the wrong side of the
/// surface is mirrored back: a white surface loses and gains nothing, whatever its normals.
struct Scatterer {
  glm::vec3 side{0.0f, 1.0f, 0.0f};    ///< unit, the triangle's normal, towards where light leaves
  glm::vec3 normal{0.0f, 1.0f, 0.0f};  ///< unit, for shading
  glm::vec3 reflectance{0.0f};
  glm::vec3 transmittance{0.0f};
  const Gloss* gloss = nullptr;     ///< of both sides, none if null
  glm::vec3 out{0.0f, 1.0f, 0.0f};  ///< unit, to where light leaves; gloss alone depends on it

  /// What light from a unit direction becomes, times its cosine: dL = value * L_i d_omega.
  glm::vec3 value(const glm::vec3& direction) const;
  /// Per steradian, of sample().
  float density(const glm::vec3& direction) const;

  struct Sample {
    glm::vec3 direction{0.0f};
    glm::vec3 weight{0.0f};  ///< value / density
  };
  /// None where the surface is black, or the light would go into it.
  std::optional<Sample> sample(Random& random) const;

 private:
  /// Sum of lobe(direction, cosine with `axis`) over a direction and its mirror image.
  template <class Lobe>
  float mirroredSum(const glm::vec3& direction, const glm::vec3& axis, const Lobe& lobe) const;
  float diffuse(const glm::vec3& direction, bool reflected) const;
  float highlight(const glm::vec3& direction) const;
  /// The normal that gloss is seen under: the shading normal, if it can be.
  const glm::vec3& facing() const { return glm::dot(normal, out) > 0.0f ? normal : side; }
  float glossShare() const;
  float reflectedShare() const;
};

/// What a scene's surfaces look like, at a hit of RayScene.
class SurfaceModel {
 public:
  SurfaceModel(const Scene& scene, const RayScene& rays, bool normal_maps, bool gloss);

  struct Point {
    glm::vec3 position{0.0f};
    Scatterer scatterer;
  };
  Point at(const RayHit& hit, const Ray& ray) const;

 private:
  struct MeshNormals {
    std::optional<TexelGrid> map;
    float scale = 1.0f;
  };
  glm::vec3 mappedNormal(const RayHit& hit, const glm::vec2& uv, const glm::vec3& normal) const;
  glm::vec3 groundReflectance(const glm::vec3& position) const;

  const Scene& scene_;
  const RayScene& rays_;
  std::optional<Gloss> leaf_gloss_, wood_gloss_;
  std::vector<std::vector<MeshNormals>> normals_;  ///< by item and mesh
  std::vector<std::vector<glm::mat4>> worlds_;     ///< by item and instance
  Texture ground_, ground_noise_;
};

}  // namespace verdure

#endif  // VERDURE_REFERENCE_SURFACE_MODEL_H_
