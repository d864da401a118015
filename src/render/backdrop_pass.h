#ifndef VERDURE_RENDER_BACKDROP_PASS_H_
#define VERDURE_RENDER_BACKDROP_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/terms.h"

namespace verdure {

/// Draws what lies around the plants: a disc of grass around the eye that fades into the sky's
/// horizon, and, where nothing else covers, the dome and the sun's disk. Inside of rendering, last.
/// `kind`: source of ambient light, sky and background; `ground`: whether there is any.
class BackdropPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const Terms& terms,
               const DrawKind& kind, bool ground);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const Terms& terms, const DrawKind& kind,
              bool ground) const;

 private:
  std::map<gpu::Constants, vk::raii::Pipeline> ground_, sky_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_BACKDROP_PASS_H_
