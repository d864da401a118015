// From settings to what the renderer takes.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "app/scene_settings.h"
#include "verdure/error.h"
#include "verdure/sun_position.h"

namespace verdure::app {
namespace {

constexpr float kLowestSun_deg = -12.0f;  // the end of nautical twilight
constexpr glm::vec2 kUsualSun_deg{85.0f, 42.0f};
constexpr int kLastCloudyType = 6;  // CIE skies up to it hide the sun

glm::vec3 sunDirection(const DaylightSettings& options) {
  if (!options.date.empty() || options.place) {
    if (options.date.empty() || !options.place)
      throw Error(options.date.empty() ? "--place" : "--date",
                  "the sun's position needs a date and a place",
                  "write --date 2026-06-21T12:30+02:00 --place 52.5,13.4");
    if (options.sun_deg)
      throw Error("--sun", "the date and the place say where the sun is", "leave one of them out");
    const double time = parseTime(options.date);
    checkSunIsUp(time, *options.place);
    return sunPosition(time, *options.place).direction();
  }
  const glm::vec2 sun = options.sun_deg.value_or(kUsualSun_deg);
  if (!(sun[1] <= 90.0f && sun[1] >= -90.0f))
    throw Error("--sun", fmt::format("the elevation {:g} is no angle above a horizon", sun[1]),
                "write AZIMUTH,ELEVATION in degrees");
  if (sun[1] < kLowestSun_deg)
    throw Error(
        "--sun",
        fmt::format("at an elevation of {:g} degrees it is night, and all is black", sun[1]),
        fmt::format("choose {:g} or more", kLowestSun_deg));
  return directionOf(glm::radians(sun[0]), glm::radians(sun[1]));
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

void checkFieldOfView(const CameraSettings& camera) {
  if (!(camera.fov_deg > 0.0 && camera.fov_deg < 170.0))
    throw Error("--fov", "must lie between 0 and 170 degrees", "34 is usual");
}

bool* termOf(Terms& terms, const std::string& name) {
  return name == "ambient"        ? &terms.ambient
         : name == "diffuse"      ? &terms.diffuse
         : name == "specular"     ? &terms.specular
         : name == "shadow"       ? &terms.shadow
         : name == "textures"     ? &terms.textures
         : name == "transmission" ? &terms.transmission
         : name == "scattering"   ? &terms.scattering
         : name == "gloss"        ? &terms.gloss
                                  : nullptr;
}

}  // namespace

Terms termsOf(const LookSettings& look) {
  Terms terms = presetTerms(look.light);
  if (look.shadows) terms.shadow_source = *look.shadows;
  if (!look.terms) return terms;
  terms.ambient = terms.diffuse = terms.specular = terms.shadow = terms.textures =
      terms.transmission = terms.scattering = terms.gloss = false;
  for (const std::string& name : *look.terms) {
    bool* const term = termOf(terms, name);
    if (term == nullptr)
      throw Error("--terms", fmt::format("'{}' is unknown", name),
                  "use ambient, diffuse, specular, shadow, textures, transmission, scattering, "
                  "gloss");
    *term = true;
  }
  return terms;
}

Daylight daylightOf(const DaylightSettings& options) {
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
  if (!options.sun_deg && options.date.empty()) daylight.sun.luminance = glm::vec3(0.0f);
  return daylight;
}

Exposure exposureOf(const ExposureSettings& options) {
  Exposure exposure;
  exposure.ev = options.ev;
  if (exposure.ev && !(std::abs(*exposure.ev) <= 40.0f))
    throw Error("--exposure", fmt::format("{:g} is out of range", *exposure.ev),
                "write auto or an exposure value: 15 in full sun, 12 under clouds, 5 at dusk");
  const auto positive = [](const char* option, double value) {
    if (!(value > 0.0 && value < 1e6))
      throw Error(option, fmt::format("{:g} is out of range", value), "choose a number above 0");
    return static_cast<float>(value);
  };
  exposure.key = positive("--key", options.key);
  if (options.white) exposure.white = positive("--white", double{*options.white});
  return exposure;
}

Wind windOf(const WindSettings& options, bool film) {
  Wind wind;
  wind.speed = options.speed.value_or(film || options.seconds ? 5.0f : 0.0f);
  if (!(wind.speed >= 0.0f && wind.speed <= 60.0f))
    throw Error("--wind", fmt::format("{:g} m/s is out of range", wind.speed), "choose 0 to 60");
  if (!std::isfinite(options.from_deg))
    throw Error("--wind-from", "must be a finite number", "0 is from +Z, 90 from +X");
  wind.from = glm::radians(options.from_deg);
  if (!(options.gusts >= 0.0f && options.gusts <= 1.0f))
    throw Error("--gusts", fmt::format("{:g} is out of range", options.gusts), "choose 0 to 1");
  wind.gusts = options.gusts;
  if (options.seconds && !std::isfinite(*options.seconds))
    throw Error("--time", "must be a finite number", "write seconds, like 2.5");
  return wind;
}

View viewOf(const SceneSettings& settings, bool film) {
  View view;
  view.width = settings.width;
  view.height = settings.height;
  const LookSettings& look = settings.look;
  view.terms = termsOf(look);
  view.daylight = daylightOf(settings.daylight);
  view.exposure = exposureOf(settings.exposure);
  const double bloom = settings.exposure.bloom;
  if (!(bloom >= 0.0 && bloom <= 1.0))
    throw Error("--bloom", fmt::format("{:g} is out of range", bloom), "choose 0 to 1");
  view.bloom = static_cast<float>(bloom);
  if (look.sky_bands < 2 || look.sky_bands > 7)
    throw Error("--bands", fmt::format("{} is out of range", look.sky_bands), "choose 2 to 7");
  view.sky_bands = look.sky_bands;
  if (!(look.visibility_exponent > 0.0f) || !std::isfinite(look.visibility_exponent))
    throw Error("--visibility-exponent", "must be a number above 0", "1 is usual");
  view.visibility_exponent = look.visibility_exponent;
  checkFieldOfView(settings.camera);
  if (look.background)
    for (int c = 0; c < 3; ++c)
      if (!((*look.background)[c] >= 0.0f && (*look.background)[c] <= 1.0f))
        throw Error("--background", fmt::format("{:g} is out of range", (*look.background)[c]),
                    "write R,G,B in [0, 1]");
  view.background = look.background;
  if (look.shadow_map < 16)
    throw Error("--shadow-map", "must be at least 16 pixels", "2048 is usual");
  view.shadow_map_size = look.shadow_map;
  view.shadow_cascades = look.cascades;
  view.style = look.style;
  view.style_normals = look.style_normals;
  view.wind = windOf(settings.wind, film);
  view.seconds = settings.wind.seconds.value_or(0.0);
  return view;
}

Camera cameraOf(const SceneSettings& settings, const Scene& scene) {
  const CameraSettings& camera = settings.camera;
  checkFieldOfView(camera);
  const float fov = glm::radians(static_cast<float>(camera.fov_deg));
  if (camera.eye) return {*camera.eye, camera.target, fov};
  return automaticCamera(scene, glm::radians(camera.from_deg[0]), glm::radians(camera.from_deg[1]),
                         static_cast<float>(settings.width) / static_cast<float>(settings.height),
                         fov);
}

}  // namespace verdure::app
