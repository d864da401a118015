#include "render/light_depth_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kLightDepthVertex[] = {
#include "shaders/shadow_pass.vert.inc"
};
constexpr std::uint32_t kWood[] = {
#include "shaders/shadow_pass.frag.inc"
};
constexpr std::uint32_t kFoliage[] = {
#include "shaders/light_depth_pass.frag.inc"
};

gpu::Constants constantsOf(const Draw& draw, const Terms& terms) {
  return termConstants({.textures = terms.textures},
                       {.alpha_test = draw.alpha_test,
                        .foliage = draw.foliage,
                        .leaf = draw.leaf_maps ? LeafModel::kMaps : LeafModel::kColor,
                        .stated_transmission = draw.stated_transmission,
                        .moving = draw.moving});
}

}  // namespace

void LightDepthPass::prepare(const gpu::Device& device, const FrameLayout& layout,
                             const GpuScene& scene, const Terms& terms) {
  for (const Draw& draw : scene.draws()) {
    gpu::Constants constants = constantsOf(draw, terms);
    if (pipelines_.contains(constants)) continue;
    gpu::GraphicsRequest request{.vertex = kLightDepthVertex,
                                 .constants = constants,
                                 .layout = *layout.pipeline,
                                 .bindings = GpuScene::bindings(false),
                                 .attributes = GpuScene::shapeAttributes(),
                                 .color = FrameLayout::kFoliageDepth,
                                 .depth = FrameLayout::kDepth,
                                 .depth_compare = vk::CompareOp::eLess};
    if (draw.foliage) {
      request.fragment = kFoliage;
      request.depth_write = false;
      request.blend = gpu::Blend::kMaxAndSum;
    } else {
      if (draw.alpha_test) request.fragment = kWood;
      request.depth_bias_slope = 1.5f;
      request.blend = gpu::Blend::kNothing;
    }
    pipelines_.emplace(std::move(constants), gpu::makeGraphicsPipeline(device, request));
  }
}

void LightDepthPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                            vk::DescriptorSet frame_set, const GpuScene& scene,
                            const gpu::Texture& wood_maps, const gpu::Texture& foliage_maps,
                            const ImpostorPass& impostors, std::uint32_t count,
                            const Terms& terms) const {
  const vk::ImageAspectFlags depth_aspect = vk::ImageAspectFlagBits::eDepth;
  gpu::imageBarrier(commands, *wood_maps.image, depth_aspect, gpu::Use::kUndefined,
                    gpu::Use::kDepthAttachment);
  gpu::imageBarrier(commands, *foliage_maps.image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  for (std::uint32_t cascade = 0; cascade < count; ++cascade) {
    const vk::RenderingAttachmentInfo foliage{
        .imageView = *foliage_maps.layer_views[cascade],
        .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
        .loadOp = vk::AttachmentLoadOp::eClear,
        .storeOp = vk::AttachmentStoreOp::eStore,
        .clearValue = vk::ClearValue(vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, 0.0f}))};
    const vk::RenderingAttachmentInfo wood{
        .imageView = *wood_maps.layer_views[cascade],
        .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
        .loadOp = vk::AttachmentLoadOp::eClear,
        .storeOp = vk::AttachmentStoreOp::eStore,
        .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 1.0f})};
    const vk::Rect2D area{.extent = {wood_maps.request.width, wood_maps.request.height}};
    commands.beginRendering({.renderArea = area,
                             .layerCount = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments = &foliage,
                             .pDepthAttachment = &wood});
    commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                         .height = static_cast<float>(area.extent.height),
                                         .maxDepth = 1.0f});
    commands.setScissor(0, area);
    if (terms.shadow) drawCasters(commands, layout, frame_set, scene, cascade, terms);
    if (terms.shadow && scene.forest() != nullptr)
      impostors.recordShadows(commands, frame_set, *scene.forest(), cascade, true);
    commands.endRendering();
  }
  gpu::imageBarrier(commands, *wood_maps.image, depth_aspect, gpu::Use::kDepthAttachment,
                    gpu::Use::kFragmentSampled);
  gpu::imageBarrier(commands, *foliage_maps.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kFragmentSampled);
}

void LightDepthPass::drawCasters(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                                 vk::DescriptorSet frame_set, const GpuScene& scene,
                                 std::uint32_t cascade, const Terms& terms) const {
  if (scene.draws().empty()) return;
  scene.bindVertices(commands, NormalSource::kLeaf);
  commands.pushConstants<std::uint32_t>(*layout.pipeline, vk::ShaderStageFlagBits::eVertex,
                                        sizeof(shared::DrawUniforms), cascade);
  for (const Draw& draw : scene.draws()) {  // wood comes first
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(constantsOf(draw, terms)));
    scene.record(commands, *layout.pipeline, frame_set, draw, cascade + 1);
  }
}

}  // namespace verdure
