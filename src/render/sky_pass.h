#ifndef VERDURE_RENDER_SKY_PASS_H_
#define VERDURE_RENDER_SKY_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/terms.h"

namespace verdure {

/// Fills what nothing else covers with the dome and the sun's disk. Inside of rendering, last.
/// `kind`: sky and background.
class SkyPass {
 public:
  void prepare(const gpu::Device& device, const FrameLayout& layout, const DrawKind& kind);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const DrawKind& kind) const;

 private:
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SKY_PASS_H_
