#ifndef VERDURE_RENDER_FRAME_H_
#define VERDURE_RENDER_FRAME_H_

#include <optional>

#include "gpu/timers.h"
#include "render/frame_layout.h"
#include "render/ground_pass.h"
#include "render/plant_pass.h"
#include "render/shadow_pass.h"
#include "render/sky_pass.h"

namespace verdure {

/// Everything that one frame needs beside the scene, and the order of its passes.
class FrameDrawer {
 public:
  explicit FrameDrawer(const gpu::Device& device);
  const FrameLayout& layout() const { return layout_; }

  /// Draws and reads back. Throws Error for sizes out of range.
  Frame draw(const GpuScene& scene, const View& view);

 private:
  struct Targets {
    gpu::Texture color, depth, resolved;
    gpu::Buffer readback;
  };
  void checkView(const View& view) const;
  void resize(const View& view);
  void writeFrameSet();
  shared::FrameUniforms makeUniforms(const GpuScene& scene, const View& view) const;
  void recordColor(const vk::raii::CommandBuffer& commands, const GpuScene& scene,
                   const View& view) const;
  Image readBack() const;

  const gpu::Device* device_;
  FrameLayout layout_;
  ShadowPass shadow_pass_;
  PlantPass plant_pass_;
  GroundPass ground_pass_;
  SkyPass sky_pass_;
  gpu::Timers timers_;
  gpu::Texture ground_texture_, ground_noise_;
  vk::raii::Sampler ground_sampler_ = nullptr;
  vk::raii::Sampler shadow_sampler_ = nullptr;
  gpu::Buffer uniforms_;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet frame_set_ = nullptr;
  std::optional<gpu::Texture> shadow_map_;
  std::optional<Targets> targets_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_FRAME_H_
