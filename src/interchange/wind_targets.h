#ifndef VERDURE_INTERCHANGE_WIND_TARGETS_H_
#define VERDURE_INTERCHANGE_WIND_TARGETS_H_

#include <string>
#include <vector>

#include "interchange/wind_quantities.h"

namespace verdure {

/// One attribute of a target: a quantity for each channel.
struct WindAttribute {
  /// Semantic; "TEXCOORD" is the first set that the file leaves free, 1 or above.
  std::string name;
  bool bytes = false;  ///< normalised; else floats
  std::vector<WindQuantity> channels;
  bool leaves_only = false;
};

struct WindTargetTable {
  std::string name, what;
  std::vector<WindAttribute> attributes;
};

/// What each engine reads. docs/wind-export.md has the source of each line and how sure it is.
const std::vector<WindTargetTable>& windTargetTables();

/// Throws Error, with the names of all targets, for another one.
const WindTargetTable& windTargetTable(const std::string& name);

inline constexpr const char* kPivotPainter = "pivot-painter2";

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_WIND_TARGETS_H_
