#ifndef VERDURE_PLANT_SKIN_BRANCHES_H_
#define VERDURE_PLANT_SKIN_BRANCHES_H_

#include <vector>

#include "verdure/plant.h"

namespace verdure {

/// The branches that the skins of a plant's glTF file state.
struct SkinBranches {
  std::vector<Branch> branches;  ///< parents before children
  /// Of each mesh, the branch of each vertex by its greatest weight (kNone: no weights); empty for
  /// meshes without a skin.
  std::vector<std::vector<std::uint32_t>> branch_of_vertex;
};

/// Chains of joints are branches: a joint goes on with the child whose name follows on its own
/// ("bough.002" on "bough.001"); where no names do, with the thickest and straightest that begins
/// at its end. Joints on which nothing hangs are left out. Radii come
/// from the wood that hangs on a joint. No branches where the document has no skin, or none that
/// wood hangs on. Throws Error for a skin that names a joint twice.
SkinBranches branchesOfSkins(const Plant& plant);

}  // namespace verdure

#endif  // VERDURE_PLANT_SKIN_BRANCHES_H_
