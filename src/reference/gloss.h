#ifndef VERDURE_REFERENCE_GLOSS_H_
#define VERDURE_REFERENCE_GLOSS_H_

#include <array>
#include <glm/glm.hpp>

#include "base/random.h"

namespace verdure {

/// The rough surface of a clear dielectric, seen from outside: Cook and Torrance, "A Reflectance
/// Model for Computer Graphics", 1982, with the distribution of Walter et al., "Microfacet Models
/// for Refraction through Rough Surfaces", EGSR 2007 (GGX), Smith's masking, height-correlated
/// (Heitz, JCGT 2014), and Schlick's Fresnel term; or Cook and Torrance's own terms
/// (shared/cook_torrance.h). All directions are unit, away from the surface; cosines are with its
/// normal.
class Gloss {
 public:
  /// `facing`: reflectance of a facet that is looked at squarely, [0, 1]; `width`: GGX's alpha,
  /// (0, 1]; `strength`: of all that is reflected, [0, 1].
  Gloss(float facing, float width, float strength = 1.0f)
      : Gloss(Facets::kGgx, facing, width, strength) {}
  /// Of leaves with maps: shared::cookTorrance(). `roughness`: m, above 0; `index` at least 1.
  static Gloss cookTorrance(float roughness, float index) {
    return {Facets::kBeckmann, index, roughness, 1.0f};
  }

  /// Radiance towards `out` for that from `in`, times the cosine of `in`; 0 below the surface.
  float value(const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) const;
  /// Per steradian, of sample().
  float density(const glm::vec3& normal, const glm::vec3& out, const glm::vec3& in) const;
  /// A direction by the facets that `out` sees (Heitz, "Sampling the GGX Distribution of Visible
  /// Normals", JCGT 2018), of Beckmann's by all facets; may lie below the surface, where no light
  /// is reflected to.
  glm::vec3 sample(const glm::vec3& normal, const glm::vec3& out, Random& random) const;

  /// Share of light from a direction that is reflected.
  float reflected(float cosine) const;
  /// What gets below the surface from one direction and out again in another, with the cosine, for
  /// a diffuse white below: (1 - reflected) of both over the mean. It keeps the rest of the energy,
  /// and directions may be exchanged (Kelemen and Szirmay-Kalos, Eurographics 2001 short papers).
  float passed(float cosine_out, float cosine_in) const {
    return (1.0f - reflected(cosine_out)) * (1.0f - reflected(cosine_in)) / mean_passed_;
  }
  float meanPassed() const { return mean_passed_; }

 private:
  static constexpr std::size_t kCosines = 64;
  enum class Facets { kGgx, kBeckmann };
  Gloss(Facets facets, float facing, float width, float strength);
  float integrated(const glm::vec3& out) const;

  Facets facets_;
  float facing_, width_;  ///< or refractive index and m
  float strength_;
  std::array<float, kCosines> reflected_{};  ///< at cosines (i + 1/2) / kCosines
  float mean_passed_ = 1.0f;                 ///< cosine-weighted over the hemisphere
};

}  // namespace verdure

#endif  // VERDURE_REFERENCE_GLOSS_H_
