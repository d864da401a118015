#ifndef VERDURE_APP_JSON_NUMBERS_H_
#define VERDURE_APP_JSON_NUMBERS_H_

#include <fmt/format.h>

#include <string>

namespace verdure::app {

/// A number for people and JSON, to six significant digits: a float's own are about seven, and the
/// rest of a double's would be noise.
inline double sixDigits(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

}  // namespace verdure::app

#endif  // VERDURE_APP_JSON_NUMBERS_H_
