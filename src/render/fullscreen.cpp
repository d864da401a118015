#include "render/fullscreen.h"

namespace verdure {
namespace {

constexpr std::uint32_t kFullscreenVertex[] = {
#include "shaders/fullscreen.vert.inc"
};

}  // namespace

vk::raii::Pipeline makeFullscreenPipeline(const gpu::Device& device, gpu::SpirV fragment,
                                          vk::PipelineLayout layout, vk::Format target,
                                          const gpu::Constants& constants) {
  return gpu::makeGraphicsPipeline(device, {.vertex = kFullscreenVertex,
                                            .fragment = fragment,
                                            .constants = constants,
                                            .layout = layout,
                                            .color = target});
}

void drawFullscreen(const vk::raii::CommandBuffer& commands, const gpu::Texture& target,
                    const vk::raii::Pipeline& pipeline, vk::PipelineLayout layout,
                    vk::DescriptorSet set) {
  gpu::imageBarrier(commands, *target.image, vk::ImageAspectFlagBits::eColor, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  drawFullscreen(commands, *target.view, {target.request.width, target.request.height}, pipeline,
                 layout, set);
}

void drawFullscreen(const vk::raii::CommandBuffer& commands, vk::ImageView target,
                    vk::Extent2D size, const vk::raii::Pipeline& pipeline,
                    vk::PipelineLayout layout, vk::DescriptorSet set) {
  const vk::RenderingAttachmentInfo color{.imageView = target,
                                          .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
                                          .loadOp = vk::AttachmentLoadOp::eDontCare,
                                          .storeOp = vk::AttachmentStoreOp::eStore};
  const vk::Rect2D area{.extent = size};
  commands.beginRendering({.renderArea = area,
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color});
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                       .height = static_cast<float>(area.extent.height),
                                       .maxDepth = 1.0f});
  commands.setScissor(0, area);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, {set}, nullptr);
  commands.draw(3, 1, 0, 0);
  commands.endRendering();
}

}  // namespace verdure
