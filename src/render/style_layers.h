#ifndef VERDURE_RENDER_STYLE_LAYERS_H_
#define VERDURE_RENDER_STYLE_LAYERS_H_

#include <array>
#include <map>
#include <optional>

#include "render/frame_layout.h"
#include "render/impostor_pass.h"
#include "render/scene.h"

namespace verdure {

/// Draws what the drawn styles are made of: foliage and wood, each as if the other were not there,
/// so that they can be laid over each other softly.
class StyleLayers {
 public:
  static constexpr vk::Format kFormat = vk::Format::eR16G16B16A16Sfloat;

  /// All of it multiplied by the share of the pixel that the layer covers; averages over samples.
  struct Layer {
    gpu::Texture normal;  ///< unit, as long as the ambient coefficient with StyleNormals::kScaled
    gpu::Texture color;   ///< linear reflectance; the covered share
    gpu::Texture shape;   ///< the covered share, lightness, 1 / distance along the view, noise
  };

  StyleLayers(const gpu::Device& device, const FrameLayout& layout,
              vk::DescriptorSetLayout motion_set);

  /// `ground_depth`: of the samples of what may stand in front; `new_targets`: it is another one.
  void prepare(const GpuScene& scene, const View& view, const gpu::Texture& ground_depth,
               bool new_targets, ImpostorPass& impostors);
  /// Outside of rendering; `ground_depth` must be kFragmentSampled. Leaves the layers so.
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuScene& scene, const View& view, const ImpostorPass& impostors) const;

  const Layer& foliage() const { return layers_[0]; }
  const Layer& wood() const { return layers_[1]; }

 private:
  const gpu::Device* device_;
  gpu::SetLayout ground_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Sampler nearest_;
  gpu::DescriptorSet ground_set_;
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
  std::array<gpu::Texture, 3> samples_;  ///< of the layer that is being drawn
  gpu::Texture depth_;                   ///< of the samples
  std::array<Layer, 2> layers_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_STYLE_LAYERS_H_
