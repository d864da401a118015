// render.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/style_names.h"
#include "app/video.h"
#include "base/files.h"
#include "base/progress.h"
#include "shared/tone.h"
#include "verdure/error.h"
#include "verdure/leaf_visibility.h"

namespace verdure::app {
namespace {

ShadowSource shadowSource(const std::string& name) {
  if (name == "map") return ShadowSource::kShadowMap;
  if (name == "paper") return ShadowSource::kDepthPaper;
  if (name == "layers") return ShadowSource::kDepthLayers;
  if (name == "ordered") return ShadowSource::kDepthOrdered;
  throw Error("--shadows", fmt::format("'{}' is unknown", name),
              "use map, paper, layers or ordered");
}

Terms parseTerms(const RenderCommand& command) {
  Terms terms = presetTerms(command.light);
  if (!command.shadows.empty()) terms.shadow_source = shadowSource(command.shadows);
  if (command.terms.empty()) return terms;
  terms.ambient = terms.diffuse = terms.specular = terms.shadow = terms.textures =
      terms.transmission = terms.scattering = terms.gloss = false;
  std::size_t begin = 0;
  while (begin <= command.terms.size()) {
    const std::size_t end = std::min(command.terms.find(',', begin), command.terms.size());
    const std::string name = command.terms.substr(begin, end - begin);
    bool* const term = name == "ambient"        ? &terms.ambient
                       : name == "diffuse"      ? &terms.diffuse
                       : name == "specular"     ? &terms.specular
                       : name == "shadow"       ? &terms.shadow
                       : name == "textures"     ? &terms.textures
                       : name == "transmission" ? &terms.transmission
                       : name == "scattering"   ? &terms.scattering
                       : name == "gloss"        ? &terms.gloss
                                                : nullptr;
    if (term == nullptr)
      throw Error("--terms", fmt::format("'{}' is unknown", name),
                  "use ambient, diffuse, specular, shadow, textures, transmission, scattering, "
                  "gloss");
    *term = true;
    begin = end + 1;
  }
  return terms;
}

}  // namespace

void checkOutput(const std::string& path, const std::vector<std::string>& extensions) {
  if (std::find(extensions.begin(), extensions.end(), std::filesystem::path(path).extension()) ==
      extensions.end())
    throw Error(path, "is not a kind of file that can be written",
                fmt::format("use {}", fmt::join(extensions, " or ")));
  checkWritable(path);
}

std::vector<float> parseNumbers(const std::string& option, const std::string& text,
                                std::size_t count) {
  std::vector<float> numbers;
  const char *at = text.data(), *const end = text.data() + text.size();
  for (;;) {
    float value = 0.0f;
    const auto [next, problem] = std::from_chars(at, end, value);
    if (problem != std::errc() || !std::isfinite(value) || (next != end && *next != ','))
      throw Error(option,
                  fmt::format("'{}' is no {}", text, count == 1 ? "number" : "list of numbers"),
                  count == 1 ? "write one like 2.5" : "separate them by commas");
    numbers.push_back(value);
    if (next == end) break;
    at = next + 1;
  }
  if (count != 0 && numbers.size() != count)
    throw Error(option, fmt::format("'{}' has {} numbers", text, numbers.size()),
                fmt::format("write {}", count));
  return numbers;
}

std::pair<int, int> parseSize(const std::string& text) {
  const std::size_t x = text.find('x');
  int width = 0, height = 0;
  const auto read = [](const std::string& part, int& out) {
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), out);
    return problem == std::errc() && end == part.data() + part.size();
  };
  if (x == std::string::npos || !read(text.substr(0, x), width) ||
      !read(text.substr(x + 1), height))
    throw Error("--size", fmt::format("'{}' is no size", text), "write 960x720");
  if (width <= 0 || height <= 0)
    throw Error("--size", fmt::format("'{}' has no pixels", text), "write 960x720");
  return {width, height};
}

std::optional<CrownLight> lightOfFile(const Plant& plant) {
  CrownLight light;
  bool any = false;
  for (const Mesh& mesh : plant.meshes) {
    MeshLight part{mesh.normals, mesh.ambient, mesh.visibility};
    any = any || !mesh.ambient.empty() || !mesh.visibility.empty();
    if (part.ambient.empty()) part.ambient.assign(mesh.positions.size(), 1.0f);
    for (float& k : part.ambient) k = std::clamp(k, 1.0f / 255.0f, 1.0f);
    light.meshes.push_back(std::move(part));
  }
  if (!any) return std::nullopt;
  return light;
}

namespace {

/// Adds leaf visibility to a light that has none. Returns the seconds that it took.
double addLeafVisibility(const Plant& plant, Progress& progress, CrownLight& light) {
  if (std::any_of(light.meshes.begin(), light.meshes.end(),
                  [](const MeshLight& mesh) { return !mesh.visibility.empty(); }))
    return 0.0;
  Timer timer;
  LeafVisibilityOptions looks;
  looks.progress = [&progress](double share) {
    progress.show("leaf visibility", share);
    return true;
  };
  setLeafVisibility(plant, leafVisibility(plant, looks), light);
  return timer.seconds();
}

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

/// The plant that is shown, with the light that the view asks for.
struct ShownPlant {
  Plant plant;
  std::optional<PlantTransfer> transfer;
  std::optional<CrownLight> light;
  std::optional<PlantMotion> motion;
  double bake_seconds = 0.0;
  std::vector<std::string> notes;  ///< how its branches were found

  /// Light that the file lacks is baked, or done without.
  ShownPlant(const RenderCommand& command, View& view, Progress& progress) {
    // The preset `expressive` means the field of its paper.
    const BakeField field = command.bake.fieldOr(
        command.light == "expressive" ? BakeField::kMetaball : BakeField::kOpticalDepth);
    progress.show("loading");
    plant = loadPlant(command.input, command.load);
    if (view.terms.ambient_source == AmbientSource::kTransfer) {
      transfer = loadTransfer(command.input, plant);
      if (!transfer && command.light == "best")
        view.terms.ambient_source = AmbientSource::kBaked;
      else if (!transfer)
        throw Error(command.input,
                    fmt::format("has no transfer vectors ({} is not there)",
                                transferPath(command.input).string()),
                    "trace them with verdure bake --transfer 5");
    }
    // The file's own bake, or one made now; a light without baked terms needs neither.
    if (!command.bake_again) light = lightOfFile(plant);
    const bool visible_terms = view.terms.ambient_source == AmbientSource::kLeafVisibility;
    if (!light && (needsBake(view) || visible_terms)) {
      progress.show("baking");
      if (field == BakeField::kMetaball) {
        DensityBake bake = bakeDensity(plant, command.bake.checked());
        light = std::move(bake.light);
        bake_seconds = bake.report.seconds_total;
      } else {
        DepthBake bake = bakeOpticalDepth(plant, command.bake.checkedDepth());
        light = std::move(bake.light);
        bake_seconds = bake.report.seconds_total;
      }
    }
    if (visible_terms) bake_seconds += addLeafVisibility(plant, progress, *light);
    if (needsLeafNormals(view)) restoreLeafNormals(plant);
    if (view.wind.speed > 0.0f) {
      progress.show("motion");
      motion = motionFor(plant);
      for (const std::string& note : plant.notes)
        if (note.starts_with("branches: ")) notes.push_back(note);
    }
  }

  /// It alone; lives no longer than this.
  Scene scene(const RenderCommand& command) const {
    Scene scene = command.sceneOf(plant, light ? &*light : nullptr);
    if (transfer) scene.items[0].transfer = &*transfer;
    if (motion) scene.items[0].motion = &*motion;
    return scene;
  }
};

}  // namespace

void runRender(const RenderCommand& command) {
  View view;
  std::tie(view.width, view.height) = command.sizeInPixels();
  view.terms = parseTerms(command);
  view.daylight = parseDaylight(command.daylight);
  view.exposure = parseExposure(command.exposure);
  view.bloom = parseBloom(command.exposure);
  if (command.bands < 2 || command.bands > 7)
    throw Error("--bands", fmt::format("{} is out of range", command.bands), "choose 2 to 7");
  view.sky_bands = command.bands;
  if (!(command.visibility_exponent > 0.0f) || !std::isfinite(command.visibility_exponent))
    throw Error("--visibility-exponent", "must be a number above 0", "1 is usual");
  view.visibility_exponent = command.visibility_exponent;
  command.checkCamera();
  if (!command.background.empty()) {
    const auto rgb = parseNumbers("--background", command.background, 3);
    for (const float c : rgb)
      if (c < 0.0f || c > 1.0f)
        throw Error("--background", fmt::format("{:g} is out of range", c),
                    "write R,G,B in [0, 1]");
    view.background = glm::vec3(rgb[0], rgb[1], rgb[2]);
  }
  if (command.shadow_map < 16)
    throw Error("--shadow-map", "must be at least 16 pixels", "2048 is usual");
  view.shadow_map_size = command.shadow_map;
  if (command.cascades != "auto") {
    if (command.cascades.size() != 1 || command.cascades[0] < '1' || command.cascades[0] > '4')
      throw Error("--cascades", fmt::format("'{}' is out of range", command.cascades),
                  "choose auto or 1 to 4");
    view.shadow_cascades = command.cascades[0] - '0';
  }
  view.style = parseStyle(command.style);
  view.style_normals = parseStyleNormals(command.style_normals);
  command.bake.fieldOr(BakeField::kOpticalDepth);  // what is wrong is said before long work
  command.bake.checked();
  command.bake.checkedDepth();
  if (command.input.empty() && !command.ground.any())
    throw Error("render", "no plant is named", "name a file, or --grass or --terrain");
  const auto frames = framesOf(command);
  if (frames)
    Video(command.output, command.fps);  // what it lacks is said before long work
  else
    checkOutput(command.output, {".png", ".exr"});
  view.wind = command.wind.wind(frames.has_value());
  view.seconds = command.wind.time.value_or(0.0);
  if (!command.motion_vectors.empty()) checkOutput(command.motion_vectors, {".exr"});
  view.hdr = std::filesystem::path(command.output).extension() == ".exr";
  if (view.hdr && view.style != Style::kPhoto)
    throw Error(command.output, "a drawn style has no light to write", "use .png");

  Progress progress("render");
  progress.show("device");
  Renderer renderer(command.device);
  std::optional<ShownPlant> shown;
  Scene scene;
  scene.ground = !command.no_ground;
  if (!command.input.empty()) {
    shown.emplace(command, view, progress);
    scene = shown->scene(command);
  } else if (command.light == "best") {
    view.terms.ambient_source = AmbientSource::kBaked;
  }
  SceneGround ground;
  if (command.ground.any()) {
    progress.show("ground");
    ground = makeGround(command.ground);
    ground.layUnder(scene, command.ground);
  }
  view.camera =
      command.cameraFor(scene, static_cast<float>(view.width) / static_cast<float>(view.height));
  progress.show("drawing");
  renderer.setScene(scene);
  if (!command.motion_vectors.empty())
    view.last = {view.camera, view.wind, view.seconds - 1.0 / command.fps};
  const Frame frame =
      frames ? drawFilm(command, *frames, view, renderer, progress) : renderer.render(view);
  if (!command.motion_vectors.empty()) writeExr(asPicture(frame), command.motion_vectors);
  if (!frames && view.hdr) writeExr(frame.hdr, command.output);
  if (!frames && !view.hdr) writePng(frame.image, command.output);
  progress.show("done");
  const std::vector<std::string> notes = shown ? shown->notes : std::vector<std::string>();
  const std::string light_name =
      command.light == "best"
          ? (shown && shown->transfer ? "best (transfer vectors)" : "best (baked)")
          : command.light;
  if (command.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{{"device", renderer.deviceName()},
                                      {"light", light_name},
                                      {"width", view.width},
                                      {"height", view.height},
                                      {"bake_seconds", shown ? shown->bake_seconds : 0.0},
                                      {"pack_ms", frame.times.pack_ms},
                                      {"motion_ms", frame.times.motion_ms},
                                      {"shadow_ms", frame.times.shadow_ms},
                                      {"color_ms", frame.times.color_ms},
                                      {"tone_ms", frame.times.tone_ms},
                                      {"average_kcd_m2", frame.average_luminance},
                                      {"white", frame.white},
                                      {"shadow_cascades", frame.shadow_cascades},
                                      {"notes", notes},
                                      {"validation_messages", renderer.validationMessages()}}
                   .dump(2));
    return;
  }
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
  fmt::print("{}: {}x{}, {} light, on {}; shadow {:.1f} ms, colour {:.1f} ms, tone {:.1f} ms\n",
             command.output, view.width, view.height, light_name, renderer.deviceName(),
             frame.times.shadow_ms, frame.times.color_ms, frame.times.tone_ms);
}

}  // namespace verdure::app
