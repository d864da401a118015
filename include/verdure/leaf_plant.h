#ifndef VERDURE_LEAF_PLANT_H_
#define VERDURE_LEAF_PLANT_H_

#include "verdure/leaf_translucency.h"
#include "verdure/plant.h"

namespace verdure {

/// Adds a leaf's maps, and the light through it, to a plant: eight textures of 8 bits (the
/// coefficients by the range that they have on each side) and a foliage material that reads them,
/// cut out by opacity. Returns its index in Plant::materials. Throws Error for a bad set or a bake
/// of another size.
std::uint32_t addLeafMaterial(Plant& plant, const LeafSet& set, const LeafTranslucency& light);

struct LeafPlantOptions {
  int segments = 32;      ///< of its mesh along each side, 1 to 1024; made even
  float fold_deg = 0.0f;  ///< how far each half turns up at the midrib, in (-90, 90)
  float bend_deg = 0.0f;  ///< how far the tip turns back against the foot, in [-360, 360]
  float scale = 1.0f;     ///< of its true size, above 0
};

/// A leaf data set as a plant of one leaf: an upright sheet whose lower edge's middle is the origin
/// and whose front faces +z. Throws Error as addLeafMaterial() does, and for options out of range.
Plant leafPlant(const LeafSet& set, const LeafTranslucency& light,
                const LeafPlantOptions& options = {});

/// The same leaf with both its surfaces as they are in space, for rays: mesh 0 is the front and
/// mesh 1 the back, each moved off the sheet by its relief, a vertex in each texel's middle, row by
/// row, with the sheet's normals and that side's albedo and normal map. Between four vertices are
/// two triangles, and the edge between them runs up to the right. Open at the outline;
/// Plant::leaves stays empty. Of the options, `segments` plays no part. Throws Error as leafPlant()
/// does, and for a set of one row or column.
Plant leafReliefPlant(const LeafSet& set, const LeafPlantOptions& options = {});

}  // namespace verdure

#endif  // VERDURE_LEAF_PLANT_H_
