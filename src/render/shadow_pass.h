#ifndef VERDURE_RENDER_SHADOW_PASS_H_
#define VERDURE_RENDER_SHADOW_PASS_H_

#include "render/frame_layout.h"
#include "render/scene.h"

namespace verdure {

/// The sun's orthographic view of the scene.
struct ShadowFit {
  glm::mat4 shadow_from_world{1.0f};  ///< x, y in [0, 1], z from 0 (nearest the sun) to 1
  float texel_m = 0.0f;
};

/// Fits a square map of size x size texels to the bounds. It depends on the scene and the sun
/// alone, so that shadows do not crawl when the camera moves.
ShadowFit fitShadow(const Bounds& bounds, const glm::vec3& to_sun, int size);

/// Draws the depth of everything as the sun sees it.
class ShadowPass {
 public:
  ShadowPass(const gpu::Device& device, const FrameLayout& layout);
  /// `map`: a depth image used as kFragmentSampled afterwards. Without `casters` it stays empty.
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const gpu::Texture& map,
              bool casters) const;

 private:
  vk::raii::Pipeline opaque_, alpha_cut_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SHADOW_PASS_H_
