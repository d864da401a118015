#include "render/shadow_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kShadowVertex[] = {
#include "shaders/shadow_pass.vert.inc"
};
constexpr std::uint32_t kShadowFragment[] = {
#include "shaders/shadow_pass.frag.inc"
};

}  // namespace

void ShadowPass::prepare(const gpu::Device& device, const FrameLayout& layout,
                         const GpuScene& scene) {
  for (const Draw& draw : scene.draws()) {
    gpu::Constants constants = GpuScene::shapeConstants(draw);
    if (pipelines_.contains(constants)) continue;
    gpu::GraphicsRequest request{.vertex = kShadowVertex,
                                 .constants = constants,
                                 .layout = *layout.pipeline,
                                 .bindings = GpuScene::bindings(false),
                                 .attributes = GpuScene::shapeAttributes(),
                                 .depth = FrameLayout::kDepth,
                                 .depth_compare = vk::CompareOp::eLess,
                                 .depth_bias_slope = 1.5f};
    if (draw.alpha_test) request.fragment = kShadowFragment;
    pipelines_.emplace(std::move(constants), gpu::makeGraphicsPipeline(device, request));
  }
}

void ShadowPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                        vk::DescriptorSet frame_set, const GpuScene& scene,
                        const gpu::Texture& maps, const ImpostorPass& impostors,
                        std::uint32_t count, bool casters) const {
  const vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eDepth;
  gpu::imageBarrier(commands, *maps.image, aspect, gpu::Use::kUndefined,
                    gpu::Use::kDepthAttachment);
  for (std::uint32_t cascade = 0; cascade < count; ++cascade) {
    const vk::RenderingAttachmentInfo depth{
        .imageView = *maps.layer_views[cascade],
        .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
        .loadOp = vk::AttachmentLoadOp::eClear,
        .storeOp = vk::AttachmentStoreOp::eStore,
        .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 1.0f})};
    const vk::Rect2D area{.extent = {maps.request.width, maps.request.height}};
    commands.beginRendering({.renderArea = area, .layerCount = 1, .pDepthAttachment = &depth});
    commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                         .height = static_cast<float>(area.extent.height),
                                         .maxDepth = 1.0f});
    commands.setScissor(0, area);
    if (casters) drawCasters(commands, layout, frame_set, scene, cascade);
    if (casters && scene.forest() != nullptr)
      impostors.recordShadows(commands, frame_set, *scene.forest(), cascade, false);
    commands.endRendering();
  }
  gpu::imageBarrier(commands, *maps.image, aspect, gpu::Use::kDepthAttachment,
                    gpu::Use::kFragmentSampled);
}

void ShadowPass::drawCasters(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                             vk::DescriptorSet frame_set, const GpuScene& scene,
                             std::uint32_t cascade) const {
  if (scene.draws().empty()) return;
  scene.bindVertices(commands, NormalSource::kLeaf);
  commands.pushConstants<std::uint32_t>(*layout.pipeline, vk::ShaderStageFlagBits::eVertex,
                                        sizeof(shared::DrawUniforms), cascade);
  for (const Draw& draw : scene.draws()) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(GpuScene::shapeConstants(draw)));
    scene.record(commands, *layout.pipeline, frame_set, draw, cascade + 1);
  }
}

}  // namespace verdure
