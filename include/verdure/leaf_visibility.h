#ifndef VERDURE_LEAF_VISIBILITY_H_
#define VERDURE_LEAF_VISIBILITY_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/occlusion.h"
#include "verdure/plant.h"

/// How much of each leaf face is seen from around: Gumbau, Chover, Rebollo, Remolar, "Real-Time
/// Illumination of Foliage Using Depth Maps", ICCS 2008.
namespace verdure {

struct LeafVisibilityOptions {
  /// Directions from which leaves are looked at, in parallel: 6 = along the axes, as the paper
  /// does; any other number, 2 to 4096, evenly over the sphere.
  int directions = 64;
  /// Of each leaf, shared out over the directions (at least one each).
  int rays = 64;
  std::uint32_t seed = 1;
  std::size_t max_memory_bytes = std::size_t{8} << 30;  ///< of the rays' scene
  std::function<bool(double share)> progress;           ///< as RayOptions::progress
};

/// V_i / V of the paper for each of Plant::leaves, x = front, y = back, in [0, 1]: over all
/// directions, the area of the face that is seen over the area that would be seen if the leaf were
/// alone. Both areas are projected along the direction; what the alpha cut takes away counts in
/// neither, nor does what the leaf itself hides. Where the paper counts pixels of a picture in
/// which every face has its own colour, points of the leaf look back along each direction: no leaf
/// is too small for the picture. A face that no direction sees even alone has 1. Deterministic for
/// any number of threads. Throws Error: options out of range, a plant without leaves, a scene over
/// max_memory_bytes, cancelled.
std::vector<glm::vec2> leafVisibility(const Plant& plant,
                                      const LeafVisibilityOptions& options = {});

/// Puts each leaf's visibility into MeshLight::visibility of its vertices, and the mean of both
/// sides (at least 1/255) into their ambient coefficients. Parts without leaves keep theirs, and
/// have no visibility.
void setLeafVisibility(const Plant& plant, const std::vector<glm::vec2>& visibility,
                       CrownLight& light);

}  // namespace verdure

#endif  // VERDURE_LEAF_VISIBILITY_H_
