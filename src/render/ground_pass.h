#ifndef VERDURE_RENDER_GROUND_PASS_H_
#define VERDURE_RENDER_GROUND_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/terms.h"

namespace verdure {

/// Draws a disc of grass around the eye that fades into the sky's horizon. Inside of rendering.
/// `kind`: source of ambient light, sky and background.
class GroundPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const Terms& terms,
               const DrawKind& kind);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const Terms& terms, const DrawKind& kind) const;

 private:
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GROUND_PASS_H_
