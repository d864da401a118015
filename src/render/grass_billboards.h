#ifndef VERDURE_RENDER_GRASS_BILLBOARDS_H_
#define VERDURE_RENDER_GRASS_BILLBOARDS_H_

#include <map>

#include "render/grass_pass.h"

namespace verdure {

/// How grass is drawn to be compared with rays.
struct BillboardTrial {
  float radius_m = 0.0f;  ///< around the eye; 0: as far as rays meet slices one by one
  /// Polygons end where they cross others, so that their order is exact; else they are a tile long
  /// and ordered by their middles.
  bool cut = false;
};

/// The baseline of table 2.1 of Habel 2009: the slices of the first layer of grass as polygons,
/// from far to near, blended over the ground with the set's picture of it.
class GrassBillboards {
 public:
  GrassBillboards(const gpu::Device& device, vk::DescriptorSetLayout frame_set,
                  const gpu::SetLayout& grass_set);

  /// After GrassPass::prepare(). Finds the polygons in view and orders them.
  void prepare(const GpuTerrain& terrain, const View& view, const DrawKind& kind,
               const BillboardTrial& trial);
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frame_set,
              const GpuTerrain& terrain, std::uint32_t nodes) const;

  std::uint32_t count() const { return count_; }
  float radius() const { return radius_m_; }
  /// What prepare() took to find and to order them, ms.
  double sortMilliseconds() const { return sort_ms_; }

 private:
  const gpu::Device* device_;
  gpu::SetLayout quad_layout_;
  vk::raii::PipelineLayout layout_;
  gpu::DescriptorSet quad_set_;
  gpu::Buffer quads_;
  std::map<gpu::Constants, std::pair<vk::raii::Pipeline, vk::raii::Pipeline>> pipelines_;
  const std::pair<vk::raii::Pipeline, vk::raii::Pipeline>* drawn_ = nullptr;  ///< ground, slices
  std::uint32_t count_ = 0;
  float radius_m_ = 0.0f;
  double sort_ms_ = 0.0;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GRASS_BILLBOARDS_H_
