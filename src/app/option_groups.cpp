#include "app/option_groups.h"

#include <CLI/CLI.hpp>

namespace verdure::app {

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

CLI::Option* addSceneOptions(CLI::App& command, SceneOptions& scene) {
  CLI::Option* const file =
      command.add_option("file", scene.input, "Plant: .glb .gltf .obj .fbx .dae .ply");
  addLoadOptions(command, scene.load);
  command.add_option("--size", scene.size, "WxH, pixels")->capture_default_str();
  command
      .add_option("--camera", scene.camera,
                  "auto; AZIMUTH,ELEVATION in degrees; or X,Y,Z,TARGETX,TARGETY,TARGETZ in m")
      ->capture_default_str();
  command.add_option("--fov", scene.fov_deg, "Vertical field of view, degrees")
      ->capture_default_str();
  command.add_flag("--no-ground", scene.no_ground, "Leave the ground out");
  return file;
}

void addGroundOptions(CLI::App& command, GroundOptions& ground) {
  constexpr const char* kGroup = "Ground";
  command
      .add_option("--grass", ground.grass,
                  "Species or folder of grass on the ground; repeat for more layers")
      ->group(kGroup)
      ->allow_extra_args(false);
  command.add_option("--grass-density", ground.density, "Of each layer, by commas, 0 to 1")
      ->group(kGroup)
      ->delimiter(',');
  command
      .add_option("--grass-cover", ground.cover,
                  "Picture over the terrain's area, white where a layer grows; one a layer")
      ->group(kGroup)
      ->allow_extra_args(false);
  command.add_option("--grass-seed", ground.grass_seed, "Of species")
      ->group(kGroup)
      ->capture_default_str();
  command.add_option("--grass-slices", ground.slices, "Most slices on a ray, 1 to 256")
      ->group(kGroup)
      ->capture_default_str();
  command
      .add_option("--terrain", ground.terrain,
                  "hills, or heights as a PNG of 8 or 16 bits (default: a plane)")
      ->group(kGroup);
  command.add_option("--terrain-size", ground.terrain_size, "WxD along x and z, m")
      ->group(kGroup)
      ->capture_default_str();
  command.add_option("--terrain-height", ground.terrain_height, "LOW,HIGH: of black and white, m")
      ->group(kGroup)
      ->capture_default_str();
  command.add_option("--terrain-seed", ground.terrain_seed, "Of hills")
      ->group(kGroup)
      ->capture_default_str();
}

void addWindOptions(CLI::App& command, WindOptions& wind) {
  command.add_option("--wind", wind.speed,
                     "Mean speed of the wind, m/s, 0 to 60 (default: 5 at a time, else 0)");
  command.add_option("--wind-from", wind.from_deg, "Azimuth that it comes from, degrees")
      ->capture_default_str();
  command.add_option("--gusts", wind.gusts, "By which share the wind rises and falls, 0 to 1")
      ->capture_default_str();
  command.add_option("--time", wind.time, "Show the plant at this time, s");
}

void addDeviceOptions(CLI::App& command, DeviceOptions& device) {
  command.add_option("--device", device.device, "Part of the name of the Vulkan device to use");
  command.add_flag("--validation", device.validation, "Check the use of Vulkan (slow)");
}

void addDaylightOptions(CLI::App& command, DaylightOptions& daylight) {
  command
      .add_option("--sky", daylight.sky,
                  "preetham; cie:1 (overcast) to cie:15; or a panorama, .exr or .hdr in kcd/m^2")
      ->capture_default_str();
  command.add_option("--sun", daylight.sun,
                     "AZIMUTH,ELEVATION, degrees (azimuth 0: +Z, 90: +X) (default: 85,42)");
  command.add_option("--date", daylight.date, "Time that says where the sun is: ISO 8601");
  command.add_option("--place", daylight.place, "LATITUDE,LONGITUDE, degrees, with --date");
  command.add_option("--turbidity", daylight.turbidity, "Haze of the air: 2 clear to 10 thick")
      ->capture_default_str();
}

void addExposureOptions(CLI::App& command, ExposureOptions& exposure) {
  command
      .add_option("--exposure", exposure.exposure,
                  "auto, or an exposure value at ISO 100 (15 in full sun)")
      ->capture_default_str();
  command.add_option("--key", exposure.key, "Brightness of the average, 0.09 dark to 0.36 light")
      ->capture_default_str();
  command
      .add_option("--white", exposure.white,
                  "auto, or the luminance of pure white in averages times the key")
      ->capture_default_str();
}

}  // namespace verdure::app
