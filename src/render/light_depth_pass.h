#ifndef VERDURE_RENDER_LIGHT_DEPTH_PASS_H_
#define VERDURE_RENDER_LIGHT_DEPTH_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/impostor_pass.h"
#include "render/scene.h"

namespace verdure {

/// Draws the scene as the sun sees it: wood as depth, and leaves, none of which hides another, as
/// the nearest, the farthest and all of them (shared/foliage_shadow.h). Leaves behind wood are left
/// out. One pass, as in Gumbau et al. 2008.
class LightDepthPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene,
               const Terms& terms);
  /// Draws the cascades of frame.shadow_from_world into the first `count` layers of both maps,
  /// which are of one size and used as kFragmentSampled afterwards. Without shadows they stay
  /// empty.
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const gpu::Texture& wood_maps,
              const gpu::Texture& foliage_maps, const ImpostorPass& impostors, std::uint32_t count,
              const Terms& terms) const;

 private:
  void drawCasters(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
                   vk::DescriptorSet frame_set, const GpuScene& scene, std::uint32_t cascade,
                   const Terms& terms) const;

  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_LIGHT_DEPTH_PASS_H_
