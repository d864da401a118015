// The options that say how a scene is lit and exposed.
#include <fmt/format.h>

#include <cmath>

#include "app/commands.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

constexpr float kDegree = static_cast<float>(M_PI / 180.0);
constexpr float kLowestSun_deg = -12.0f;  // the end of nautical twilight

}  // namespace

Daylight parseDaylight(const DaylightOptions& options) {
  const std::vector<float> sun = parseNumbers("--sun", options.sun, 2);
  if (sun[1] > 90.0f || sun[1] < -90.0f)
    throw Error("--sun", fmt::format("the elevation {:g} is no angle above a horizon", sun[1]),
                "write AZIMUTH,ELEVATION in degrees");
  if (sun[1] < kLowestSun_deg)
    throw Error(
        "--sun",
        fmt::format("at an elevation of {:g} degrees it is night, and all is black", sun[1]),
        fmt::format("choose {:g} or more", kLowestSun_deg));
  if (options.sky != "preetham")
    throw Error("--sky", fmt::format("'{}' is unknown", options.sky), "use preetham");
  return preethamDaylight(static_cast<float>(options.turbidity),
                          directionOf(sun[0] * kDegree, sun[1] * kDegree));
}

Exposure parseExposure(const ExposureOptions& options) {
  Exposure exposure;
  if (options.exposure != "auto") {
    exposure.ev = parseNumbers("--exposure", options.exposure, 1)[0];
    if (std::abs(*exposure.ev) > 40.0f)
      throw Error("--exposure", fmt::format("{:g} is out of range", *exposure.ev),
                  "write auto or an exposure value: 15 in full sun, 12 under clouds, 5 at dusk");
  }
  const auto positive = [](const char* option, double value) {
    if (!(value > 0.0 && value < 1e6))
      throw Error(option, fmt::format("{:g} is out of range", value), "choose a number above 0");
    return static_cast<float>(value);
  };
  exposure.key = positive("--key", options.key);
  exposure.white = positive("--white", options.white);
  return exposure;
}

float parseBloom(const ExposureOptions& options) {
  if (!(options.bloom >= 0.0 && options.bloom <= 1.0))
    throw Error("--bloom", fmt::format("{:g} is out of range", options.bloom), "choose 0 to 1");
  return static_cast<float>(options.bloom);
}

}  // namespace verdure::app
