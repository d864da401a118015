#ifndef VERDURE_SKY_FORMULA_SKY_H_
#define VERDURE_SKY_FORMULA_SKY_H_

#include "shared/sky_formula.h"
#include "verdure/sky.h"

namespace verdure {

/// A sky that is its formula.
std::shared_ptr<const Sky> formulaSky(const shared::SkyFormula& formula);

/// The direction, made unit. Throws Error if it is zero or not finite.
glm::vec3 unitDirection(const glm::vec3& to_sun);

/// A unit direction below the horizon turned up to it.
glm::vec3 raisedToHorizon(const glm::vec3& unit);

}  // namespace verdure

#endif  // VERDURE_SKY_FORMULA_SKY_H_
