#ifndef VERDURE_MOTION_BEAM_H_
#define VERDURE_MOTION_BEAM_H_

#include <glm/glm.hpp>

namespace verdure {

/// The taper below which a beam counts as that thin at its tip: (4.7) has a pole at 0, and a branch
/// is no needle.
inline constexpr double kLeastTaper = 0.05;

/// Deflection u(x) of a tapered cantilever under an even load across it, (4.7) of Habel 2009, for
/// E'F / r_1^4 = 1; x in [0, 1] of its length, `taper` = radius of the tip by that of the root, at
/// least kLeastTaper (smaller ones are taken for that; thicker tips than roots are fine). Exact
/// within 1e-10, also at and near a taper of 1, where (4.7) is 0/0.
double beamDeflectionExact(double taper, double x);

/// (4.8): c_2 and c_4 of c_2 x^2 + c_4 x^4, by least squares at 101 points from 0 to 1 (table 4.1).
glm::dvec2 fitBeam(double taper);

}  // namespace verdure

#endif  // VERDURE_MOTION_BEAM_H_
