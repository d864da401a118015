#include "render/exposure_pass.h"

#include <array>
#include <cstring>

namespace verdure {
namespace {

constexpr std::uint32_t kTiles[] = {
#include "shaders/exposure_tiles.comp.inc"
};
constexpr std::uint32_t kMean[] = {
#include "shaders/exposure_mean.comp.inc"
};
constexpr std::uint32_t kTileSize = 64;  // as in exposure_tiles.comp

}  // namespace

ExposurePass::ExposurePass(const gpu::Device& device)
    : device_(&device),
      set_layout_(device,
                  {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer},
                  vk::ShaderStageFlagBits::eCompute),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eCompute, sizeof(float))),
      tiles_(gpu::makeComputePipeline(device, kTiles, *layout_)),
      mean_(gpu::makeComputePipeline(device, kMean, *layout_)),
      sampler_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)),
      set_(device, set_layout_) {}

void ExposurePass::setSource(const gpu::Texture& source) {
  columns_ = (source.request.width + kTileSize - 1) / kTileSize;
  rows_ = (source.request.height + kTileSize - 1) / kTileSize;
  sums_.reset();
  sums_ = gpu::makeBuffer(*device_, (vk::DeviceSize{columns_} * rows_ + 1) * 2 * sizeof(float),
                          vk::BufferUsageFlagBits::eStorageBuffer, gpu::MemoryUse::kFromGpu);
  std::memset(sums_->memory.mapped(), 0, sums_->size);
  set_.setTexture(0, source, *sampler_);
  set_.setBuffer(1, *sums_);
}

void ExposurePass::record(const vk::raii::CommandBuffer& commands, float smallest) const {
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, {*set_}, nullptr);
  commands.pushConstants<float>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, smallest);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *tiles_);
  commands.dispatch(columns_, rows_, 1);
  gpu::bufferBarrier(commands, *sums_->buffer, gpu::Use::kComputeStorage,
                     gpu::Use::kComputeStorage);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *mean_);
  commands.dispatch(1, 1, 1);
  gpu::bufferBarrier(commands, *sums_->buffer, gpu::Use::kComputeStorage,
                     gpu::Use::kFragmentStorage);
  gpu::bufferBarrier(commands, *sums_->buffer, gpu::Use::kComputeStorage, gpu::Use::kHostRead);
}

float ExposurePass::average() const {
  float value = 0.0f;
  std::memcpy(&value, sums_->memory.mapped(), sizeof(value));
  return value;
}

}  // namespace verdure
