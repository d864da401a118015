#ifndef VERDURE_APP_VIEW_FLY_CAMERA_H_
#define VERDURE_APP_VIEW_FLY_CAMERA_H_

#include "verdure/scene.h"

/// A camera that goes where it looks. All keep the field of view and the target's distance, so that
/// orbiting may go on from there.
namespace verdure::app {

/// Looks around: `turn` radians to the right and `rise` upwards, to kMostOrbitElevation at most.
/// The eye stays.
Camera lookedAround(const Camera& camera, float turn, float rise);

/// Eye and target move by metres to the right, up (in the world) and forward (where it looks).
Camera flown(const Camera& camera, float right, float up, float forward);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_FLY_CAMERA_H_
