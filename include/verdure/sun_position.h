#ifndef VERDURE_SUN_POSITION_H_
#define VERDURE_SUN_POSITION_H_

#include <glm/glm.hpp>
#include <optional>
#include <string>

/// Where the sun stands at a time and a place: Meeus, "Astronomical Algorithms", 2nd edition 1998,
/// chapters 12, 13, 16 and 25 (low accuracy). Good to 0.02 degrees from 1900 to 2100.
namespace verdure {

/// Seconds since 1970-01-01T00:00:00 UTC, without leap seconds, from ISO 8601: 2026-06-21T12:30,
/// with seconds and their fractions if wanted, then Z (as without it) or +02:00. Throws Error for
/// anything else, for days that do not exist and for years outside of 1900 to 2100.
double parseTime(const std::string& iso8601);

/// The same as "2026-06-21T12:30Z", rounded to minutes.
std::string formatTime(double unix_seconds);

struct Place {
  double latitude_deg = 0.0;   ///< north positive, [-90, 90]
  double longitude_deg = 0.0;  ///< east positive, [-180, 180]
};

struct SunPosition {
  double azimuth_deg = 0.0;    ///< 0: south (+Z), 90: east (+X); [-180, 180]
  double elevation_deg = 0.0;  ///< as seen: raised by refraction (Saemundsson 1986)
  double geometric_deg = 0.0;  ///< elevation without air

  /// Unit, +Y up, as seen.
  glm::vec3 direction() const;
};

/// Throws Error for a place that is none.
SunPosition sunPosition(double unix_seconds, const Place& place);

/// Sunrise and sunset of the day whose noon is nearest: the sun's upper edge at a level horizon,
/// 50 arc minutes above its geometric centre.
struct SunDay {
  double noon = 0.0;
  std::optional<double> rise, set;  ///< none: the sun stays up, or down
};
SunDay sunDay(double unix_seconds, const Place& place);

/// Elevation (without air) of the sun's centre when it rises and sets, degrees.
inline constexpr double kSunriseDeg = -50.0 / 60.0;

/// Throws Error that tells when the sun rises and sets if it is below the horizon.
void checkSunIsUp(double unix_seconds, const Place& place);

}  // namespace verdure

#endif  // VERDURE_SUN_POSITION_H_
