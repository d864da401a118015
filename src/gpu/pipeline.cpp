#include "gpu/pipeline.h"

#include <array>

namespace verdure::gpu {
namespace {

vk::raii::ShaderModule makeModule(const Device& device, SpirV code) {
  return device.raii().createShaderModule({.codeSize = code.size_bytes(), .pCode = code.data()});
}

}  // namespace

vk::raii::Pipeline makeGraphicsPipeline(const Device& device, const GraphicsRequest& request) {
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < request.constants.size(); ++i)
    entries.push_back({.constantID = i, .offset = i * 4, .size = 4});
  const vk::SpecializationInfo constants{
      .mapEntryCount = static_cast<std::uint32_t>(entries.size()),
      .pMapEntries = entries.data(),
      .dataSize = request.constants.size() * 4,
      .pData = request.constants.data()};
  const vk::raii::ShaderModule vertex = makeModule(device, request.vertex);
  std::vector<vk::PipelineShaderStageCreateInfo> stages{{.stage = vk::ShaderStageFlagBits::eVertex,
                                                         .module = *vertex,
                                                         .pName = "main",
                                                         .pSpecializationInfo = &constants}};
  vk::raii::ShaderModule fragment = nullptr;
  if (!request.fragment.empty()) {
    fragment = makeModule(device, request.fragment);
    stages.push_back({.stage = vk::ShaderStageFlagBits::eFragment,
                      .module = *fragment,
                      .pName = "main",
                      .pSpecializationInfo = &constants});
  }
  const vk::PipelineVertexInputStateCreateInfo vertex_input{
      .vertexBindingDescriptionCount = static_cast<std::uint32_t>(request.bindings.size()),
      .pVertexBindingDescriptions = request.bindings.data(),
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(request.attributes.size()),
      .pVertexAttributeDescriptions = request.attributes.data()};
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology =
                                                              vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const vk::PipelineRasterizationStateCreateInfo raster{
      .cullMode = vk::CullModeFlagBits::eNone,
      .frontFace = vk::FrontFace::eCounterClockwise,
      .depthBiasEnable = request.depth_bias_slope != 0.0f,
      .depthBiasSlopeFactor = request.depth_bias_slope,
      .lineWidth = 1.0f};
  const vk::PipelineMultisampleStateCreateInfo multisample{.rasterizationSamples = request.samples};
  const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = true,
                                                      .depthWriteEnable = request.depth_write,
                                                      .depthCompareOp = request.depth_compare};
  using Component = vk::ColorComponentFlagBits;
  const bool over = request.blend == Blend::kOver;
  const vk::BlendFactor kept = over ? vk::BlendFactor::eOneMinusSrcAlpha : vk::BlendFactor::eOne;
  const vk::PipelineColorBlendAttachmentState attachment{
      .blendEnable = over || request.blend == Blend::kMaxAndSum,
      .srcColorBlendFactor = vk::BlendFactor::eOne,
      .dstColorBlendFactor = kept,
      .colorBlendOp = over ? vk::BlendOp::eAdd : vk::BlendOp::eMax,
      .srcAlphaBlendFactor = vk::BlendFactor::eOne,
      .dstAlphaBlendFactor = kept,
      .alphaBlendOp = vk::BlendOp::eAdd,
      .colorWriteMask = request.blend == Blend::kNothing
                            ? vk::ColorComponentFlags{}
                            : Component::eR | Component::eG | Component::eB | Component::eA};
  std::vector<vk::Format> colors = request.more_colors;
  if (request.color != vk::Format::eUndefined) colors.insert(colors.begin(), request.color);
  const auto color_count = static_cast<std::uint32_t>(colors.size());
  const std::vector<vk::PipelineColorBlendAttachmentState> attachments(colors.size(), attachment);
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = color_count,
                                                    .pAttachments = attachments.data()};
  const std::array dynamic_states{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic{
      .dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size()),
      .pDynamicStates = dynamic_states.data()};
  const vk::PipelineRenderingCreateInfo rendering{.colorAttachmentCount = color_count,
                                                  .pColorAttachmentFormats = colors.data(),
                                                  .depthAttachmentFormat = request.depth};
  return device.raii().createGraphicsPipeline(
      nullptr,
      vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                     .stageCount = static_cast<std::uint32_t>(stages.size()),
                                     .pStages = stages.data(),
                                     .pVertexInputState = &vertex_input,
                                     .pInputAssemblyState = &assembly,
                                     .pViewportState = &viewport,
                                     .pRasterizationState = &raster,
                                     .pMultisampleState = &multisample,
                                     .pDepthStencilState = &depth,
                                     .pColorBlendState = &blend,
                                     .pDynamicState = &dynamic,
                                     .layout = request.layout});
}

vk::raii::Pipeline makeComputePipeline(const Device& device, SpirV code,
                                       vk::PipelineLayout layout) {
  const vk::raii::ShaderModule module = makeModule(device, code);
  return device.raii().createComputePipeline(
      nullptr,
      vk::ComputePipelineCreateInfo{
          .stage = {.stage = vk::ShaderStageFlagBits::eCompute, .module = *module, .pName = "main"},
          .layout = layout});
}

vk::raii::PipelineLayout makePipelineLayout(const Device& device,
                                            std::span<const vk::DescriptorSetLayout> sets,
                                            vk::ShaderStageFlags push_stages,
                                            std::uint32_t push_bytes,
                                            std::uint32_t vertex_push_bytes) {
  std::vector<vk::PushConstantRange> ranges;
  if (push_bytes > 0) ranges.push_back({.stageFlags = push_stages, .size = push_bytes});
  if (vertex_push_bytes > 0)
    ranges.push_back({.stageFlags = vk::ShaderStageFlagBits::eVertex,
                      .offset = push_bytes,
                      .size = vertex_push_bytes});
  return device.raii().createPipelineLayout(
      {.setLayoutCount = static_cast<std::uint32_t>(sets.size()),
       .pSetLayouts = sets.data(),
       .pushConstantRangeCount = static_cast<std::uint32_t>(ranges.size()),
       .pPushConstantRanges = ranges.data()});
}

vk::raii::DescriptorSetLayout makeSetLayout(const Device& device,
                                            std::span<const vk::DescriptorType> types,
                                            vk::ShaderStageFlags stages) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (const vk::DescriptorType type : types)
    bindings.push_back({.binding = static_cast<std::uint32_t>(bindings.size()),
                        .descriptorType = type,
                        .descriptorCount = 1,
                        .stageFlags = stages});
  return device.raii().createDescriptorSetLayout(
      {.bindingCount = static_cast<std::uint32_t>(bindings.size()), .pBindings = bindings.data()});
}

}  // namespace verdure::gpu
