#ifndef VERDURE_GPU_DEVICE_H_
#define VERDURE_GPU_DEVICE_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/memory.h"
#include "gpu/vulkan.h"

namespace verdure::gpu {

/// What a window gives a device that shows pictures in it.
struct WindowSurface {
  std::vector<std::string> instance_extensions;
  std::function<VkSurfaceKHR(VkInstance)> make;  ///< throws Error
};

/// A Vulkan 1.3 device with dynamic rendering, synchronization2 and one graphics queue. Neither
/// copied nor moved: everything made from it keeps a pointer to it.
class Device {
 public:
  /// `name`: part of the device's name, any case; empty = the first discrete GPU, else the first
  /// device. Throws Error (with what to install) when there is no loader, driver or fitting device,
  /// or no validation layer although `validation` asks for it. With a window: a device that can
  /// present there; the window must outlive it.
  Device(const std::string& name, bool validation, const WindowSurface* window = nullptr);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const vk::raii::Device& raii() const { return device_; }
  const vk::raii::PhysicalDevice& physical() const { return physical_; }
  const vk::PhysicalDeviceLimits& limits() const { return limits_; }
  const std::string& name() const { return name_; }
  MemoryPool& memory() const { return *memory_; }
  float maxAnisotropy() const { return max_anisotropy_; }  ///< 1 = none
  /// Warnings and errors of the validation layer so far; each was printed to standard error.
  int validationMessages() const;
  /// Of the window that it was made for, else null.
  vk::SurfaceKHR surface() const { return *surface_; }
  const vk::raii::Queue& queue() const { return queue_; }
  std::uint32_t queueFamily() const { return family_; }

  /// Records commands, submits them and waits until they are done.
  void submit(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;

 private:
  struct Messages;
  void chooseDevice(const std::string& name);

  std::unique_ptr<Messages> messages_;
  std::unique_ptr<vk::raii::Context> context_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  vk::raii::SurfaceKHR surface_ = nullptr;
  vk::raii::PhysicalDevice physical_ = nullptr;
  std::uint32_t family_ = 0;
  vk::PhysicalDeviceLimits limits_;
  std::string name_;
  float max_anisotropy_ = 1.0f;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::CommandPool pool_ = nullptr;
  std::unique_ptr<MemoryPool> memory_;
};

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_DEVICE_H_
