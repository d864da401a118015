#include "app/option_groups.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/parse.h"
#include "app/style_names.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

CameraSettings parseCamera(const std::string& text, double fov_deg) {
  CameraSettings camera;
  camera.fov_deg = fov_deg;
  if (text == "auto") return camera;
  const std::vector<float> n = parseNumbers("--camera", text, 0);
  if (n.size() == 2) {
    camera.from_deg = {n[0], n[1]};
  } else if (n.size() == 6) {
    camera.eye = {n[0], n[1], n[2]};
    camera.target = {n[3], n[4], n[5]};
  } else {
    throw Error("--camera", "needs 2 or 6 numbers", "AZIMUTH,ELEVATION or X,Y,Z,TX,TY,TZ");
  }
  return camera;
}

/// WxD metres.
glm::vec2 parseArea(const std::string& text) {
  std::string numbers = text;
  std::replace(numbers.begin(), numbers.end(), 'x', ',');
  const std::vector<float> size = parseNumbers("--terrain-size", numbers, 2);
  if (!(size[0] > 0.0f && size[1] > 0.0f))
    throw Error("--terrain-size", fmt::format("'{}' has no area", text), "write 200x200, metres");
  return {size[0], size[1]};
}

ShadowSource parseShadows(const std::string& name) {
  if (name == "map") return ShadowSource::kShadowMap;
  if (name == "paper") return ShadowSource::kDepthPaper;
  if (name == "layers") return ShadowSource::kDepthLayers;
  if (name == "ordered") return ShadowSource::kDepthOrdered;
  throw Error("--shadows", fmt::format("'{}' is unknown", name),
              "use map, paper, layers or ordered");
}

/// Names between commas; LookSettings knows which there are.
std::vector<std::string> parseTerms(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

}  // namespace

void addLoadOptions(CLI::App& command, LoadOptions& load) {
  command
      .add_option("--foliage", load.foliage,
                  "Material, mesh or node that is foliage (name, * matches anything; repeatable)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      .add_option("--wood", load.wood, "Material, mesh or node that is not foliage (repeatable)")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

void addBakeOptions(CLI::App& command, BakeParameters& bake, const char* group) {
  DensityOptions& o = bake.options;
  command
      .add_option("--field", bake.field,
                  "optical-depth, or metaball (Luft et al. 2007; any of its parameters means it)")
      ->group(group);
  command.add_option("--rho", o.rho, "Radius of influence of a leaf, m (default: from the crown)")
      ->group(group);
  command
      .add_option("--tau", o.tau,
                  "Threshold of the surface, in kernel sums (default: from the crown)")
      ->group(group);
  command.add_option("--fraction", o.fraction, "Share of the leaves that is used, (0, 1]")
      ->group(group)
      ->capture_default_str();
  command.add_option("--norm", bake.norm, "Norm of distances: 1, 2, inf, or any p >= 1")
      ->group(group)
      ->capture_default_str();
  command.add_option("--grid", o.grid, "Cells of the surface's grid along the longest side")
      ->group(group)
      ->capture_default_str();
  command
      .add_option("--d-min", o.d_min,
                  "Field value from which a vertex is darkest (default: from the crown)")
      ->group(group);
  command.add_option("--k-min", o.k_min, "Least ambient coefficient, [0, 1]")
      ->group(group)
      ->capture_default_str();
  command
      .add_option("--exponent", o.exponent,
                  "How fast it darkens inwards: below 1 slowly, above 1 rapidly")
      ->group(group)
      ->capture_default_str();
  command
      .add_option(
          "--normals", bake.normals,
          "Leaf normals: optical-depth; metaball: surface-point, surface-vertex, ellipsoid; "
          "keep; in bake bent (default: the field's first)")
      ->group(group);
  command.add_option("--blend", o.blend, "0 = the leaf's normals, 1 = the crown's")
      ->group(group)
      ->capture_default_str();
  command.add_option("--seed", o.seed, "Seed of the random fraction")
      ->group(group)
      ->capture_default_str();
  command.add_option("--max-memory", bake.max_memory_mib, "Memory for the grid, MiB")
      ->group(group)
      ->capture_default_str();
}

void addSceneOptions(CLI::App& command, SceneCommand& scene) {
  SceneSettings& s = scene.scene;
  // Options are taken in this order, whatever theirs on the command line: a scene is read first,
  // and what else is given changes it.
  command.add_option_function<std::string>(
      "file",
      [&scene, &s](const std::string& file) {
        scene.input = file;
        if (isSceneFile(file))
          s = readScene(file);
        else
          s.plants = {PlantSettings{.name = {}, .file = file, .grow = {}, .load = {}, .bake = {}}};
      },
      "Plant: .glb .gltf .obj .fbx .dae .ply; or a scene: .json");
  addLoadOptions(command, scene.load);
  command
      .add_option_function<std::string>(
          "--size",
          [&s](const std::string& size) { std::tie(s.width, s.height) = parseSize(size); },
          "WxH, pixels")
      ->default_str("960x720");
  command
      .add_option_function<std::string>(
          "--camera",
          [&s](const std::string& camera) { s.camera = parseCamera(camera, s.camera.fov_deg); },
          "auto; AZIMUTH,ELEVATION in degrees; or X,Y,Z,TARGETX,TARGETY,TARGETZ in m")
      ->default_str("auto");
  command.add_option("--fov", s.camera.fov_deg, "Vertical field of view, degrees")
      ->capture_default_str();
  command.add_flag_function(
      "--no-ground", [&s](std::int64_t) { s.ground.shown = false; }, "Leave the ground out");
}

void addGroundOptions(CLI::App& command, GroundSettings& ground) {
  constexpr const char* kGroup = "Ground";
  using Words = std::vector<std::string>;
  command
      .add_option_function<Words>(
          "--grass",
          [&ground](const Words& names) {
            ground.grass.clear();
            for (const std::string& name : names)
              ground.grass.push_back({.grass = name, .cover = {}});
          },
          "Species or folder of grass on the ground; repeat for more layers")
      ->group(kGroup)
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<float>>(
          "--grass-density",
          [&ground](const std::vector<float>& density) {
            for (std::size_t i = 0; i < ground.grass.size(); ++i)
              ground.grass[i].density = density[std::min(i, density.size() - 1)];
          },
          "Of each layer, by commas, 0 to 1")
      ->group(kGroup)
      ->delimiter(',');
  command
      .add_option_function<Words>(
          "--grass-cover",
          [&ground](const Words& covers) {
            if (covers.size() > ground.grass.size())
              throw Error("--grass-cover", "there are more maps than layers of grass",
                          "leave some out");
            for (std::size_t i = 0; i < covers.size(); ++i) ground.grass[i].cover = covers[i];
          },
          "Picture over the terrain's area, white where a layer grows; one a layer")
      ->group(kGroup)
      ->allow_extra_args(false);
  command.add_option("--grass-seed", ground.grass_seed, "Of species")
      ->group(kGroup)
      ->capture_default_str();
  command.add_option("--grass-slices", ground.grass_slices, "Most slices on a ray, 1 to 256")
      ->group(kGroup)
      ->capture_default_str();
  command
      .add_option("--terrain", ground.terrain,
                  "hills, or heights as a PNG of 8 or 16 bits (default: a plane)")
      ->group(kGroup);
  command
      .add_option_function<std::string>(
          "--terrain-size",
          [&ground](const std::string& size) { ground.terrain_size_m = parseArea(size); },
          "WxD along x and z, m")
      ->group(kGroup)
      ->default_str("200x200");
  command
      .add_option_function<std::string>(
          "--terrain-height",
          [&ground](const std::string& text) {
            const std::vector<float> range = parseNumbers("--terrain-height", text, 2);
            if (!(range[1] >= range[0]))
              throw Error("--terrain-height", fmt::format("{:g} is above {:g}", range[0], range[1]),
                          "write LOW,HIGH");
            ground.terrain_height_m = {range[0], range[1]};
          },
          "LOW,HIGH: of black and white, m")
      ->group(kGroup)
      ->default_str("0,12");
  command.add_option("--terrain-seed", ground.terrain_seed, "Of hills")
      ->group(kGroup)
      ->capture_default_str();
}

void addWindOptions(CLI::App& command, WindSettings& wind) {
  command.add_option("--wind", wind.speed,
                     "Mean speed of the wind, m/s, 0 to 60 (default: 5 at a time, else 0)");
  command.add_option("--wind-from", wind.from_deg, "Azimuth that it comes from, degrees")
      ->capture_default_str();
  command.add_option("--gusts", wind.gusts, "By which share the wind rises and falls, 0 to 1")
      ->capture_default_str();
  command.add_option("--time", wind.seconds, "Show the plant at this time, s");
}

void addDeviceOptions(CLI::App& command, DeviceOptions& device) {
  command.add_option("--device", device.device, "Part of the name of the Vulkan device to use");
  command.add_flag("--validation", device.validation, "Check the use of Vulkan (slow)");
}

void addDaylightOptions(CLI::App& command, DaylightSettings& daylight) {
  command
      .add_option("--sky", daylight.sky,
                  "preetham; cie:1 (overcast) to cie:15; or a panorama, .exr or .hdr in kcd/m^2")
      ->capture_default_str();
  // Each takes the place of what a scene file has of the other.
  const CLI::Option* const sun = command.add_option_function<std::string>(
      "--sun",
      [&daylight](const std::string& text) {
        const std::vector<float> degrees = parseNumbers("--sun", text, 2);
        daylight.sun_deg = {degrees[0], degrees[1]};
        daylight.date.clear();
        daylight.place.reset();
      },
      "AZIMUTH,ELEVATION, degrees (azimuth 0: +Z, 90: +X) (default: 85,42)");
  const auto without_sun = [&daylight, sun] {
    if (sun->count() == 0) daylight.sun_deg.reset();
  };
  command.add_option_function<std::string>(
      "--date",
      [&daylight, without_sun](const std::string& date) {
        daylight.date = date;
        without_sun();
      },
      "Time that says where the sun is: ISO 8601");
  command.add_option_function<std::string>(
      "--place",
      [&daylight, without_sun](const std::string& text) {
        const std::vector<float> degrees = parseNumbers("--place", text, 2);
        daylight.place = Place{double{degrees[0]}, double{degrees[1]}};
        without_sun();
      },
      "LATITUDE,LONGITUDE, degrees, with --date");
  command.add_option("--turbidity", daylight.turbidity, "Haze of the air: 2 clear to 10 thick")
      ->capture_default_str();
}

void addExposureOptions(CLI::App& command, ExposureSettings& exposure) {
  const auto add_automatic = [&command](const char* option, std::optional<float>& value,
                                        const char* help) {
    command
        .add_option_function<std::string>(
            option,
            [option, &value](const std::string& text) {
              value.reset();
              if (text != "auto") value = parseNumbers(option, text, 1)[0];
            },
            help)
        ->default_str("auto");
  };
  add_automatic("--exposure", exposure.ev,
                "auto, or an exposure value at ISO 100 (15 in full sun)");
  command.add_option("--key", exposure.key, "Brightness of the average, 0.09 dark to 0.36 light")
      ->capture_default_str();
  add_automatic("--white", exposure.white,
                "auto, or the luminance of pure white in averages times the key");
}

void addLookOptions(CLI::App& command, LookSettings& look) {
  command
      .add_option("--light", look.light,
                  "best, standard, expressive, transfer, depth-maps or habel")
      ->capture_default_str();
  command.add_option_function<std::string>(
      "--terms", [&look](const std::string& text) { look.terms = parseTerms(text); },
      "Only these terms: ambient,diffuse,specular,shadow,textures,transmission,"
      "scattering,gloss");
  command.add_option_function<std::string>(
      "--shadows", [&look](const std::string& name) { look.shadows = parseShadows(name); },
      "Instead of the light's own: map, or depth maps of leaves: paper, layers or "
      "ordered");
  command.add_option("--bands", look.sky_bands, "Bands of harmonics of the sky's light, 2 to 7")
      ->capture_default_str();
  command
      .add_option("--visibility-exponent", look.visibility_exponent,
                  "Of leaf visibility: above 1 leaves darken rapidly inwards, below slowly")
      ->capture_default_str();
  command.add_option_function<std::string>(
      "--background",
      [&look](const std::string& text) {
        const std::vector<float> rgb = parseNumbers("--background", text, 3);
        look.background = {rgb[0], rgb[1], rgb[2]};
      },
      "R,G,B in [0, 1] instead of the sky");
  command.add_option("--shadow-map", look.shadow_map, "Side of the shadow map, pixels")
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--cascades",
          [&look](const std::string& text) {
            const bool is_count = text.size() == 1 && text[0] >= '1' && text[0] <= '4';
            if (text != "auto" && !is_count)
              throw Error("--cascades", fmt::format("'{}' is out of range", text),
                          "choose auto or 1 to 4");
            look.cascades = is_count ? text[0] - '0' : 0;
          },
          "Shadow maps, finer near the eye: auto or 1 to 4")
      ->default_str("auto");
  command
      .add_option_function<std::string>(
          "--style", [&look](const std::string& name) { look.style = parseStyle(name); },
          "photo, edges, toon, watercolour or normals")
      ->default_str("photo");
  command
      .add_option_function<std::string>(
          "--style-normals",
          [&look](const std::string& name) { look.style_normals = parseStyleNormals(name); },
          "What drawn styles take: raw, realigned or scaled (by the ambient coefficient)")
      ->default_str("scaled");
}

}  // namespace verdure::app
