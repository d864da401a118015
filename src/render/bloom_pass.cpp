#include "render/bloom_pass.h"

#include <algorithm>
#include <array>

namespace verdure {
namespace {

constexpr std::uint32_t kDown[] = {
#include "shaders/bloom_down.frag.inc"
};
constexpr std::uint32_t kUp[] = {
#include "shaders/bloom_up.frag.inc"
};
constexpr vk::Format kFormat = vk::Format::eR16G16B16A16Sfloat;
constexpr std::size_t kMostLevels = 7;  // the widest spreads over some 2^8 pixels
constexpr std::uint32_t kSmallest = 6;  // pixels across the coarsest level, about

gpu::Texture makeLevel(const gpu::Device& device, std::uint32_t width, std::uint32_t height) {
  using Usage = vk::ImageUsageFlagBits;
  return gpu::makeTexture(device, {.format = kFormat,
                                   .width = width,
                                   .height = height,
                                   .usage = Usage::eColorAttachment | Usage::eSampled});
}

}  // namespace

BloomPass::BloomPass(const gpu::Device& device)
    : device_(&device),
      set_(device,
           {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eCombinedImageSampler},
           vk::ShaderStageFlagBits::eFragment),
      layout_(gpu::makePipelineLayout(device, std::array{*set_.layout})),
      down_(makeFullscreenPipeline(device, kDown, *layout_, kFormat)),
      up_(makeFullscreenPipeline(device, kUp, *layout_, kFormat)),
      sampler_(
          gpu::makeSampler(device, vk::Filter::eLinear, vk::SamplerAddressMode::eClampToEdge)) {}

void BloomPass::setSource(const gpu::Texture& source) {
  levels_.clear();
  std::uint32_t width = source.request.width, height = source.request.height;
  do {
    width = std::max(width / 2, 1u);
    height = std::max(height / 2, 1u);
    levels_.push_back({makeLevel(*device_, width, height), makeLevel(*device_, width, height),
                       gpu::DescriptorSet(*device_, set_), gpu::DescriptorSet(*device_, set_)});
  } while (levels_.size() < kMostLevels && std::min(width, height) >= 2 * kSmallest);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    const bool coarsest = i + 1 == levels_.size();
    const gpu::Texture& finer = i == 0 ? source : levels_[i - 1].average;
    const gpu::Texture& coarser = coarsest                  ? level.average
                                  : i + 2 == levels_.size() ? levels_[i + 1].average
                                                            : levels_[i + 1].spread;
    level.down.setTexture(0, finer, *sampler_);
    level.down.setTexture(1, finer, *sampler_);
    level.up.setTexture(0, level.average, *sampler_);
    level.up.setTexture(1, coarser, *sampler_);
  }
}

void BloomPass::record(const vk::raii::CommandBuffer& commands, bool on) const {
  const auto readable = [&](const gpu::Texture& texture, gpu::Use from) {
    gpu::imageBarrier(commands, *texture.image, gpu::kColorAspect, from,
                      gpu::Use::kFragmentSampled);
  };
  if (!on) {
    readable(result(), gpu::Use::kUndefined);
    return;
  }
  for (const Level& level : levels_) {
    drawFullscreen(commands, level.average, down_, *layout_, *level.down);
    readable(level.average, gpu::Use::kColorAttachment);
  }
  for (std::size_t i = levels_.size() - (levels_.size() > 1 ? 1 : 0); i-- > 0;) {
    drawFullscreen(commands, levels_[i].spread, up_, *layout_, *levels_[i].up);
    readable(levels_[i].spread, gpu::Use::kColorAttachment);
  }
}

}  // namespace verdure
