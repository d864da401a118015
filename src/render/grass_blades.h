#ifndef VERDURE_RENDER_GRASS_BLADES_H_
#define VERDURE_RENDER_GRASS_BLADES_H_

#include <map>
#include <vector>

#include "render/frame_layout.h"
#include "render/grass_pass.h"
#include "render/terms.h"
#include "shared/grass_blades.h"

namespace verdure {

/// Plants of a terrain's grass that are so near that they are drawn one by one, as ribbons; they
/// give way to the traced ones with their distance. Chosen on the GPU.
class GrassBlades {
 public:
  GrassBlades(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
              const gpu::SetLayout& grass_set);

  /// Behind GrassPass::prepare(). Does nothing for layers without plants.
  void prepare(const GpuTerrain& terrain, const View& view, const DrawKind& kind);
  /// Which plants there are, outside of rendering; then they are drawn, inside.
  void recordChoice(const vk::raii::CommandBuffer& commands, const GpuTerrain& terrain) const;
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuTerrain& terrain, const Terms& terms, const DrawKind& kind) const;
  /// The next frame shows another scene.
  void forget() { layers_.clear(); }

 private:
  struct Layer {
    std::size_t index = 0;  ///< of the terrain's layers
    std::vector<shared::BladeJob> jobs;
    gpu::Buffer parts, blades, draw;
    std::optional<gpu::DescriptorSet> set;
  };

  const gpu::Device* device_;
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout choice_layout_, layout_;
  vk::raii::Pipeline choice_;
  gpu::Buffer indices_;
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
  std::vector<Layer> layers_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GRASS_BLADES_H_
