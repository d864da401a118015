#ifndef VERDURE_APP_VIEW_ORBIT_CAMERA_H_
#define VERDURE_APP_VIEW_ORBIT_CAMERA_H_

#include "verdure/scene.h"

/// A camera that goes around what it looks at. All keep the field of view.
namespace verdure::app {

/// How near the eye may come to the vertical through the target, radians.
inline constexpr float kMostOrbitElevation = 1.54f;

/// Around the target: `turn` radians to the right, as seen from above against the clock, and `rise`
/// upwards, to kMostOrbitElevation at most. Distance and target stay.
Camera orbited(const Camera& camera, float turn, float rise);

/// Eye and target move alike, by shares of the picture's height at the target's distance: what is
/// there follows a pointer that goes `right` and `down` by as much.
Camera panned(const Camera& camera, float right, float down);

/// The eye's distance becomes `factor` > 0 times as large, between `least` and `most` metres.
Camera zoomed(const Camera& camera, float factor, float least, float most);

/// The eye is at least at this height, the target stays.
Camera raisedTo(const Camera& camera, float least_height);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_ORBIT_CAMERA_H_
