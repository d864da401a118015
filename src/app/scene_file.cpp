// Scene files: docs/scene.md. One list of fields (fieldsOf) is read and written.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/scene_archive.h"
#include "app/scene_settings.h"
#include "base/files.h"
#include "verdure/error.h"
#include "verdure/grass.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-6;  // the least of what must be above 0
constexpr double kFar_m = 1e7;

template <class Archive>
void fieldsOf(Archive& a, GrowOptions& grow) {
  a.text("species", grow.species);
  a.number("seed", grow.seed, 0, kAny);
  a.choice("leaves", grow.leaf_form, {"mesh", "card"});
  a.assignments("set", grow.set);
  a.number("texture_size", grow.texture_size, 32, 8192);
  a.number("leaf_age", grow.leaf_age, 0, 1);
  if constexpr (Archive::kReads) {
    const auto& species = speciesList();
    if (std::none_of(species.begin(), species.end(),
                     [&](const SpeciesInfo& s) { return s.name == grow.species; }))
      a.refuse("species", fmt::format("names '{}', which is no species", grow.species),
               "see verdure grow --list");
  }
}

template <class Archive>
void fieldsOf(Archive& a, BakeParameters& bake) {
  a.text("field", bake.field);
  DensityOptions& o = bake.options;
  // These mean the metaball field: an optical-depth bake has none of them.
  const bool metaball =
      Archive::kReads || bake.fieldOr(BakeField::kOpticalDepth) == BakeField::kMetaball;
  if (metaball) {
    a.number("rho_m", o.rho, kTiny, kFar_m);
    a.number("tau", o.tau, 0, kAny);
    a.number("fraction", o.fraction, kTiny, 1);
    a.numberOrWord("norm", bake.norm, "inf");
    a.number("grid", o.grid, 2, 4096);
    a.number("d_min", o.d_min, kTiny, kAny);
    a.number("k_min", o.k_min, 0, 1);
    a.number("exponent", o.exponent, kTiny, kAny);
  }
  a.text("normals", bake.normals);
  a.number("blend", o.blend, 0, 1);
  a.number("seed", o.seed, 0, kAny);
  a.flag("fit", bake.fit);
  a.number("max_memory_mib", bake.max_memory_mib, kTiny, kAny);
  if constexpr (Archive::kReads) {
    for (const char* key :
         {"rho_m", "tau", "fraction", "norm", "grid", "d_min", "k_min", "exponent"})
      if (a.has(key)) bake.metaball_option = key;
    try {
      if (bake.fieldOr(BakeField::kOpticalDepth) == BakeField::kMetaball)
        bake.checked();
      else
        bake.checkedDepth();
    } catch (const Error& e) {
      a.refuse("", fmt::format("is no bake: {}", e.what()), "");
    }
  }
}

template <class Archive>
void fieldsOf(Archive& a, MotionSettings& motion) {
  a.number("flexibility", motion.flexibility, kTiny, 100.0);
  a.vector("level_flexibility", motion.level_flexibility, 0.0, 100.0);
  a.vector("damping_ratio", motion.damping_ratio, 0.02, 4.0);
  a.list("branches", motion.branches, [&](MotionSettings::BranchFlexibility& one) {
    a.number("branch", one.branch, 0.0, 1e9);
    a.number("flexibility", one.flexibility, 0.0, 100.0);
  });
}

template <class Archive>
void fieldsOf(Archive& a, PlantSettings& plant) {
  a.text("name", plant.name);
  if (Archive::kReads || !plant.file.empty()) {
    a.path("file", plant.file);
    a.texts("foliage", plant.load.foliage);
    a.texts("wood", plant.load.wood);
  }
  if (Archive::kReads ? a.has("grow") : plant.file.empty())
    a.object("grow", [&] { fieldsOf(a, plant.grow); });
  a.optionalObject("bake", plant.bake, [&](BakeParameters& bake) { fieldsOf(a, bake); });
  a.optionalObject("motion", plant.motion, [&](MotionSettings& motion) { fieldsOf(a, motion); });
  if constexpr (Archive::kReads) {
    if (plant.file.empty() && !a.has("grow"))
      a.refuse("", "has neither a file nor grow", "name a file, or the species that grows");
    if (!plant.file.empty() && a.has("grow"))
      a.refuse("grow", "stands beside a file", "leave one of them out");
    if (plant.name.empty())
      plant.name = plant.file.empty() ? plant.grow.species : fs::path(plant.file).stem().string();
  }
}

template <class Archive>
void fieldsOf(Archive& a, Placement& place) {
  a.plant("plant", place.plant);
  a.vector("position_m", place.position, -kFar_m, kFar_m);
  a.angle("turn_deg", place.angle);
  a.number("scale", place.scale, kTiny, 1e4);
  a.color("tint", place.tint);
  a.number("phase", place.phase, 0, kAny);
}

template <class Archive>
void fieldsOf(Archive& a, LayoutSettings& layout) {
  a.path("file", layout.file);
  a.plants("plants", layout.plants);
  a.choice("heights", layout.heights_of_file, {"ground", "file"});
  a.number("scale", layout.scale, kTiny, 1e4);
  if constexpr (Archive::kReads) {
    if (layout.file.empty()) a.refuse("", "has no file", "name a .glb or .gltf with instances");
    if (layout.plants.empty()) a.refuse("plants", "names no plant", "name those that stand there");
  }
}

template <class Archive>
void fieldsOf(Archive& a, ScatterSettings::Kind& kind) {
  a.plant("plant", kind.plant);
  a.number("share", kind.share, kTiny, 1e6);
  a.number("radius_m", kind.radius_m, 0, 1e4);
  a.vector("scale", kind.scale, kTiny, 1e4);
  if constexpr (Archive::kReads)
    if (kind.scale.y < kind.scale.x) a.refuse("scale", "falls", "write [LEAST, MOST]");
}

template <class Archive>
void fieldsOf(Archive& a, ScatterSettings& scatter) {
  a.list("plants", scatter.kinds, [&](ScatterSettings::Kind& kind) { fieldsOf(a, kind); });
  a.number("seed", scatter.seed, 0, kAny);
  a.vector("center_m", scatter.center_m, -kFar_m, kFar_m);
  a.vector("size_m", scatter.size_m, kTiny, kFar_m);
  a.number("per_ha", scatter.per_ha, 0, kAny);
  a.path("density_map", scatter.density_map);
  a.number("clear_m", scatter.clear_m, 0, kFar_m);
  a.number("most_slope_deg", scatter.most_slope_deg, 0, 90);
  a.vector("height_m", scatter.height, -kFar_m, kFar_m);
  a.number("hue_spread", scatter.hue_spread, 0, 1);
  a.number("brightness_spread", scatter.brightness_spread, 0, 1);
  if constexpr (Archive::kReads) {
    if (scatter.kinds.empty() || scatter.kinds.size() > 64)
      a.refuse("plants", fmt::format("has {} plants", scatter.kinds.size()), "name 1 to 64");
    const auto without =
        std::count_if(scatter.kinds.begin(), scatter.kinds.end(),
                      [](const ScatterSettings::Kind& kind) { return kind.radius_m == 0.0f; });
    if (without != 0 && without != std::ssize(scatter.kinds))
      a.refuse("plants", "has plants with a radius of 0 and others", "give all a radius, or none");
    if (without != 0 && !scatter.per_ha)
      a.refuse("", "has no per_ha: without a radius there is room for any number",
               "give per_ha, or the plants a radius_m");
    if (scatter.height && scatter.height->y < scatter.height->x)
      a.refuse("height_m", "falls", "write [LOWEST, HIGHEST]");
  }
}

template <class Archive>
void fieldsOf(Archive& a, GroundSettings& ground) {
  const auto is_grass = [](const std::string& text) {
    const auto& names = grassSpeciesNames();
    return std::find(names.begin(), names.end(), text) != names.end();
  };
  a.flag("shown", ground.shown);
  a.list("grass", ground.grass, [&](GrassLayerSettings& layer) {
    a.path("grass", layer.grass, is_grass);
    a.number("density", layer.density, 0, 1);
    a.path("cover", layer.cover);
    if constexpr (Archive::kReads)
      if (layer.grass.empty()) a.refuse("", "names no grass", "name a species or a folder");
  });
  a.number("grass_seed", ground.grass_seed, 0, kAny);
  a.number("grass_slices", ground.grass_slices, 1, 256);
  a.path("terrain", ground.terrain, [](const std::string& text) { return text == "hills"; });
  a.vector("terrain_size_m", ground.terrain_size_m, kTiny, kFar_m);
  a.vector("terrain_height_m", ground.terrain_height_m, -kFar_m, kFar_m);
  a.number("terrain_seed", ground.terrain_seed, 0, kAny);
  if constexpr (Archive::kReads)
    if (ground.terrain_height_m.y < ground.terrain_height_m.x)
      a.refuse("terrain_height_m", "falls", "write [LOWEST, HIGHEST]");
}

/// "preetham" or "cie:N"; all else is a panorama's path.
bool isSkyName(const std::string& sky) {
  return sky == "preetham" || sky.starts_with("cie:");
}

template <class Archive>
void fieldsOf(Archive& a, DaylightSettings& daylight) {
  a.path("sky", daylight.sky, isSkyName);
  a.vector("sun_deg", daylight.sun_deg, -kFar_m, kFar_m);
  a.text("date", daylight.date);
  std::optional<glm::dvec2> place;
  if (daylight.place) place = {daylight.place->latitude_deg, daylight.place->longitude_deg};
  a.vector("place_deg", place, -180, 180);
  a.number("turbidity", daylight.turbidity, 2, 10);
  if constexpr (Archive::kReads) {
    if (place) daylight.place = Place{place->x, place->y};
    if (daylight.place && std::abs(daylight.place->latitude_deg) > 90.0)
      a.refuse("place_deg", fmt::format("has the latitude {:g}", daylight.place->latitude_deg),
               "write [LATITUDE, LONGITUDE]");
    if (daylight.date.empty() == daylight.place.has_value())
      a.refuse(daylight.place ? "place_deg" : "date", "needs the other of date and place_deg",
               "write both, or sun_deg");
    if (daylight.place && daylight.sun_deg)
      a.refuse("sun_deg", "stands beside a date and a place", "leave one of them out");
    if (daylight.sun_deg && !(daylight.sun_deg->y >= -12.0f && daylight.sun_deg->y <= 90.0f))
      a.refuse("sun_deg", fmt::format("has the elevation {:g}", daylight.sun_deg->y),
               "write [AZIMUTH, ELEVATION], the second of them -12 to 90");
    if (daylight.sky.starts_with("cie:")) {
      const std::string number = daylight.sky.substr(4);
      bool good = false;
      for (int type = 1; type <= 15; ++type) good = good || number == std::to_string(type);
      if (!good) a.refuse("sky", fmt::format("is '{}'", daylight.sky), "write cie:1 to cie:15");
    } else if (daylight.sky != "preetham") {
      const fs::path extension = fs::path(daylight.sky).extension();
      if (extension != ".exr" && extension != ".hdr" && extension != ".pic")
        a.refuse("sky", "is no sky that is known",
                 "use preetham, cie:1 to cie:15, or a panorama: .exr or .hdr");
    }
    if (!daylight.date.empty()) {
      try {
        parseTime(daylight.date);
      } catch (const Error& e) {
        a.refuse("date", fmt::format("is no time: {}", e.what()), "");
      }
    }
  }
}

template <class Archive>
void fieldsOf(Archive& a, ExposureSettings& exposure) {
  a.number("ev", exposure.ev, -40, 40);
  a.number("key", exposure.key, kTiny, 1e6);
  a.number("white", exposure.white, kTiny, 1e6);
  a.number("bloom", exposure.bloom, 0, 1);
}

template <class Archive>
void fieldsOf(Archive& a, WindSettings& wind) {
  a.number("speed_m_s", wind.speed, 0, 60);
  a.number("from_deg", wind.from_deg, -kFar_m, kFar_m);
  a.number("gusts", wind.gusts, 0, 1);
  a.number("seconds", wind.seconds, -kAny, kAny);
}

template <class Archive>
void fieldsOf(Archive& a, CameraSettings& camera) {
  a.vector("eye_m", camera.eye, -kFar_m, kFar_m);
  a.vector("target_m", camera.target, -kFar_m, kFar_m);
  a.vector("from_deg", camera.from_deg, -kFar_m, kFar_m);
  a.number("fov_deg", camera.fov_deg, 0.01, 169.99);
  if constexpr (Archive::kReads)
    if (camera.eye && *camera.eye == camera.target)
      a.refuse("target_m", "is the eye's own place", "move one of them");
}

template <class Archive>
void fieldsOf(Archive& a, LookSettings& look) {
  a.text("light", look.light);
  a.texts("terms", look.terms);
  a.choice("shadows", look.shadows, {"map", "paper", "layers", "ordered"});
  a.number("sky_bands", look.sky_bands, 2, 7);
  a.number("visibility_exponent", look.visibility_exponent, kTiny, kAny);
  a.vector("background", look.background, 0, 1);
  a.number("shadow_map", look.shadow_map, 16, 32768);
  a.number("cascades", look.cascades, 0, 4);
  a.choice("style", look.style, {"photo", "normals", "edges", "toon", "watercolour"});
  a.choice("style_normals", look.style_normals, {"raw", "realigned", "scaled"});
  if constexpr (Archive::kReads) {
    try {
      termsOf({.light = look.light, .terms = {}, .shadows = {}, .background = {}});
    } catch (const Error& e) {
      a.refuse("light", fmt::format("is no light: {}", e.what()), "");
    }
    try {
      termsOf(look);
    } catch (const Error& e) {
      a.refuse("terms", fmt::format("is wrong: {}", e.what()), "");
    }
  }
}

template <class Archive>
void fieldsOf(Archive& a, SceneSettings& scene) {
  a.number("width", scene.width, 1, 1 << 20);
  a.number("height", scene.height, 1, 1 << 20);
  a.list("plants", scene.plants, [&](PlantSettings& plant) { fieldsOf(a, plant); });
  if constexpr (Archive::kReads)
    for (std::size_t i = 0; i < scene.plants.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (scene.plants[k].name == scene.plants[i].name)
          a.refuse(fmt::format("plants[{}].name", i).c_str(),
                   fmt::format("is '{}', as plant {}'s is", scene.plants[i].name, k),
                   "give each a name of its own");
  a.setPlants(scene.plants);
  a.list("placements", scene.placements, [&](Placement& place) { fieldsOf(a, place); });
  a.flag("bake_together", scene.bake_together);
  if constexpr (Archive::kReads)
    if (scene.bake_together && scene.placements.size() > kMostTogether)
      a.refuse("bake_together", fmt::format("is set for {} placements", scene.placements.size()),
               fmt::format("up to {} are baked in one field", kMostTogether));
  a.list("layouts", scene.layouts, [&](LayoutSettings& layout) { fieldsOf(a, layout); });
  a.list("scatters", scene.scatters, [&](ScatterSettings& scatter) { fieldsOf(a, scatter); });
  a.number("detail", scene.detail, kTiny, 100);
  a.object("ground", [&] { fieldsOf(a, scene.ground); });
  a.object("daylight", [&] { fieldsOf(a, scene.daylight); });
  a.object("exposure", [&] { fieldsOf(a, scene.exposure); });
  a.object("wind", [&] { fieldsOf(a, scene.wind); });
  a.object("camera", [&] { fieldsOf(a, scene.camera); });
  a.object("look", [&] { fieldsOf(a, scene.look); });
}

/// Names that are missing or taken are made, since places name plants.
void nameAll(std::vector<PlantSettings>& plants) {
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const auto taken = [&](const std::string& name) {
      return std::any_of(plants.begin(), plants.begin() + static_cast<std::ptrdiff_t>(i),
                         [&](const PlantSettings& other) { return other.name == name; });
    };
    std::string base = plants[i].name;
    if (base.empty())
      base = plants[i].file.empty() ? plants[i].grow.species
                                    : fs::path(plants[i].file).stem().string();
    plants[i].name = base;
    for (int n = 2; taken(plants[i].name); ++n) plants[i].name = fmt::format("{}-{}", base, n);
  }
}

}  // namespace

bool isSceneFile(const fs::path& path) {
  return path.extension() == ".json";
}

SceneSettings readScene(const fs::path& path) {
  const auto bytes = readFile(path);
  SceneReader reader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
  reader.checkVersion(kVersion);
  SceneSettings settings;
  fieldsOf(reader, settings);
  reader.finish();
  return settings;
}

std::string sceneText(const SceneSettings& settings, const fs::path& path) {
  SceneSettings named = settings;
  nameAll(named.plants);
  for (PlantSettings& plant : named.plants)
    if (plant.bake && plant.bake->field.empty() && !plant.bake->metaball_option.empty())
      plant.bake->field = "metaball";
  SceneWriter writer(path, kVersion);
  fieldsOf(writer, named);
  return writer.text();
}

void writeScene(const SceneSettings& settings, const fs::path& path) {
  writeFile(path, sceneText(settings, path));
}

}  // namespace verdure::app
