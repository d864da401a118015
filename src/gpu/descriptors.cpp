#include "gpu/descriptors.h"

#include "gpu/pipeline.h"

namespace verdure::gpu {

SetLayout::SetLayout(const Device& device,
                     std::initializer_list<vk::DescriptorType> descriptor_types,
                     vk::ShaderStageFlags stages)
    : types(descriptor_types), layout(makeSetLayout(device, types, stages)) {}

DescriptorSet::DescriptorSet(const Device& device, const SetLayout& layout)
    : device_(&device), types_(layout.types) {
  std::vector<vk::DescriptorPoolSize> sizes;
  for (const vk::DescriptorType type : types_)
    sizes.push_back({.type = type, .descriptorCount = 1});
  pool_ = device.raii().createDescriptorPool(
      {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
       .maxSets = 1,
       .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
       .pPoolSizes = sizes.data()});
  set_ = std::move(vk::raii::DescriptorSets(
      device.raii(),
      vk::DescriptorSetAllocateInfo{
          .descriptorPool = *pool_, .descriptorSetCount = 1, .pSetLayouts = &*layout.layout})[0]);
}

void DescriptorSet::setBuffer(std::uint32_t binding, const Buffer& buffer) {
  const vk::DescriptorBufferInfo info{.buffer = *buffer.buffer, .range = VK_WHOLE_SIZE};
  device_->raii().updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *set_,
                                                              .dstBinding = binding,
                                                              .descriptorCount = 1,
                                                              .descriptorType = types_[binding],
                                                              .pBufferInfo = &info},
                                       nullptr);
}

void DescriptorSet::setTexture(std::uint32_t binding, const Texture& texture, vk::Sampler sampler) {
  const vk::DescriptorImageInfo info{.sampler = sampler,
                                     .imageView = *texture.view,
                                     .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
  device_->raii().updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *set_,
                                                              .dstBinding = binding,
                                                              .descriptorCount = 1,
                                                              .descriptorType = types_[binding],
                                                              .pImageInfo = &info},
                                       nullptr);
}

vk::raii::Sampler makeSampler(const Device& device, vk::Filter filter,
                              vk::SamplerAddressMode beyond) {
  return device.raii().createSampler({.magFilter = filter,
                                      .minFilter = filter,
                                      .mipmapMode = filter == vk::Filter::eLinear
                                                        ? vk::SamplerMipmapMode::eLinear
                                                        : vk::SamplerMipmapMode::eNearest,
                                      .addressModeU = beyond,
                                      .addressModeV = beyond,
                                      .maxLod = VK_LOD_CLAMP_NONE});
}

}  // namespace verdure::gpu
