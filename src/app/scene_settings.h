#ifndef VERDURE_APP_SCENE_SETTINGS_H_
#define VERDURE_APP_SCENE_SETTINGS_H_

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/bake_parameters.h"
#include "verdure/grow.h"
#include "verdure/placement.h"
#include "verdure/plant_io.h"
#include "verdure/render.h"
#include "verdure/sun_position.h"

/// All that a picture depends on: what scene files hold (docs/scene.md), command lines are read
/// into, and the viewer edits. Paths are as the program can open them; in files they are relative
/// to the file.
namespace verdure::app {

/// How a plant answers wind, by its branches' levels and branch by branch (Figure 4.17 of Habel
/// 2009).
struct MotionSettings {
  struct BranchFlexibility {
    std::uint32_t branch = 0;  ///< index into MotionTree::branches; those that are not there: none
    float flexibility = 1.0f;  ///< times its deflections, at least 0
  };
  float flexibility = 1.0f;  ///< times all deflections, above 0
  glm::vec4 level_flexibility{
      1.0f};  ///< times those of a level's branches, trunk first, at least 0
  glm::vec4 damping_ratio{0.3f, 0.2f, 0.2f, 0.2f};  ///< of a level's, [0.02, 4]
  std::vector<BranchFlexibility> branches;
};

/// A kind of plant of the scene: a file, or grown.
struct PlantSettings {
  std::string name;  ///< what places call it, unique in its scene
  std::string file;  ///< empty: grown
  GrowOptions grow;  ///< without a file
  LoadOptions load;  ///< of a file
  /// Unset: the file's own bake; if it has none, or the plant is grown, the defaults.
  std::optional<BakeParameters> bake;
  std::optional<MotionSettings> motion = {};  ///< unset: the defaults
};

/// Places from a glTF file's instances (EXT_mesh_gpu_instancing).
struct LayoutSettings {
  std::string file;
  std::vector<std::uint32_t> plants;  ///< of its nodes that have instances, in turn
  bool heights_of_file = false;       ///< else on the ground
  float scale = 1.0f;                 ///< times the instances' own, above 0
};

/// Places by chance: verdure/scatter.h.
struct ScatterSettings {
  struct Kind {
    std::uint32_t plant = 0;  ///< index into SceneSettings::plants
    float share = 1.0f;       ///< of the places, in shares of all kinds' sum, above 0
    float radius_m = 1.0f;    ///< places are at least both radii apart, at least 0
    glm::vec2 scale{0.85f, 1.15f};
  };
  std::vector<Kind> kinds;
  std::uint64_t seed = 1;
  glm::vec2 center_m{0.0f};         ///< x, z
  glm::vec2 size_m{100.0f};         ///< along x and z
  std::optional<float> per_ha;      ///< places a hectare; unset: as many as find room
  std::string density_map;          ///< picture over the area, white: all places; empty: everywhere
  float clear_m = 0.0f;             ///< around the camera's eye and all places before, at least 0
  float most_slope_deg = 90.0f;     ///< of the ground
  std::optional<glm::vec2> height;  ///< of the ground, lowest and highest, m
  float hue_spread = 0.1f;          ///< of tints, [0, 1]
  float brightness_spread = 0.2f;   ///< [0, 1]
};

struct GrassLayerSettings {
  std::string grass;  ///< species, folder or grass.json
  float density = 1.0f;
  std::string cover;  ///< picture over the terrain's area; empty: everywhere
};

struct GroundSettings {
  bool shown = true;
  std::vector<GrassLayerSettings> grass;
  std::uint64_t grass_seed = 1;
  int grass_slices = 32;
  std::string terrain;  ///< "hills" or a picture; empty: a plane
  glm::vec2 terrain_size_m{200.0f};
  glm::vec2 terrain_height_m{0.0f, 12.0f};  ///< of black and white
  std::uint64_t terrain_seed = 1;

  bool any() const { return !grass.empty() || !terrain.empty(); }
};

struct DaylightSettings {
  std::string sky = "preetham";  ///< or "cie:1" to "cie:15", or a panorama
  /// Azimuth and elevation; unset: `date` and `place`, else 85, 42 (of a panorama: its own sun).
  std::optional<glm::vec2> sun_deg;
  std::string date;  ///< ISO 8601; both or neither
  std::optional<Place> place;
  double turbidity = 3.0;
};

struct ExposureSettings {
  std::optional<float> ev;  ///< unset: automatic
  double key = 0.3;
  std::optional<float> white;  ///< unset: automatic
  double bloom = 0.01;
};

struct WindSettings {
  std::optional<float> speed;  ///< unset: 5 m/s if `seconds` or frames are asked for, else 0
  float from_deg = 240.0f;
  float gusts = 0.4f;
  std::optional<double> seconds;
};

struct CameraSettings {
  /// Unset: all of the scene is seen, from this azimuth and elevation.
  std::optional<glm::vec3> eye;
  glm::vec3 target{0.0f};  ///< with an eye
  glm::vec2 from_deg{35.0f, 4.0f};
  double fov_deg = 34.0;  ///< vertical
};

struct LookSettings {
  std::string light = "best";  ///< a preset
  /// Only these of ambient, diffuse, specular, shadow, textures, transmission, scattering, gloss;
  /// unset: the preset's.
  std::optional<std::vector<std::string>> terms;
  std::optional<ShadowSource> shadows;  ///< unset: the preset's
  int sky_bands = 5;
  float visibility_exponent = 1.0f;
  std::optional<glm::vec3> background;
  int shadow_map = 2048;
  int cascades = 0;  ///< 0: automatic
  Style style = Style::kPhoto;
  StyleNormals style_normals = StyleNormals::kScaled;
};

struct SceneSettings {
  int width = 960, height = 720;
  std::vector<PlantSettings> plants;
  /// Position: x and z, and y above the ground there. Without placements, layouts and scatters each
  /// plant stands once, as its file has it.
  std::vector<Placement> placements;
  /// Placements are baked in one metaball field, with the parameters of the first one's plant:
  /// neighbours darken each other, and each is drawn whole, without its tint.
  bool bake_together = false;
  std::vector<LayoutSettings> layouts;
  std::vector<ScatterSettings> scatters;
  float detail = 1.0f;  ///< Forest::detail
  GroundSettings ground;
  DaylightSettings daylight;
  ExposureSettings exposure;
  WindSettings wind;
  CameraSettings camera;
  LookSettings look;
};

/// Most placements that are baked together.
inline constexpr std::size_t kMostTogether = 64;

/// Throws Error in one line that names file, line and key for what is no scene, of a newer version,
/// has unknown keys or numbers out of range. Files that it names need not be there.
SceneSettings readScene(const std::filesystem::path& path);

/// Atomic. What was written is read again as it was, to the bit.
void writeScene(const SceneSettings& settings, const std::filesystem::path& path);

/// What writeScene() writes there: the same text for the same settings. Throws Error for names that
/// are no UTF-8.
std::string sceneText(const SceneSettings& settings, const std::filesystem::path& path);

/// Whether a path ends as scene files do: .json.
bool isSceneFile(const std::filesystem::path& path);

/// Each throws Error that names the option of the command line, for numbers out of range.
Terms termsOf(const LookSettings& look);
Daylight daylightOf(const DaylightSettings& daylight);
Exposure exposureOf(const ExposureSettings& exposure);
/// `film`: frames are asked for.
Wind windOf(const WindSettings& wind, bool film = false);
/// All of a view but its camera.
View viewOf(const SceneSettings& settings, bool film = false);
/// The camera that shows `scene`.
Camera cameraOf(const SceneSettings& settings, const Scene& scene);

}  // namespace verdure::app

#endif  // VERDURE_APP_SCENE_SETTINGS_H_
