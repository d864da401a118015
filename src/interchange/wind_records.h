#ifndef VERDURE_INTERCHANGE_WIND_RECORDS_H_
#define VERDURE_INTERCHANGE_WIND_RECORDS_H_

#include <string>

#include "interchange/wind_quantities.h"

namespace verdure {

/// The branch records of a plant as JSON: numbers with units in their names, and where each came
/// from.
std::string windRecords(const Plant& plant, const PlantMotion& motion,
                        const WindQuantities& quantities);

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_WIND_RECORDS_H_
