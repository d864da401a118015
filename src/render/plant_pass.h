#ifndef VERDURE_RENDER_PLANT_PASS_H_
#define VERDURE_RENDER_PLANT_PASS_H_

#include <map>
#include <utility>

#include "render/frame_layout.h"
#include "render/scene.h"

namespace verdure {

/// Draws wood and foliage, lit by the terms that are on. Inside of rendering.
class PlantPass {
 public:
  /// Makes the pipelines that the scene needs with these terms, once each; before recording.
  /// `kind`: what the sky is drawn with.
  void prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene,
               const Terms& terms, const DrawKind& kind);
  /// `behind`: meshes of trees that become impostors; else all but these.
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const Terms& terms,
              const DrawKind& kind, bool behind) const;

 private:
  /// By whether there are transfer vectors, and the terms.
  std::map<std::pair<bool, gpu::Constants>, vk::raii::Pipeline> pipelines_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_PLANT_PASS_H_
