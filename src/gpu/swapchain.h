#ifndef VERDURE_GPU_SWAPCHAIN_H_
#define VERDURE_GPU_SWAPCHAIN_H_

#include <optional>

#include "gpu/resources.h"

namespace verdure::gpu {

/// The images of the device's window, made anew when its size changes. One frame is under way at a
/// time: what one reads may be changed after waitForFrame(). 8 bits a channel, as the display
/// expects them (sRGB values, not encoded again).
class Swapchain {
 public:
  /// The device must have a surface. Throws Error if that offers no usable format.
  explicit Swapchain(const Device& device);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  vk::Format format() const { return format_.format; }

  struct Target {
    vk::ImageView view;
    vk::Extent2D size;
  };
  /// Draws to the next image and presents it: `record` finds it in use kColorAttachment and leaves
  /// it so. `width`, `height`: of the window, pixels. False if there was nothing to draw to: the
  /// window is minimised or has just changed; another call then finds its new size. `capture`, if
  /// given, gets what was drawn, in RGBA; it stays empty where the device cannot read it.
  bool draw(std::uint32_t width, std::uint32_t height,
            const std::function<void(const vk::raii::CommandBuffer&, const Target&)>& record,
            std::vector<std::uint8_t>* capture = nullptr);
  /// Returns when the GPU is done with the last frame.
  void waitForFrame() const;
  vk::Extent2D size() const { return size_; }

 private:
  bool recreate(std::uint32_t width, std::uint32_t height);

  const Device* device_;
  vk::SurfaceFormatKHR format_;
  bool readable_ = false;
  vk::raii::SwapchainKHR swapchain_ = nullptr;
  vk::Extent2D size_{};
  std::vector<vk::Image> images_;
  std::vector<vk::raii::ImageView> views_;
  std::vector<vk::raii::Semaphore> drawn_;  ///< of each image: presenting waits for it
  vk::raii::Semaphore acquired_ = nullptr;
  vk::raii::Fence done_ = nullptr;
  vk::raii::CommandPool pool_ = nullptr;
  std::optional<vk::raii::CommandBuffer> commands_;
  bool stale_ = true;  ///< to be made anew before the next frame
};

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_SWAPCHAIN_H_
