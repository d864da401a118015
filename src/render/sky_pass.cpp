#include "render/sky_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "shaders/fullscreen.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "shaders/sky_pass.frag.inc"
};

}  // namespace

void SkyPass::prepare(const gpu::Device& device, const FrameLayout& layout, const DrawKind& kind) {
  gpu::Constants constants = termConstants({}, kind);
  if (pipelines_.contains(constants)) return;
  vk::raii::Pipeline pipeline =
      gpu::makeGraphicsPipeline(device, {.vertex = kVertex,
                                         .fragment = kFragment,
                                         .constants = constants,
                                         .layout = *layout.pipeline,
                                         .color = FrameLayout::kColor,
                                         .depth = FrameLayout::kDepth,
                                         .samples = FrameLayout::kSamples,
                                         .depth_compare = vk::CompareOp::eGreaterOrEqual,
                                         .depth_write = false});
  pipelines_.emplace(std::move(constants), std::move(pipeline));
}

void SkyPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                     vk::DescriptorSet frame_set, const DrawKind& kind) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipelines_.at(termConstants({}, kind)));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout.pipeline, 0, {frame_set},
                              nullptr);
  commands.draw(3, 1, 0, 0);
}

}  // namespace verdure
