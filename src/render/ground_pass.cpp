#include "render/ground_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "shaders/ground_pass.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "shaders/ground_pass.frag.inc"
};
constexpr std::uint32_t kSlices = 64;  // as in ground_pass.vert

}  // namespace

void GroundPass::prepare(const gpu::Device& device, const FrameLayout& layout, const Terms& terms,
                         const DrawKind& kind) {
  gpu::Constants constants = termConstants(terms, kind);
  if (pipelines_.contains(constants)) return;
  vk::raii::Pipeline pipeline =
      gpu::makeGraphicsPipeline(device, {.vertex = kVertex,
                                         .fragment = kFragment,
                                         .constants = constants,
                                         .layout = *layout.pipeline,
                                         .color = FrameLayout::kColor,
                                         .depth = FrameLayout::kDepth,
                                         .samples = FrameLayout::kSamples});
  pipelines_.emplace(std::move(constants), std::move(pipeline));
}

void GroundPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                        vk::DescriptorSet frame_set, const Terms& terms,
                        const DrawKind& kind) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                        *pipelines_.at(termConstants(terms, kind)));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout.pipeline, 0, {frame_set},
                              nullptr);
  commands.draw(3 * kSlices, 1, 0, 0);
}

}  // namespace verdure
