#ifndef VERDURE_GPU_MEMORY_H_
#define VERDURE_GPU_MEMORY_H_

#include <array>
#include <memory>
#include <vector>

#include "gpu/vulkan.h"

namespace verdure::gpu {

/// What memory is for: decides its type.
enum class MemoryUse {
  kDevice,   ///< read and written by the GPU
  kToGpu,    ///< written by the CPU: staging and uniforms, mapped
  kFromGpu,  ///< read by the CPU: readback, mapped, cached where there is a choice
};

struct MemoryBlock {
  vk::raii::DeviceMemory memory = nullptr;
  vk::DeviceSize size = 0;
  vk::DeviceSize used = 0;
  std::uint32_t type = 0;
  bool images = false;
  std::byte* mapped = nullptr;
};

/// A range of a block; the block lives as long as one of its ranges does.
struct Allocation {
  std::shared_ptr<MemoryBlock> block;
  vk::DeviceSize offset = 0;
  vk::DeviceSize size = 0;
  std::byte* mapped() const { return block->mapped != nullptr ? block->mapped + offset : nullptr; }
};

/// Hands out ranges of a few big blocks, because drivers allow only some thousand allocations
/// (maxMemoryAllocationCount). Ranges are taken from a block one after another and not reused one
/// by one: a block is freed as a whole when its last range goes, which suits scenes and frame
/// targets, born and gone together. Images and buffers never share a block, so that
/// bufferImageGranularity does not matter.
class MemoryPool {
 public:
  static constexpr vk::DeviceSize kBlockBytes = vk::DeviceSize{32} << 20;

  MemoryPool(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device);

  /// Throws Error when no memory is left.
  Allocation allocate(const vk::MemoryRequirements& need, MemoryUse use, bool for_image);
  /// Blocks that live now.
  std::size_t blockCount() const;

 private:
  std::uint32_t typeFor(std::uint32_t type_bits, MemoryUse use) const;

  const vk::raii::Device* device_;
  vk::PhysicalDeviceMemoryProperties properties_;
  std::vector<std::weak_ptr<MemoryBlock>> blocks_;
};

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_MEMORY_H_
