#ifndef VERDURE_RENDER_IMPOSTOR_PASS_H_
#define VERDURE_RENDER_IMPOSTOR_PASS_H_

#include <map>

#include "render/frame_layout.h"
#include "render/scene.h"

namespace verdure {

/// Draws a forest's far trees, each as a card of what it looks like from there. Inside of
/// rendering.
class ImpostorPass {
 public:
  ImpostorPass(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
               const ForestLayouts& layouts);
  /// Makes pipelines, once each; before recording.
  void prepare(const Terms& terms, const DrawKind& kind, bool light_depth);
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuForest& forest, const Terms& terms, const DrawKind& kind) const;
  /// The same for a layer of foliage of the drawn styles: to three targets of `color`, with a set
  /// of `ground_set` as the third.
  void prepareDrawn(const Terms& terms, const DrawKind& kind, vk::DescriptorSetLayout ground_set,
                    vk::Format color);
  void recordDrawn(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                   vk::DescriptorSet ground_set, const GpuForest& forest, const Terms& terms,
                   const DrawKind& kind) const;
  /// How far they have come since the last frame: to a single target of `way`.
  void prepareVelocity(vk::Format way);
  void recordVelocity(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                      const GpuForest& forest) const;
  /// One of the sun's maps.
  void recordShadows(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                     const GpuForest& forest, std::uint32_t cascade, bool light_depth) const;

 private:
  void draw(const vk::raii::CommandBuffer& commands, vk::PipelineLayout layout,
            vk::DescriptorSet frame_set, const GpuForest& forest, std::uint32_t view,
            bool velocity = false) const;

  const gpu::Device* device_;
  vk::DescriptorSetLayout frame_layout_, impostor_layout_;
  vk::raii::PipelineLayout layout_, drawn_layout_ = nullptr;
  vk::raii::Pipeline velocity_ = nullptr;
  std::map<gpu::Constants, vk::raii::Pipeline> pictures_, drawn_;
  std::map<bool, vk::raii::Pipeline> shadows_;  ///< by whether it is a light depth map
};

}  // namespace verdure

#endif  // VERDURE_RENDER_IMPOSTOR_PASS_H_
