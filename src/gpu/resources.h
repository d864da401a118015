#ifndef VERDURE_GPU_RESOURCES_H_
#define VERDURE_GPU_RESOURCES_H_

#include <span>
#include <vector>

#include "gpu/barrier.h"
#include "gpu/device.h"

namespace verdure::gpu {

struct Buffer {
  Allocation memory;  ///< outlives `buffer` (destroyed after it)
  vk::raii::Buffer buffer = nullptr;
  vk::DeviceSize size = 0;
};

/// A buffer of `size` bytes, at least 1 (so that empty scenes need no special case).
Buffer makeBuffer(const Device& device, vk::DeviceSize size, vk::BufferUsageFlags usage,
                  MemoryUse use);

struct ImageRequest {
  vk::Format format = vk::Format::eUndefined;
  std::uint32_t width = 1, height = 1;
  std::uint32_t mips = 1;
  std::uint32_t layers = 0;  ///< of a 2-D array; 0 = no array
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  vk::ImageUsageFlags usage;
  vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eColor;
};

/// A 2-D image and the view of all of it.
struct Texture {
  Allocation memory;
  vk::raii::Image image = nullptr;
  vk::raii::ImageView view = nullptr;
  std::vector<vk::raii::ImageView> layer_views;  ///< of an array: to draw to
  ImageRequest request;
};

/// Throws Error if the size or the number of layers is over the device's limit.
Texture makeTexture(const Device& device, const ImageRequest& request);

/// One level of an 8-bit RGBA picture on the CPU.
struct MipLevel {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Copies to the GPU, gathered and done together by finish().
class Upload {
 public:
  explicit Upload(const Device& device) : device_(&device) {}

  /// A new device-local buffer with these bytes, ready as vertex input.
  template <class T>
  Buffer buffer(std::span<const T> data, vk::BufferUsageFlags usage) {
    return bufferBytes(std::as_bytes(data), usage);
  }
  /// A new texture of 4 x 8 bits with these mips, largest first, ready for fragment shaders.
  Texture texture(std::span<const MipLevel> mips, vk::Format format);
  /// The same as an array of layers, each with its mips, all of one size.
  Texture textureArray(std::span<const std::vector<MipLevel>> layers, vk::Format format);
  /// Submits all copies and waits.
  void finish();

 private:
  struct Copy {
    Buffer staging;
    vk::Buffer buffer = {};  ///< target, or
    vk::Image image = {};    ///< target
    std::vector<vk::BufferImageCopy> regions = {};
  };
  Texture layered(std::span<const std::span<const MipLevel>> layers, bool array, vk::Format format);
  Buffer bufferBytes(std::span<const std::byte> data, vk::BufferUsageFlags usage);

  const Device* device_;
  std::vector<Copy> copies_;
};

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_RESOURCES_H_
