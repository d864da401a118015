#ifndef VERDURE_REFERENCE_SURFACE_MODEL_H_
#define VERDURE_REFERENCE_SURFACE_MODEL_H_

#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/random.h"
#include "rays/ray_scene.h"
#include "reference/gloss.h"
#include "scene/texel_grid.h"

namespace verdure {

/// Diffuse reflection on the side of `side` and diffuse transmission to the other, both with the
/// cosine to a shading normal, and gloss over them. The part of a lobe on the wrong side of the
/// surface is mirrored back: a white surface loses and gains nothing, whatever its normals. What a
/// leaf's maps let through is not: they know no light from the side that is looked at.
struct Scatterer {
  /// Light through a leaf with maps.
  struct Through {
    glm::vec3 vector{0.0f};        ///< shared::leafThrough(), instead of the cosine's -normal
    const Gloss* gloss = nullptr;  ///< of the side that is lit
  };

  glm::vec3 side{0.0f, 1.0f, 0.0f};    ///< unit, the triangle's normal, towards where light leaves
  glm::vec3 normal{0.0f, 1.0f, 0.0f};  ///< unit, for shading
  glm::vec3 reflectance{0.0f};
  glm::vec3 transmittance{0.0f};
  const Gloss* gloss = nullptr;     ///< of both sides (see `through`), none if null
  glm::vec3 out{0.0f, 1.0f, 0.0f};  ///< unit, to where light leaves; gloss alone depends on it
  std::optional<Through> through = std::nullopt;

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
  float transmitted(const glm::vec3& direction) const;
  /// Unit: of the diffuse lobe to this side or the other.
  glm::vec3 axis(bool reflected) const;
  float meanTransmitted() const;
  float highlight(const glm::vec3& direction) const;
  /// The normal that gloss is seen under: the shading normal, if it can be.
  const glm::vec3& facing() const { return glm::dot(normal, out) > 0.0f ? normal : side; }
  float glossShare() const;
  float reflectedShare() const;
};

/// What a scene's surfaces look like, at a hit of RayScene.
class SurfaceModel {
 public:
  struct Options {
    bool normal_maps = true, gloss = true;
    bool leaf_maps = true;  ///< Material::leaf of foliage, where it has all six
  };
  SurfaceModel(const Scene& scene, const RayScene& rays, const Options& options);

  struct Point {
    glm::vec3 position{0.0f};
    Scatterer scatterer;
  };
  Point at(const RayHit& hit, const Ray& ray) const;

 private:
  /// Of one side, the front or the back.
  struct LeafSideMaps {
    TexelGrid translucency, light;
    float scale = 1.0f, offset = 0.0f;  ///< of light
    const Gloss* gloss = nullptr;
  };
  struct LeafMaps {
    TexelGrid back_color;
    std::optional<TexelGrid> back_normal;
    glm::vec3 factor{1.0f};  ///< of colours
    std::array<LeafSideMaps, 2> sides;
  };
  struct MeshMaps {
    std::optional<TexelGrid> normal;
    float normal_scale = 1.0f;
    const Gloss* gloss = nullptr;
    std::optional<LeafMaps> leaf;
  };
  const Gloss* glossOf(const Material& material, bool foliage);
  LeafMaps leafMaps(const Plant& plant, const Material& material);
  glm::mat3 textureFrame(const RayHit& hit, const glm::vec3& normal) const;
  static void lightThroughMaps(const LeafMaps& maps, bool front, const glm::vec2& uv,
                               const glm::mat3& frame, Scatterer& scatterer);
  glm::vec3 groundReflectance(const glm::vec3& position) const;

  const Scene& scene_;
  const RayScene& rays_;
  Options options_;
  /// By what facets reflect squarely, width and strength.
  std::map<std::array<float, 3>, Gloss> glosses_;
  std::map<std::pair<float, float>, Gloss> leaf_glosses_;  ///< by roughness and refractive index
  std::vector<std::vector<MeshMaps>> maps_;                ///< by item and mesh
  std::vector<std::vector<glm::mat4>> worlds_;             ///< by item and instance
  Texture ground_, ground_noise_;
};

}  // namespace verdure

#endif  // VERDURE_REFERENCE_SURFACE_MODEL_H_
