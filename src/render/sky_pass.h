#ifndef VERDURE_RENDER_SKY_PASS_H_
#define VERDURE_RENDER_SKY_PASS_H_

#include "render/frame_layout.h"

namespace verdure {

/// Fills what nothing else covers with the sky. Inside of rendering, last.
class SkyPass {
 public:
  SkyPass(const gpu::Device& device, const FrameLayout& layout);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set) const;

 private:
  vk::raii::Pipeline pipeline_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SKY_PASS_H_
