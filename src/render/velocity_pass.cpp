#include "render/velocity_pass.h"

#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "scene/camera.h"

namespace verdure {
namespace {

constexpr std::uint32_t kVelocityVertex[] = {
#include "shaders/velocity_pass.vert.inc"
};
constexpr std::uint32_t kVelocityFragment[] = {
#include "shaders/velocity_pass.frag.inc"
};
/// Of pixels without plants; no vertex comes this far.
constexpr float kNothing = 1e30f;

}  // namespace

void VelocityPass::prepare(const gpu::Device& device, const FrameLayout& layout,
                           const GpuScene& scene, int width, int height) {
  for (const Draw& draw : scene.draws()) {
    gpu::Constants constants = GpuScene::shapeConstants(draw);
    if (pipelines_.contains(constants)) continue;
    pipelines_.emplace(constants,
                       gpu::makeGraphicsPipeline(device, {.vertex = kVelocityVertex,
                                                          .fragment = kVelocityFragment,
                                                          .constants = constants,
                                                          .layout = *layout.pipeline,
                                                          .bindings = GpuScene::bindings(false),
                                                          .attributes = GpuScene::shapeAttributes(),
                                                          .color = kFormat,
                                                          .depth = FrameLayout::kDepth}));
  }
  const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
  if (ways_ && ways_->request.width == w && ways_->request.height == h) return;
  using Usage = vk::ImageUsageFlagBits;
  ways_ = gpu::makeTexture(device, {.format = kFormat,
                                    .width = w,
                                    .height = h,
                                    .usage = Usage::eColorAttachment | Usage::eTransferSrc});
  depth_ = gpu::makeTexture(device, {.format = FrameLayout::kDepth,
                                     .width = w,
                                     .height = h,
                                     .usage = Usage::eDepthStencilAttachment,
                                     .aspect = vk::ImageAspectFlagBits::eDepth});
  readback_ = gpu::makeBuffer(device, vk::DeviceSize{w} * h * sizeof(glm::vec2),
                              vk::BufferUsageFlagBits::eTransferDst, gpu::MemoryUse::kFromGpu);
}

void VelocityPass::record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                          vk::DescriptorSet frame_set, const GpuScene& scene,
                          const ImpostorPass& impostors, const GrassPass& grass) const {
  gpu::imageBarrier(commands, *ways_->image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  gpu::imageBarrier(commands, *depth_->image, vk::ImageAspectFlagBits::eDepth, gpu::Use::kUndefined,
                    gpu::Use::kDepthAttachment);
  const vk::RenderingAttachmentInfo color{
      .imageView = *ways_->view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue =
          vk::ClearValue(vk::ClearColorValue(std::array{kNothing, kNothing, 0.0f, 0.0f}))};
  const vk::RenderingAttachmentInfo depth{
      .imageView = *depth_->view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eDontCare,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 0.0f})};
  const vk::Rect2D area{.extent = {ways_->request.width, ways_->request.height}};
  commands.beginRendering({.renderArea = area,
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                       .height = static_cast<float>(area.extent.height),
                                       .maxDepth = 1.0f});
  commands.setScissor(0, area);
  if (!scene.draws().empty()) scene.bindVertices(commands, NormalSource::kLeaf);
  for (const Draw& draw : scene.draws()) {
    if (!draw.seen) continue;
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                          *pipelines_.at(GpuScene::shapeConstants(draw)));
    scene.recordSeen(commands, *layout.pipeline, frame_set, draw);
  }
  if (scene.forest() != nullptr) impostors.recordVelocity(commands, frame_set, *scene.forest());
  if (scene.terrain() != nullptr) grass.recordVelocity(commands, frame_set, *scene.terrain());
  commands.endRendering();
  gpu::imageBarrier(commands, *ways_->image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kTransferSource);
  commands.copyImageToBuffer(
      *ways_->image, vk::ImageLayout::eTransferSrcOptimal, *readback_->buffer,
      vk::BufferImageCopy{.imageSubresource = {.aspectMask = gpu::kColorAspect, .layerCount = 1},
                          .imageExtent = {area.extent.width, area.extent.height, 1}});
  gpu::bufferBarrier(commands, *readback_->buffer, gpu::Use::kTransferTarget, gpu::Use::kHostRead);
}

std::vector<glm::vec2> VelocityPass::read(const Camera& now, const Camera& last,
                                          std::optional<float> ground_height) const {
  const std::size_t width = ways_->request.width, height = ways_->request.height;
  std::vector<glm::vec2> ways(width * height);
  std::memcpy(ways.data(), readback_->memory.mapped(), ways.size() * sizeof(glm::vec2));
  const glm::vec2 size(static_cast<float>(width), static_cast<float>(height));
  const CameraRays rays = cameraRays(now, size.x / size.y);
  const glm::mat4 clip_from_world = clipFromWorld(last, size.x / size.y);
  parallelFor(height, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      glm::vec2& way = ways[y * width + x];
      if (way.x != kNothing) continue;
      const glm::vec2 at = glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f;
      const glm::vec2 place = at / size * 2.0f - 1.0f;
      const glm::vec3 ray = rays.forward + place.x * rays.right + place.y * rays.down;
      // The sky is infinitely far away.
      glm::vec4 seen(ray, 0.0f);
      if (ground_height && ray.y < 0.0f && rays.eye.y > *ground_height)
        seen = glm::vec4(rays.eye + ray * ((*ground_height - rays.eye.y) / ray.y), 1.0f);
      const glm::vec4 clip = clip_from_world * seen;
      way = clip.w > 0.0f ? at - (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * size : glm::vec2(0.0f);
    }
  });
  return ways;
}

}  // namespace verdure
