#include "render/tone_pass.h"

#include <array>

namespace verdure {
namespace {

constexpr std::uint32_t kToneFragment[] = {
#include "shaders/tone_pass.frag.inc"
};

}  // namespace

TonePass::TonePass(const gpu::Device& device)
    : set_layout_(device,
                  {vk::DescriptorType::eCombinedImageSampler,
                   vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer},
                  vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eFragment,
                                      sizeof(shared::ToneUniforms))),
      pipeline_(makeFullscreenPipeline(device, kToneFragment, *layout_, kFormat)),
      nearest_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)),
      linear_(gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eClampToEdge)),
      set_(device, set_layout_) {}

void TonePass::setSource(const gpu::Texture& color, const gpu::Texture& bloom,
                         const gpu::Buffer& measured) {
  set_.setTexture(0, color, *nearest_);
  set_.setTexture(1, bloom, *linear_);
  set_.setBuffer(2, measured);
}

void TonePass::record(const vk::raii::CommandBuffer& commands, const gpu::Texture& target,
                      const shared::ToneUniforms& uniforms) const {
  commands.pushConstants<shared::ToneUniforms>(*layout_, vk::ShaderStageFlagBits::eFragment, 0,
                                               uniforms);
  drawFullscreen(commands, target, pipeline_, *layout_, *set_);
}

}  // namespace verdure
