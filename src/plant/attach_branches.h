#ifndef VERDURE_PLANT_ATTACH_BRANCHES_H_
#define VERDURE_PLANT_ATTACH_BRANCHES_H_

#include <vector>

#include "verdure/plant.h"

namespace verdure {

/// Hangs pieces of wood on each other. `branches`: of all pieces, each piece's first branch its
/// root; `piece_of_branch`: ascending. Sets parent of the roots that touch another piece's branch,
/// that they are nearest to by its radius; then of those that float in the air, and adds nothing to
/// those that stand on the ground. Pieces never hang on each other in a circle: the better contact
/// holds. Roots for which `fixed` (by piece) is true stay as they are.
void attachPieces(std::vector<Branch>& branches, const std::vector<std::uint32_t>& piece_of_branch,
                  const std::vector<bool>& fixed);

}  // namespace verdure

#endif  // VERDURE_PLANT_ATTACH_BRANCHES_H_
