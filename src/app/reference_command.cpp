// reference.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "base/progress.h"
#include "scene/display.h"
#include "shared/tone.h"
#include "verdure/error.h"
#include "verdure/reference.h"

namespace verdure::app {

void runReference(const ReferenceCommand& command) {
  ReferenceOptions options;
  std::tie(options.width, options.height) = command.sizeInPixels();
  command.checkCamera();
  const Daylight light = parseDaylight(command.daylight);
  const Exposure exposure = parseExposure(command.exposure);
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
  const Wind wind = command.wind.wind(false);

  Progress progress("reference");
  progress.show("loading");
  Plant plant = loadPlant(command.input, command.load);
  restoreLeafNormals(plant);
  const Scene scene = command.sceneOf(plant, nullptr);
  options.camera = command.cameraFor(
      scene, static_cast<float>(options.width) / static_cast<float>(options.height));
  // Looked at as the plant at rest is, as render does.
  if (wind.speed > 0.0f)
    movePlant(motionFor(plant), wind, command.wind.time.value_or(0.0), {}, plant);
  progress.show("tracing", 0.0);
  options.progress = [&progress](double share) { progress.show("tracing", share); };
  const ReferencePicture picture = renderReference(scene, light, options);
  const float average =
      exposure.ev ? shared::meteredLuminance(*exposure.ev) : averageLuminance(picture.image);
  const float white = exposure.white.value_or(automaticWhite(picture.image, average, exposure.key));
  if (std::filesystem::path(command.output).extension() == ".exr")
    writeExr(picture.image, command.output);
  else
    writePng(displayed(picture.image, average, exposure.key, white), command.output);
  progress.show("done");
  const double paths = static_cast<double>(options.width) * options.height * picture.samples;
  if (command.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"width", options.width},
                                              {"height", options.height},
                                              {"samples", picture.samples},
                                              {"noise", picture.noise},
                                              {"average_kcd_m2", average},
                                              {"white", white},
                                              {"seconds", picture.seconds},
                                              {"paths_per_second", paths / picture.seconds}}
                           .dump(2));
  else
    fmt::print("{}: {}x{}, {} samples a pixel, noise {:.2g}, {:.1f} s ({:.2f} M paths/s)\n",
               command.output, options.width, options.height, picture.samples, picture.noise,
               picture.seconds, 1e-6 * paths / picture.seconds);
}

}  // namespace verdure::app
