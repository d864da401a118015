#ifndef VERDURE_RENDER_BLOOM_PASS_H_
#define VERDURE_RENDER_BLOOM_PASS_H_

#include <vector>

#include "render/fullscreen.h"

namespace verdure {

/// Spreads light as a lens and an eye do: a pyramid of ever coarser averages of the picture, mixed
/// on the way back up. The result is an average of the picture, so light is kept.
class BloomPass {
 public:
  explicit BloomPass(const gpu::Device& device);
  /// `source` (linear, alpha = share that is not background) must outlive this or the next call.
  void setSource(const gpu::Texture& source);
  /// Of half the source's size; kFragmentSampled after record().
  const gpu::Texture& result() const { return levels_.front().spread; }
  /// The source must be kFragmentSampled. If not `on`, the result has no contents.
  void record(const vk::raii::CommandBuffer& commands, bool on) const;

 private:
  struct Level {
    gpu::Texture average;  ///< of the next finer level
    gpu::Texture spread;   ///< mixed with the coarser levels; of the coarsest level never used
    gpu::DescriptorSet down, up;
  };
  const gpu::Device* device_;
  gpu::SetLayout set_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline down_, up_;
  vk::raii::Sampler sampler_;
  std::vector<Level> levels_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_BLOOM_PASS_H_
