#ifndef VERDURE_LEAF_VENATION_H_
#define VERDURE_LEAF_VENATION_H_

#include <cstdint>
#include <vector>

#include "leaf/leaf_form.h"
#include "leaf/leaf_raster.h"

namespace verdure {

/// A node of the venation, joined to its parent by a straight piece of vein. Parents come before
/// their children; node 0 is the stalk's foot.
struct VeinNode {
  glm::vec2 position;  ///< mm
  int parent = -1;
  int order = 1;        ///< 1 primary, 2 secondary, 3 tertiary and finer
  bool midrib = false;  ///< of the first guide: the stalk and what goes on from it
  int tips = 0;         ///< ends of veins that it feeds
  float radius = 0;     ///< mm
};

struct VenationOptions {
  float step_mm = 0.25f;       ///< distance between nodes
  float spacing_mm = 1.0f;     ///< least distance of the last auxin sources from all veins
  float first_spacing_mm = 8;  ///< the same of the first ones
  float clearance_mm = 0.2f;   ///< veins stay that far inside of the outline
  float exponent = 2.7f;       ///< n of r^n = sum of the children's r^n: 2 da Vinci, 3 Murray
};

/// How near each auxin source is reached, by the distance at which it was born.
inline constexpr float kKillShare = 0.5f;

/// Open venation by Runions, Fuhrer, Lane, Federl, Rolland-Lagan and Prusinkiewicz 2005, "Modeling
/// and visualization of leaf venation patterns". The form's large veins come first. Then auxin
/// sources appear wherever no vein and no other source is near, each draws the vein node nearest
/// to it of those that it sees within the blade, nodes grow by a step along the mean direction to
/// their sources, and sources that are reached vanish. That is repeated with sources ever closer
/// together, which is uniform growth of the blade seen in the frame of the full-grown leaf. After
/// each round the new ends run on to the vein ahead of them, without joining it.
std::vector<VeinNode> growVenation(const LeafPlan& form, const VenationOptions& options,
                                   std::uint64_t seed);

/// Sets tips and radii: every end of a vein has the same radius, and at each fork r^n is the sum of
/// the children's, so that a node's r^n is proportional to the number of ends that it feeds. The
/// foot gets `foot_radius`.
void setVeinWidths(std::vector<VeinNode>& nodes, float foot_radius, float exponent);

}  // namespace verdure

#endif  // VERDURE_LEAF_VENATION_H_
