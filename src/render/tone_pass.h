#ifndef VERDURE_RENDER_TONE_PASS_H_
#define VERDURE_RENDER_TONE_PASS_H_

#include "render/fullscreen.h"
#include "shared/frame.h"

namespace verdure {

/// From the samples of the linear picture to 8-bit sRGB: bloom, exposure, tone curve, resolve,
/// dither.
class TonePass {
 public:
  explicit TonePass(const gpu::Device& device);
  static constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Unorm;  ///< sRGB values, encoded here

  /// `color`: multisampled, alpha = share that is not background; `measured`: an
  /// ExposurePass::Measured.
  void setSource(const gpu::Texture& color, const gpu::Texture& bloom, const gpu::Buffer& measured);
  /// The sources must be kFragmentSampled and kFragmentStorage. Leaves `target` as
  /// kColorAttachment.
  void record(const vk::raii::CommandBuffer& commands, const gpu::Texture& target,
              const shared::ToneUniforms& uniforms) const;

 private:
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
  vk::raii::Sampler nearest_, linear_;
  gpu::DescriptorSet set_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_TONE_PASS_H_
