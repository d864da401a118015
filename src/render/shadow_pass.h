#ifndef VERDURE_RENDER_SHADOW_PASS_H_
#define VERDURE_RENDER_SHADOW_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/impostor_pass.h"
#include "render/scene.h"

namespace verdure {

/// Draws the depth of everything as the sun sees it, at each cascade's scale.
class ShadowPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene);
  /// Draws the cascades of frame.shadow_from_world into the first `count` layers of `maps`, a depth
  /// image used as kFragmentSampled afterwards. Without `casters` they stay empty.
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const gpu::Texture& maps,
              const ImpostorPass& impostors, std::uint32_t count, bool casters) const;

 private:
  void drawCasters(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                   vk::DescriptorSet frame_set, const GpuScene& scene, std::uint32_t cascade) const;

  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SHADOW_PASS_H_
