// The command line: parses options and calls the library, nothing else.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>

#include "app/bench_command.h"
#include "app/commands.h"
#include "app/grass_commands.h"
#include "app/option_groups.h"
#include "app/view/view_command.h"
#include "base/parallel.h"
#include "verdure/error.h"

namespace {

using namespace verdure;
using namespace verdure::app;

/// Help of all commands that goes down to the commands of commands.
class NestedHelp : public CLI::Formatter {
 public:
  std::string make_expanded(const CLI::App* command) const override {
    std::string help = CLI::Formatter::make_expanded(command);
    for (const CLI::App* part : command->get_subcommands([](const CLI::App*) { return true; }))
      help += make_expanded(part);
    return help;
  }
};

/// Prints one line, whatever bytes the names of files and parts hold.
int fail(const std::string& message) {
  std::string line = "verdure: " + message;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  std::fprintf(stderr, "%s\n", line.c_str());
  return 2;
}

int run(int argc, char** argv) {
  CLI::App app{"verdure: vegetation, grown, lit and rendered", "verdure"};
  app.formatter(std::make_shared<NestedHelp>());
  app.set_version_flag("--version", std::string("verdure ") + VERDURE_VERSION);
  app.fallthrough();  // --threads may stand behind the command
  app.set_help_all_flag("--help-all", "Help of all commands");
  app.option_defaults()->always_capture_default(false);
  int threads = 0;
  app.add_option("--threads", threads, "Threads to use (default: all cores)")
      ->check(CLI::Range(0, 1024));

  GrowCommand grow;
  CLI::App* grow_app = app.add_subcommand("grow", "Grow a tree or shrub (Weber and Penn 1995)");
  grow_app->add_option("-o,--output", grow.output, "File to write: .glb or .gltf");
  grow_app->add_option("--species", grow.grow.species, "Species, see --list")
      ->capture_default_str();
  grow_app->add_option("--seed", grow.grow.seed, "Each seed is another tree")
      ->capture_default_str();
  grow_app->add_option("--set", grow.assignments, "Override a parameter, see --parameters")
      ->type_name("PARAM=VALUE")
      ->allow_extra_args(false);
  grow_app->add_option("--leaves", grow.leaves, "mesh (folded blades) or card (one quad a leaf)")
      ->capture_default_str();
  grow_app->add_option("--texture-size", grow.grow.texture_size, "Side of its textures, pixels")
      ->capture_default_str();
  grow_app->add_option("--leaf-age", grow.grow.leaf_age, "0 spring, 0.4 summer, 1 autumn")
      ->capture_default_str();
  grow_app->add_flag("--list", grow.list, "List the species");
  grow_app->add_flag("--parameters", grow.parameters, "List the species' parameters");
  grow_app->add_flag("--json", grow.json, "Print JSON");

  CLI::App* leaf_app = app.add_subcommand("leaf", "Leaves as maps, and light through them");
  LeafGrowCommand leaf_grow;
  CLI::App* leaf_grow_app = leaf_app->add_subcommand("grow", "Grow a leaf: outline, veins, maps");
  leaf_grow_app->add_option("-o,--output", leaf_grow.output, "Folder to write");
  leaf_grow_app->add_option("--species", leaf_grow.grow.species, "Species, see --list")
      ->capture_default_str();
  leaf_grow_app->add_option("--seed", leaf_grow.grow.seed, "Each seed is another leaf")
      ->capture_default_str();
  leaf_grow_app->add_option("--size", leaf_grow.grow.size, "Texels a side, 16 to 8192")
      ->capture_default_str();
  leaf_grow_app->add_option("--age", leaf_grow.grow.age, "0 spring, 0.4 summer, 1 autumn")
      ->capture_default_str();
  leaf_grow_app->add_flag("--list", leaf_grow.list, "List the species");
  leaf_grow_app->add_flag("--json", leaf_grow.json, "Print JSON");
  LeafImportCommand leaf_import;
  CLI::App* leaf_import_app =
      leaf_app->add_subcommand("import", "Make a leaf's folder of maps or of a material");
  leaf_import_app
      ->add_option("source", leaf_import.input,
                   "Folder with a leaf.json or with maps named as ambientCG does; .glb or .gltf")
      ->required();
  leaf_import_app->add_option("-o,--output", leaf_import.output, "Folder to write")->required();
  leaf_import_app->add_option("--name", leaf_import.options.name, "Name of the leaf");
  leaf_import_app->add_option("--material", leaf_import.material,
                              "Which material of the glTF file (* matches anything)");
  leaf_import_app->add_option("--mm-per-texel", leaf_import.options.mm_per_texel,
                              "Width of a texel, mm");
  leaf_import_app->add_option("--width-mm", leaf_import.options.width_mm,
                              "Instead: width of the maps, mm");
  leaf_import_app->add_option("--thickness-mm", leaf_import.options.thickness_mm,
                              "Thickness of the leaf, or of its thickness map's white, mm");
  leaf_import_app->add_option("--relief-mm", leaf_import.options.relief_mm,
                              "Height of white over black in maps of relief, mm");
  LeafBakeCommand leaf_bake;
  CLI::App* leaf_bake_app =
      leaf_app->add_subcommand("bake", "Bake light through a leaf (Habel 2009, 3.3)");
  leaf_bake_app->add_option("folder", leaf_bake.input, "Folder with a leaf.json")->required();
  leaf_bake_app->add_option("-o,--output", leaf_bake.output, "Folder to write (default: the same)");
  leaf_bake_app->add_option("--method", leaf_bake.method, "gaussians, or direct (slow, to compare)")
      ->capture_default_str();
  leaf_bake_app
      ->add_option("--directions", leaf_bake.directions, "Directions of light, 16 to 65536")
      ->capture_default_str();
  leaf_bake_app->add_option(
      "--surface-reflection", leaf_bake.surface_reflection,
      "Share of light inside that the surface throws back, [0, 1) (default: of the leaf's index)");
  leaf_bake_app
      ->add_option("--wavelength", leaf_bake.wavelength,
                   "R,G,B: what of the albedo stands for the light that is simulated")
      ->capture_default_str();
  leaf_bake_app->add_option("--report", leaf_bake.report,
                            "Write every number of the bake, and the basis' errors, as JSON");
  leaf_bake_app->add_flag("--json", leaf_bake.json, "Print the report as JSON");

  CLI::App* grass_app = app.add_subcommand("grass", "Grass as slices and ground");
  GrassGrowCommand grass_grow;
  CLI::App* grass_grow_app =
      grass_app->add_subcommand("grow", "Grow a data set of grass (Habel 2009, chapter 2)");
  grass_grow_app->add_option("-o,--output", grass_grow.output, "Folder to write");
  grass_grow_app->add_option("--species", grass_grow.species, "Species, see --list")
      ->capture_default_str();
  grass_grow_app->add_option("--seed", grass_grow.grow.seed, "Each seed is other grass")
      ->capture_default_str();
  grass_grow_app
      ->add_option("--texels-per-m", grass_grow.grow.texels_per_m,
                   "Of slices and ground, 16 to 4096")
      ->capture_default_str();
  grass_grow_app->add_option("--kinds", grass_grow.grow.kinds, "Slices, 1 to 64")
      ->capture_default_str();
  grass_grow_app->add_flag("--list", grass_grow.list, "List the species");
  grass_grow_app->add_flag("--json", grass_grow.json, "Print JSON");

  InspectCommand inspect;
  CLI::App* inspect_app = app.add_subcommand("inspect", "Say what is in a plant file");
  inspect_app->add_option("file", inspect.input, "Plant: .glb .gltf .obj .fbx .dae .ply")
      ->required();
  addLoadOptions(*inspect_app, inspect.load);
  inspect_app->add_option("--skeleton", inspect.skeleton,
                          "Write its branches: lines by level, .obj, or a drawing, .png");
  inspect_app->add_flag("--json", inspect.json, "Print JSON");

  BakeCommand bake;
  CLI::App* bake_app =
      app.add_subcommand("bake", "Bake a crown's light into its mesh (Luft et al. 2007)");
  bake_app->add_option("file", bake.input, "Plant: .glb .gltf .obj .fbx .dae .ply")->required();
  bake_app->add_option("-o,--output", bake.output, "File to write: .glb or .gltf")->required();
  addLoadOptions(*bake_app, bake.load);
  addBakeOptions(*bake_app, bake.bake, "Density field");
  bake_app->add_flag_function(
      "--fit,!--no-fit", [&bake](std::int64_t count) { bake.bake.fit = count > 0; },
      "Choose the field's parameters by rays traced from some hundred vertices (metaball: not by "
      "default)");
  bake_app->add_option("--surface", bake.surface,
                       "Use this surface instead of the field's: .obj .ply .glb");
  bake_app->add_option("--population", bake.population,
                       "Bake a group in one field: JSON layout (see docs/population.md)");
  constexpr const char* kRayGroup = "Rays";
  bake_app
      ->add_option("--ambient", bake.rays.ambient,
                   "Ambient coefficients: density, ray-traced (slower, true) or leaf-visibility")
      ->group(kRayGroup)
      ->capture_default_str();
  bake_app
      ->add_option("--transfer", bake.rays.transfer_bands,
                   "Trace transfer vectors of so many bands, 2 to 7, into OUTPUT's .transfer")
      ->check(CLI::Range(2, 7))
      ->group(kRayGroup);
  bake_app
      ->add_option("--directions", bake.rays.directions,
                   "Of leaf-visibility: from how many sides leaves are looked at (6: the paper's)")
      ->check(CLI::Range(2, 4096))
      ->group(kRayGroup)
      ->capture_default_str();
  bake_app
      ->add_option("--rays", bake.rays.rays,
                   "Rays of each vertex and side of a leaf (default: 256), or of each leaf for "
                   "leaf-visibility (default: 64)")
      ->check(CLI::Range(1, 65536))
      ->group(kRayGroup);
  bake_app->add_option("--bounces", bake.rays.bounces, "Most surfaces that light meets on its way")
      ->group(kRayGroup)
      ->capture_default_str();
  bake_app->add_option("--report", bake.report, "Write every number of the bake as JSON");
  bake_app->add_flag("--color1", bake.color1, "Write the ambient coefficient as COLOR_1 too");
  bake_app->add_flag("--json", bake.json, "Print the report as JSON");

  ExportCommand wind_files;
  CLI::App* export_app =
      app.add_subcommand("export", "Write a plant with wind data for other programs");
  export_app->add_option("file", wind_files.input, "Plant: .glb .gltf .obj .fbx .dae .ply");
  export_app->add_option("-o,--output", wind_files.output, "File to write: .glb or .gltf");
  addLoadOptions(*export_app, wind_files.load);
  export_app->add_option("--wind", wind_files.wind,
                         "What the wind data are for, see --list (default: attributes)");
  export_app->add_flag("--list", wind_files.list, "List what wind data can be for");
  constexpr const char* kClipGroup = "Clip";
  export_app->add_flag("--skin", wind_files.skin, "Instead: a skin, and a clip that loops")
      ->group(kClipGroup);
  export_app->add_option("--seconds", wind_files.seconds, "Length of the loop, 0.5 to 60")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--fps", wind_files.fps, "Frames a second, 5 to 120")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--joints", wind_files.joints, "Joints at most, 8 to 4096")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--wind-speed", wind_files.wind_speed, "m/s, 0 to 60")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--wind-from", wind_files.wind_from_deg, "Degrees (0: +Z, 90: +X)")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--gusts", wind_files.gusts, "Share by which the speed varies, 0 to 1")
      ->group(kClipGroup)
      ->capture_default_str();
  export_app->add_option("--seed", wind_files.seed, "Each seed moves otherwise")
      ->capture_default_str();
  export_app->add_flag("--json", wind_files.json, "Print JSON");

  RenderCommand render;
  CLI::App* render_app = app.add_subcommand("render", "Render a plant or a scene to a picture");
  addSceneOptions(*render_app, render);
  addGroundOptions(*render_app, render.scene.ground);
  render_app
      ->add_option("-o,--output", render.output,
                   "File to write: .png, or .exr in kcd/m^2; for a film see --frames")
      ->required();
  addLookOptions(*render_app, render.scene.look);
  addDaylightOptions(*render_app, render.scene.daylight);
  addExposureOptions(*render_app, render.scene.exposure);
  render_app
      ->add_option("--bloom", render.scene.exposure.bloom,
                   "Share of light that the lens spreads, 0 to 1")
      ->capture_default_str();
  addWindOptions(*render_app, render.scene.wind);
  render_app->add_option(
      "--frames", render.frames,
      "FIRST:LAST: a film (.mp4, .webm or .gif by ffmpeg) or numbered pictures (.png)");
  render_app->add_option("--fps", render.fps, "Frames a second, 1 to 240")->capture_default_str();
  render_app->add_option("--motion-vectors", render.motion_vectors,
                         "Write how far each pixel has come since the last frame: .exr, pixels");
  render_app->add_option("--save-scene", render.save_scene, "Scene file to write, too: .json");
  addDeviceOptions(*render_app, render.device);
  constexpr const char* kBakeGroup = "Density field (given any, the file's own bake is left)";
  addBakeOptions(*render_app, render.bake, kBakeGroup);
  render_app->add_flag("--json", render.json, "Print times as JSON");

  ViewCommand view;
  CLI::App* view_app = app.add_subcommand("view", "Look at a plant or a scene in a window");
  view_app->add_option("file", view.input,
                       "Plant: .glb .gltf .obj .fbx .dae .ply; or scene: .json");
  view_app->add_option("--size", view.size, "WxH of the window, pixels")->capture_default_str();
  view_app->add_option("--screenshot", view.screenshot,
                       "Write the window to this .png when all is drawn, and close it");
  addDeviceOptions(*view_app, view.device);

  ReferenceCommand reference;
  CLI::App* reference_app =
      app.add_subcommand("reference", "Path-trace a plant or scene: the truth for render (CPU)");
  addSceneOptions(*reference_app, reference);
  reference_app->get_option("file")->required();
  reference_app
      ->add_option("-o,--output", reference.output, "File to write: .png, or .exr in kcd/m^2")
      ->required();
  addWindOptions(*reference_app, reference.scene.wind);
  addDaylightOptions(*reference_app, reference.scene.daylight);
  addExposureOptions(*reference_app, reference.scene.exposure);
  reference_app->add_option("--samples", reference.samples, "Paths a pixel at most")
      ->capture_default_str();
  reference_app->add_option("--seconds", reference.seconds, "Stop after this time, 0 = never")
      ->capture_default_str();
  reference_app->add_option("--noise", reference.noise, "Stop at this relative noise, 0 = never")
      ->capture_default_str();
  reference_app->add_option("--bounces", reference.bounces, "Surfaces on a path, 1 = direct light")
      ->capture_default_str();
  reference_app->add_option("--seed", reference.seed, "Of the noise")->capture_default_str();
  reference_app->add_flag("--json", reference.json, "Print JSON");

  CompareCommand compare;
  CLI::App* compare_app = app.add_subcommand("compare", "Say how different two images are");
  compare_app->add_option("reference", compare.reference, "Image: .png .jpg .exr .hdr")->required();
  compare_app->add_option("test", compare.test, "Image of the same size")->required();
  compare_app->add_option("--metric", compare.metric, "Of flip, psnr, ssim, by commas")
      ->capture_default_str();
  compare_app->add_option("--heatmap", compare.heatmap, "PNG of FLIP's map to write");
  compare_app->add_option(
      "--threshold", compare.threshold,
      "Exit with 1 if the first metric is worse: flip above it, others below it");
  compare_app
      ->add_option("--pixels-per-degree", compare.pixels_per_degree,
                   "FLIP: of the display as it is seen")
      ->capture_default_str();
  compare_app->add_option("--peak", compare.peak,
                          "PSNR of HDR images: the peak (default: the reference's largest value)");
  compare_app->add_flag("--json", compare.json, "Print JSON");

  SkyCommand sky;
  CLI::App* sky_app = app.add_subcommand("sky", "Say what a sky gives; draw, project and fit it");
  sky_app->add_option("--turbidity", sky.turbidity, "Preetham's, 2 (clear) to 10 (thick haze)")
      ->capture_default_str();
  sky_app->add_option("--sun", sky.sun,
                      "AZIMUTH,ELEVATION, degrees (azimuth 0: south, 90: east; default: 0,45)");
  sky_app->add_option("--date", sky.date, "Time instead of --sun: 2026-06-21T12:30Z, or +02:00");
  sky_app->add_option("--place", sky.place, "LATITUDE,LONGITUDE for --date, degrees");
  sky_app->add_option("--model", sky.model, "preetham, cie:1 to cie:15, or a panorama .hdr .exr")
      ->capture_default_str();
  sky_app->add_option("--illuminance", sky.illuminance,
                      "klx of a CIE sky on level ground (default: from the sun's elevation)");
  sky_app->add_option("--turn", sky.turn_deg, "Turn of a panorama, degrees from south to east")
      ->capture_default_str();
  sky_app->add_option("--scale", sky.scale, "kcd/m^2 of a panorama's value 1")
      ->capture_default_str();
  sky_app->add_option("--bands", sky.bands, "Bands of the spherical harmonics, 1 to 7")
      ->capture_default_str();
  sky_app->add_flag("--filter", sky.filter, "Filter the printed weights against ringing");
  sky_app->add_option("--image", sky.image, "Picture of the sky to write: .png or .exr");
  sky_app->add_option("--dome", sky.dome, "fisheye or panorama")->capture_default_str();
  sky_app->add_option("--size", sky.size, "Height of the picture, pixels")->capture_default_str();
  sky_app->add_option("--emit-header", sky.emit_header, "C header with the fit to write");
  sky_app->add_option("--report", sky.report, "Folder for the fit's errors and pictures");
  sky_app->add_flag("--json", sky.json, "Print JSON, with the harmonics' weights");

  FiguresCommand luft, npr, gumbau, leaf_figures, grass_figures, sky_figures;
  CLI::App* figures_app = app.add_subcommand("figures", "Reproduce the figures of a paper");
  const auto add_figures = [figures_app](const char* name, const char* help,
                                         FiguresCommand& figures) {
    CLI::App* paper = figures_app->add_subcommand(name, help);
    paper->add_option("-o,--output", figures.output, "Folder to write")->capture_default_str();
    paper->add_option("--species", figures.species, "Species of the main plant")
        ->capture_default_str();
    paper->add_option("--size", figures.size, "WxH of each picture")->capture_default_str();
    addDeviceOptions(*paper, figures.device);
    return paper;
  };
  CLI::App* luft_app = add_figures("luft", "Luft, Balzer, Deussen 2007: 1 to 6", luft);
  CLI::App* npr_app = add_figures("npr", "Luft, Balzer, Deussen 2007: 7 and 8, drawn styles", npr);
  CLI::App* gumbau_app =
      add_figures("gumbau", "Gumbau, Chover, Rebollo, Remolar 2008: 1 to 5", gumbau);
  CLI::App* leaf_figures_app =
      add_figures("leaf", "Habel 2009, chapter 3: 3.9 to 3.20", leaf_figures);
  leaf_figures_app
      ->add_option("--samples", leaf_figures.samples, "Paths a pixel of traced pictures")
      ->capture_default_str();
  grass_figures.species = "meadow";
  grass_figures.size = "480x360";
  CLI::App* grass_figures_app =
      add_figures("grass", "Habel 2009, chapter 2: 2.9 to 2.16", grass_figures);
  sky_figures.size = "480x360";
  CLI::App* sky_figures_app = add_figures("sky", "Habel 2009, chapter 5: 5.3 to 5.7", sky_figures);

  FidelityCommand fidelity;
  CLI::App* report_app = app.add_subcommand("report", "Measure what verdure claims");
  CLI::App* fidelity_app = report_app->add_subcommand(
      "fidelity", "Light presets against the path tracer, crown fields against rays");
  fidelity_app->add_option("-o,--output", fidelity.output, "Folder to write")
      ->capture_default_str();
  fidelity_app
      ->add_option("--species", fidelity.species, "Species, separated by commas (default: six)")
      ->delimiter(',');
  fidelity_app->add_option("--size", fidelity.size, "WxH of each picture")->capture_default_str();
  fidelity_app->add_option("--samples", fidelity.samples, "Paths a pixel of the reference")
      ->capture_default_str();
  fidelity_app->add_option("--rays", fidelity.transfer_rays, "Rays a vertex of transfer vectors")
      ->capture_default_str();
  fidelity_app->add_flag("--json", fidelity.json, "Print the numbers as JSON");
  addDeviceOptions(*fidelity_app, fidelity.device);
  MotionReportCommand motion_report;
  CLI::App* motion_app = report_app->add_subcommand(
      "motion", "Beams and spectra of trees in wind against theory, and frames of one");
  motion_app->add_option("file", motion_report.input, "Plant to show (default: a birch is grown)");
  motion_app->add_option("-o,--output", motion_report.output, "Folder to write")
      ->capture_default_str();
  motion_app->add_option("--size", motion_report.size, "WxH of each frame")->capture_default_str();
  motion_app->add_flag("--json", motion_report.json, "Print the numbers as JSON");
  addDeviceOptions(*motion_app, motion_report.device);

  BenchGrassCommand bench_grass;
  CLI::App* bench_app = app.add_subcommand("bench", "Measure how fast pictures are drawn");
  CLI::App* bench_grass_app = bench_app->add_subcommand(
      "grass", "Traced grass against sorted polygons (Habel 2009, table 2.1)");
  bench_grass_app->add_option("--size", bench_grass.sizes, "WxH of pictures, by commas")
      ->delimiter(',')
      ->capture_default_str();
  bench_grass_app->add_option(
      "--frames", bench_grass.frames,
      "Frames of each kind, 1 to 1000 (default: up to 15, as the device is fast)");
  bench_grass_app->add_option("--species", bench_grass.species, "Species of grass")
      ->capture_default_str();
  bench_grass_app->add_flag("--json", bench_grass.json, "Print JSON");
  addDeviceOptions(*bench_grass_app, bench_grass.device);

  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')
      throw Error("argument " + std::to_string(i), "is empty", "give it a value or leave it out");
  std::string help = "verdure --help";
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    for (const CLI::App* command : app.get_subcommands())
      help = "verdure " + command->get_name() + " --help";
    return fail(std::string(e.what()) + "; see " + help);
  }
  if (app.get_subcommands().empty())
    throw Error(
        "command line", "no command is named",
        "use grow, leaf, grass, inspect, bake, export, render, view, reference, compare, sky, "
        "figures, report or bench; see " +
            help);
  if (*figures_app && figures_app->get_subcommands().empty())
    throw Error("figures", "no paper is named",
                "use luft, npr, gumbau, leaf, grass or sky; see verdure figures --help");
  if (*report_app && report_app->get_subcommands().empty())
    throw Error("report", "nothing is named", "use fidelity or motion; see verdure report --help");
  if (*leaf_app && leaf_app->get_subcommands().empty())
    throw Error("leaf", "nothing is named", "use grow, import or bake; see verdure leaf --help");
  if (*grass_app && grass_app->get_subcommands().empty())
    throw Error("grass", "nothing is named", "use grow; see verdure grass --help");
  if (*bench_app && bench_app->get_subcommands().empty())
    throw Error("bench", "nothing is named", "use grass; see verdure bench --help");
  for (const CLI::Option* option : render_app->get_options())
    if (option->get_group() == kBakeGroup && option->count() > 0) render.bake_again = true;
  for (const char* name : {"--rho", "--tau", "--fraction", "--norm", "--grid", "--d-min", "--k-min",
                           "--exponent", "--surface", "--population"}) {
    const CLI::Option* const of_bake = bake_app->get_option(name);
    if (of_bake->count() > 0) bake.bake.metaball_option = name;
    const CLI::Option* const of_render = render_app->get_option_no_throw(name);
    if (of_render != nullptr && of_render->count() > 0) render.bake.metaball_option = name;
  }
  for (const CLI::Option* option : export_app->get_options())
    if (option->get_group() == kClipGroup && option->count() > 0)
      wind_files.clip_option = option->get_name();
  setThreadCount(threads);
  if (*grow_app) runGrow(grow);
  if (*leaf_grow_app) runLeafGrow(leaf_grow);
  if (*leaf_import_app) runLeafImport(leaf_import);
  if (*leaf_bake_app) runLeafBake(leaf_bake);
  if (*grass_grow_app) runGrassGrow(grass_grow);
  if (*inspect_app) runInspect(inspect);
  if (*bake_app) runBake(bake);
  if (*export_app) runExport(wind_files);
  if (*render_app) runRender(render);
  if (*view_app) runView(view);
  if (*reference_app) runReference(reference);
  if (*compare_app) return runCompare(compare);
  if (*sky_app) runSky(sky);
  if (*luft_app) runLuftFigures(luft);
  if (*npr_app) runNprFigures(npr);
  if (*gumbau_app) runGumbauFigures(gumbau);
  if (*leaf_figures_app) runLeafFigures(leaf_figures);
  if (*grass_figures_app) runGrassFigures(grass_figures);
  if (*sky_figures_app) runSkyFigures(sky_figures);
  if (*fidelity_app) runFidelityReport(fidelity);
  if (*motion_app) runMotionReport(motion_report);
  if (*bench_grass_app) runBenchGrass(bench_grass);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int code = run(argc, argv);
    if (std::fflush(stdout) != 0)
      return fail("standard output: cannot be written; check its space");
    return code;
  } catch (const verdure::Error& e) {
    return fail(e.what());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a smaller plant, grid or picture");
  } catch (const std::exception& e) {
    return fail(std::string("unexpected: ") + e.what());
  }
}
