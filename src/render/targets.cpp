#include "render/targets.h"

#include <cstring>
#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "render/frame_layout.h"
#include "render/tone_pass.h"

namespace verdure {
namespace {

using Usage = vk::ImageUsageFlagBits;

gpu::Texture makeTarget(const gpu::Device& device, std::uint32_t width, std::uint32_t height,
                        vk::Format format, vk::SampleCountFlagBits samples,
                        vk::ImageUsageFlags usage) {
  const bool depth = format == FrameLayout::kDepth;
  return gpu::makeTexture(device,
                          {.format = format,
                           .width = width,
                           .height = height,
                           .samples = samples,
                           .usage = usage,
                           .aspect = depth ? vk::ImageAspectFlagBits::eDepth : gpu::kColorAspect});
}

void recordCopy(const vk::raii::CommandBuffer& commands, const gpu::Texture& from,
                const gpu::Buffer& to) {
  commands.copyImageToBuffer(
      *from.image, vk::ImageLayout::eTransferSrcOptimal, *to.buffer,
      vk::BufferImageCopy{.imageSubresource = {.aspectMask = gpu::kColorAspect, .layerCount = 1},
                          .imageExtent = {from.request.width, from.request.height, 1}});
  gpu::bufferBarrier(commands, *to.buffer, gpu::Use::kTransferTarget, gpu::Use::kHostRead);
}

}  // namespace

Targets::Targets(const gpu::Device& device, std::uint32_t width, std::uint32_t height)
    : color(makeTarget(device, width, height, FrameLayout::kColor, FrameLayout::kSamples,
                       Usage::eColorAttachment | Usage::eSampled)),
      depth(makeTarget(device, width, height, FrameLayout::kDepth, FrameLayout::kSamples,
                       Usage::eDepthStencilAttachment | Usage::eSampled)),
      resolved(makeTarget(device, width, height, FrameLayout::kColor, vk::SampleCountFlagBits::e1,
                          Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc)),
      picture(makeTarget(device, width, height, TonePass::kFormat, vk::SampleCountFlagBits::e1,
                         Usage::eColorAttachment | Usage::eTransferSrc)),
      device_(&device),
      picture_readback_(gpu::makeBuffer(device, vk::DeviceSize{width} * height * 4,
                                        vk::BufferUsageFlagBits::eTransferDst,
                                        gpu::MemoryUse::kFromGpu)) {}

bool Targets::fits(int width, int height) const {
  return color.request.width == static_cast<std::uint32_t>(width) &&
         color.request.height == static_cast<std::uint32_t>(height);
}

void Targets::recordReadback(const vk::raii::CommandBuffer& commands, bool hdr) {
  gpu::imageBarrier(commands, *picture.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kTransferSource);
  recordCopy(commands, picture, picture_readback_);
  if (!hdr) return;
  if (!hdr_readback_)
    hdr_readback_ = gpu::makeBuffer(
        *device_, vk::DeviceSize{resolved.request.width} * resolved.request.height * 8,
        vk::BufferUsageFlagBits::eTransferDst, gpu::MemoryUse::kFromGpu);
  gpu::imageBarrier(commands, *resolved.image, gpu::kColorAspect, gpu::Use::kFragmentSampled,
                    gpu::Use::kTransferSource);
  recordCopy(commands, resolved, *hdr_readback_);
}

void Targets::recordHandOver(const vk::raii::CommandBuffer& commands,
                             const gpu::Texture& to) const {
  gpu::imageBarrier(commands, *picture.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kTransferSource);
  gpu::imageBarrier(commands, *to.image, gpu::kColorAspect, gpu::Use::kFragmentSampled,
                    gpu::Use::kTransferTarget);
  const vk::ImageSubresourceLayers layers{.aspectMask = gpu::kColorAspect, .layerCount = 1};
  commands.copyImage(*picture.image, vk::ImageLayout::eTransferSrcOptimal, *to.image,
                     vk::ImageLayout::eTransferDstOptimal,
                     vk::ImageCopy{.srcSubresource = layers,
                                   .dstSubresource = layers,
                                   .extent = {picture.request.width, picture.request.height, 1}});
  gpu::imageBarrier(commands, *to.image, gpu::kColorAspect, gpu::Use::kTransferTarget,
                    gpu::Use::kFragmentSampled);
}

Image Targets::readPicture() const {
  Image image(static_cast<int>(picture.request.width), static_cast<int>(picture.request.height));
  std::memcpy(image.rgba.data(), picture_readback_.memory.mapped(), image.rgba.size());
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

HdrImage Targets::readHdr(float units_per_kcd) const {
  HdrImage image(static_cast<int>(resolved.request.width),
                 static_cast<int>(resolved.request.height));
  const std::byte* texels = hdr_readback_->memory.mapped();
  parallelFor(image.rgb.size(), 1 << 14, [&](std::size_t i) {
    std::uint64_t texel = 0;
    std::memcpy(&texel, texels + i * sizeof(texel), sizeof(texel));
    image.rgb[i] = glm::vec3(glm::unpackHalf4x16(texel)) / units_per_kcd;
  });
  return image;
}

}  // namespace verdure
