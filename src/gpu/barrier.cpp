#include "gpu/barrier.h"

namespace verdure::gpu {

UseInfo useInfo(Use use) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  switch (use) {
    case Use::kUndefined:
      return {Stage::eNone, Access::eNone, Layout::eUndefined};
    case Use::kTransferTarget:
      return {Stage::eTransfer, Access::eTransferWrite, Layout::eTransferDstOptimal};
    case Use::kTransferSource:
      return {Stage::eTransfer, Access::eTransferRead, Layout::eTransferSrcOptimal};
    case Use::kColorAttachment:
      return {Stage::eColorAttachmentOutput,
              Access::eColorAttachmentRead | Access::eColorAttachmentWrite,
              Layout::eColorAttachmentOptimal};
    case Use::kDepthAttachment:
      return {Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
              Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite,
              Layout::eDepthAttachmentOptimal};
    case Use::kFragmentSampled:
      return {Stage::eFragmentShader, Access::eShaderSampledRead, Layout::eShaderReadOnlyOptimal};
    case Use::kDrawSampled:
      return {Stage::eVertexShader | Stage::eFragmentShader, Access::eShaderSampledRead,
              Layout::eShaderReadOnlyOptimal};
    case Use::kComputeSampled:
      return {Stage::eComputeShader, Access::eShaderSampledRead, Layout::eShaderReadOnlyOptimal};
    case Use::kVertexInput:
      return {Stage::eVertexInput, Access::eVertexAttributeRead | Access::eIndexRead,
              Layout::eUndefined};
    case Use::kVertexStorage:
      return {Stage::eVertexShader, Access::eShaderStorageRead, Layout::eUndefined};
    case Use::kComputeStorage:
      return {Stage::eComputeShader, Access::eShaderStorageRead | Access::eShaderStorageWrite,
              Layout::eUndefined};
    case Use::kIndirect:
      return {Stage::eDrawIndirect, Access::eIndirectCommandRead, Layout::eUndefined};
    case Use::kFragmentStorage:
      return {Stage::eFragmentShader, Access::eShaderStorageRead, Layout::eUndefined};
    case Use::kHostRead:
      return {Stage::eHost, Access::eHostRead, Layout::eUndefined};
    case Use::kAcquired:  // the stage that waits for the semaphore
      return {Stage::eColorAttachmentOutput, Access::eNone, Layout::eUndefined};
    case Use::kPresented:
      return {Stage::eNone, Access::eNone, Layout::ePresentSrcKHR};
  }
  return {};
}

void imageBarrier(const vk::raii::CommandBuffer& commands, vk::Image image,
                  vk::ImageAspectFlags aspect, Use from, Use to) {
  const UseInfo source = useInfo(from), target = useInfo(to);
  const vk::ImageMemoryBarrier2 barrier{
      .srcStageMask = source.stages,
      .srcAccessMask = source.access,
      .dstStageMask = target.stages,
      .dstAccessMask = target.access,
      .oldLayout = source.layout,
      .newLayout = target.layout,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image,
      .subresourceRange = {.aspectMask = aspect,
                           .levelCount = VK_REMAINING_MIP_LEVELS,
                           .layerCount = VK_REMAINING_ARRAY_LAYERS}};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

void bufferBarrier(const vk::raii::CommandBuffer& commands, vk::Buffer buffer, Use from, Use to) {
  const UseInfo source = useInfo(from), target = useInfo(to);
  const vk::BufferMemoryBarrier2 barrier{.srcStageMask = source.stages,
                                         .srcAccessMask = source.access,
                                         .dstStageMask = target.stages,
                                         .dstAccessMask = target.access,
                                         .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .buffer = buffer,
                                         .size = VK_WHOLE_SIZE};
  commands.pipelineBarrier2({.bufferMemoryBarrierCount = 1, .pBufferMemoryBarriers = &barrier});
}

}  // namespace verdure::gpu
