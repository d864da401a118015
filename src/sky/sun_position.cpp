#include "verdure/sun_position.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "verdure/error.h"

namespace verdure {
namespace {

double sinDeg(double a) {
  return std::sin(glm::radians(a));
}
double cosDeg(double a) {
  return std::cos(glm::radians(a));
}
double turn(double deg) {
  return deg - 360.0 * std::floor(deg / 360.0);
}
double halfTurn(double deg) {
  return turn(deg + 180.0) - 180.0;
}

/// Days from 2000-01-01T12:00 to the time.
double daysSince2000(double unix_seconds) {
  return unix_seconds / 86400.0 - 10957.5;
}

struct Equatorial {
  double right_ascension, declination;  ///< degrees
};

/// The sun's apparent place (chapter 25). Universal time stands for dynamical: 0.001 degrees.
Equatorial apparentSun(double days) {
  const double t = days / 36525.0;
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
  const double center = (1.914602 - t * (0.004817 + t * 0.000014)) * sinDeg(anomaly) +
                        (0.019993 - t * 0.000101) * sinDeg(2.0 * anomaly) +
                        0.000289 * sinDeg(3.0 * anomaly);
  const double node = 125.04 - 1934.136 * t;
  const double longitude = mean_longitude + center - 0.00569 - 0.00478 * sinDeg(node);
  const double obliquity =
      23.4392911 - t * (0.0130042 + t * (1.64e-7 - t * 5.04e-7)) + 0.00256 * cosDeg(node);
  return {glm::degrees(std::atan2(cosDeg(obliquity) * sinDeg(longitude), cosDeg(longitude))),
          glm::degrees(std::asin(sinDeg(obliquity) * sinDeg(longitude)))};
}

/// Angle of the sun west of the meridian, degrees in [-180, 180) (12.4 and chapter 13).
double hourAngle(double days, const Equatorial& sun, double longitude_deg) {
  const double t = days / 36525.0;
  const double sidereal = 280.46061837 + 360.98564736629 * days + t * t * 0.000387933;
  return halfTurn(sidereal + longitude_deg - sun.right_ascension);
}

/// Refraction at a geometric elevation, both in degrees (16.4); below the horizon, where nothing is
/// seen, it fades.
double refraction(double elevation) {
  const double h = std::max(elevation, -1.0);
  const double lift = 1.02 / 60.0 / std::tan(glm::radians(h + 10.3 / (h + 5.11)));
  return std::max(lift, 0.0) * (elevation < -1.0 ? std::exp(elevation + 1.0) : 1.0);
}

void checkPlace(const Place& p) {
  if (!(std::abs(p.latitude_deg) <= 90.0 && std::abs(p.longitude_deg) <= 180.0))
    throw Error("place", fmt::format("{:g},{:g} is not on Earth", p.latitude_deg, p.longitude_deg),
                "give a latitude in [-90, 90] and a longitude in [-180, 180]");
}

/// Reads `digits` digits at `at` and moves on. Negative: there are none.
int readDigits(const std::string& text, std::size_t& at, std::size_t digits) {
  int value = 0;
  for (std::size_t i = 0; i < digits; ++i, ++at) {
    if (at >= text.size() || text[at] < '0' || text[at] > '9') return -1;
    value = value * 10 + (text[at] - '0');
  }
  return value;
}

bool skip(const std::string& text, std::size_t& at, char c) {
  if (at >= text.size() || text[at] != c) return false;
  ++at;
  return true;
}

/// Minutes east of UTC at the end of a time; none if there is something else.
std::optional<int> readZone(const std::string& text, std::size_t at) {
  if (at == text.size()) return 0;
  if (skip(text, at, 'Z')) return at == text.size() ? std::optional(0) : std::nullopt;
  const int sign = skip(text, at, '+') ? 1 : skip(text, at, '-') ? -1 : 0;
  const int hours = readDigits(text, at, 2);
  skip(text, at, ':');
  const int minutes = readDigits(text, at, 2);
  if (sign == 0 || hours < 0 || hours > 14 || minutes < 0 || minutes > 59 || at != text.size())
    return std::nullopt;
  return sign * (60 * hours + minutes);
}

}  // namespace

double parseTime(const std::string& iso8601) {
  const Error bad("date", "'" + iso8601 + "' is no time of the years 1900 to 2100",
                  "write it as 2026-06-21T12:30Z or 2026-06-21T14:30+02:00");
  std::size_t at = 0;
  const int year = readDigits(iso8601, at, 4);
  if (!skip(iso8601, at, '-')) throw bad;
  const int month = readDigits(iso8601, at, 2);
  if (!skip(iso8601, at, '-')) throw bad;
  const int day = readDigits(iso8601, at, 2);
  if (!skip(iso8601, at, 'T')) throw bad;
  const int hour = readDigits(iso8601, at, 2);
  if (!skip(iso8601, at, ':')) throw bad;
  const int minute = readDigits(iso8601, at, 2);
  double second = 0.0;
  if (skip(iso8601, at, ':')) {
    second = readDigits(iso8601, at, 2);
    if (second >= 0.0 && skip(iso8601, at, '.')) {
      double place = 0.1;
      const std::size_t begin = at;
      for (; at < iso8601.size() && iso8601[at] >= '0' && iso8601[at] <= '9'; ++at, place *= 0.1)
        second += place * (iso8601[at] - '0');
      if (at == begin) throw bad;
    }
  }
  const std::optional<int> zone = readZone(iso8601, at);
  if (year < 1900 || year > 2100 || month < 1 || day < 1 || hour < 0 || hour > 23 || minute < 0 ||
      minute > 59 || second < 0.0 || second >= 60.0 || !zone)
    throw bad;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) throw bad;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * (minute - *zone) + second;
}

std::string formatTime(double unix_seconds) {
  const double minutes = std::round(unix_seconds / 60.0);
  const double days = std::floor(minutes / 1440.0);
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::days(static_cast<int>(days)))};
  const int minute = static_cast<int>(minutes - 1440.0 * days);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     minute / 60, minute % 60);
}

glm::vec3 SunPosition::direction() const {
  return glm::vec3(glm::dvec3(cosDeg(elevation_deg) * sinDeg(azimuth_deg), sinDeg(elevation_deg),
                              cosDeg(elevation_deg) * cosDeg(azimuth_deg)));
}

SunPosition sunPosition(double unix_seconds, const Place& place) {
  checkPlace(place);
  const double days = daysSince2000(unix_seconds);
  const Equatorial sun = apparentSun(days);
  const double hour = hourAngle(days, sun, place.longitude_deg);
  const double latitude = place.latitude_deg;
  const double south = cosDeg(hour) * cosDeg(sun.declination) * sinDeg(latitude) -
                       sinDeg(sun.declination) * cosDeg(latitude);
  const double west = sinDeg(hour) * cosDeg(sun.declination);
  const double up = sinDeg(latitude) * sinDeg(sun.declination) +
                    cosDeg(latitude) * cosDeg(sun.declination) * cosDeg(hour);
  SunPosition position;
  position.azimuth_deg = glm::degrees(std::atan2(-west, south));
  position.geometric_deg = glm::degrees(std::asin(std::clamp(up, -1.0, 1.0)));
  position.elevation_deg = position.geometric_deg + refraction(position.geometric_deg);
  return position;
}

SunDay sunDay(double unix_seconds, const Place& place) {
  checkPlace(place);
  // The time at which the hour angle is that of `wanted(declination)`, from a first guess.
  const auto solve = [&](double time, const auto& wanted) {
    for (int step = 0; step < 6; ++step) {
      const double days = daysSince2000(time);
      const Equatorial sun = apparentSun(days);
      time -= halfTurn(hourAngle(days, sun, place.longitude_deg) - wanted(sun.declination)) *
              (86400.0 / 360.0);
    }
    return time;
  };
  // Cosine of the hour angle at the horizon: beyond 1 the sun stays on one side of it.
  const auto horizon = [&](double declination) {
    return (sinDeg(kSunriseDeg) - sinDeg(place.latitude_deg) * sinDeg(declination)) /
           std::max(cosDeg(place.latitude_deg) * cosDeg(declination), 1e-9);
  };
  const auto halfDay = [&](double declination) {
    return glm::degrees(std::acos(std::clamp(horizon(declination), -1.0, 1.0)));
  };
  SunDay day;
  day.noon = solve(unix_seconds, [](double) { return 0.0; });
  if (std::abs(horizon(apparentSun(daysSince2000(day.noon)).declination)) >= 1.0) return day;
  day.rise = solve(day.noon - 21600.0, [&](double d) { return -halfDay(d); });
  day.set = solve(day.noon + 21600.0, [&](double d) { return halfDay(d); });
  return day;
}

void checkSunIsUp(double unix_seconds, const Place& place) {
  if (sunPosition(unix_seconds, place).geometric_deg >= kSunriseDeg) return;
  const SunDay day = sunDay(unix_seconds, place);
  throw Error("sun", fmt::format("the sun is below the horizon at {}", formatTime(unix_seconds)),
              day.rise ? fmt::format("it rises at {} and sets at {}", formatTime(*day.rise),
                                     formatTime(*day.set))
                       : "it does not rise there that day; take another date");
}

}  // namespace verdure
