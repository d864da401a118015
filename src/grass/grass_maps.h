#ifndef VERDURE_GRASS_GRASS_MAPS_H_
#define VERDURE_GRASS_GRASS_MAPS_H_

#include <vector>

#include "verdure/grass.h"

namespace verdure {

/// What is seen through all slices one behind the other, each time again, until nothing is seen
/// through; where there is nothing to see in a column, the row's mean. Slices of one size, at least
/// one.
GrassMap opaqueMap(const std::vector<GrassMap>& slices);

/// A picture of one colour with alpha 1, that faces the looker and belongs to no plant.
GrassMap evenMap(int width, int height, const glm::vec3& color);

}  // namespace verdure

#endif  // VERDURE_GRASS_GRASS_MAPS_H_
