#ifndef VERDURE_RENDER_EXPOSURE_PASS_H_
#define VERDURE_RENDER_EXPOSURE_PASS_H_

#include <optional>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"

namespace verdure {

/// Measures a picture's log-average luminance (Reinhard et al. 2002, (1)) and its bright luminance
/// (shared/tone.h) on the GPU, the same each time: sums have a fixed order, counts need none.
class ExposurePass {
 public:
  /// In the source's unit; 0 where there was nothing but background.
  struct Measured {
    float average = 0.0f;
    float bright = 0.0f;
  };

  explicit ExposurePass(const gpu::Device& device);
  /// `source` (linear, alpha = share that is not background) must outlive this or the next call.
  void setSource(const gpu::Texture& source);
  /// A Measured as a storage buffer; kFragmentStorage after record().
  const gpu::Buffer& result() const { return result_; }
  /// The source must be kComputeSampled. `smallest`: the luminance that is added so that black has
  /// a logarithm.
  void record(const vk::raii::CommandBuffer& commands, float smallest) const;
  /// After the fence.
  Measured measured() const;

 private:
  const gpu::Device* device_;
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline tiles_, mean_;
  vk::raii::Sampler sampler_;
  gpu::DescriptorSet set_;
  gpu::Buffer result_;
  std::optional<gpu::Buffer> work_;       ///< counts of luminances, sums of the tiles
  std::uint32_t columns_ = 0, rows_ = 0;  ///< tiles
};

}  // namespace verdure

#endif  // VERDURE_RENDER_EXPOSURE_PASS_H_
