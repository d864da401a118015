#include "render/half_texture.h"

#include <cstring>
#include <glm/gtc/packing.hpp>

namespace verdure {
namespace {

constexpr float kLargest = 65000.0f;

}  // namespace

HalfTexture::HalfTexture(const gpu::Device& device, std::uint32_t width, std::uint32_t height)
    : texture_(gpu::makeTexture(device, {.format = vk::Format::eR16G16B16A16Sfloat,
                                         .width = width,
                                         .height = height,
                                         .usage = vk::ImageUsageFlagBits::eSampled |
                                                  vk::ImageUsageFlagBits::eTransferDst})),
      staging_(gpu::makeBuffer(device, vk::DeviceSize{width} * height * 8,
                               vk::BufferUsageFlagBits::eTransferSrc, gpu::MemoryUse::kToGpu)) {
  std::memset(staging_.memory.mapped(), 0, staging_.size);
}

void HalfTexture::set(int x, int y, const glm::vec3& color) {
  const glm::vec3 cut = glm::clamp(color, glm::vec3(0.0f), glm::vec3(kLargest));
  const std::uint64_t texel = glm::packHalf4x16(glm::vec4(cut, 1.0f));
  const auto at =
      static_cast<std::size_t>(y) * texture_.request.width + static_cast<std::size_t>(x);
  std::memcpy(staging_.memory.mapped() + at * sizeof(texel), &texel, sizeof(texel));
}

void HalfTexture::record(const vk::raii::CommandBuffer& commands) const {
  gpu::imageBarrier(commands, *texture_.image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kTransferTarget);
  commands.copyBufferToImage(
      *staging_.buffer, *texture_.image, vk::ImageLayout::eTransferDstOptimal,
      vk::BufferImageCopy{.imageSubresource = {.aspectMask = gpu::kColorAspect, .layerCount = 1},
                          .imageExtent = {texture_.request.width, texture_.request.height, 1}});
  gpu::imageBarrier(commands, *texture_.image, gpu::kColorAspect, gpu::Use::kTransferTarget,
                    gpu::Use::kDrawSampled);
}

}  // namespace verdure
