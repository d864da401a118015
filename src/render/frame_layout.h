#ifndef VERDURE_RENDER_FRAME_LAYOUT_H_
#define VERDURE_RENDER_FRAME_LAYOUT_H_

#include "gpu/pipeline.h"

namespace verdure {

/// What all passes agree on: formats, samples, descriptor sets and push constants.
struct FrameLayout {
  static constexpr vk::Format kColor = vk::Format::eR8G8B8A8Srgb;
  static constexpr vk::Format kDepth = vk::Format::eD32Sfloat;
  static constexpr vk::SampleCountFlagBits kSamples = vk::SampleCountFlagBits::e4;

  explicit FrameLayout(const gpu::Device& device);

  vk::raii::DescriptorSetLayout frame_set;     ///< as in src/shaders/frame_set.glsl
  vk::raii::DescriptorSetLayout material_set;  ///< base colour, normal map
  vk::raii::PipelineLayout pipeline;           ///< both sets and DrawUniforms
};

}  // namespace verdure

#endif  // VERDURE_RENDER_FRAME_LAYOUT_H_
