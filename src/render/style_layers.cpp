#include "render/style_layers.h"

namespace verdure {
namespace {

constexpr std::uint32_t kStyleLayersVertex[] = {
#include "shaders/plant_pass.vert.inc"
};
constexpr std::uint32_t kStyleLayersFragment[] = {
#include "shaders/style_layers.frag.inc"
};
using Usage = vk::ImageUsageFlagBits;

/// The ambient coefficient counts where normals are scaled by it.
AmbientSource ambientOf(const View& view) {
  return view.style_normals == StyleNormals::kScaled ? AmbientSource::kBaked : AmbientSource::kSky;
}

gpu::Constants constantsOf(const Draw& draw, const View& view) {
  const bool leaf_normals = view.style_normals == StyleNormals::kRaw || !draw.baked;
  return termConstants(view.terms, {.ambient_source = ambientOf(view),
                                    .flip_normal = draw.foliage && leaf_normals,
                                    .alpha_test = draw.alpha_test,
                                    .foliage = draw.foliage,
                                    .moving = draw.moving,
                                    .forest = draw.forest.has_value()});
}

}  // namespace

StyleLayers::StyleLayers(const gpu::Device& device, const FrameLayout& layout,
                         vk::DescriptorSetLayout motion_set)
    : device_(&device),
      ground_layout_(device, {vk::DescriptorType::eCombinedImageSampler},
                     vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device,
                                      std::array{*layout.frame_set.layout, *layout.material_set,
                                                 motion_set, *ground_layout_.layout},
                                      vk::ShaderStageFlagBits::eFragment,
                                      sizeof(shared::DrawUniforms), sizeof(std::uint32_t))),
      nearest_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)),
      ground_set_(device, ground_layout_) {}

void StyleLayers::prepare(const GpuScene& scene, const View& view, const gpu::Texture& ground_depth,
                          bool new_targets, ImpostorPass& impostors) {
  if (scene.forest() != nullptr)
    impostors.prepareDrawn(view.terms, {.ambient_source = ambientOf(view)}, *ground_layout_.layout,
                           kFormat);
  for (const Draw& draw : scene.draws()) {
    gpu::Constants constants = constantsOf(draw, view);
    if (!draw.seen || pipelines_.contains(constants)) continue;
    pipelines_.emplace(constants,
                       gpu::makeGraphicsPipeline(*device_, {.vertex = kStyleLayersVertex,
                                                            .fragment = kStyleLayersFragment,
                                                            .constants = constants,
                                                            .layout = *layout_,
                                                            .bindings = GpuScene::bindings(false),
                                                            .attributes = GpuScene::attributes(),
                                                            .color = kFormat,
                                                            .more_colors = {kFormat, kFormat},
                                                            .depth = FrameLayout::kDepth,
                                                            .samples = FrameLayout::kSamples}));
  }
  if (!new_targets && *depth_.image) return;
  const std::uint32_t width = ground_depth.request.width, height = ground_depth.request.height;
  const auto make = [&](vk::SampleCountFlagBits samples, vk::ImageUsageFlags usage) {
    return gpu::makeTexture(*device_, {.format = kFormat,
                                       .width = width,
                                       .height = height,
                                       .samples = samples,
                                       .usage = Usage::eColorAttachment | usage});
  };
  for (gpu::Texture& samples : samples_) {
    samples = {};
    samples = make(FrameLayout::kSamples, Usage::eTransientAttachment);
  }
  for (Layer& layer : layers_)
    for (gpu::Texture* texture : {&layer.normal, &layer.color, &layer.shape}) {
      *texture = {};
      *texture = make(vk::SampleCountFlagBits::e1, Usage::eSampled);
    }
  depth_ = {};
  depth_ = gpu::makeTexture(*device_, {.format = FrameLayout::kDepth,
                                       .width = width,
                                       .height = height,
                                       .samples = FrameLayout::kSamples,
                                       .usage = Usage::eDepthStencilAttachment,
                                       .aspect = vk::ImageAspectFlagBits::eDepth});
  ground_set_.setTexture(0, ground_depth, *nearest_);
}

void StyleLayers::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                         const GpuScene& scene, const View& view,
                         const ImpostorPass& impostors) const {
  const NormalSource normals =
      view.style_normals == StyleNormals::kRaw ? NormalSource::kLeaf : NormalSource::kCrown;
  for (const bool foliage : {true, false}) {
    const Layer& layer = foliage ? this->foliage() : wood();
    const std::array<const gpu::Texture*, 3> results{&layer.normal, &layer.color, &layer.shape};
    std::array<vk::RenderingAttachmentInfo, 3> colors;
    for (std::size_t i = 0; i < colors.size(); ++i) {
      // The samples of the layer before have been read by its resolve.
      gpu::imageBarrier(commands, *samples_[i].image, gpu::kColorAspect,
                        foliage ? gpu::Use::kUndefined : gpu::Use::kColorAttachment,
                        gpu::Use::kColorAttachment);
      gpu::imageBarrier(commands, *results[i]->image, gpu::kColorAspect, gpu::Use::kUndefined,
                        gpu::Use::kColorAttachment);
      colors[i] = vk::RenderingAttachmentInfo{
          .imageView = *samples_[i].view,
          .imageLayout = vk::ImageLayout::eColorAttachmentOptimal,
          .resolveMode = vk::ResolveModeFlagBits::eAverage,
          .resolveImageView = *results[i]->view,
          .resolveImageLayout = vk::ImageLayout::eColorAttachmentOptimal,
          .loadOp = vk::AttachmentLoadOp::eClear,
          .storeOp = vk::AttachmentStoreOp::eDontCare,
          .clearValue = vk::ClearValue(vk::ClearColorValue(std::array{0.0f, 0.0f, 0.0f, 0.0f}))};
    }
    gpu::imageBarrier(commands, *depth_.image, vk::ImageAspectFlagBits::eDepth,
                      foliage ? gpu::Use::kUndefined : gpu::Use::kDepthAttachment,
                      gpu::Use::kDepthAttachment);
    const vk::RenderingAttachmentInfo depth{
        .imageView = *depth_.view,
        .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
        .loadOp = vk::AttachmentLoadOp::eClear,
        .storeOp = vk::AttachmentStoreOp::eDontCare,
        .clearValue = vk::ClearValue(vk::ClearDepthStencilValue{.depth = 0.0f})};
    const vk::Rect2D area{.extent = {depth_.request.width, depth_.request.height}};
    commands.beginRendering({.renderArea = area,
                             .layerCount = 1,
                             .colorAttachmentCount = 3,
                             .pColorAttachments = colors.data(),
                             .pDepthAttachment = &depth});
    commands.setViewport(0, vk::Viewport{.width = static_cast<float>(area.extent.width),
                                         .height = static_cast<float>(area.extent.height),
                                         .maxDepth = 1.0f});
    commands.setScissor(0, area);
    if (!scene.draws().empty()) scene.bindVertices(commands, normals);
    for (const Draw& draw : scene.draws()) {
      if (!draw.seen || draw.foliage != foliage) continue;
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                            *pipelines_.at(constantsOf(draw, view)));
      commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, 3, {*ground_set_},
                                  nullptr);
      scene.recordSeen(commands, *layout_, frame_set, draw);
    }
    if (foliage && scene.forest() != nullptr)
      impostors.recordDrawn(commands, frame_set, *ground_set_, *scene.forest(), view.terms,
                            {.ambient_source = ambientOf(view)});
    commands.endRendering();
    for (const gpu::Texture* result : results)
      gpu::imageBarrier(commands, *result->image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                        gpu::Use::kFragmentSampled);
  }
}

}  // namespace verdure
