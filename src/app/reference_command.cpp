// reference.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/loaded_scene.h"
#include "base/progress.h"
#include "scene/display.h"
#include "shared/tone.h"
#include "verdure/error.h"
#include "verdure/reference.h"

namespace verdure::app {

void runReference(const ReferenceCommand& command) {
  ReferenceOptions options;
  const SceneSettings settings = command.settings();
  const View view = viewOf(settings);  // what is wrong is said before long work
  options.width = settings.width;
  options.height = settings.height;
  if (command.samples < 1) throw Error("--samples", "must be at least 1", "64 is a fair start");
  if (command.bounces < 1)
    throw Error("--bounces", "must be at least 1", "1 is direct light alone");
  if (!(command.seconds >= 0.0)) throw Error("--seconds", "must not be negative");
  if (!(command.noise >= 0.0)) throw Error("--noise", "must not be negative");
  options.samples = command.samples;
  options.bounces = command.bounces;
  options.seconds = command.seconds;
  options.noise = command.noise;
  options.seed = command.seed;
  checkOutput(command.output, {".exr", ".png"});

  Progress progress("reference");
  LoadSceneOptions load;
  load.for_reference = true;
  load.missing_is_error = !isSceneFile(command.input);
  load.progress = [&progress](const std::string& step, double share) {
    progress.show(step, share);
  };
  const LoadedScene loaded(settings, load);
  options.camera = loaded.view().camera;
  progress.show("tracing", 0.0);
  options.progress = [&progress](double share) { progress.show("tracing", share); };
  const ReferencePicture picture = renderReference(loaded.scene(), view.daylight, options);
  const Exposure& exposure = view.exposure;
  const float average =
      exposure.ev ? shared::meteredLuminance(*exposure.ev) : averageLuminance(picture.image);
  const float white = exposure.white.value_or(automaticWhite(picture.image, average, exposure.key));
  if (std::filesystem::path(command.output).extension() == ".exr")
    writeExr(picture.image, command.output);
  else
    writePng(displayed(picture.image, average, exposure.key, white), command.output);
  progress.show("done");
  tellNotes(loaded, command.json);
  const double paths = static_cast<double>(options.width) * options.height * picture.samples;
  if (command.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"width", options.width},
                                              {"height", options.height},
                                              {"samples", picture.samples},
                                              {"noise", picture.noise},
                                              {"average_kcd_m2", average},
                                              {"white", white},
                                              {"seconds", picture.seconds},
                                              {"notes", loaded.notes()},
                                              {"paths_per_second", paths / picture.seconds}}
                           .dump(2));
  else
    fmt::print("{}: {}x{}, {} samples a pixel, noise {:.2g}, {:.1f} s ({:.2f} M paths/s)\n",
               command.output, options.width, options.height, picture.samples, picture.noise,
               picture.seconds, 1e-6 * paths / picture.seconds);
}

}  // namespace verdure::app
