#include "render/shadow_pass.h"

#include <algorithm>
#include <cmath>

namespace verdure {
namespace {

constexpr std::uint32_t kVertex[] = {
#include "shaders/shadow_pass.vert.inc"
};
constexpr std::uint32_t kFragment[] = {
#include "shaders/shadow_pass.frag.inc"
};

vk::raii::Pipeline makePipeline(const gpu::Device& device, const FrameLayout& layout, bool cut) {
  return gpu::makeGraphicsPipeline(device, {.vertex = kVertex,
                                            .fragment = cut ? gpu::SpirV(kFragment) : gpu::SpirV(),
                                            .layout = *layout.pipeline,
                                            .bindings = GpuScene::bindings(false),
                                            .attributes = GpuScene::shapeAttributes(),
                                            .depth = FrameLayout::kDepth,
                                            .depth_compare = vk::CompareOp::eLess,
                                            .depth_bias_slope = 1.5f});
}

}  // namespace

ShadowFit fitShadow(const Bounds& bounds, const glm::vec3& to_sun, int size) {
  const glm::vec3 aside = std::abs(to_sun.y) > 0.999f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(aside, to_sun));
  const glm::vec3 up = glm::cross(to_sun, right);
  const glm::vec3 center = bounds.center(), half = 0.5f * bounds.size();
  const auto reach = [&half](const glm::vec3& axis) { return glm::dot(glm::abs(axis), half); };
  // A square, so that texels are square, with some texels around for the filter.
  const float smallest = 1e-4f + 1e-6f * glm::length(center);
  const float side = 2.0f * std::max({reach(right), reach(up), smallest}) *
                     static_cast<float>(size) / static_cast<float>(std::max(size - 8, 1));
  const float depth = 2.0f * std::max(reach(to_sun), smallest) * 1.01f;
  glm::mat4 m(1.0f);
  const auto setRow = [&m](int row, const glm::vec3& axis, float offset) {
    for (int c = 0; c < 3; ++c) m[c][row] = axis[c];
    m[3][row] = offset;
  };
  setRow(0, right / side, 0.5f - glm::dot(right, center) / side);
  setRow(1, up / side, 0.5f - glm::dot(up, center) / side);
  setRow(2, -to_sun / depth, 0.5f + glm::dot(to_sun, center) / depth);
  return {m, side / static_cast<float>(size)};
}

ShadowPass::ShadowPass(const gpu::Device& device, const FrameLayout& layout)
    : opaque_(makePipeline(device, layout, false)),
      alpha_cut_(makePipeline(device, layout, true)) {}

void ShadowPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                        vk::DescriptorSet frame_set, const GpuScene& scene, const gpu::Texture& map,
                        bool casters) const {
  const vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eDepth;
  gpu::imageBarrier(commands, *map.image, aspect, gpu::Use::kUndefined, gpu::Use::kDepthAttachment);
  const vk::RenderingAttachmentInfo depth{
      .imageView = *map.view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 1.0f})};
  const vk::Rect2D area{.extent = {map.request.width, map.request.height}};
  commands.beginRendering({.renderArea = area, .layerCount = 1, .pDepthAttachment = &depth});
  if (casters && !scene.draws().empty()) {
    commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                         .height = static_cast<float>(area.extent.height),
                                         .maxDepth = 1.0f});
    commands.setScissor(0, area);
    scene.bindVertices(commands, NormalSource::kLeaf);
    for (const Draw& draw : scene.draws()) {
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                            draw.alpha_test ? *alpha_cut_ : *opaque_);
      commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout.pipeline, 0,
                                  {frame_set, scene.materialSet(draw.material)}, nullptr);
      commands.pushConstants<shared::DrawUniforms>(
          *layout.pipeline, vk::ShaderStageFlagBits::eFragment, 0, draw.uniforms);
      commands.drawIndexed(draw.index_count, draw.instance_count, draw.first_index,
                           draw.vertex_offset, draw.first_instance);
    }
  }
  commands.endRendering();
  gpu::imageBarrier(commands, *map.image, aspect, gpu::Use::kDepthAttachment,
                    gpu::Use::kFragmentSampled);
}

}  // namespace verdure
