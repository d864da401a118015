// render.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/loaded_scene.h"
#include "app/video.h"
#include "base/files.h"
#include "base/progress.h"
#include "shared/tone.h"
#include "verdure/error.h"

namespace verdure::app {

void checkOutput(const std::string& path, const std::vector<std::string>& extensions) {
  if (std::find(extensions.begin(), extensions.end(), std::filesystem::path(path).extension()) ==
      extensions.end())
    throw Error(path, "is not a kind of file that can be written",
                fmt::format("use {}", fmt::join(extensions, " or ")));
  checkWritable(path);
}

namespace {

/// First and last frame.
std::optional<std::pair<int, int>> framesOf(const RenderCommand& command) {
  if (command.fps < 1 || command.fps > 240)
    throw Error("--fps", fmt::format("{} is out of range", command.fps), "choose 1 to 240");
  if (command.frames.empty()) return std::nullopt;
  const std::size_t colon = command.frames.find(':');
  int first = 0, last = 0;
  const auto read = [](const std::string& text, int& out) {
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), out);
    return problem == std::errc() && end == text.data() + text.size();
  };
  if (colon == std::string::npos || !read(command.frames.substr(0, colon), first) ||
      !read(command.frames.substr(colon + 1), last) || first < 0)
    throw Error("--frames", fmt::format("'{}' is no range of frames", command.frames),
                "write FIRST:LAST, like 0:95");
  if (last < first)
    throw Error("--frames", fmt::format("{} is before {}", last, first),
                fmt::format("write {}:{}", last, first));
  if (last >= 1000000)
    throw Error("--frames", fmt::format("{} is out of range", last), "choose up to 999999");
  if (!command.motion_vectors.empty())
    throw Error("--motion-vectors", "is for one picture, not for frames", "leave one out");
  return std::pair(first, last);
}

/// Motion vectors as a picture: red to the right, green down, pixels.
HdrImage asPicture(const Frame& frame) {
  HdrImage picture(frame.image.width, frame.image.height);
  for (std::size_t i = 0; i < frame.motion.size(); ++i)
    picture.rgb[i] = glm::vec3(frame.motion[i], 0.0f);
  return picture;
}

/// All frames of a film, lit and exposed as its first. Returns that.
Frame drawFilm(const RenderCommand& command, const std::pair<int, int>& frames, View view,
               Renderer& renderer, Progress& progress) {
  Video video(command.output, command.fps);
  const double start = view.seconds;
  std::optional<Frame> first;
  for (int n = frames.first; n <= frames.second; ++n) {
    const int count = frames.second - frames.first + 1;
    progress.show(fmt::format("frame {} of {}", n - frames.first + 1, count),
                  static_cast<double>(n - frames.first) / count);
    view.seconds = start + static_cast<double>(n) / command.fps;
    Frame frame = renderer.render(view);
    video.add(frame.image, n);
    if (first) continue;
    if (!view.exposure.ev && frame.average_luminance > 0.0f)
      view.exposure.ev = std::log2(frame.average_luminance / shared::meteredLuminance(0.0f));
    view.exposure.white = frame.white;
    view.shadow_cascades = frame.shadow_cascades;
    first = std::move(frame);
  }
  video.finish();
  return std::move(*first);
}

}  // namespace

void runRender(const RenderCommand& command) {
  const SceneSettings settings = command.settings();
  const View checked = viewOf(settings);  // what is wrong is said before long work
  command.bake.fieldOr(BakeField::kOpticalDepth);
  command.bake.checked();
  command.bake.checkedDepth();
  if (settings.plants.empty() && !settings.ground.any())
    throw Error("render", "no plant is named", "name a file, or --grass or --terrain");
  const auto frames = framesOf(command);
  if (frames)
    Video(command.output, command.fps);  // what it lacks is said before long work
  else
    checkOutput(command.output, {".png", ".exr"});
  if (!command.motion_vectors.empty()) checkOutput(command.motion_vectors, {".exr"});
  if (!command.save_scene.empty()) checkOutput(command.save_scene, {".json"});
  const bool hdr = std::filesystem::path(command.output).extension() == ".exr";
  if (hdr && checked.style != Style::kPhoto)
    throw Error(command.output, "a drawn style has no light to write", "use .png");

  Progress progress("render");
  progress.show("device");
  Renderer renderer(command.device);
  LoadSceneOptions load;
  load.film = frames.has_value();
  load.missing_is_error = !isSceneFile(command.input);
  load.progress = [&progress](const std::string& step, double share) {
    progress.show(step, share);
  };
  const LoadedScene loaded(settings, load);
  View view = loaded.view();
  view.hdr = hdr;
  progress.show("drawing");
  renderer.setScene(loaded.scene());
  if (!command.motion_vectors.empty())
    view.last = {view.camera, view.wind, view.seconds - 1.0 / command.fps};
  const Frame frame =
      frames ? drawFilm(command, *frames, view, renderer, progress) : renderer.render(view);
  if (!command.motion_vectors.empty()) writeExr(asPicture(frame), command.motion_vectors);
  if (!frames && view.hdr) writeExr(frame.hdr, command.output);
  if (!frames && !view.hdr) writePng(frame.image, command.output);
  command.save(settings);
  progress.show("done");
  tellNotes(loaded, command.json);
  if (command.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{{"device", renderer.deviceName()},
                                      {"light", loaded.lightName()},
                                      {"width", view.width},
                                      {"height", view.height},
                                      {"bake_seconds", loaded.bakeSeconds()},
                                      {"pack_ms", frame.times.pack_ms},
                                      {"motion_ms", frame.times.motion_ms},
                                      {"shadow_ms", frame.times.shadow_ms},
                                      {"color_ms", frame.times.color_ms},
                                      {"tone_ms", frame.times.tone_ms},
                                      {"average_kcd_m2", frame.average_luminance},
                                      {"white", frame.white},
                                      {"shadow_cascades", frame.shadow_cascades},
                                      {"notes", loaded.notes()},
                                      {"validation_messages", renderer.validationMessages()}}
                   .dump(2));
    return;
  }
  fmt::print("{}: {}x{}, {} light, on {}; shadow {:.1f} ms, colour {:.1f} ms, tone {:.1f} ms\n",
             command.output, view.width, view.height, loaded.lightName(), renderer.deviceName(),
             frame.times.shadow_ms, frame.times.color_ms, frame.times.tone_ms);
}

}  // namespace verdure::app
