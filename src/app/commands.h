#ifndef VERDURE_APP_COMMANDS_H_
#define VERDURE_APP_COMMANDS_H_

#include <optional>
#include <string>
#include <vector>

#include "app/bake_parameters.h"
#include "app/parse.h"
#include "app/plant_prep.h"
#include "app/scene_settings.h"
#include "verdure/density.h"
#include "verdure/grow.h"
#include "verdure/leaf_files.h"
#include "verdure/leaf_grow.h"
#include "verdure/optical_depth.h"
#include "verdure/plant_io.h"
#include "verdure/render.h"
#include "verdure/transfer.h"

/// One function for each subcommand: parsed options in, files and lines out. All throw Error.
namespace verdure::app {

struct GrowCommand {
  GrowOptions grow;
  std::string leaves = "mesh";
  std::vector<std::string> assignments;  ///< "Param=value"
  std::string output;
  bool list = false;
  bool parameters = false;
  bool json = false;
};
void runGrow(GrowCommand command);

struct ExportCommand {
  std::string input;
  std::string output;
  LoadOptions load;
  std::string wind;  ///< target; empty: attributes, or none with skin
  bool list = false;
  bool skin = false;
  double seconds = 4.0, fps = 24.0, wind_speed = 6.0, wind_from_deg = 270.0, gusts = 0.4;
  int joints = 256;
  std::uint64_t seed = 1;
  std::string clip_option;  ///< one that was given and that only a skin has
  bool json = false;
};
void runExport(const ExportCommand& command);

struct LeafGrowCommand {
  LeafGrowOptions grow;
  std::string output;  ///< folder
  bool list = false;
  bool json = false;
};
void runLeafGrow(const LeafGrowCommand& command);

struct InspectCommand {
  std::string input;
  LoadOptions load;
  std::string skeleton;  ///< .obj or .png to write, empty for none
  bool json = false;
};
void runInspect(const InspectCommand& command);

struct LeafImportCommand {
  std::string input;  ///< folder, .glb or .gltf
  std::string output;
  std::string material;
  LeafImportOptions options;
};
void runLeafImport(const LeafImportCommand& command);

struct LeafBakeCommand {
  std::string input;
  std::string output;  ///< empty: the input folder
  std::string method = "gaussians";
  int directions = 128;
  std::optional<float> surface_reflection;
  std::string wavelength = "0,1,0";  ///< weights of R, G, B
  std::string report;
  bool json = false;
};
void runLeafBake(const LeafBakeCommand& command);

struct RayParameters {
  std::string ambient = "density";
  std::optional<int> rays;  ///< unset: as RayOptions, LeafVisibilityOptions
  int bounces = 3;
  int transfer_bands = 0;  ///< 0 = none
  int directions = 64;     ///< of the leaves' visibility
};

struct BakeCommand {
  std::string input;
  std::string output;
  LoadOptions load;
  BakeParameters bake;
  std::string surface;     ///< file that replaces the extracted surface
  std::string population;  ///< layout file
  RayParameters rays;
  std::string report;
  bool color1 = false;
  bool json = false;
};
void runBake(const BakeCommand& command);

/// What a picture is made of: a plant with options, or a scene file that options change.
struct SceneCommand {
  std::string input;    ///< plant or scene; may be empty
  SceneSettings scene;  ///< as read and changed so far
  LoadOptions load;     ///< of all plants, where it says anything
  BakeParameters bake;
  bool bake_again = false;  ///< parameters of the bake were given: they are those of all plants
  std::string save_scene;   ///< file

  /// The scene with what was given for all its plants.
  SceneSettings settings() const;
  /// Writes `settings` where that was asked for.
  void save(const SceneSettings& settings) const;
};

class LoadedScene;
/// Prints what was found out: missing plants on standard error, the rest unless it goes into JSON.
void tellNotes(const LoadedScene& loaded, bool json);

struct RenderCommand : SceneCommand {
  std::string output;
  DeviceOptions device;
  std::string frames;  ///< FIRST:LAST; empty: one picture
  int fps = 24;
  std::string motion_vectors;  ///< file
  bool json = false;
};
void runRender(const RenderCommand& command);

struct ReferenceCommand : SceneCommand {
  std::string output;
  int samples = 64;
  double seconds = 0.0;
  double noise = 0.0;
  int bounces = 32;
  std::uint32_t seed = 1;
  bool json = false;
};
void runReference(const ReferenceCommand& command);

struct CompareCommand {
  std::string reference, test;
  std::string metric = "flip,psnr,ssim";
  std::string heatmap;
  float pixels_per_degree = 67.0f;
  std::optional<float> peak;        ///< of PSNR, HDR images
  std::optional<double> threshold;  ///< of the first metric
  bool json = false;
};
/// Returns the exit code: 1 if the first metric is worse than the threshold.
int runCompare(const CompareCommand& command);

struct SkyCommand {
  float turbidity = 3.0f;
  std::string sun;          ///< "azimuth,elevation", degrees
  std::string date, place;  ///< ISO 8601; "latitude,longitude"
  std::string model = "preetham";
  std::optional<float> illuminance;  ///< of a CIE sky, klx
  float turn_deg = 0.0f;             ///< of a panorama
  float scale = 1.0f;                ///< of a panorama, kcd/m^2 of its value 1
  int bands = 7;
  bool filter = false;
  std::string image;
  std::string dome = "fisheye";
  int size = 512;
  std::string emit_header;
  std::string report;  ///< folder
  bool json = false;
};
void runSky(const SkyCommand& command);

struct FiguresCommand {
  std::string output = "figures";
  std::string species = "black-oak";
  std::string size = "640x640";
  int samples = 32;  ///< of leaf's traced pictures
  DeviceOptions device;
};
void runLuftFigures(const FiguresCommand& command);
void runNprFigures(const FiguresCommand& command);
void runGumbauFigures(const FiguresCommand& command);
void runLeafFigures(const FiguresCommand& command);
void runSkyFigures(const FiguresCommand& command);

/// Figures 5.3 to 5.7 of Habel 2009, with a page that shows them and the errors as JSON; the sun
/// and the turbidity are those of Figure 5.5.
struct SkyReport {
  std::string folder = "figures";
  int bands = 7;
  glm::vec3 to_sun{0.0f, 0.70710678f, 0.70710678f};
  float turbidity = 3.0f;
  std::optional<FiguresCommand> scenes = {};  ///< draws Figures 5.6 and 5.7; else they are left out
};
void writeSkyReport(const SkyReport& report);

struct FidelityCommand {
  std::string output = "fidelity";
  std::vector<std::string> species;  ///< empty: six
  std::string size = "320x320";
  int samples = 96;         ///< of the reference, a pixel
  int transfer_rays = 128;  ///< for each vertex and side
  DeviceOptions device;
  bool json = false;
};
void runFidelityReport(const FidelityCommand& command);

struct MotionReportCommand {
  std::string input;  ///< empty: a birch is grown
  std::string output = "motion";
  std::string size = "320x400";
  DeviceOptions device;
  bool json = false;
};
void runMotionReport(const MotionReportCommand& command);

// Shared by the commands.

/// bake --population.
void bakePopulation(const BakeCommand& command);

/// Throws Error unless a file can be written at `path` and its name ends in one of `extensions`.
void checkOutput(const std::string& path, const std::vector<std::string>& extensions);
/// What a bake's rays found, beside the light that it changed.
struct RayReport {
  std::optional<PlantTransfer> transfer;
  int rays = 0, bounces = 0;
  int leaf_rays = 0;  ///< of the leaves' visibility
  double seconds_normals = 0, seconds_ambient = 0, seconds_visibility = 0, seconds_transfer = 0;
  double mean_ambient = 0;  ///< of the coefficients that are written
};
/// Traces what the command asks for, if anything: open directions and ambient coefficients replace
/// those of `light`.
std::optional<RayReport> traceLight(const BakeCommand& command, const Plant& plant,
                                    CrownLight& light);
std::string jsonOf(const RayReport& report);
std::string jsonOf(const DensityReport& report);
std::string jsonOf(const DepthReport& report);
std::string jsonOf(const PlantReport& report);

}  // namespace verdure::app

#endif  // VERDURE_APP_COMMANDS_H_
