#include "render/transfer_pass.h"

#include <array>
#include <cstring>

namespace verdure {
namespace {

constexpr std::uint32_t kShader[] = {
#include "shaders/transfer_pass.comp.inc"
};
constexpr std::uint32_t kGroupSize = 64;   // as in transfer_pass.comp
constexpr std::size_t kBytesOfLight = 16;  // of one vertex

}  // namespace

GpuTransfer::GpuTransfer(const gpu::Device& device, gpu::Upload& upload,
                         std::span<const PackedTransfer> parts, std::size_t vertices,
                         const gpu::SetLayout& set_layout)
    : weights_(gpu::makeBuffer(device, sunWeightsAt(kMostBounceBands + 1) * sizeof(glm::vec2),
                               vk::BufferUsageFlagBits::eStorageBuffer, gpu::MemoryUse::kToGpu)),
      light_(upload.buffer(
          std::span<const std::byte>(
              std::vector<std::byte>((parts.empty() ? 1 : vertices) * kBytesOfLight)),
          vk::BufferUsageFlagBits::eVertexBuffer | vk::BufferUsageFlagBits::eStorageBuffer)) {
  for (const PackedTransfer& packed : parts) {
    Part part{packed.uniforms,
              upload.buffer(std::span(packed.words), vk::BufferUsageFlagBits::eStorageBuffer),
              gpu::DescriptorSet(device, set_layout)};
    part.set.setBuffer(0, part.words);
    part.set.setBuffer(1, weights_);
    part.set.setBuffer(2, light_);
    parts_.push_back(std::move(part));
  }
}

TransferPass::TransferPass(const gpu::Device& device)
    : set_layout_(device,
                  {vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
                   vk::DescriptorType::eStorageBuffer},
                  vk::ShaderStageFlagBits::eCompute),
      layout_(gpu::makePipelineLayout(device, std::array{*set_layout_.layout},
                                      vk::ShaderStageFlagBits::eCompute,
                                      sizeof(shared::TransferUniforms))),
      pipeline_(gpu::makeComputePipeline(device, kShader, *layout_)) {}

void TransferPass::record(const vk::raii::CommandBuffer& commands, GpuTransfer& transfer,
                          std::vector<glm::vec2> weights) const {
  if (transfer.parts_.empty() || transfer.known_weights_ == weights) return;
  transfer.known_weights_ = std::move(weights);
  std::memcpy(transfer.weights_.memory.mapped(), transfer.known_weights_.data(),
              transfer.known_weights_.size() * sizeof(glm::vec2));
  const vk::Buffer light = *transfer.light_.buffer;
  gpu::bufferBarrier(commands, light, gpu::Use::kVertexInput, gpu::Use::kComputeStorage);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  for (const GpuTransfer::Part& part : transfer.parts_) {
    gpu::bufferBarrier(commands, *part.words.buffer, gpu::Use::kVertexInput,
                       gpu::Use::kComputeStorage);  // an upload leaves buffers as vertex input
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, {*part.set}, nullptr);
    commands.pushConstants<shared::TransferUniforms>(*layout_, vk::ShaderStageFlagBits::eCompute, 0,
                                                     part.uniforms);
    commands.dispatch((part.uniforms.count + kGroupSize - 1) / kGroupSize, 1, 1);
  }
  gpu::bufferBarrier(commands, light, gpu::Use::kComputeStorage, gpu::Use::kVertexInput);
}

}  // namespace verdure
