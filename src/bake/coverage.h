#ifndef VERDURE_BAKE_COVERAGE_H_
#define VERDURE_BAKE_COVERAGE_H_

#include "verdure/plant.h"

namespace verdure {

/// Share of a disk around the plant that it covers, seen from the side and from a little above,
/// mean of several directions. The same for any number of threads.
double meanCoverage(const Plant& plant);

}  // namespace verdure

#endif  // VERDURE_BAKE_COVERAGE_H_
