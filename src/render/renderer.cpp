#include <optional>

#include "base/progress.h"
#include "render/frame.h"
#include "verdure/error.h"
#include "verdure/render.h"

namespace verdure {
namespace {

struct Preset {
  const char* name;
  Terms terms;
};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all{
      {"standard", {.normal = NormalSource::kLeaf, .ambient_source = AmbientSource::kConstant}},
      {"expressive", {.normal = NormalSource::kCrown, .ambient_source = AmbientSource::kBaked}},
      {"transfer",
       {.normal = NormalSource::kLeaf,
        .ambient_source = AmbientSource::kTransfer,
        .transmission = true,
        .gloss = true}},
      {"depth-maps",
       {.normal = NormalSource::kLeaf,
        .ambient_source = AmbientSource::kLeafVisibility,
        .shadow_source = ShadowSource::kDepthLayers,
        .transmission = true,
        .scattering = true}},
      {"habel",
       {.normal = NormalSource::kLeaf,
        .ambient_source = AmbientSource::kBaked,
        .transmission = true,
        .leaf = LeafModel::kMaps}},
      {"best",
       {.normal = NormalSource::kLeaf,
        .ambient_source = AmbientSource::kTransfer,
        .shadow_source = ShadowSource::kDepthOrdered,
        .transmission = true,
        .gloss = true,
        .leaf = LeafModel::kMaps}}};
  return all;
}

/// Runs `body`; what the driver reports becomes an Error.
template <class Body>
auto guarded(const std::string& device, const Body& body) {
  try {
    return body();
  } catch (const vk::Error& e) {
    throw Error(device.empty() ? "Vulkan" : device,
                std::string("the driver failed (") + e.what() + ")",
                "try a smaller image or scene, or another device");
  }
}

}  // namespace

Terms presetTerms(const std::string& name) {
  for (const Preset& preset : presets())
    if (name == preset.name) return preset.terms;
  std::string known;
  for (const Preset& preset : presets())
    known += (known.empty() ? "" : ", ") + std::string(preset.name);
  throw Error("preset", "no preset is called \"" + name + "\"", "choose one of " + known);
}

const std::vector<std::string>& presetNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Preset& preset : presets()) out.emplace_back(preset.name);
    return out;
  }();
  return names;
}

struct Renderer::State {
  explicit State(const DeviceOptions& options)
      : device(options.device, options.validation), frames(device) {}

  gpu::Device device;
  FrameDrawer frames;
  std::optional<GpuScene> scene;
  double pack_ms = 0.0;
};

Renderer::Renderer(const DeviceOptions& options)
    : state_(guarded("", [&options] { return std::make_unique<State>(options); })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const std::string& Renderer::deviceName() const {
  return state_->device.name();
}

int Renderer::validationMessages() const {
  return state_->device.validationMessages();
}

void Renderer::setScene(const Scene& scene) {
  const Timer timer;
  PackedScene packed = packScene(scene);
  guarded(deviceName(), [&] {
    state_->scene.reset();
    state_->frames.forgetScene();
    state_->scene.emplace(state_->device, std::move(packed), state_->frames.sceneLayouts());
  });
  state_->pack_ms = timer.seconds() * 1e3;
}

Frame Renderer::render(const View& view) {
  if (!state_->scene) setScene(Scene{});
  Frame frame = guarded(deviceName(), [&] { return state_->frames.draw(*state_->scene, view); });
  frame.times.pack_ms = state_->pack_ms;
  return frame;
}

}  // namespace verdure
