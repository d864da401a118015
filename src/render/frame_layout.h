#ifndef VERDURE_RENDER_FRAME_LAYOUT_H_
#define VERDURE_RENDER_FRAME_LAYOUT_H_

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"

namespace verdure {

/// What all passes agree on: formats, samples, descriptor sets and push constants.
struct FrameLayout {
  /// Halves in frame units (shared/frame.h): 11 bits of a range of 10^9 from the sun's disk down,
  /// and half the memory traffic of floats.
  static constexpr vk::Format kColor = vk::Format::eR16G16B16A16Sfloat;
  static constexpr vk::Format kDepth = vk::Format::eD32Sfloat;
  /// Of the light depth map.
  static constexpr vk::Format kFoliageDepth = vk::Format::eR16G16B16A16Sfloat;
  static constexpr vk::SampleCountFlagBits kSamples = vk::SampleCountFlagBits::e4;

  FrameLayout(const gpu::Device& device, vk::DescriptorSetLayout motion_set);

  gpu::SetLayout frame_set;                    ///< as in src/shaders/frame_set.glsl
  vk::raii::DescriptorSetLayout material_set;  ///< as in src/shaders/plant_pass.frag
  vk::raii::PipelineLayout pipeline;           ///< both, what moves plants, and DrawUniforms
};

}  // namespace verdure

#endif  // VERDURE_RENDER_FRAME_LAYOUT_H_
