#include <gtest/gtest.h>

#include <cstring>

#include "base/random.h"
#include "gpu/pipeline.h"
#include "gpu/resources.h"
#include "gpu/timers.h"
#include "shared_functions.h"
#include "verdure/error.h"

namespace verdure::gpu {
namespace {

constexpr std::uint32_t kSharedFunctions[] = {
#include "shaders/shared_functions.comp.inc"
};

using BufferUsage = vk::BufferUsageFlagBits;

TEST(Barrier, WritesAreMadeVisibleAndReadsAreNot) {
  using Access = vk::AccessFlagBits2;
  for (const Use use :
       {Use::kTransferTarget, Use::kColorAttachment, Use::kDepthAttachment, Use::kComputeStorage}) {
    const UseInfo info = useInfo(use);
    EXPECT_TRUE(info.stages);
    EXPECT_TRUE(info.access & (Access::eTransferWrite | Access::eColorAttachmentWrite |
                               Access::eDepthStencilAttachmentWrite | Access::eShaderStorageWrite));
  }
  for (const Use use : {Use::kTransferSource, Use::kFragmentSampled, Use::kComputeSampled,
                        Use::kVertexInput, Use::kFragmentStorage, Use::kHostRead}) {
    const UseInfo info = useInfo(use);
    EXPECT_TRUE(info.stages);
    EXPECT_FALSE(info.access & (Access::eTransferWrite | Access::eColorAttachmentWrite |
                                Access::eDepthStencilAttachmentWrite | Access::eShaderWrite |
                                Access::eShaderStorageWrite | Access::eHostWrite));
  }
  EXPECT_FALSE(useInfo(Use::kUndefined).access);
}

TEST(Upload, BytesComeBack) {
  const Device device("", true);
  Random random(3);
  std::vector<std::uint32_t> words(64);
  for (std::uint32_t& word : words) word = random.next();
  const Buffer readback =
      makeBuffer(device, words.size() * 4, BufferUsage::eTransferDst, MemoryUse::kFromGpu);
  Upload upload(device);
  const Buffer buffer = upload.buffer(std::span<const std::uint32_t>(words),
                                      BufferUsage::eVertexBuffer | BufferUsage::eTransferSrc);
  upload.finish();
  device.submit([&](const vk::raii::CommandBuffer& commands) {
    bufferBarrier(commands, *buffer.buffer, Use::kVertexInput, Use::kTransferSource);
    commands.copyBuffer(*buffer.buffer, *readback.buffer, vk::BufferCopy{.size = buffer.size});
    bufferBarrier(commands, *readback.buffer, Use::kTransferTarget, Use::kHostRead);
  });
  EXPECT_EQ(std::memcmp(readback.memory.mapped(), words.data(), words.size() * 4), 0);
  EXPECT_EQ(device.validationMessages(), 0);
}

TEST(Memory, SharesBlocksAndGivesThemBack) {
  const Device device("", false);
  const std::size_t before = device.memory().blockCount();
  {
    std::vector<Buffer> buffers;
    for (int i = 0; i < 500; ++i)
      buffers.push_back(makeBuffer(device, 1000, BufferUsage::eTransferSrc, MemoryUse::kToGpu));
    EXPECT_LE(device.memory().blockCount(), before + 1);
    for (std::size_t i = 0; i < buffers.size(); ++i)
      std::memset(buffers[i].memory.mapped(), static_cast<int>(i % 251), 1000);
    for (std::size_t i = 0; i < buffers.size(); ++i)  // ranges do not overlap
      for (const std::size_t at : {std::size_t{0}, std::size_t{999}})
        ASSERT_EQ(static_cast<int>(buffers[i].memory.mapped()[at]), static_cast<int>(i % 251));
  }
  EXPECT_EQ(device.memory().blockCount(), before);
}

TEST(Device, SaysWhatIsMissing) {
  try {
    const Device device("no such device", false);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("no such device"), std::string::npos) << e.what();
  }
}

TEST(Validation, CountsMistakes) {
  const Device device("", true);
  testing::internal::CaptureStderr();
  // A copy beyond the end of a buffer.
  const Buffer small = makeBuffer(device, 16, BufferUsage::eTransferSrc, MemoryUse::kToGpu);
  const Buffer target = makeBuffer(device, 64, BufferUsage::eTransferDst, MemoryUse::kFromGpu);
  const vk::raii::CommandPool pool(device.raii(), vk::CommandPoolCreateInfo{});
  const vk::raii::CommandBuffers buffers(
      device.raii(), vk::CommandBufferAllocateInfo{.commandPool = *pool, .commandBufferCount = 1});
  buffers[0].begin(vk::CommandBufferBeginInfo{});
  buffers[0].copyBuffer(*small.buffer, *target.buffer, vk::BufferCopy{.size = 64});
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_GT(device.validationMessages(), 0);
  EXPECT_NE(printed.find("Vulkan validation"), std::string::npos);
}

TEST(Shared, FunctionsAgreeOnCpuAndGpu) {
  constexpr std::size_t kCount = 4096;
  const Device device("", true);
  Random random(99);
  std::vector<glm::vec4> inputs(2 * kCount);
  for (glm::vec4& v : inputs)
    v = {random.uniform(), random.uniform(), random.uniform(), random.uniform()};

  const Buffer in = makeBuffer(device, inputs.size() * sizeof(glm::vec4),
                               BufferUsage::eStorageBuffer, MemoryUse::kToGpu);
  std::memcpy(in.memory.mapped(), inputs.data(), inputs.size() * sizeof(glm::vec4));
  const Buffer out = makeBuffer(device, kCount * sizeof(shared::SharedResults),
                                BufferUsage::eStorageBuffer, MemoryUse::kFromGpu);
  using Type = vk::DescriptorType;
  const vk::raii::DescriptorSetLayout set_layout =
      makeSetLayout(device, std::array{Type::eStorageBuffer, Type::eStorageBuffer},
                    vk::ShaderStageFlagBits::eCompute);
  const vk::raii::PipelineLayout layout = makePipelineLayout(device, std::array{*set_layout});
  const vk::raii::Pipeline pipeline = makeComputePipeline(device, kSharedFunctions, *layout);
  const vk::DescriptorPoolSize size{.type = Type::eStorageBuffer, .descriptorCount = 2};
  const vk::raii::DescriptorPool pool = device.raii().createDescriptorPool(
      {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
       .maxSets = 1,
       .poolSizeCount = 1,
       .pPoolSizes = &size});
  const vk::raii::DescriptorSets sets(
      device.raii(),
      vk::DescriptorSetAllocateInfo{
          .descriptorPool = *pool, .descriptorSetCount = 1, .pSetLayouts = &*set_layout});
  for (std::uint32_t binding = 0; binding < 2; ++binding) {
    const vk::DescriptorBufferInfo info{.buffer = binding == 0 ? *in.buffer : *out.buffer,
                                        .range = VK_WHOLE_SIZE};
    device.raii().updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = *sets[0],
                               .dstBinding = binding,
                               .descriptorCount = 1,
                               .descriptorType = Type::eStorageBuffer,
                               .pBufferInfo = &info},
        nullptr);
  }
  device.submit([&](const vk::raii::CommandBuffer& commands) {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, {*sets[0]}, nullptr);
    commands.dispatch(kCount / 64, 1, 1);
    bufferBarrier(commands, *out.buffer, Use::kComputeStorage, Use::kHostRead);
  });

  std::vector<shared::SharedResults> results(kCount);
  std::memcpy(results.data(), out.memory.mapped(), kCount * sizeof(shared::SharedResults));
  for (std::size_t i = 0; i < kCount; ++i) {
    const shared::SharedResults expected = shared::evaluateShared(inputs[2 * i], inputs[2 * i + 1]);
    const auto* want = reinterpret_cast<const float*>(&expected);
    const auto* got = reinterpret_cast<const float*>(&results[i]);
    for (std::size_t k = 0; k < sizeof(shared::SharedResults) / sizeof(float); ++k)
      ASSERT_NEAR(got[k], want[k], 2e-4f) << "input " << i << ", result " << k;
  }
  EXPECT_EQ(device.validationMessages(), 0);
}

TEST(Timers, OrderStamps) {
  const Device device("", true);
  const Timers timers(device, 2);
  const Buffer target = makeBuffer(device, 1 << 24, BufferUsage::eTransferDst, MemoryUse::kDevice);
  device.submit([&](const vk::raii::CommandBuffer& commands) {
    timers.reset(commands);
    timers.stamp(commands, 0);
    commands.fillBuffer(*target.buffer, 0, VK_WHOLE_SIZE, 7);
    timers.stamp(commands, 1);
  });
  EXPECT_GE(timers.milliseconds(0, 1), 0.0);
  EXPECT_LT(timers.milliseconds(0, 1), 60e3);
  EXPECT_EQ(device.validationMessages(), 0);
}

}  // namespace
}  // namespace verdure::gpu
