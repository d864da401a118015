#ifndef VERDURE_RENDER_GRASS_PASS_H_
#define VERDURE_RENDER_GRASS_PASS_H_

#include <map>
#include <optional>

#include "render/frame_layout.h"
#include "render/packed_grass.h"
#include "render/terms.h"

namespace verdure {

/// Cells along a node of the terrain.
constexpr std::uint32_t kTerrainCells = 16;

/// The ground of a scene that is more than a plane, packed.
struct PackedTerrain {
  Terrain terrain;
  std::vector<PackedGrass> layers;  ///< none: bare ground
};

/// The same on the GPU.
class GpuTerrain {
 public:
  GpuTerrain(const gpu::Device& device, PackedTerrain packed, const gpu::SetLayout& layout);
  const Terrain& terrain() const { return terrain_; }
  float lowest() const { return range_.x; }  ///< m

 private:
  friend class GrassPass;
  friend class GrassBlades;
  friend class GrassBillboards;
  struct Layer {
    PackedGrass packed;      ///< without its textures' bytes
    bool grass = false;      ///< else it is bare ground
    bool holds_eye = false;  ///< the eye is in its shell
    std::optional<gpu::Texture> slice_colors, slice_data, ground_colors, ground_data, far_colors;
    gpu::Buffer cover, uniforms;
    std::optional<gpu::DescriptorSet> set;
  };
  Terrain terrain_;
  glm::vec2 range_{0.0f};  ///< lowest and highest place
  bool level_ = false;
  gpu::Buffer heights_;
  std::vector<vk::raii::Sampler> samplers_;
  std::vector<Layer> layers_;
  gpu::Buffer nodes_;
};

/// Draws a terrain, and rays through the grass on it, over what stands there already.
class GrassPass {
 public:
  GrassPass(const gpu::Device& device, vk::DescriptorSetLayout frame_set);
  const gpu::SetLayout& setLayout() const { return set_layout_; }
  /// Of the terrain that was prepared last, 6 kTerrainCells^2 vertices each.
  std::uint32_t nodeCount() const { return nodes_; }

  /// What depends on the eye and the time; `depth`: of the samples of what stands in the grass.
  void prepare(GpuTerrain& terrain, const View& view, const gpu::Texture& depth, bool new_depth,
               const DrawKind& kind, float radius);
  /// Outside of rendering; `depth` from kDepthAttachment and back.
  void recordDepthRange(const vk::raii::CommandBuffer& commands, const gpu::Texture& depth) const;
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuTerrain& terrain, const Terms& terms, const DrawKind& kind) const;
  /// How far the ground, or the upper side of the first layer, has come since the last frame:
  /// inside of the velocity pass's rendering, to a target of this format. Behind prepare().
  void prepareVelocity(const GpuTerrain& terrain, vk::Format format);
  void recordVelocity(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
                      const GpuTerrain& terrain) const;

 private:
  gpu::Constants constantsOf(const GpuTerrain& terrain, std::size_t layer, const Terms& terms,
                             const DrawKind& kind, bool from_eye) const;
  /// Without what the target is.
  gpu::GraphicsRequest requestOf(gpu::SpirV fragment, const gpu::Constants& constants) const;
  void addPipeline(const gpu::Constants& constants);

  const gpu::Device* device_;
  gpu::SetLayout set_layout_, depth_layout_;
  vk::raii::PipelineLayout layout_, depth_pipeline_layout_;
  vk::raii::Pipeline depth_pipeline_;
  gpu::DescriptorSet depth_set_;
  vk::raii::Sampler nearest_;
  std::optional<gpu::Texture> range_;
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_, velocity_;
  std::uint32_t nodes_ = 0;  ///< that are drawn
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GRASS_PASS_H_
