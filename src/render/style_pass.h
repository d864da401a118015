#ifndef VERDURE_RENDER_STYLE_PASS_H_
#define VERDURE_RENDER_STYLE_PASS_H_

#include <map>
#include <vector>

#include "render/fullscreen.h"
#include "render/style_layers.h"
#include "shared/style.h"

namespace verdure {

/// Draws a picture in one of the drawn styles, from the layers of its plants and the photo of what
/// stands around them.
class StylePass {
 public:
  StylePass(const gpu::Device& device, const FrameLayout& layout,
            vk::DescriptorSetLayout motion_set);

  /// The next frame has other targets.
  void forgetTargets();
  /// `ground_depth`: of the photo's samples. `haze`: half distance, m.
  void prepare(const GpuScene& scene, const View& view, const gpu::Texture& ground_depth,
               ImpostorPass& impostors, float haze);
  /// Where the photo without plants belongs, sRGB; must be kColorAttachment before record().
  const gpu::Texture& backdrop() const { return backdrop_; }
  /// Outside of rendering. `ground_depth` must be kDepthAttachment. Leaves `target` as
  /// kColorAttachment.
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuScene& scene, const View& view, const ImpostorPass& impostors,
              const gpu::Texture& ground_depth, const gpu::Texture& target) const;

 private:
  /// A picture and what it is when it is blurred.
  struct Blur {
    gpu::Texture across, result;
    std::optional<gpu::DescriptorSet> from_source, from_across;
    shared::BlurUniforms first{}, second{};
  };
  void makeTargets(const gpu::Texture& ground_depth);
  /// `sigma`: of the Gaussian, pixels of the source; `shrink`: pixels of it that become one.
  Blur makeBlur(const gpu::Texture& source, float sigma, std::uint32_t shrink) const;
  void recordBlur(const vk::raii::CommandBuffer& commands, const Blur& blur) const;

  const gpu::Device* device_;
  StyleLayers layers_;
  gpu::SetLayout blur_layout_, merge_layout_, style_layout_;
  vk::raii::PipelineLayout blur_pipeline_layout_, merge_pipeline_layout_, style_pipeline_layout_;
  vk::raii::Pipeline blur_, merge_normals_, merge_depths_;
  std::map<Style, vk::raii::Pipeline> styles_;
  vk::raii::Sampler linear_, nearest_, repeat_;
  gpu::Texture paper_;
  gpu::Texture backdrop_, normals_, depths_;
  gpu::DescriptorSet merge_set_, style_set_;
  Blur soft_normals_, foliage_fine_, foliage_broad_, foliage_wide_, foliage_color_, soft_backdrop_;
  shared::StyleUniforms uniforms_{};
};

}  // namespace verdure

#endif  // VERDURE_RENDER_STYLE_PASS_H_
