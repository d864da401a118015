// The options that say how a scene is lit and exposed.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "app/commands.h"
#include "verdure/error.h"
#include "verdure/sun_position.h"

namespace verdure::app {
namespace {

constexpr float kDegree = static_cast<float>(M_PI / 180.0);
constexpr float kLowestSun_deg = -12.0f;  // the end of nautical twilight
constexpr int kLastCloudyType = 6;        // CIE skies up to it hide the sun

glm::vec3 sunDirection(const DaylightOptions& options) {
  if (!options.date.empty() || !options.place.empty()) {
    if (options.date.empty() || options.place.empty())
      throw Error(options.date.empty() ? "--place" : "--date",
                  "the sun's position needs a date and a place",
                  "write --date 2026-06-21T12:30+02:00 --place 52.5,13.4");
    if (!options.sun.empty())
      throw Error("--sun", "the date and the place say where the sun is", "leave one of them out");
    const std::vector<float> degrees = parseNumbers("--place", options.place, 2);
    const Place place{double{degrees[0]}, double{degrees[1]}};
    const double time = parseTime(options.date);
    checkSunIsUp(time, place);
    return sunPosition(time, place).direction();
  }
  const std::vector<float> sun =
      parseNumbers("--sun", options.sun.empty() ? "85,42" : options.sun, 2);
  if (sun[1] > 90.0f || sun[1] < -90.0f)
    throw Error("--sun", fmt::format("the elevation {:g} is no angle above a horizon", sun[1]),
                "write AZIMUTH,ELEVATION in degrees");
  if (sun[1] < kLowestSun_deg)
    throw Error(
        "--sun",
        fmt::format("at an elevation of {:g} degrees it is night, and all is black", sun[1]),
        fmt::format("choose {:g} or more", kLowestSun_deg));
  return directionOf(sun[0] * kDegree, sun[1] * kDegree);
}

int cieType(const std::string& sky) {
  int type = 0;
  const char *begin = sky.data() + 4, *const end = sky.data() + sky.size();
  const auto [last, problem] = std::from_chars(begin, end, type);
  if (problem != std::errc() || last != end || type < 1 || type > 15)
    throw Error("--sky", fmt::format("'{}' is no CIE standard sky", sky),
                "write cie:1 (overcast) to cie:15 (clear and turbid)");
  return type;
}

}  // namespace

Daylight parseDaylight(const DaylightOptions& options) {
  const glm::vec3 to_sun = sunDirection(options);
  Daylight daylight = preethamDaylight(static_cast<float>(options.turbidity), to_sun);
  if (options.sky == "preetham") return daylight;
  if (options.sky.rfind("cie:", 0) == 0) {
    const int type = cieType(options.sky);
    daylight.sky = cieSky(type, to_sun);
    if (type <= kLastCloudyType) daylight.sun.luminance = glm::vec3(0.0f);
    return daylight;
  }
  const std::filesystem::path extension = std::filesystem::path(options.sky).extension();
  if (extension != ".exr" && extension != ".hdr" && extension != ".pic")
    throw Error("--sky", fmt::format("'{}' is unknown", options.sky),
                "use preetham, cie:1 to cie:15, or a panorama: .exr or .hdr");
  daylight.sky = imageSky(readHdrImage(options.sky));
  // The panorama shows its own sun; another is added only where one was asked for.
  if (options.sun.empty() && options.date.empty()) daylight.sun.luminance = glm::vec3(0.0f);
  return daylight;
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
  if (options.white != "auto")
    exposure.white = positive("--white", double{parseNumbers("--white", options.white, 1)[0]});
  return exposure;
}

float parseBloom(const ExposureOptions& options) {
  if (!(options.bloom >= 0.0 && options.bloom <= 1.0))
    throw Error("--bloom", fmt::format("{:g} is out of range", options.bloom), "choose 0 to 1");
  return static_cast<float>(options.bloom);
}

}  // namespace verdure::app
