#ifndef VERDURE_GPU_PIPELINE_H_
#define VERDURE_GPU_PIPELINE_H_

#include <span>
#include <vector>

#include "gpu/device.h"

namespace verdure::gpu {

using SpirV = std::span<const std::uint32_t>;

/// Specialisation constants 0, 1, 2, ... of a shader: 32 bits each (booleans are 0 or 1).
using Constants = std::vector<std::uint32_t>;

/// How a fragment joins what the target holds.
enum class Blend {
  kReplace,
  kNothing,    ///< is not written
  kMaxAndSum,  ///< the larger colour, the sum of the alphas
  kOver,       ///< covers it by its alpha, which the colour has been multiplied with
};

/// What a graphics pipeline is made of; what is not listed is the same for all of verdure's
/// pipelines (triangle lists, no culling, dynamic viewport and scissor).
struct GraphicsRequest {
  SpirV vertex;
  SpirV fragment = {};       ///< may be empty: depth only
  Constants constants = {};  ///< of both shaders
  vk::PipelineLayout layout;
  std::vector<vk::VertexInputBindingDescription> bindings = {};
  std::vector<vk::VertexInputAttributeDescription> attributes = {};
  vk::Format color = vk::Format::eUndefined;  ///< eUndefined = none
  std::vector<vk::Format> more_colors = {};   ///< of further targets, blended as the first
  vk::Format depth = vk::Format::eUndefined;
  vk::SampleCountFlagBits samples = vk::SampleCountFlagBits::e1;
  vk::CompareOp depth_compare = vk::CompareOp::eGreater;
  bool depth_write = true;
  float depth_bias_slope = 0.0f;  ///< 0 = no bias
  Blend blend = Blend::kReplace;
};

vk::raii::Pipeline makeGraphicsPipeline(const Device& device, const GraphicsRequest& request);
vk::raii::Pipeline makeComputePipeline(const Device& device, SpirV code, vk::PipelineLayout layout);

/// A pipeline layout of these sets, one push-constant range from 0 (0 bytes = none), and right
/// behind it another of the vertex stage alone.
vk::raii::PipelineLayout makePipelineLayout(const Device& device,
                                            std::span<const vk::DescriptorSetLayout> sets,
                                            vk::ShaderStageFlags push_stages = {},
                                            std::uint32_t push_bytes = 0,
                                            std::uint32_t vertex_push_bytes = 0);

/// A set layout of single descriptors at bindings 0, 1, 2, ...
vk::raii::DescriptorSetLayout makeSetLayout(const Device& device,
                                            std::span<const vk::DescriptorType> types,
                                            vk::ShaderStageFlags stages);

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_PIPELINE_H_
