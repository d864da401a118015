// sky: what a sky is, as numbers, pictures, harmonics and code.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/sky_pictures.h"
#include "base/files.h"
#include "verdure/error.h"
#include "verdure/sky_fit.h"
#include "verdure/sun_position.h"

namespace verdure::app {
namespace {

using Json = nlohmann::ordered_json;

struct SunPlace {
  float azimuth_deg = 0.0f, elevation_deg = 45.0f;
  glm::vec3 direction() const {
    const float a = glm::radians(azimuth_deg), e = glm::radians(elevation_deg);
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
  }
};

SunPlace placeSun(const SkyCommand& command) {
  if (!command.sun.empty() && !(command.date.empty() && command.place.empty()))
    throw Error("--sun", "stands beside --date", "give the sun, or a date and a place");
  if (command.date.empty() != command.place.empty())
    throw Error(command.date.empty() ? "--place" : "--date", "stands alone",
                "give --date and --place together");
  if (!command.date.empty()) {
    const double time = parseTime(command.date);
    const std::vector<float> n = parseNumbers("--place", command.place, 2);
    const Place place{double{n[0]}, double{n[1]}};
    checkSunIsUp(time, place);
    const SunPosition sun = sunPosition(time, place);
    return {static_cast<float>(sun.azimuth_deg), static_cast<float>(sun.elevation_deg)};
  }
  if (command.sun.empty()) return {};
  const std::vector<float> n = parseNumbers("--sun", command.sun, 2);
  if (n[1] < 0.0f)
    throw Error("--sun", fmt::format("at {:g} degrees the sun is below the horizon", n[1]),
                "give an elevation in [0, 90]");
  if (n[1] > 90.0f)
    throw Error("--sun", fmt::format("{:g} degrees is above the zenith", n[1]),
                "give an elevation in [0, 90]");
  return {n[0], n[1]};
}

/// The sky and, where the model has one, its sun.
Daylight makeDaylight(const SkyCommand& command, const glm::vec3& to_sun) {
  if (command.model == "preetham") return preethamDaylight(command.turbidity, to_sun);
  Daylight light;
  light.sun.direction = to_sun;
  if (command.model.starts_with("cie:")) {
    int type = 0;
    const char* end = command.model.data() + command.model.size();
    const auto [next, problem] = std::from_chars(command.model.data() + 4, end, type);
    if (problem != std::errc() || next != end)
      throw Error("--model", "'" + command.model + "' names no CIE sky", "write cie:1 to cie:15");
    light.sky = cieSky(type, to_sun, command.illuminance);
    return light;
  }
  if (!command.model.ends_with(".hdr") && !command.model.ends_with(".exr"))
    throw Error("--model", "'" + command.model + "' is no model",
                "use preetham, cie:1 to cie:15, or a panorama (.hdr or .exr)");
  HdrImage image = readHdrImage(command.model);
  try {
    light.sky = imageSky(std::move(image), glm::radians(command.turn_deg), command.scale);
  } catch (const Error& e) {
    throw Error(command.model, e.what());
  }
  return light;
}

Json jsonOfColor(const glm::vec3& c) {
  return {c.r, c.g, c.b};
}

float photometric(const glm::vec3& c) {
  return glm::dot(c, {0.2126f, 0.7152f, 0.0722f});
}

}  // namespace

void runSky(const SkyCommand& command) {
  if (command.bands < 1 || command.bands > kMaxBands)
    throw Error("--bands", fmt::format("{} is outside of [1, {}]", command.bands, kMaxBands),
                "the paper uses 4 to 7");
  if (command.dome != "fisheye" && command.dome != "panorama")
    throw Error("--dome", "'" + command.dome + "' is none", "use fisheye or panorama");
  if (command.size < 16 || command.size > 8192)
    throw Error("--size", fmt::format("{} is outside of [16, 8192]", command.size), "512 is usual");
  if (!command.image.empty()) checkOutput(command.image, {".png", ".exr"});
  if (!command.emit_header.empty()) checkOutput(command.emit_header, {".h"});
  const bool fits = !command.emit_header.empty() || !command.report.empty();
  if (fits && command.model != "preetham")
    throw Error("--model", "only preetham is fitted", "leave --emit-header and --report out");
  const SunPlace place = placeSun(command);
  const glm::vec3 to_sun = place.direction();
  const Daylight light = makeDaylight(command, to_sun);
  Harmonics harmonics = projectSky(*light.sky, command.bands);
  if (command.filter) harmonics = withoutRinging(harmonics);
  const glm::vec3 zenith = light.sky->luminance({0, 1, 0});
  const glm::vec3 level = levelIlluminance(projectSky(*light.sky, 2));
  const glm::vec3 facing = light.sun.illuminance();

  if (!command.image.empty()) {
    const Light sky = [&](const glm::vec3& d) { return light.sky->luminance(d); };
    const HdrImage image = command.dome == "fisheye" ? drawFisheye(sky, command.size)
                                                     : drawPanorama(sky, command.size);
    if (command.image.ends_with(".exr"))
      writeExr(image, command.image);
    else
      writePng(toneMapped(image, meanLuminance(image)), command.image);
  }
  if (!command.emit_header.empty()) {
    SkyFitOptions options;
    options.bands = command.bands;
    writeFile(command.emit_header, skyFitHeader(SkyFit(preethamModel(), options)));
  }
  if (!command.report.empty())
    writeSkyReport({command.report, command.bands, to_sun, command.turbidity});

  if (!command.json) {
    fmt::print("sun: azimuth {:.2f}, elevation {:.2f} degrees; {:.2f} klx facing it\n",
               place.azimuth_deg, place.elevation_deg, photometric(facing));
    fmt::print("sky: zenith {:.3f} kcd/m2, {:.2f} klx on level ground\n", photometric(zenith),
               photometric(level));
    return;
  }
  Json weights = Json::array();
  for (int i = 0; i < harmonics.count(); ++i)
    weights.push_back(jsonOfColor(harmonics.weights[static_cast<std::size_t>(i)]));
  Json json = {{"model", command.model}};
  if (command.model == "preetham") json["turbidity"] = command.turbidity;
  json["sun"] = {{"azimuth_deg", place.azimuth_deg},
                 {"elevation_deg", place.elevation_deg},
                 {"direction", jsonOfColor(to_sun)},
                 {"luminance_kcd_m2", jsonOfColor(light.sun.luminance)},
                 {"facing_illuminance_klx", photometric(facing)}};
  json["sky"] = {{"zenith_luminance_kcd_m2", jsonOfColor(zenith)},
                 {"level_illuminance_klx", photometric(level)}};
  json["bands"] = command.bands;
  json["filtered"] = command.filter;
  json["harmonics"] = weights;
  fmt::print("{}\n", json.dump(2));
}

}  // namespace verdure::app
