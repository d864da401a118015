#include "render/blocker_pass.h"

#include <array>

#include "shared/foliage_shadow.h"

namespace verdure {
namespace {

constexpr std::uint32_t kBlockerFragment[] = {
#include "shaders/blocker_pass.frag.inc"
};

}  // namespace

BlockerPass::BlockerPass(const gpu::Device& device)
    : device_(&device),
      set_layout_(
          device,
          {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler},
          vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eFragment, sizeof(std::uint32_t))),
      pipeline_(makeFullscreenPipeline(device, kBlockerFragment, *layout_, kFormat)),
      set_(device, set_layout_) {}

void BlockerPass::setSources(const gpu::Texture& foliage_maps, const gpu::Texture& wood_maps,
                             vk::Sampler linear, vk::Sampler texels) {
  using Usage = vk::ImageUsageFlagBits;
  const auto block = static_cast<std::uint32_t>(shared::blockerBlock());
  maps_.reset();
  maps_ = gpu::makeTexture(*device_, {.format = kFormat,
                                      .width = (wood_maps.request.width + block - 1) / block,
                                      .height = (wood_maps.request.height + block - 1) / block,
                                      .layers = wood_maps.request.layers,
                                      .usage = Usage::eColorAttachment | Usage::eSampled});
  set_.setTexture(0, foliage_maps, linear);
  set_.setTexture(1, wood_maps, texels);
}

void BlockerPass::record(const vk::raii::CommandBuffer& commands, std::uint32_t count) const {
  gpu::imageBarrier(commands, *maps_->image, gpu::kColorAspect, gpu::Use::kUndefined,
                    gpu::Use::kColorAttachment);
  for (std::uint32_t cascade = 0; cascade < count; ++cascade) {
    commands.pushConstants<std::uint32_t>(*layout_, vk::ShaderStageFlagBits::eFragment, 0, cascade);
    drawFullscreen(commands, *maps_->layer_views[cascade],
                   {maps_->request.width, maps_->request.height}, pipeline_, *layout_, *set_);
  }
  gpu::imageBarrier(commands, *maps_->image, gpu::kColorAspect, gpu::Use::kColorAttachment,
                    gpu::Use::kFragmentSampled);
}

}  // namespace verdure
