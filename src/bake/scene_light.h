#ifndef VERDURE_BAKE_SCENE_LIGHT_H_
#define VERDURE_BAKE_SCENE_LIGHT_H_

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "bake/ray_bake.h"

namespace verdure {

/// A square of the ground around a plant, its height wider on each side: beyond, the plant covers
/// little sky.
struct GroundSquare {
  glm::vec2 corner{0.0f};  ///< least x and z, m
  float side = 0.0f;       ///< m, above 0
};
GroundSquare groundSquare(const Plant& plant, float height);

/// What light rays find in a plant's scene: that of the sky, or that which surfaces pass on after
/// one or more bounces, as coefficients of harmonics.
///
/// Surfaces are cut into patches, a triangle each (large ones into several) and cells of the
/// ground. A few rays from random points of each side of a patch tell how much of the sky it sees
/// and which patches; what those pass on is summed up, one bounce after the other (Sloan, Kautz,
/// Snyder 2002, section 5, with patches in the place of vertices; the last step is the "final
/// gather" of radiosity). A patch passes on its mean light times its mean reflectance, and leaves
/// what arrives at their other side times their transmittance. Inside of wood it is dark.
class SceneLight {
 public:
  using Slot = std::uint32_t;  ///< one side of a patch
  static constexpr Slot kBlack = std::numeric_limits<Slot>::max();
  static constexpr Slot kInside = kBlack - 1;  ///< the inside of wood: as black

  /// `bands` of harmonics, 0: an even light of 1 (one coefficient). Without bounces surfaces are
  /// black, and the rest does nothing. Throws Error: more memory than allowed.
  SceneLight(const Plant& plant, const RayBake& rays, const RayOptions& options, int bands);

  std::size_t coefficients() const { return count_; }

  /// Rays that bounce() traces.
  double rayCount() const;
  /// Finds the light that surfaces pass on; the share done that is told goes from 0 to `end`.
  void bounce(double end);

  /// Adds the sky's harmonics to direct[0 .. coefficients()) if the ray reaches it; else the side
  /// of a patch that it meets.
  Slot follow(const Ray& ray, float* direct) const;
  /// Adds what these sides pass on to sums[0 .. 3 * coefficients()): red, green and blue of the
  /// first coefficient, ...
  void gather(std::span<const Slot> slots, float* sums) const;

 private:
  /// The patches of one triangle: n * n alike, each of one side (wood) or two.
  struct Split {
    Slot first = 0;
    std::uint32_t n = 1;
  };
  struct TriangleId {
    std::uint32_t mesh = 0, triangle = 0;
  };
  struct Side {
    glm::vec3 reflectance{0.0f}, transmittance{0.0f};  ///< means over the patch
    float weight = 0.0f;                               ///< of a ray
  };

  void layPatches();
  std::size_t sidesOf(std::uint32_t mesh) const;
  TriangleId triangleOf(std::size_t number) const;
  Slot slotOf(const Ray& ray, const RayHit& hit) const;
  void addSky(const glm::vec3& direction, float* direct) const;
  void tracePatch(TriangleId id, std::uint32_t part, Random& random);
  void traceCell(std::size_t cell, Random& random);
  /// What a patch passes on of the sky's light and, if `again`, of what its rays met passes on now.
  void passOn(Slot first, std::size_t sides, bool again, std::vector<float>& passed) const;
  void passAll(bool again, double begin, double end);

  const Plant& plant_;
  const RayBake& rays_;
  const RayOptions& options_;
  int bands_ = 0;
  std::size_t count_ = 1;
  std::size_t rays_each_ = 0;
  std::vector<std::size_t> first_triangle_;  ///< of each mesh, and the end
  std::vector<Split> splits_;                ///< of each triangle of the plant
  Slot first_cell_ = 0, slot_count_ = 0;     ///< the last slot is the open ground
  GroundSquare square_;
  // Of each slot:
  std::vector<Side> sides_;
  std::vector<float> direct_;  ///< mean light of the sky, coefficients()
  std::vector<Slot> met_;      ///< by each of its rays
  std::vector<float> passed_;  ///< what it passes on, 3 * coefficients()
};

}  // namespace verdure

#endif  // VERDURE_BAKE_SCENE_LIGHT_H_
