#ifndef VERDURE_PLANT_SURFACE_DISTANCE_H_
#define VERDURE_PLANT_SURFACE_DISTANCE_H_

#include <span>

#include "plant/wood_surface.h"

namespace verdure {

/// Who is beside whom on a patch.
class PatchGraph {
 public:
  explicit PatchGraph(const WoodPatch& patch);

  std::span<const std::uint32_t> neighbours(std::uint32_t point) const {
    return {neighbours_.data() + first_neighbour_[point],
            first_neighbour_[point + 1] - first_neighbour_[point]};
  }
  /// Triangles with three different points.
  std::span<const std::uint32_t> triangles(std::uint32_t point) const {
    return {triangles_.data() + first_triangle_[point],
            first_triangle_[point + 1] - first_triangle_[point]};
  }
  /// The open rim through a point: all points reached along edges of one triangle; the point alone
  /// where there is none.
  std::vector<std::uint32_t> rimThrough(std::uint32_t point) const;

 private:
  std::vector<std::uint32_t> first_neighbour_, neighbours_, first_triangle_, triangles_;
  std::vector<bool> rim_;  ///< parallel to neighbours_: the edge has one triangle
};

/// Distance along the surface from the nearest of `sources`, for every point of the patch: fast
/// marching (Kimmel and Sethian, "Computing geodesic paths on manifolds", PNAS 1998) with straight
/// fronts in each triangle, along edges where a front would leave it.
std::vector<float> surfaceDistance(const WoodPatch& patch, const PatchGraph& graph,
                                   std::span<const std::uint32_t> sources);

}  // namespace verdure

#endif  // VERDURE_PLANT_SURFACE_DISTANCE_H_
