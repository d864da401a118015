#ifndef VERDURE_LEAF_LEAF_ATLAS_H_
#define VERDURE_LEAF_LEAF_ATLAS_H_

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "verdure/leaf_translucency.h"

namespace verdure {

/// The variants of a leaf that one texture of a plant holds.
inline constexpr int kLeafVariants = 4;

/// Leaves of a species side by side as one set, all at one scale, with the light through them.
struct LeafAtlas {
  LeafSet set;
  LeafTranslucency light;
  int columns = 0, rows = 0;  ///< of cells; leaf k is in column k % columns of row k / columns
  float cell_width = 0;       ///< by its height
  /// Width of a leaf by its length, the mean of all.
  float natural_width = 0;

  struct Variant {
    float foot = 0;  ///< where the stalk's foot is on the cell's lower edge, in cell heights
    /// Points whose convex hull holds the leaf, from its foot, in cell heights, y upwards.
    std::vector<glm::vec2> points;
  };
  std::vector<Variant> variants;
};

/// Grows kLeafVariants leaves and bakes the light through them. Cells are `size` / 2 texels high,
/// and as wide; those of narrow leaves are half as wide, those of very narrow ones a quarter, which
/// then are `size` high. `size` is a multiple of 4, 32 to 8192. Throws Error as growLeaf() does.
LeafAtlas growLeafAtlas(const std::string& species, int size, float age);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_ATLAS_H_
