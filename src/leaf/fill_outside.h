#ifndef VERDURE_LEAF_FILL_OUTSIDE_H_
#define VERDURE_LEAF_FILL_OUTSIDE_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace verdure {

/// Replaces the texels of width x height that are not `inside` by smooth values that begin with
/// those of the nearest inside, so that filtering at the outline mixes in nothing foreign: averages
/// of ever larger squares, from the coarse ones back. Nothing changes if there is no texel inside.
void fillOutside(std::vector<glm::vec3>& texels, const std::vector<std::uint8_t>& inside, int width,
                 int height);

}  // namespace verdure

#endif  // VERDURE_LEAF_FILL_OUTSIDE_H_
