#include "gpu/timers.h"

#include "base/check.h"

namespace verdure::gpu {

Timers::Timers(const Device& device, std::uint32_t count)
    : count_(count), period_ns_(static_cast<double>(device.limits().timestampPeriod)) {
  if (!device.limits().timestampComputeAndGraphics) return;
  pool_ =
      device.raii().createQueryPool({.queryType = vk::QueryType::eTimestamp, .queryCount = count});
}

void Timers::reset(const vk::raii::CommandBuffer& commands) const {
  if (*pool_) commands.resetQueryPool(*pool_, 0, count_);
}

void Timers::stamp(const vk::raii::CommandBuffer& commands, std::uint32_t index) const {
  VERDURE_CHECK_LT(index, count_);
  if (*pool_) commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, index);
}

double Timers::milliseconds(std::uint32_t from, std::uint32_t to) const {
  if (!*pool_) return 0.0;
  const auto [result, ticks] = pool_.getResults<std::uint64_t>(
      0, count_, count_ * sizeof(std::uint64_t), sizeof(std::uint64_t),
      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  if (result != vk::Result::eSuccess) return 0.0;
  return static_cast<double>(ticks[to] - ticks[from]) * period_ns_ * 1e-6;
}

}  // namespace verdure::gpu
