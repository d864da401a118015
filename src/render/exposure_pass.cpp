#include "render/exposure_pass.h"

#include <array>
#include <cstring>

#include "shared/tone.h"

namespace verdure {
namespace {

constexpr std::uint32_t kTiles[] = {
#include "shaders/exposure_tiles.comp.inc"
};
constexpr std::uint32_t kMean[] = {
#include "shaders/exposure_mean.comp.inc"
};
constexpr std::uint32_t kTileSize = 64;  // as in exposure_tiles.comp
constexpr vk::DeviceSize kBinBytes = shared::kLuminanceBins * sizeof(std::uint32_t);

}  // namespace

ExposurePass::ExposurePass(const gpu::Device& device)
    : device_(&device),
      set_layout_(device,
                  {vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eStorageBuffer,
                   vk::DescriptorType::eStorageBuffer},
                  vk::ShaderStageFlagBits::eCompute),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eCompute, sizeof(float))),
      tiles_(gpu::makeComputePipeline(device, kTiles, *layout_)),
      mean_(gpu::makeComputePipeline(device, kMean, *layout_)),
      sampler_(
          gpu::makeSampler(device, vk::Filter::eNearest, vk::SamplerAddressMode::eClampToEdge)),
      set_(device, set_layout_),
      result_(gpu::makeBuffer(device, 2 * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer,
                              gpu::MemoryUse::kFromGpu)) {
  std::memset(result_.memory.mapped(), 0, result_.size);
  set_.setBuffer(2, result_);
}

void ExposurePass::setSource(const gpu::Texture& source) {
  columns_ = (source.request.width + kTileSize - 1) / kTileSize;
  rows_ = (source.request.height + kTileSize - 1) / kTileSize;
  work_.reset();
  using Usage = vk::BufferUsageFlagBits;
  work_ =
      gpu::makeBuffer(*device_, kBinBytes + vk::DeviceSize{columns_} * rows_ * 2 * sizeof(float),
                      Usage::eStorageBuffer | Usage::eTransferDst, gpu::MemoryUse::kDevice);
  set_.setTexture(0, source, *sampler_);
  set_.setBuffer(1, *work_);
}

void ExposurePass::record(const vk::raii::CommandBuffer& commands, float smallest) const {
  commands.fillBuffer(*work_->buffer, 0, kBinBytes, 0);
  gpu::bufferBarrier(commands, *work_->buffer, gpu::Use::kTransferTarget,
                     gpu::Use::kComputeStorage);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, {*set_}, nullptr);
  commands.pushConstants<float>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, smallest);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *tiles_);
  commands.dispatch(columns_, rows_, 1);
  gpu::bufferBarrier(commands, *work_->buffer, gpu::Use::kComputeStorage,
                     gpu::Use::kComputeStorage);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *mean_);
  commands.dispatch(1, 1, 1);
  gpu::bufferBarrier(commands, *result_.buffer, gpu::Use::kComputeStorage,
                     gpu::Use::kFragmentStorage);
  gpu::bufferBarrier(commands, *result_.buffer, gpu::Use::kComputeStorage, gpu::Use::kHostRead);
}

ExposurePass::Measured ExposurePass::measured() const {
  Measured measured;
  std::memcpy(&measured, result_.memory.mapped(), sizeof(measured));
  return measured;
}

}  // namespace verdure
