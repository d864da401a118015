#ifndef VERDURE_RENDER_GROUND_PASS_H_
#define VERDURE_RENDER_GROUND_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "verdure/render.h"

namespace verdure {

/// Draws a disc of grass around the eye that fades into the sky's horizon. Inside of rendering.
class GroundPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const Terms& terms);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const Terms& terms) const;

 private:
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GROUND_PASS_H_
