#include "render/frame.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "render/look.h"
#include "scene/camera.h"
#include "scene/ground_texture.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr vk::ImageAspectFlags kColorAspect = vk::ImageAspectFlagBits::eColor;
constexpr vk::ImageAspectFlags kDepthAspect = vk::ImageAspectFlagBits::eDepth;

vk::raii::DescriptorSetLayout makeFrameSet(const gpu::Device& device) {
  using Type = vk::DescriptorType;
  using Stage = vk::ShaderStageFlagBits;
  return gpu::makeSetLayout(device,
                            std::array{Type::eUniformBuffer, Type::eCombinedImageSampler,
                                       Type::eCombinedImageSampler, Type::eCombinedImageSampler},
                            Stage::eVertex | Stage::eFragment);
}

vk::raii::DescriptorSetLayout makeMaterialSet(const gpu::Device& device) {
  using Type = vk::DescriptorType;
  return gpu::makeSetLayout(device,
                            std::array{Type::eCombinedImageSampler, Type::eCombinedImageSampler},
                            vk::ShaderStageFlagBits::eFragment);
}

}  // namespace

FrameLayout::FrameLayout(const gpu::Device& device)
    : frame_set(makeFrameSet(device)),
      material_set(makeMaterialSet(device)),
      pipeline(gpu::makePipelineLayout(device, std::array{*frame_set, *material_set},
                                       vk::ShaderStageFlagBits::eFragment,
                                       sizeof(shared::DrawUniforms))) {}

FrameDrawer::FrameDrawer(const gpu::Device& device)
    : device_(&device),
      layout_(device),
      shadow_pass_(device, layout_),
      sky_pass_(device, layout_),
      timers_(device, 3) {
  gpu::Upload upload(device);
  ground_texture_ =
      upload.texture(buildColorMips(makeGroundTexture(look::kGroundTextureSize), {}).levels,
                     vk::Format::eR8G8B8A8Srgb);
  ground_noise_ = upload.texture(buildLinearMips(makeGroundNoise(look::kGroundNoiseSize)).levels,
                                 vk::Format::eR8G8B8A8Unorm);
  upload.finish();
  // No anisotropic filter: ground_pass.frag takes several taps along a grazing footprint itself.
  ground_sampler_ = device.raii().createSampler({.magFilter = vk::Filter::eLinear,
                                                 .minFilter = vk::Filter::eLinear,
                                                 .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                                 .maxLod = VK_LOD_CLAMP_NONE});
  // Bilinear comparison where the device has it for this format; else the tent has harder steps.
  const bool smooth =
      bool(device.physical().getFormatProperties(FrameLayout::kDepth).optimalTilingFeatures &
           vk::FormatFeatureFlagBits::eSampledImageFilterLinear);
  const vk::Filter filter = smooth ? vk::Filter::eLinear : vk::Filter::eNearest;
  shadow_sampler_ =
      device.raii().createSampler({.magFilter = filter,
                                   .minFilter = filter,
                                   .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                   .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                   .compareEnable = true,
                                   .compareOp = vk::CompareOp::eLessOrEqual});
  uniforms_ = gpu::makeBuffer(device, sizeof(shared::FrameUniforms),
                              vk::BufferUsageFlagBits::eUniformBuffer, gpu::MemoryUse::kToGpu);
  const std::array sizes{
      vk::DescriptorPoolSize{.type = vk::DescriptorType::eUniformBuffer, .descriptorCount = 1},
      vk::DescriptorPoolSize{.type = vk::DescriptorType::eCombinedImageSampler,
                             .descriptorCount = 3}};
  pool_ = device.raii().createDescriptorPool(
      {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
       .maxSets = 1,
       .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
       .pPoolSizes = sizes.data()});
  frame_set_ = std::move(vk::raii::DescriptorSets(
      device.raii(), vk::DescriptorSetAllocateInfo{.descriptorPool = *pool_,
                                                   .descriptorSetCount = 1,
                                                   .pSetLayouts = &*layout_.frame_set})[0]);
}

void FrameDrawer::checkView(const View& view) const {
  const vk::PhysicalDeviceLimits& limits = device_->limits();
  const auto most = static_cast<int>(
      std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxImageDimension2D,
                limits.maxViewportDimensions[0], limits.maxViewportDimensions[1], 1u << 20}));
  const auto check = [most](const char* what, int value, int least) {
    if (value < least || value > most)
      throw Error("view",
                  std::string(what) + " is " + std::to_string(value) + ", not between " +
                      std::to_string(least) + " and the device's " + std::to_string(most),
                  "choose another size");
  };
  check("width", view.width, 1);
  check("height", view.height, 1);
  check("shadow_map_size", view.shadow_map_size, 16);
}

void FrameDrawer::resize(const View& view) {
  using Usage = vk::ImageUsageFlagBits;
  const auto width = static_cast<std::uint32_t>(view.width);
  const auto height = static_cast<std::uint32_t>(view.height);
  if (!targets_ || targets_->color.request.width != width ||
      targets_->color.request.height != height) {
    targets_.reset();
    gpu::ImageRequest request{.format = FrameLayout::kColor,
                              .width = width,
                              .height = height,
                              .samples = FrameLayout::kSamples,
                              .usage = Usage::eColorAttachment};
    gpu::Texture color = gpu::makeTexture(*device_, request);
    request.samples = vk::SampleCountFlagBits::e1;
    request.usage = Usage::eColorAttachment | Usage::eTransferSrc;
    gpu::Texture resolved = gpu::makeTexture(*device_, request);
    gpu::Texture depth = gpu::makeTexture(*device_, {.format = FrameLayout::kDepth,
                                                     .width = width,
                                                     .height = height,
                                                     .samples = FrameLayout::kSamples,
                                                     .usage = Usage::eDepthStencilAttachment,
                                                     .aspect = kDepthAspect});
    gpu::Buffer readback =
        gpu::makeBuffer(*device_, vk::DeviceSize{width} * height * 4,
                        vk::BufferUsageFlagBits::eTransferDst, gpu::MemoryUse::kFromGpu);
    targets_ =
        Targets{std::move(color), std::move(depth), std::move(resolved), std::move(readback)};
  }
  const auto size = static_cast<std::uint32_t>(view.shadow_map_size);
  if (!shadow_map_ || shadow_map_->request.width != size) {
    shadow_map_.reset();
    shadow_map_ =
        gpu::makeTexture(*device_, {.format = FrameLayout::kDepth,
                                    .width = size,
                                    .height = size,
                                    .usage = Usage::eDepthStencilAttachment | Usage::eSampled,
                                    .aspect = kDepthAspect});
    writeFrameSet();
  }
}

void FrameDrawer::writeFrameSet() {
  const vk::DescriptorBufferInfo uniforms{.buffer = *uniforms_.buffer, .range = VK_WHOLE_SIZE};
  const vk::DescriptorImageInfo shadow{.sampler = *shadow_sampler_,
                                       .imageView = *shadow_map_->view,
                                       .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
  const vk::DescriptorImageInfo ground{.sampler = *ground_sampler_,
                                       .imageView = *ground_texture_.view,
                                       .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
  vk::DescriptorImageInfo noise = ground;
  noise.imageView = *ground_noise_.view;
  const auto write = [this](std::uint32_t binding, vk::DescriptorType type) {
    return vk::WriteDescriptorSet{
        .dstSet = *frame_set_, .dstBinding = binding, .descriptorCount = 1, .descriptorType = type};
  };
  std::array writes{write(0, vk::DescriptorType::eUniformBuffer),
                    write(1, vk::DescriptorType::eCombinedImageSampler),
                    write(2, vk::DescriptorType::eCombinedImageSampler),
                    write(3, vk::DescriptorType::eCombinedImageSampler)};
  writes[0].pBufferInfo = &uniforms;
  writes[1].pImageInfo = &shadow;
  writes[2].pImageInfo = &ground;
  writes[3].pImageInfo = &noise;
  device_->raii().updateDescriptorSets(writes, nullptr);
}

shared::FrameUniforms FrameDrawer::makeUniforms(const GpuScene& scene, const View& view) const {
  shared::FrameUniforms u{};
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const CameraRays rays = cameraRays(view.camera, aspect);
  u.clip_from_world = clipFromWorld(view.camera, aspect);
  u.eye = glm::vec4(rays.eye, 0.0f);
  u.ray_right = glm::vec4(rays.right, 0.0f);
  u.ray_down = glm::vec4(rays.down, 0.0f);
  u.ray_forward = glm::vec4(rays.forward, 0.0f);
  const glm::vec3 to_sun = directionOf(view.sun_azimuth, view.sun_elevation);
  const ShadowFit fit = fitShadow(scene.bounds(), to_sun, view.shadow_map_size);
  u.shadow_from_world = fit.shadow_from_world;
  u.to_sun = glm::vec4(to_sun, fit.texel_m);
  u.sun_color = glm::vec4(view.sun_color, 1.0f / static_cast<float>(view.shadow_map_size));
  u.ambient_color = glm::vec4(view.ambient_color, 0.0f);
  u.sky_horizon = glm::vec4(view.background.value_or(look::kSkyHorizon), 0.0f);
  u.sky_zenith = glm::vec4(view.background.value_or(look::kSkyZenith), 0.0f);
  const float distance = glm::length(view.camera.eye - view.camera.target);
  const float haze = std::max(look::kHazeHalf * distance, look::kHazeHalfLeast_m);
  u.ground = glm::vec4(scene.groundHeight(), look::kGroundRadius * haze, haze, look::kGroundTile_m);
  return u;
}

void FrameDrawer::recordColor(const vk::raii::CommandBuffer& commands, const GpuScene& scene,
                              const View& view) const {
  gpu::imageBarrier(commands, *targets_->color.image, kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  gpu::imageBarrier(commands, *targets_->resolved.image, kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  gpu::imageBarrier(commands, *targets_->depth.image, kDepthAspect, gpu::Use::kUndefined,
                    gpu::Use::kDepthAttachment);
  const vk::RenderingAttachmentInfo color{
      .imageView = *targets_->color.view,
      .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .resolveMode = vk::ResolveModeFlagBits::eAverage,
      .resolveImageView = *targets_->resolved.view,
      .resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eDontCare,
      .clearValue = vk::ClearValue(vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, 1.0f}))};
  const vk::RenderingAttachmentInfo depth{
      .imageView = *targets_->depth.view,
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eDontCare,
      .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 0.0f})};
  const vk::Rect2D area{.extent = {targets_->color.request.width, targets_->color.request.height}};
  commands.beginRendering({.renderArea = area,
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                       .height = static_cast<float>(area.extent.height),
                                       .maxDepth = 1.0f});
  commands.setScissor(0, area);
  plant_pass_.record(commands, layout_, *frame_set_, scene, view.terms);
  if (scene.ground()) ground_pass_.record(commands, layout_, *frame_set_, view.terms);
  sky_pass_.record(commands, layout_, *frame_set_);
  commands.endRendering();
}

Frame FrameDrawer::draw(const GpuScene& scene, const View& view) {
  checkView(view);
  resize(view);
  const shared::FrameUniforms uniforms = makeUniforms(scene, view);
  std::memcpy(uniforms_.memory.mapped(), &uniforms, sizeof(uniforms));
  plant_pass_.prepare(*device_, layout_, scene, view.terms);
  if (scene.ground()) ground_pass_.prepare(*device_, layout_, view.terms);

  device_->submit([&](const vk::raii::CommandBuffer& commands) {
    timers_.reset(commands);
    timers_.stamp(commands, 0);
    shadow_pass_.record(commands, layout_, *frame_set_, scene, *shadow_map_, view.terms.shadow);
    timers_.stamp(commands, 1);
    recordColor(commands, scene, view);
    timers_.stamp(commands, 2);

    gpu::imageBarrier(commands, *targets_->resolved.image, kColorAspect, gpu::Use::kColorAttachment,
                      gpu::Use::kTransferSource);
    const vk::BufferImageCopy copy{
        .imageSubresource = {.aspectMask = kColorAspect, .layerCount = 1},
        .imageExtent = {targets_->resolved.request.width, targets_->resolved.request.height, 1}};
    commands.copyImageToBuffer(*targets_->resolved.image, vk::ImageLayout::eTransferSrcOptimal,
                               *targets_->readback.buffer, copy);
    gpu::bufferBarrier(commands, *targets_->readback.buffer, gpu::Use::kTransferTarget,
                       gpu::Use::kHostRead);
  });
  Frame frame;
  frame.image = readBack();
  frame.times.shadow_ms = timers_.milliseconds(0, 1);
  frame.times.color_ms = timers_.milliseconds(1, 2);
  return frame;
}

Image FrameDrawer::readBack() const {
  Image image(static_cast<int>(targets_->resolved.request.width),
              static_cast<int>(targets_->resolved.request.height));
  std::memcpy(image.rgba.data(), targets_->readback.memory.mapped(), image.rgba.size());
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

}  // namespace verdure
