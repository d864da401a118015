#ifndef VERDURE_PLANT_SURFACE_BRANCHES_H_
#define VERDURE_PLANT_SURFACE_BRANCHES_H_

#include <span>

#include "plant/surface_distance.h"

namespace verdure {

/// The branches of one patch of bark.
struct PatchBranches {
  std::vector<Branch> branches;  ///< the one from the root first, parents before children
  std::vector<std::uint32_t> branch_of_point;
  std::vector<std::uint32_t> tips;  ///< the point of the patch where each branch ends
};

/// Splits a patch by the level sets of the distance from its root: what `sources` holds, the points
/// of one end. Above a fork the level sets are several loops; how they hang together is a tree that
/// one sweep over the points from the farthest to the nearest finds (the split tree of Carr,
/// Snoeyink, Axen, "Computing contour trees in all dimensions", 2003). What is not at least about
/// as long as it is thick is a burr and no branch. At a fork the thickest and straightest goes on
/// as the branch. Axes run through the centroids of level sets, radii are the distances of the
/// bark's own points from them. Levels of Branch count within the patch.
PatchBranches branchesOfPatch(const WoodPatch& patch, const PatchGraph& graph,
                              std::span<const std::uint32_t> sources);

}  // namespace verdure

#endif  // VERDURE_PLANT_SURFACE_BRANCHES_H_
