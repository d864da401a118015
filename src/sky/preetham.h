#ifndef VERDURE_SKY_PREETHAM_H_
#define VERDURE_SKY_PREETHAM_H_

#include "shared/sky_formula.h"

namespace verdure {

/// The sky of Preetham, Shirley, Smits 1999 for a turbidity (2 to 10, not checked) and the unit
/// direction towards the sun. A sun below the horizon lights as from the horizon, dimmed by
/// twilight().
shared::SkyFormula preethamFormula(float turbidity, const glm::vec3& to_sun);

/// Share of the light at sunset that the sky still gives when the sun stands at `elevation`
/// (radians): 1 above the horizon, a factor of 10^-0.4 for each degree below it. Within a factor of
/// 1.7 of the table of twilight in Seidelmann, "Explanatory Supplement to the Astronomical
/// Almanac", 1992, section 9.3, down to 12 degrees below the horizon.
float twilight(float elevation);

/// Luminance, kcd/m^2, of the sun's disk at `elevation` (radians) through air of a turbidity: the
/// spectrum of Preetham et al., appendix 2. Black when all of it is below the horizon, dimmed by
/// the share of the disk that is hidden where it sets.
glm::vec3 sunLuminance(float turbidity, float elevation, float angular_radius);

}  // namespace verdure

#endif  // VERDURE_SKY_PREETHAM_H_
