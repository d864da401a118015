#include "render/backdrop_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kGroundVertex[] = {
#include "shaders/ground_pass.vert.inc"
};
constexpr std::uint32_t kGroundFragment[] = {
#include "shaders/ground_pass.frag.inc"
};
constexpr std::uint32_t kSkyVertex[] = {
#include "shaders/fullscreen.vert.inc"
};
constexpr std::uint32_t kSkyFragment[] = {
#include "shaders/sky_pass.frag.inc"
};

/// The sky is the same with any terms.
gpu::Constants skyConstants(const DrawKind& kind) {
  return termConstants({}, kind);
}

}  // namespace

void BackdropPass::prepare(const gpu::Device& device, const FrameLayout& layout, const Terms& terms,
                           const DrawKind& kind, bool ground) {
  const auto make = [&](auto& pipelines, gpu::Constants constants, gpu::GraphicsRequest request) {
    if (pipelines.contains(constants)) return;
    request.constants = constants;
    request.layout = *layout.pipeline;
    request.color = FrameLayout::kColor;
    request.depth = FrameLayout::kDepth;
    request.samples = FrameLayout::kSamples;
    pipelines.emplace(std::move(constants), gpu::makeGraphicsPipeline(device, request));
  };
  if (ground)
    make(ground_, termConstants(terms, kind),
         {.vertex = kGroundVertex, .fragment = kGroundFragment, .layout = {}});
  make(sky_, skyConstants(kind),
       {.vertex = kSkyVertex,
        .fragment = kSkyFragment,
        .layout = {},
        .depth_compare = vk::CompareOp::eGreaterOrEqual,
        .depth_write = false});
}

void BackdropPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                          vk::DescriptorSet frame_set, const Terms& terms, const DrawKind& kind,
                          bool ground) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout.pipeline, 0, {frame_set},
                              nullptr);
  if (ground) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *ground_.at(termConstants(terms, kind)));
    commands.draw(6, 1, 0, 0);
  }
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *sky_.at(skyConstants(kind)));
  commands.draw(3, 1, 0, 0);
}

}  // namespace verdure
