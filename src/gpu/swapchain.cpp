#include "gpu/swapchain.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "verdure/error.h"

namespace verdure::gpu {
namespace {

constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();

vk::SurfaceFormatKHR chooseFormat(const Device& device) {
  const auto formats = device.physical().getSurfaceFormatsKHR(device.surface());
  for (const vk::Format wanted : {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm})
    for (const vk::SurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear)
        return format;
  throw Error("window", "the driver shows no pictures of 8 bits a channel",
              "choose another device");
}

}  // namespace

Swapchain::Swapchain(const Device& device) : device_(&device), format_(chooseFormat(device)) {
  acquired_ = device.raii().createSemaphore({});
  done_ = device.raii().createFence({.flags = vk::FenceCreateFlagBits::eSignaled});
  pool_ =
      device.raii().createCommandPool({.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                       .queueFamilyIndex = device.queueFamily()});
  commands_.emplace(
      std::move(device.raii().allocateCommandBuffers({.commandPool = *pool_,
                                                      .level = vk::CommandBufferLevel::ePrimary,
                                                      .commandBufferCount = 1})[0]));
}

Swapchain::~Swapchain() {
  try {
    device_->raii().waitIdle();  // presenting has no fence
  } catch (const vk::Error&) {
    // A lost device has nothing pending.
  }
}

void Swapchain::waitForFrame() const {
  if (device_->raii().waitForFences({*done_}, true, kForever) != vk::Result::eSuccess)
    throw Error("Vulkan", "the GPU did not finish", "try a smaller scene");
}

bool Swapchain::recreate(std::uint32_t width, std::uint32_t height) {
  device_->raii().waitIdle();
  const vk::SurfaceCapabilitiesKHR can =
      device_->physical().getSurfaceCapabilitiesKHR(device_->surface());
  vk::Extent2D size = can.currentExtent;
  if (size.width == std::numeric_limits<std::uint32_t>::max())  // the swapchain decides
    size = vk::Extent2D{std::clamp(width, can.minImageExtent.width, can.maxImageExtent.width),
                        std::clamp(height, can.minImageExtent.height, can.maxImageExtent.height)};
  if (size.width == 0 || size.height == 0) return false;
  std::uint32_t count = can.minImageCount + 1;
  if (can.maxImageCount > 0) count = std::min(count, can.maxImageCount);
  using Usage = vk::ImageUsageFlagBits;
  readable_ = bool(can.supportedUsageFlags & Usage::eTransferSrc);
  const vk::CompositeAlphaFlagBitsKHR alpha =
      can.supportedCompositeAlpha & vk::CompositeAlphaFlagBitsKHR::eOpaque
          ? vk::CompositeAlphaFlagBitsKHR::eOpaque
          : vk::CompositeAlphaFlagBitsKHR::eInherit;
  views_.clear();
  drawn_.clear();
  vk::raii::SwapchainKHR next = device_->raii().createSwapchainKHR(
      {.surface = device_->surface(),
       .minImageCount = count,
       .imageFormat = format_.format,
       .imageColorSpace = format_.colorSpace,
       .imageExtent = size,
       .imageArrayLayers = 1,
       .imageUsage = readable_ ? Usage::eColorAttachment | Usage::eTransferSrc
                               : vk::ImageUsageFlags(Usage::eColorAttachment),
       .imageSharingMode = vk::SharingMode::eExclusive,
       .preTransform = can.currentTransform,
       .compositeAlpha = alpha,
       .presentMode = vk::PresentModeKHR::eFifo,
       .clipped = true,
       .oldSwapchain = *swapchain_});
  swapchain_ = std::move(next);
  size_ = size;
  images_.clear();
  for (const VkImage image : swapchain_.getImages()) {
    images_.emplace_back(image);
    views_.push_back(device_->raii().createImageView(
        {.image = image,
         .viewType = vk::ImageViewType::e2D,
         .format = format_.format,
         .subresourceRange = {.aspectMask = kColorAspect, .levelCount = 1, .layerCount = 1}}));
    drawn_.push_back(device_->raii().createSemaphore({}));
  }
  stale_ = false;
  return true;
}

bool Swapchain::draw(
    std::uint32_t width, std::uint32_t height,
    const std::function<void(const vk::raii::CommandBuffer&, const Target&)>& record,
    std::vector<std::uint8_t>* capture) {
  if (capture != nullptr) capture->clear();
  if (width == 0 || height == 0) return false;
  waitForFrame();
  if ((stale_ || size_ != vk::Extent2D{width, height}) && !recreate(width, height)) return false;
  std::uint32_t index = 0;
  try {
    const auto [result, next] = swapchain_.acquireNextImage(kForever, *acquired_);
    stale_ = result == vk::Result::eSuboptimalKHR;
    index = next;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
    return false;
  }

  Buffer readback;
  if (capture != nullptr && readable_)
    readback = makeBuffer(*device_, vk::DeviceSize{size_.width} * size_.height * 4,
                          vk::BufferUsageFlagBits::eTransferDst, MemoryUse::kFromGpu);
  commands_->begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  imageBarrier(*commands_, images_[index], kColorAspect, Use::kAcquired, Use::kColorAttachment);
  record(*commands_, {*views_[index], size_});
  if (readback.size > 0) {
    imageBarrier(*commands_, images_[index], kColorAspect, Use::kColorAttachment,
                 Use::kTransferSource);
    commands_->copyImageToBuffer(
        images_[index], vk::ImageLayout::eTransferSrcOptimal, *readback.buffer,
        vk::BufferImageCopy{.imageSubresource = {.aspectMask = kColorAspect, .layerCount = 1},
                            .imageExtent = {size_.width, size_.height, 1}});
    bufferBarrier(*commands_, *readback.buffer, Use::kTransferTarget, Use::kHostRead);
    imageBarrier(*commands_, images_[index], kColorAspect, Use::kTransferSource, Use::kPresented);
  } else {
    imageBarrier(*commands_, images_[index], kColorAspect, Use::kColorAttachment, Use::kPresented);
  }
  commands_->end();

  device_->raii().resetFences({*done_});
  const vk::SemaphoreSubmitInfo wait{.semaphore = *acquired_,
                                     .stageMask = useInfo(Use::kAcquired).stages};
  const vk::SemaphoreSubmitInfo signal{.semaphore = *drawn_[index],
                                       .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
  const vk::CommandBufferSubmitInfo buffer{.commandBuffer = **commands_};
  device_->queue().submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                           .pWaitSemaphoreInfos = &wait,
                                           .commandBufferInfoCount = 1,
                                           .pCommandBufferInfos = &buffer,
                                           .signalSemaphoreInfoCount = 1,
                                           .pSignalSemaphoreInfos = &signal},
                           *done_);
  const vk::Semaphore drawn = *drawn_[index];
  const vk::SwapchainKHR swapchain = *swapchain_;
  try {
    const vk::Result result = device_->queue().presentKHR({.waitSemaphoreCount = 1,
                                                           .pWaitSemaphores = &drawn,
                                                           .swapchainCount = 1,
                                                           .pSwapchains = &swapchain,
                                                           .pImageIndices = &index});
    stale_ = stale_ || result == vk::Result::eSuboptimalKHR;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
  }
  if (readback.size > 0) {
    waitForFrame();
    capture->resize(readback.size);
    std::memcpy(capture->data(), readback.memory.mapped(), capture->size());
    for (std::size_t i = 0; i < capture->size(); i += 4) {
      if (format_.format == vk::Format::eB8G8R8A8Unorm) std::swap((*capture)[i], (*capture)[i + 2]);
      (*capture)[i + 3] = 255;
    }
  }
  return true;
}

}  // namespace verdure::gpu
