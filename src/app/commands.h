#ifndef VERDURE_APP_COMMANDS_H_
#define VERDURE_APP_COMMANDS_H_

#include <optional>
#include <string>
#include <vector>

#include "verdure/density.h"
#include "verdure/grow.h"
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

struct InspectCommand {
  std::string input;
  LoadOptions load;
  bool json = false;
};
void runInspect(const InspectCommand& command);

enum class BakeField { kMetaball, kOpticalDepth };

/// The parameters of the bake as the command line gives them; `options` reads them.
struct BakeParameters {
  DensityOptions options;
  std::string field;            ///< metaball or optical-depth; empty: as fieldOr() finds
  std::string metaball_option;  ///< one that was given and that only the metaball field has
  std::string norm = "2";
  std::string normals;  ///< empty: the field's own
  bool fit = false;
  double max_memory_mib = 4096;

  /// The field that was named, else the one that the given options need, else `fallback`. Throws
  /// Error: an unknown field, an option that the named one has not.
  BakeField fieldOr(BakeField fallback) const;
  /// Throws Error for an unknown norm or kind of normals.
  DensityOptions checked() const;
  DepthOptions checkedDepth() const;
};

struct RayParameters {
  std::string ambient = "density";
  int rays = 256;
  int bounces = 3;
  int transfer_bands = 0;  ///< 0 = none
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

struct RenderCommand {
  std::string input;
  std::string output;
  LoadOptions load;
  BakeParameters bake;
  bool bake_again =
      false;  ///< parameters of the bake were given: the file's own light is not theirs
  std::string size = "960x720";
  std::string light = "expressive";
  std::string terms;
  std::string sun = "85,42";
  std::string camera = "auto";
  double fov_deg = 34.0;
  std::string background;
  bool no_ground = false;
  int shadow_map = 2048;
  DeviceOptions device;
  bool json = false;
};
void runRender(const RenderCommand& command);

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

struct FiguresCommand {
  std::string output = "figures";
  std::string species = "black-oak";
  std::string size = "640x640";
  DeviceOptions device;
};
void runLuftFigures(const FiguresCommand& command);

// Shared by the commands.

/// Throws Error unless a file can be written at `path` and its name ends in one of `extensions`.
void checkOutput(const std::string& path, const std::vector<std::string>& extensions);
/// "960x720" to two numbers. Throws Error.
std::pair<int, int> parseSize(const std::string& text);
/// Comma-separated numbers; throws Error unless there are `count` of them (0: any).
std::vector<float> parseNumbers(const std::string& option, const std::string& text,
                                std::size_t count);
/// The light that a file brought along in `_AO` and NORMAL, if it has any.
std::optional<CrownLight> lightOfFile(const Plant& plant);
/// Where a plant stands: on the zero of its own heights, where strands may hang below it; one that
/// was modelled around or away from it stands on its lowest point.
float groundHeight(const Plant& plant);
/// What a bake's rays found, beside the light that it changed.
struct RayReport {
  std::optional<PlantTransfer> transfer;
  int rays = 0, bounces = 0;
  double seconds_normals = 0, seconds_ambient = 0, seconds_transfer = 0;
  double mean_ambient = 0;  ///< of the traced coefficients
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
