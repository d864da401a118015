#include "render/impostor_pass.h"

namespace verdure {
namespace {

constexpr std::uint32_t kImpostorVertex[] = {
#include "shaders/impostor.vert.inc"
};
constexpr std::uint32_t kImpostorFragment[] = {
#include "shaders/impostor.frag.inc"
};
constexpr std::uint32_t kDrawn[] = {
#include "shaders/style_impostor.frag.inc"
};
constexpr std::uint32_t kImpostorVelocity[] = {
#include "shaders/impostor_velocity.frag.inc"
};
constexpr std::uint32_t kShadow[] = {
#include "shaders/impostor_shadow.frag.inc"
};
constexpr std::uint32_t kLightDepth[] = {
#include "shaders/impostor_depth.frag.inc"
};

gpu::Constants constantsOf(const Terms& terms, DrawKind kind) {
  // Their pictures hold no transfer vectors and no visibility.
  if (kind.ambient_source == AmbientSource::kTransfer ||
      kind.ambient_source == AmbientSource::kLeafVisibility)
    kind.ambient_source = AmbientSource::kBaked;
  kind.transmission = terms.transmission;
  kind.forest = true;
  return termConstants(terms, kind);
}

}  // namespace

ImpostorPass::ImpostorPass(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
                           const ForestLayouts& layouts)
    : device_(&device),
      frame_layout_(frame_set),
      impostor_layout_(*layouts.impostor.layout),
      layout_(gpu::makePipelineLayout(
          device, std::array{frame_set, *layouts.impostor.layout},
          vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment,
          sizeof(shared::ImpostorJob))) {}

void ImpostorPass::prepare(const Terms& terms, const DrawKind& kind, bool light_depth) {
  gpu::Constants constants = constantsOf(terms, kind);
  if (!pictures_.contains(constants)) {
    vk::raii::Pipeline pipeline =
        gpu::makeGraphicsPipeline(*device_, {.vertex = kImpostorVertex,
                                             .fragment = kImpostorFragment,
                                             .constants = constants,
                                             .layout = *layout_,
                                             .color = FrameLayout::kColor,
                                             .depth = FrameLayout::kDepth,
                                             .samples = FrameLayout::kSamples});
    pictures_.emplace(std::move(constants), std::move(pipeline));
  }
  if (shadows_.contains(light_depth)) return;
  gpu::GraphicsRequest request{.vertex = kImpostorVertex,
                               .fragment = kShadow,
                               .layout = *layout_,
                               .depth = FrameLayout::kDepth,
                               .depth_compare = vk::CompareOp::eLess,
                               .depth_bias_slope = 1.5f};
  if (light_depth) {
    request.fragment = kLightDepth;
    request.color = FrameLayout::kFoliageDepth;
    request.depth_write = false;
    request.depth_bias_slope = 0.0f;
    request.blend = gpu::Blend::kMaxAndSum;
  }
  shadows_.emplace(light_depth, gpu::makeGraphicsPipeline(*device_, request));
}

void ImpostorPass::draw(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
                        vk::DescriptorSet frame_set, const GpuForest& forest, std::uint32_t view,
                        bool velocity) const {
  for (std::uint32_t k = 0; k < forest.kinds_.size(); ++k) {
    if (!forest.kinds_[k].set) continue;
    const shared::ForestView& data = forest.view_data_[view];
    const shared::ImpostorJob job{
        .kind = k,
        .range = view * forest.packed_.classes + forest.kind_data_[k].first_class +
                 forest.kind_data_[k].meshes,
        .first_far = data.first_far,
        .cascade = view == GpuForest::kBehind ? shared::kForestNone : view - 1,
        .most = data.eye.w,
        .velocity = velocity ? 1u : 0u};
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0,
                                {frame_set, **forest.kinds_[k].set}, nullptr);
    commands.pushConstants<shared::ImpostorJob>(
        layout, vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment, 0, job);
    forest.drawFar(commands, k, view);
  }
}

void ImpostorPass::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                          const GpuForest& forest, const Terms& terms, const DrawKind& kind) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pictures_.at(constantsOf(terms, kind)));
  draw(commands, *layout_, frame_set, forest, GpuForest::kBehind);
}

void ImpostorPass::prepareDrawn(const Terms& terms, const DrawKind& kind,
                                vk::DescriptorSetLayout ground_set, vk::Format color) {
  if (!*drawn_layout_)
    drawn_layout_ = gpu::makePipelineLayout(
        *device_, std::array{frame_layout_, impostor_layout_, ground_set},
        vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment,
        sizeof(shared::ImpostorJob));
  gpu::Constants constants = constantsOf(terms, kind);
  if (drawn_.contains(constants)) return;
  vk::raii::Pipeline pipeline =
      gpu::makeGraphicsPipeline(*device_, {.vertex = kImpostorVertex,
                                           .fragment = kDrawn,
                                           .constants = constants,
                                           .layout = *drawn_layout_,
                                           .color = color,
                                           .more_colors = {color, color},
                                           .depth = FrameLayout::kDepth,
                                           .samples = FrameLayout::kSamples});
  drawn_.emplace(std::move(constants), std::move(pipeline));
}

void ImpostorPass::recordDrawn(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                               vk::DescriptorSet ground_set, const GpuForest& forest,
                               const Terms& terms, const DrawKind& kind) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *drawn_.at(constantsOf(terms, kind)));
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *drawn_layout_, 2, {ground_set},
                              nullptr);
  draw(commands, *drawn_layout_, frame_set, forest, GpuForest::kBehind);
}

void ImpostorPass::prepareVelocity(vk::Format way) {
  if (*velocity_) return;
  velocity_ = gpu::makeGraphicsPipeline(*device_, {.vertex = kImpostorVertex,
                                                   .fragment = kImpostorVelocity,
                                                   .layout = *layout_,
                                                   .color = way,
                                                   .depth = FrameLayout::kDepth});
}

void ImpostorPass::recordVelocity(const vk::raii::CommandBuffer& commands,
                                  vk::DescriptorSet frame_set, const GpuForest& forest) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *velocity_);
  draw(commands, *layout_, frame_set, forest, GpuForest::kBehind, true);
}

void ImpostorPass::recordShadows(const vk::raii::CommandBuffer& commands,
                                 vk::DescriptorSet frame_set, const GpuForest& forest,
                                 std::uint32_t cascade, bool light_depth) const {
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *shadows_.at(light_depth));
  draw(commands, *layout_, frame_set, forest, cascade + 1);
}

}  // namespace verdure
