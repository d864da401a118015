#ifndef VERDURE_SCENE_TERRAIN_HORIZON_H_
#define VERDURE_SCENE_TERRAIN_HORIZON_H_

#include <vector>

#include "verdure/terrain.h"

namespace verdure {

/// Tangents of the steepest lines of sight from `eye` to the ground, for each turn about +Y (from
/// +Z towards +X) up to each ring: [turn * shared::kHorizonRings + ring], see shared/horizon.h.
/// Never too high for what stands there, and lower by what the drawn ground may lie below the true
/// one.
std::vector<float> terrainHorizon(const Terrain& terrain, const glm::vec3& eye);

}  // namespace verdure

#endif  // VERDURE_SCENE_TERRAIN_HORIZON_H_
