#ifndef VERDURE_GPU_TIMERS_H_
#define VERDURE_GPU_TIMERS_H_

#include "gpu/device.h"

namespace verdure::gpu {

/// GPU time stamps of one submission.
class Timers {
 public:
  Timers(const Device& device, std::uint32_t count);
  /// To be recorded first, outside of rendering.
  void reset(const vk::raii::CommandBuffer& commands) const;
  /// Stamp `index` is taken when all earlier commands are done.
  void stamp(const vk::raii::CommandBuffer& commands, std::uint32_t index) const;
  /// After the fence: milliseconds from one stamp to another; 0 where the device has no timers.
  double milliseconds(std::uint32_t from, std::uint32_t to) const;

 private:
  vk::raii::QueryPool pool_ = nullptr;
  std::uint32_t count_;
  double period_ns_;
};

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_TIMERS_H_
