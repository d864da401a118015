#include "render/motion_pass.h"

#include <string>

#include "motion/motion_texture.h"
#include "render/gpu_forest.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr std::uint32_t kBranches[] = {
#include "shaders/branch_motion.comp.inc"
};
constexpr std::uint32_t kLeaves[] = {
#include "shaders/leaf_motion.comp.inc"
};
constexpr std::uint32_t kGroupSize = 64;  // as in motion_job.glsl

}  // namespace

MotionLayouts::MotionLayouts(const gpu::Device& device)
    : job(device,
          {vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
           vk::DescriptorType::eStorageBuffer},
          vk::ShaderStageFlagBits::eCompute),
      vertex(device,
             {vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
              vk::DescriptorType::eStorageBuffer},
             vk::ShaderStageFlagBits::eVertex) {}

GpuMotion::GpuMotion(const gpu::Device& device, gpu::Upload& upload, const PackedMotions& packed,
                     const gpu::Buffer& instances, GpuForest* forest, const MotionLayouts& layouts)
    : items_(packed.items), instances_(*instances.buffer), forest_(forest) {
  constexpr auto kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
  const auto stored = [&upload](const auto& data) {
    return upload.buffer(std::span(data), kStorage);
  };
  beams_ = stored(packed.beams);
  drives_ = stored(packed.drives);
  leaves_ = stored(packed.leaves);
  hangs_ = stored(packed.hangs);
  const auto check = [&device](vk::DeviceSize bytes) {
    if (bytes > device.limits().maxStorageBufferRange)
      throw Error(device.name(),
                  "the motion of this scene takes " + std::to_string(bytes >> 20) +
                      " MiB at once, more than this device reads",
                  "draw fewer kinds of plants in wind");
  };
  for (const gpu::Buffer* buffer : {&beams_, &drives_, &leaves_, &hangs_}) check(buffer->size);
  const auto results = [&](std::size_t bytes) {
    check(bytes);
    return gpu::makeBuffer(device, bytes, kStorage, gpu::MemoryUse::kDevice);
  };
  for (std::size_t slot = 0; slot < 2; ++slot) {
    amplitudes_[slot] = results(std::size_t{packed.amplitudes} * sizeof(glm::vec2));
    turns_[slot] = results(std::size_t{packed.turns} * sizeof(std::uint32_t));
  }
  for (PackedMotion& item : items_) {
    std::vector<std::uint32_t> texels = item.tables->texels;
    const std::vector<std::uint32_t>& wind = item.tables->wind.texels;
    texels.insert(texels.end(), wind.begin(), wind.end());
    texels_.push_back(stored(texels));
    check(texels_.back().size);
    for (std::size_t slot = 0; slot < 2; ++slot) {
      gpu::DescriptorSet& set = job_sets_[slot].emplace_back(device, layouts.job);
      std::uint32_t binding = 0;
      for (const gpu::Buffer* buffer :
           {&std::as_const(beams_), &std::as_const(drives_), &std::as_const(leaves_),
            &std::as_const(texels_.back()), item.forest_kind ? &forest->seatBuffer() : &instances,
            &std::as_const(amplitudes_[slot]), &std::as_const(turns_[slot])})
        set.setBuffer(binding++, *buffer);
    }
  }
  if (forest != nullptr) forest->setMotion(packed, beams_, drives_, texels_);
  vertex_set_.emplace(device, layouts.vertex);
  std::uint32_t binding = 0;
  for (const gpu::Buffer* buffer :
       {&beams_, &leaves_, &hangs_, &amplitudes_[0], &turns_[0], &amplitudes_[1], &turns_[1]})
    vertex_set_->setBuffer(binding++, *buffer);
}

MotionPass::MotionPass(const gpu::Device& device)
    : layouts_(device),
      layout_(gpu::makePipelineLayout(device, std::array{*layouts_.job.layout},
                                      vk::ShaderStageFlagBits::eCompute,
                                      sizeof(shared::MotionJob))),
      branches_(gpu::makeComputePipeline(device, kBranches, *layout_)),
      leaves_(gpu::makeComputePipeline(device, kLeaves, *layout_)) {}

void MotionPass::record(const vk::raii::CommandBuffer& commands, const GpuMotion& motion,
                        const Wind& wind, double seconds, bool last) const {
  if (motion.items_.empty()) return;
  const std::size_t slot = last ? 1 : 0;
  const auto turn = [&](const gpu::Buffer& buffer, gpu::Use from, gpu::Use to) {
    gpu::bufferBarrier(commands, *buffer.buffer, from, to);
  };
  // An upload leaves buffers as vertex input.
  for (const gpu::Buffer* buffer : {&motion.beams_, &motion.leaves_, &motion.hangs_})
    turn(*buffer, gpu::Use::kVertexInput, gpu::Use::kVertexStorage);
  for (const gpu::Buffer* buffer : {&motion.beams_, &motion.drives_, &motion.leaves_})
    turn(*buffer, gpu::Use::kVertexInput, gpu::Use::kComputeStorage);
  gpu::bufferBarrier(commands, motion.instances_, gpu::Use::kVertexInput,
                     gpu::Use::kComputeStorage);
  for (const gpu::Buffer& texels : motion.texels_)
    turn(texels, gpu::Use::kVertexInput, gpu::Use::kComputeStorage);
  for (const gpu::Buffer* results : {&motion.amplitudes_[slot], &motion.turns_[slot]})
    turn(*results, gpu::Use::kVertexStorage, gpu::Use::kComputeStorage);
  const MotionTime time = motionTime(seconds);
  for (std::size_t i = 0; i < motion.items_.size(); ++i) {
    const PackedMotion& item = motion.items_[i];
    const auto run = [&](const vk::raii::Pipeline& pipeline, std::size_t count, std::uint32_t first,
                         std::uint32_t out_base, vk::DeviceSize command) {
      if (count == 0) return;
      const shared::MotionJob job{
          .moment = momentOf(wind, seconds, item.tables->wind_extent),
          .whole = time.whole,
          .first = first,
          .count = static_cast<std::uint32_t>(count),
          .first_instance = item.first_instance,
          .out_base = out_base,
          .wind_texels = static_cast<std::uint32_t>(item.tables->texels.size()),
          .wind_size = item.tables->wind.size.x,
          .padding = 0};
      commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
      commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0,
                                  {*motion.job_sets_[slot][i]}, nullptr);
      commands.pushConstants<shared::MotionJob>(*layout_, vk::ShaderStageFlagBits::eCompute, 0,
                                                job);
      if (item.forest_kind)
        commands.dispatchIndirect(*motion.forest_->commandBuffer().buffer,
                                  motion.forest_->motionCommand(*item.forest_kind) + command);
      else
        commands.dispatch((job.count + kGroupSize - 1) / kGroupSize, item.places, 1);
    };
    run(branches_, item.tables->beams.size(), item.first_beam, item.amplitude_base, 0);
    run(leaves_, item.tables->leaves.size(), item.first_leaf, item.turn_base,
        sizeof(vk::DispatchIndirectCommand));
  }
  for (const gpu::Buffer* results : {&motion.amplitudes_[slot], &motion.turns_[slot]})
    turn(*results, gpu::Use::kComputeStorage, gpu::Use::kVertexStorage);
}

}  // namespace verdure
