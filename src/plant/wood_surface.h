#ifndef VERDURE_PLANT_WOOD_SURFACE_H_
#define VERDURE_PLANT_WOOD_SURFACE_H_

#include <array>
#include <vector>

#include "verdure/plant.h"

namespace verdure {

/// One connected piece of wood after welding: joined by edges, so that tubes that touch in a point
/// are two.
struct WoodPatch {
  std::vector<glm::vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points; two may be one point
};

struct WoodVertex {
  std::uint32_t patch = kNone;  ///< kNone: of no triangle with an extent
  std::uint32_t point = 0;
};

struct WoodSurface {
  std::vector<WoodPatch> patches;                 ///< by their first triangle
  std::vector<std::vector<WoodVertex>> vertices;  ///< of each mesh; empty where it was left out
};

/// The wood of all meshes together, without those for which `leave_out` is true. Triangles are
/// joined at edges that they share in the file, and where at most two meet after welding: an open
/// end on another tube's ring stays apart.
WoodSurface weldWood(const Plant& plant, const std::vector<bool>& leave_out);

}  // namespace verdure

#endif  // VERDURE_PLANT_WOOD_SURFACE_H_
