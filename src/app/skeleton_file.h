#ifndef VERDURE_APP_SKELETON_FILE_H_
#define VERDURE_APP_SKELETON_FILE_H_

#include <string>

#include "verdure/plant.h"

namespace verdure::app {

/// Writes a plant's branches: .obj holds one polyline each, an object for each level (positions
/// relative to Plant::origin); .png a drawing from the front and from the right, coloured by level,
/// as thick as the branches are, with leaves as faint dots. Atomic. Throws Error.
void writeSkeleton(const Plant& plant, const std::string& path);

}  // namespace verdure::app

#endif  // VERDURE_APP_SKELETON_FILE_H_
