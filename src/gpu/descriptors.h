#ifndef VERDURE_GPU_DESCRIPTORS_H_
#define VERDURE_GPU_DESCRIPTORS_H_

#include <initializer_list>
#include <vector>

#include "gpu/resources.h"

namespace verdure::gpu {

/// A set layout of single descriptors at bindings 0, 1, 2, ..., and what they are.
struct SetLayout {
  SetLayout(const Device& device, std::initializer_list<vk::DescriptorType> descriptor_types,
            vk::ShaderStageFlags stages);

  std::vector<vk::DescriptorType> types;
  vk::raii::DescriptorSetLayout layout;
};

/// One descriptor set in a pool of its own. Every binding must be written before it is bound, those
/// that shaders do not read, too.
class DescriptorSet {
 public:
  DescriptorSet(const Device& device, const SetLayout& layout);
  vk::DescriptorSet operator*() const { return *set_; }

  void setBuffer(std::uint32_t binding, const Buffer& buffer);
  /// The texture must be in use kFragmentSampled or kComputeSampled when it is read.
  void setTexture(std::uint32_t binding, const Texture& texture, vk::Sampler sampler);

 private:
  const Device* device_;
  std::vector<vk::DescriptorType> types_;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
};

/// Filters between texels and mips; beyond the edge it repeats or keeps the edge's texel.
vk::raii::Sampler makeSampler(const Device& device, vk::Filter filter,
                              vk::SamplerAddressMode beyond);

}  // namespace verdure::gpu

#endif  // VERDURE_GPU_DESCRIPTORS_H_
