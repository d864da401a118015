#ifndef VERDURE_RENDER_EXPOSURE_PASS_H_
#define VERDURE_RENDER_EXPOSURE_PASS_H_

#include <optional>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"

namespace verdure {

/// Measures the log-average luminance of a picture (Reinhard et al. 2002, (1)) on the GPU, with
/// sums in a fixed order.
class ExposurePass {
 public:
  explicit ExposurePass(const gpu::Device& device);
  /// `source` (linear, alpha = share that is not background) must outlive this or the next call.
  void setSource(const gpu::Texture& source);
  /// The average as a storage buffer: its first float, in the source's unit; kFragmentStorage after
  /// record().
  const gpu::Buffer& result() const { return *sums_; }
  /// The source must be kComputeSampled. `smallest`: the luminance that is added so that black has
  /// a logarithm.
  void record(const vk::raii::CommandBuffer& commands, float smallest) const;
  /// What was measured, after the fence; 0 where there was nothing but background.
  float average() const;

 private:
  const gpu::Device* device_;
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline tiles_, mean_;
  vk::raii::Sampler sampler_;
  gpu::DescriptorSet set_;
  std::optional<gpu::Buffer> sums_;
  std::uint32_t columns_ = 0, rows_ = 0;  ///< tiles
};

}  // namespace verdure

#endif  // VERDURE_RENDER_EXPOSURE_PASS_H_
