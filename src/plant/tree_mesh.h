#ifndef VERDURE_PLANT_TREE_MESH_H_
#define VERDURE_PLANT_TREE_MESH_H_

#include "leaf/leaf_atlas.h"
#include "plant/weber_penn.h"
#include "verdure/grow.h"
#include "verdure/plant.h"

namespace verdure {

/// Stems as closed generalised cylinders with rounded tips: those whose radius at the base lies in
/// [min_radius, max_radius), m. U runs around a stem a whole number of times, V along it so that a
/// texture `bark_width` metres wide keeps its proportions.
Mesh meshStems(const Skeleton& skeleton, const TreeParameters& parameters, float bark_width,
               float min_radius, float max_radius);

/// How blades are bent.
struct BladeForm {
  float fold_deg = 18;  ///< each half above the plane of the leaf
  float curl_deg = 30;  ///< turn of the midrib from foot to tip, downwards
};

/// Leaves as one mesh, with Plant::leaves and leaf_triangles (mesh number `mesh_index`). `shoots`:
/// they are shoots with needles, not blades.
Mesh meshLeaves(const Skeleton& skeleton, const LeafAtlas& atlas, const BladeForm& form,
                LeafForm leaf_form, bool shoots, std::uint32_t mesh_index, Plant& plant);

}  // namespace verdure

#endif  // VERDURE_PLANT_TREE_MESH_H_
