#ifndef VERDURE_MOTION_LARGE_DEFLECTION_H_
#define VERDURE_MOTION_LARGE_DEFLECTION_H_

#include <glm/glm.hpp>
#include <vector>

namespace verdure {

/// The truth about strongly bent beams, to measure (4.8) and the length correction against: a
/// tapered cantilever of length 1 under an even load across its axis at rest, per length of the
/// beam, of any deflection (E I(s) dtheta/ds = M(s), solved to 1e-10). Points at `count` + 1 equal
/// steps along the bent axis, x along the axis at rest, y aside; `tip` in [0, 0.8] is y of the
/// last. `taper` as in beamDeflectionExact(). Throws Error for numbers out of range.
std::vector<glm::dvec2> bentBeam(double taper, double tip, int count = 200);

}  // namespace verdure

#endif  // VERDURE_MOTION_LARGE_DEFLECTION_H_
