#include "gpu/memory.h"

#include <algorithm>

#include "verdure/error.h"

namespace verdure::gpu {

MemoryPool::MemoryPool(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device)
    : device_(&device), properties_(physical.getMemoryProperties()) {}

std::uint32_t MemoryPool::typeFor(std::uint32_t type_bits, MemoryUse use) const {
  using Flag = vk::MemoryPropertyFlagBits;
  vk::MemoryPropertyFlags must, wish;
  switch (use) {
    case MemoryUse::kDevice:
      wish = Flag::eDeviceLocal;
      break;
    case MemoryUse::kToGpu:
      must = Flag::eHostVisible | Flag::eHostCoherent;
      break;
    case MemoryUse::kFromGpu:
      must = Flag::eHostVisible | Flag::eHostCoherent;
      wish = Flag::eHostCached;
      break;
  }
  for (const vk::MemoryPropertyFlags flags : {must | wish, must})
    for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i)
      if ((type_bits >> i & 1u) != 0 && (properties_.memoryTypes[i].propertyFlags & flags) == flags)
        return i;
  throw Error("Vulkan", "no memory type fits a resource", "update the driver");
}

Allocation MemoryPool::allocate(const vk::MemoryRequirements& need, MemoryUse use, bool for_image) {
  const std::uint32_t type = typeFor(need.memoryTypeBits, use);
  const bool wants_mapping = use != MemoryUse::kDevice;
  std::erase_if(blocks_, [](const auto& block) { return block.expired(); });
  for (const std::weak_ptr<MemoryBlock>& weak : blocks_) {
    const std::shared_ptr<MemoryBlock> block = weak.lock();
    // Software drivers have one type for all uses: a block that is not mapped must not be handed
    // out to be written.
    const bool mapped = block->mapped != nullptr;
    if (block->type != type || block->images != for_image || mapped != wants_mapping) continue;
    const vk::DeviceSize offset =
        (block->used + need.alignment - 1) / need.alignment * need.alignment;
    if (offset + need.size > block->size) continue;
    block->used = offset + need.size;
    return {block, offset, need.size};
  }
  auto block = std::make_shared<MemoryBlock>();
  block->size = std::max(kBlockBytes, need.size);
  block->type = type;
  block->images = for_image;
  block->used = need.size;
  try {
    block->memory =
        device_->allocateMemory({.allocationSize = block->size, .memoryTypeIndex = type});
  } catch (const vk::SystemError& e) {
    throw Error("Vulkan", "out of GPU memory (" + std::to_string(block->size >> 20) + " MiB more)",
                "use a smaller image, shadow map or scene");
  }
  if (wants_mapping)
    block->mapped = static_cast<std::byte*>(block->memory.mapMemory(0, VK_WHOLE_SIZE));
  blocks_.push_back(block);
  return {std::move(block), 0, need.size};
}

std::size_t MemoryPool::blockCount() const {
  return static_cast<std::size_t>(
      std::count_if(blocks_.begin(), blocks_.end(), [](const auto& b) { return !b.expired(); }));
}

}  // namespace verdure::gpu
