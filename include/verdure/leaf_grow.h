#ifndef VERDURE_LEAF_GROW_H_
#define VERDURE_LEAF_GROW_H_

#include <cstdint>
#include <string>
#include <vector>

#include "verdure/leaf.h"

/// Leaves grown from nothing but a species and a seed.
namespace verdure {

struct LeafGrowOptions {
  std::string species = "silver-birch";
  std::uint32_t seed = 1;
  int size = 1024;   ///< texels a side, 16 to 8192
  float age = 0.4f;  ///< [0, 1]: 0 fresh in spring, 0.4 summer, 1 autumn
};

/// Grows a leaf: an outline with teeth or lobes, open venation of three orders by space
/// colonisation (Runions et al. 2005, "Modeling and visualization of leaf venation patterns"),
/// veins as wide as those they feed (r^n = sum of the children's, n between da Vinci's 2 and
/// Murray's 3), and from these relief, thickness, normals and colours of both sides.
///
/// The image is square, the stalk's foot at the middle of the lower edge. Outline and venation
/// depend on species and seed alone, and neither on the size nor on the age; what age changes,
/// it changes continuously. Colours and thickness go on outside of the outline, so that filtering
/// shows no fringe. The same for any number of threads. Scots pine is a shoot with its needles.
///
/// Throws Error for an unknown species, a size out of range or an age outside of [0, 1].
LeafSet growLeaf(const LeafGrowOptions& options);

/// Several leaves of one tree, of the seeds options.seed, options.seed + 1 ...: as growLeaf()
/// makes them but in one frame, that of the largest, so that tileLeaves() takes them. `count` is 1
/// to 1024.
std::vector<LeafSet> growLeaves(const LeafGrowOptions& options, int count);

struct LeafSpeciesInfo {
  std::string name;   ///< as given to LeafGrowOptions::species; those of grow()
  std::string title;  ///< "Quaking aspen (Populus tremuloides)"
};

/// All species, in a fixed order.
const std::vector<LeafSpeciesInfo>& leafSpeciesList();

}  // namespace verdure

#endif  // VERDURE_LEAF_GROW_H_
