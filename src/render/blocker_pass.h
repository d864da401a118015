#ifndef VERDURE_RENDER_BLOCKER_PASS_H_
#define VERDURE_RENDER_BLOCKER_PASS_H_

#include <optional>

#include "render/fullscreen.h"

namespace verdure {

/// Finds, once a frame and for blocks of texels, how far away what hides the sun is: the search
/// that "Percentage-Closer Soft Shadows" (Fernando 2005) makes for every pixel.
class BlockerPass {
 public:
  static constexpr vk::Format kFormat = vk::Format::eR16G16Sfloat;

  explicit BlockerPass(const gpu::Device& device);

  /// Of the maps that LightDepthPass draws; `texels` samples one as it is. All must outlive this or
  /// the next call.
  void setSources(const gpu::Texture& foliage_maps, const gpu::Texture& wood_maps,
                  vk::Sampler linear, vk::Sampler texels);
  /// A layer for each of `wood_maps`, as blocker_pass.frag has it; kFragmentSampled after record().
  const gpu::Texture& result() const { return *maps_; }
  /// The first `count` layers, of sources that are kFragmentSampled; 0: the result has no contents.
  void record(const vk::raii::CommandBuffer& commands, std::uint32_t count) const;

 private:
  const gpu::Device* device_;
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
  gpu::DescriptorSet set_;
  std::optional<gpu::Texture> maps_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_BLOCKER_PASS_H_
