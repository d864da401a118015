#include "gpu/resources.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "verdure/error.h"

namespace verdure::gpu {

Buffer makeBuffer(const Device& device, vk::DeviceSize size, vk::BufferUsageFlags usage,
                  MemoryUse use) {
  Buffer made;
  made.size = std::max<vk::DeviceSize>(size, 1);
  made.buffer = device.raii().createBuffer({.size = made.size, .usage = usage});
  made.memory = device.memory().allocate(made.buffer.getMemoryRequirements(), use, false);
  made.buffer.bindMemory(*made.memory.block->memory, made.memory.offset);
  return made;
}

Texture makeTexture(const Device& device, const ImageRequest& request) {
  const std::uint32_t limit = device.limits().maxImageDimension2D;
  if (request.width == 0 || request.height == 0 || request.width > limit || request.height > limit)
    throw Error("image",
                std::to_string(request.width) + " x " + std::to_string(request.height) +
                    " pixels are not between 1 and the device's limit of " + std::to_string(limit),
                "choose another size");
  const std::uint32_t layers = std::max(request.layers, 1u);
  if (layers > device.limits().maxImageArrayLayers)
    throw Error("image", std::to_string(layers) + " layers are more than the device has",
                "choose fewer");
  Texture made;
  made.request = request;
  made.image = device.raii().createImage({.imageType = vk::ImageType::e2D,
                                          .format = request.format,
                                          .extent = {request.width, request.height, 1},
                                          .mipLevels = request.mips,
                                          .arrayLayers = layers,
                                          .samples = request.samples,
                                          .usage = request.usage});
  made.memory =
      device.memory().allocate(made.image.getMemoryRequirements(), MemoryUse::kDevice, true);
  made.image.bindMemory(*made.memory.block->memory, made.memory.offset);
  const auto viewOf = [&](vk::ImageViewType type, std::uint32_t first, std::uint32_t count) {
    return device.raii().createImageView({.image = *made.image,
                                          .viewType = type,
                                          .format = request.format,
                                          .subresourceRange = {.aspectMask = request.aspect,
                                                               .levelCount = request.mips,
                                                               .baseArrayLayer = first,
                                                               .layerCount = count}});
  };
  using Type = vk::ImageViewType;
  made.view = viewOf(request.layers > 0 ? Type::e2DArray : Type::e2D, 0, layers);
  for (std::uint32_t layer = 0; layer < request.layers; ++layer)
    made.layer_views.push_back(viewOf(Type::e2D, layer, 1));
  return made;
}

Buffer Upload::bufferBytes(std::span<const std::byte> data, vk::BufferUsageFlags usage) {
  Buffer target = makeBuffer(*device_, data.size(), usage | vk::BufferUsageFlagBits::eTransferDst,
                             MemoryUse::kDevice);
  if (data.empty()) return target;
  Copy copy{.staging = makeBuffer(*device_, data.size(), vk::BufferUsageFlagBits::eTransferSrc,
                                  MemoryUse::kToGpu),
            .buffer = *target.buffer};
  std::memcpy(copy.staging.memory.mapped(), data.data(), data.size());
  copies_.push_back(std::move(copy));
  return target;
}

Texture Upload::texture(std::span<const MipLevel> mips, vk::Format format) {
  return layered({&mips, 1}, false, format);
}

Texture Upload::textureArray(std::span<const std::vector<MipLevel>> layers, vk::Format format) {
  const std::vector<std::span<const MipLevel>> spans(layers.begin(), layers.end());
  return layered(spans, true, format);
}

Texture Upload::layered(std::span<const std::span<const MipLevel>> layers, bool array,
                        vk::Format format) {
  VERDURE_CHECK_LT(std::size_t{0}, layers.size());
  VERDURE_CHECK_LT(std::size_t{0}, layers[0].size());
  using UsageBit = vk::ImageUsageFlagBits;
  Texture target =
      makeTexture(*device_, {.format = format,
                             .width = layers[0][0].width,
                             .height = layers[0][0].height,
                             .mips = static_cast<std::uint32_t>(layers[0].size()),
                             .layers = static_cast<std::uint32_t>(array ? layers.size() : 0),
                             .usage = UsageBit::eSampled | UsageBit::eTransferDst});
  std::size_t bytes = 0;
  for (const auto& mips : layers)
    for (const MipLevel& mip : mips) bytes += mip.rgba.size();
  Copy copy{.staging = makeBuffer(*device_, bytes, vk::BufferUsageFlagBits::eTransferSrc,
                                  MemoryUse::kToGpu),
            .image = *target.image};
  std::size_t offset = 0;
  for (std::uint32_t layer = 0; layer < layers.size(); ++layer)
    for (std::uint32_t level = 0; level < layers[0].size(); ++level) {
      const MipLevel& mip = layers[layer][level];
      VERDURE_CHECK_EQ(mip.rgba.size(), std::size_t{mip.width} * mip.height * 4);
      std::memcpy(copy.staging.memory.mapped() + offset, mip.rgba.data(), mip.rgba.size());
      copy.regions.push_back({.bufferOffset = offset,
                              .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                                                   .mipLevel = level,
                                                   .baseArrayLayer = layer,
                                                   .layerCount = 1},
                              .imageExtent = {mip.width, mip.height, 1}});
      offset += mip.rgba.size();
    }
  copies_.push_back(std::move(copy));
  return target;
}

void Upload::finish() {
  if (copies_.empty()) return;
  device_->submit([&](const vk::raii::CommandBuffer& commands) {
    for (const Copy& copy : copies_) {
      if (copy.buffer) {
        commands.copyBuffer(*copy.staging.buffer, copy.buffer,
                            vk::BufferCopy{.size = copy.staging.size});
        bufferBarrier(commands, copy.buffer, Use::kTransferTarget, Use::kVertexInput);
      } else {
        const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
        imageBarrier(commands, copy.image, color, Use::kUndefined, Use::kTransferTarget);
        commands.copyBufferToImage(*copy.staging.buffer, copy.image,
                                   vk::ImageLayout::eTransferDstOptimal, copy.regions);
        imageBarrier(commands, copy.image, color, Use::kTransferTarget, Use::kFragmentSampled);
      }
    }
  });
  copies_.clear();
}

}  // namespace verdure::gpu
