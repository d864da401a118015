#include "render/style_pass.h"

#include <algorithm>
#include <cmath>

#include "render/paper.h"
#include "render/tone_pass.h"
#include "scene/camera.h"

namespace verdure {
namespace {

constexpr std::uint32_t kBlur[] = {
#include "shaders/style_blur.frag.inc"
};
constexpr std::uint32_t kMerge[] = {
#include "shaders/style_merge.frag.inc"
};
constexpr std::uint32_t kNormals[] = {
#include "shaders/style_normals.frag.inc"
};
constexpr std::uint32_t kEdges[] = {
#include "shaders/style_edges.frag.inc"
};
constexpr std::uint32_t kToon[] = {
#include "shaders/style_toon.frag.inc"
};
constexpr std::uint32_t kWatercolor[] = {
#include "shaders/style_watercolor.frag.inc"
};
constexpr vk::ImageAspectFlags kDepthAspect = vk::ImageAspectFlagBits::eDepth;
constexpr vk::Format kFormat = StyleLayers::kFormat;
constexpr int kPaperSize = 512;

// Deviations of the Gaussians, as shares of the picture's height: of normals before lines are
// looked for, of foliage for its outline, for its tones, and for what lies around, of sky and
// ground.
constexpr float kNormalBlur = 0.0014f;
constexpr float kFineBlur = 0.0030f;
constexpr float kBroadBlur = 0.0085f;
constexpr float kWideBlur = 0.030f;
constexpr float kBackdropBlur = 0.008f;

vk::raii::Pipeline mergePipeline(const gpu::Device& device, vk::PipelineLayout layout,
                                 bool normals) {
  return makeFullscreenPipeline(device, kMerge, layout, kFormat, {normals});
}

}  // namespace

StylePass::StylePass(const gpu::Device& device, const FrameLayout& layout,
                     vk::DescriptorSetLayout motion_set)
    : device_(&device),
      layers_(device, layout, motion_set),
      blur_layout_(device, {vk::DescriptorType::eCombinedImageSampler},
                   vk::ShaderStageFlagBits::eFragment),
      merge_layout_(
          device,
          {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler},
          vk::ShaderStageFlagBits::eFragment),
      style_layout_(
          device,
          {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler,
           vk::DescriptorType::eCombinedImageSampler},
          vk::ShaderStageFlagBits::eFragment),
      blur_pipeline_layout_(gpu::makePipelineLayout(device, std::array{*blur_layout_.layout},
                                                    vk::ShaderStageFlagBits::eFragment,
                                                    sizeof(shared::BlurUniforms))),
      merge_pipeline_layout_(gpu::makePipelineLayout(device, std::array{*merge_layout_.layout},
                                                     vk::ShaderStageFlagBits::eFragment,
                                                     sizeof(shared::StyleUniforms))),
      style_pipeline_layout_(gpu::makePipelineLayout(device, std::array{*style_layout_.layout},
                                                     vk::ShaderStageFlagBits::eFragment,
                                                     sizeof(shared::StyleUniforms))),
      blur_(makeFullscreenPipeline(device, kBlur, *blur_pipeline_layout_, kFormat)),
      merge_normals_(mergePipeline(device, *merge_pipeline_layout_, true)),
      merge_depths_(mergePipeline(device, *merge_pipeline_layout_, false)),
      linear_(gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eClampToEdge)),
      nearest_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)),
      repeat_(gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eRepeat)),
      merge_set_(device, merge_layout_),
      style_set_(device, style_layout_) {
  const std::pair<Style, gpu::SpirV> shaders[] = {{Style::kNormals, kNormals},
                                                  {Style::kEdges, kEdges},
                                                  {Style::kToon, kToon},
                                                  {Style::kWatercolor, kWatercolor}};
  for (const auto& [style, shader] : shaders)
    styles_.emplace(
        style, makeFullscreenPipeline(device, shader, *style_pipeline_layout_, TonePass::kFormat));
  gpu::Upload upload(device);
  paper_ =
      upload.texture(buildLinearMips(makePaper(kPaperSize)).levels, vk::Format::eR8G8B8A8Unorm);
  upload.finish();
}

StylePass::Blur StylePass::makeBlur(const gpu::Texture& source, float sigma,
                                    std::uint32_t shrink) const {
  const glm::vec2 size(source.request.width, source.request.height);
  const std::uint32_t width = std::max(source.request.width / shrink, 1u);
  const std::uint32_t height = std::max(source.request.height / shrink, 1u);
  const auto make = [&] {
    using Usage = vk::ImageUsageFlagBits;
    return gpu::makeTexture(*device_, {.format = kFormat,
                                       .width = width,
                                       .height = height,
                                       .usage = Usage::eColorAttachment | Usage::eSampled});
  };
  Blur blur;
  blur.across = make();
  blur.result = make();
  blur.from_source.emplace(*device_, blur_layout_);
  blur.from_source->setTexture(0, source, *linear_);
  blur.from_across.emplace(*device_, blur_layout_);
  blur.from_across->setTexture(0, blur.across, *linear_);
  const glm::vec2 texel(1.0f / static_cast<float>(width), 1.0f / static_cast<float>(height));
  // Both directions walk in texels of the target.
  const glm::vec2 sigmas = glm::max(sigma / (size * texel), 0.3f);
  const auto along = [&](glm::vec2 direction, float deviation) {
    return shared::BlurUniforms{.step = direction * texel,
                                .texel = texel,
                                .sigma = deviation,
                                .reach = static_cast<int>(std::ceil(2.7f * deviation))};
  };
  blur.first = along({1.0f, 0.0f}, sigmas.x);
  blur.second = along({0.0f, 1.0f}, sigmas.y);
  return blur;
}

void StylePass::forgetTargets() {
  backdrop_ = {};
  for (Blur* blur : {&soft_normals_, &foliage_fine_, &foliage_broad_, &foliage_wide_,
                     &foliage_color_, &soft_backdrop_})
    *blur = {};  // sets go before others take their place: their pools must not go first
}

void StylePass::makeTargets(const gpu::Texture& ground_depth) {
  const std::uint32_t width = ground_depth.request.width, height = ground_depth.request.height;
  const auto make = [&](vk::Format format) {
    using Usage = vk::ImageUsageFlagBits;
    return gpu::makeTexture(*device_, {.format = format,
                                       .width = width,
                                       .height = height,
                                       .usage = Usage::eColorAttachment | Usage::eSampled});
  };
  backdrop_ = make(TonePass::kFormat);
  normals_ = make(kFormat);
  depths_ = make(kFormat);
  const auto lines = static_cast<float>(height);
  const StyleLayers::Layer &foliage = layers_.foliage(), &wood = layers_.wood();
  soft_normals_ = makeBlur(normals_, kNormalBlur * lines, 1);
  foliage_fine_ = makeBlur(foliage.shape, kFineBlur * lines, 1);
  foliage_broad_ = makeBlur(foliage.shape, kBroadBlur * lines, 2);
  foliage_wide_ = makeBlur(foliage_broad_.result, kWideBlur * lines / 2.0f, 2);
  foliage_color_ = makeBlur(foliage.color, kBroadBlur * lines, 2);
  soft_backdrop_ = makeBlur(backdrop_, kBackdropBlur * lines, 2);
  merge_set_.setTexture(0, foliage.normal, *nearest_);
  merge_set_.setTexture(1, foliage.shape, *nearest_);
  merge_set_.setTexture(2, wood.normal, *nearest_);
  merge_set_.setTexture(3, wood.shape, *nearest_);
  merge_set_.setTexture(4, ground_depth, *nearest_);
  const gpu::Texture* const read[] = {&soft_normals_.result,
                                      &depths_,
                                      &wood.color,
                                      &wood.shape,
                                      &foliage_color_.result,
                                      &foliage_fine_.result,
                                      &foliage_broad_.result,
                                      &foliage_wide_.result,
                                      &soft_backdrop_.result};
  std::uint32_t binding = 0;
  for (const gpu::Texture* texture : read) style_set_.setTexture(binding++, *texture, *linear_);
  style_set_.setTexture(binding++, paper_, *repeat_);
  style_set_.setTexture(binding, normals_, *nearest_);
}

void StylePass::prepare(const GpuScene& scene, const View& view, const gpu::Texture& ground_depth,
                        ImpostorPass& impostors, float haze) {
  const bool make = !*backdrop_.image;
  layers_.prepare(scene, view, ground_depth, make, impostors);
  if (make) makeTargets(ground_depth);
  const glm::mat3 axes = cameraAxes(view.camera);
  const float near = clipFromWorld(view.camera, 1.0f)[3].z;  // clip z of all points
  uniforms_ = {.picture = glm::vec4(view.width, view.height, 1.0f / near, haze),
               .right = glm::vec4(axes[0], 0.0f),
               .up = glm::vec4(axes[1], 0.0f),
               .back = glm::vec4(axes[2], 0.0f),
               .background = glm::vec4(view.background.value_or(glm::vec3(1.0f)),
                                       view.background ? 1.0f : 0.0f)};
}

void StylePass::recordBlur(const vk::raii::CommandBuffer& commands, const Blur& blur) const {
  const auto draw = [&](const gpu::Texture& target, const gpu::DescriptorSet& set,
                        const shared::BlurUniforms& uniforms) {
    commands.pushConstants<shared::BlurUniforms>(*blur_pipeline_layout_,
                                                 vk::ShaderStageFlagBits::eFragment, 0, uniforms);
    drawFullscreen(commands, target, blur_, *blur_pipeline_layout_, *set);
    gpu::imageBarrier(commands, *target.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                      gpu::Use::kFragmentSampled);
  };
  draw(blur.across, *blur.from_source, blur.first);
  draw(blur.result, *blur.from_across, blur.second);
}

void StylePass::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                       const GpuScene& scene, const View& view, const ImpostorPass& impostors,
                       const gpu::Texture& ground_depth, const gpu::Texture& target) const {
  gpu::imageBarrier(commands, *ground_depth.image, kDepthAspect, gpu::Use::kDepthAttachment,
                    gpu::Use::kFragmentSampled);
  gpu::imageBarrier(commands, *backdrop_.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kFragmentSampled);
  layers_.record(commands, frame_set, scene, view, impostors);
  const auto push = [&](const vk::raii::PipelineLayout& layout) {
    commands.pushConstants<shared::StyleUniforms>(*layout, vk::ShaderStageFlagBits::eFragment, 0,
                                                  uniforms_);
  };
  push(merge_pipeline_layout_);
  for (const bool normals : {true, false}) {
    const gpu::Texture& merged = normals ? normals_ : depths_;
    drawFullscreen(commands, merged, normals ? merge_normals_ : merge_depths_,
                   *merge_pipeline_layout_, *merge_set_);
    gpu::imageBarrier(commands, *merged.image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                      gpu::Use::kFragmentSampled);
  }
  // What each style reads.
  std::vector<const Blur*> blurs;
  if (view.style != Style::kNormals) blurs = {&soft_normals_};
  if (view.style != Style::kNormals)
    blurs.insert(blurs.end(), {&foliage_fine_, &foliage_broad_, &foliage_wide_});
  if (view.style == Style::kToon || view.style == Style::kWatercolor)
    blurs.insert(blurs.end(), {&foliage_color_, &soft_backdrop_});
  for (const Blur* blur : blurs) recordBlur(commands, *blur);
  push(style_pipeline_layout_);
  drawFullscreen(commands, target, styles_.at(view.style), *style_pipeline_layout_, *style_set_);
}

}  // namespace verdure
