#include "app/view/screen.h"

#include <array>
#include <optional>

#include "app/view/gui_pass.h"
#include "app/view/window.h"
#include "base/progress.h"
#include "render/frame.h"
#include "render/packed_light.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

gpu::WindowSurface surfaceOf(const Window& window) {
  return {Window::vulkanExtensions(),
          [&window](VkInstance instance) { return window.makeSurface(instance); }};
}

/// What the driver reports becomes an Error.
template <class Body>
auto guarded(const Body& body) {
  try {
    return body();
  } catch (const vk::Error& e) {
    throw Error("Vulkan", std::string("the driver failed (") + e.what() + ")",
                "try a smaller window or scene, or another device");
  }
}

}  // namespace

std::shared_ptr<PackedScene> packedScene(const Scene& scene) {
  return std::make_shared<PackedScene>(packScene(scene));
}

std::shared_ptr<PackedLight> packedLight(const Scene& scene) {
  return std::make_shared<PackedLight>(packLight(scene));
}

struct Screen::State {
  State(const Window& shown, const DeviceOptions& options)
      : window(&shown),
        surface(surfaceOf(shown)),
        device(options.device, options.validation, &surface),
        frames(device),
        swapchain(device),
        gui(device, swapchain.format()) {}

  GpuScene& sceneOrEmpty() {
    if (!scene) upload(packScene(Scene{}));
    return *scene;
  }
  void upload(PackedScene packed) {
    swapchain.waitForFrame();
    scene.reset();
    frames.forgetScene();
    scene.emplace(device, std::move(packed), frames.sceneLayouts());
  }
  Frame draw(const View& view, Inspection what, const gpu::Texture* target) {
    GpuScene& shown = sceneOrEmpty();
    frames.inspect(what);
    return frames.draw(shown, what == Inspection::kNothing ? view : inspectedView(view, what),
                       target);
  }
  /// A picture's texture, black if it is new.
  GuiTexture& pictureOf(std::size_t index, int width, int height) {
    std::unique_ptr<GuiTexture>& picture = pictures[index];
    const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
    if (picture && picture->texture.request.width == w && picture->texture.request.height == h)
      return *picture;
    return replace(index, {w, h, std::vector<std::uint8_t>(std::size_t{w} * h * 4)});
  }
  GuiTexture& replace(std::size_t index, const gpu::MipLevel& level) {
    gpu::Upload upload(device);
    gpu::Texture texture = upload.texture({&level, 1}, TonePass::kFormat);
    upload.finish();
    swapchain.waitForFrame();  // the old one may be shown
    pictures[index] = gui.add(std::move(texture));
    return *pictures[index];
  }

  const Window* window;
  gpu::WindowSurface surface;
  gpu::Device device;
  FrameDrawer frames;
  std::optional<GpuScene> scene;
  gpu::Swapchain swapchain;
  GuiPass gui;
  std::array<std::unique_ptr<GuiTexture>, kPictures> pictures;
  double pack_ms = 0.0;
};

Screen::Screen(const Window& window, const DeviceOptions& options)
    : state_(guarded([&] { return std::make_unique<State>(window, options); })) {}
Screen::~Screen() {
  try {
    state_->swapchain.waitForFrame();
  } catch (const std::exception&) {
    // A lost device has nothing pending.
  }
}

const std::string& Screen::deviceName() const {
  return state_->device.name();
}

int Screen::validationMessages() const {
  return state_->device.validationMessages();
}

void Screen::setScene(const std::shared_ptr<PackedScene>& packed) {
  const Timer timer;
  guarded([&] { state_->upload(std::move(*packed)); });
  state_->pack_ms = timer.seconds() * 1e3;
}

bool Screen::setLight(const PackedLight& light) {
  const Timer timer;
  const bool fits = state_->scene && guarded([&] {
                      state_->swapchain.waitForFrame();
                      return state_->scene->setLight(state_->device, light);
                    });
  if (fits) state_->pack_ms = timer.seconds() * 1e3;
  return fits;
}

Frame Screen::draw(int picture, const View& view, Inspection what) {
  Frame frame = guarded([&] {
    const GuiTexture& target =
        state_->pictureOf(static_cast<std::size_t>(picture), view.width, view.height);
    return state_->draw(view, what, &target.texture);
  });
  frame.times.pack_ms = state_->pack_ms;
  return frame;
}

void Screen::setPicture(int picture, const Image& image) {
  guarded([&] {
    state_->replace(static_cast<std::size_t>(picture),
                    {static_cast<std::uint32_t>(image.width),
                     static_cast<std::uint32_t>(image.height), image.rgba});
  });
}

void* Screen::texture(int picture) const {
  return state_->pictures[static_cast<std::size_t>(picture)].get();
}

Frame Screen::read(const View& view, Inspection what) {
  return guarded([&] { return state_->draw(view, what, nullptr); });
}

bool Screen::present(const ImDrawData& panels, Image* capture) {
  const glm::ivec2 size = state_->window->size();
  std::vector<std::uint8_t> bytes;
  const bool shown = guarded([&] {
    return state_->swapchain.draw(
        static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y),
        [&](const vk::raii::CommandBuffer& commands, const gpu::Swapchain::Target& target) {
          state_->gui.record(commands, target, panels);
        },
        capture != nullptr ? &bytes : nullptr);
  });
  if (!bytes.empty()) {
    const vk::Extent2D drawn = state_->swapchain.size();
    *capture = Image(static_cast<int>(drawn.width), static_cast<int>(drawn.height));
    capture->rgba = std::move(bytes);
  }
  return shown;
}

}  // namespace verdure::app
