#ifndef VERDURE_RENDER_GPU_FOREST_H_
#define VERDURE_RENDER_GPU_FOREST_H_

#include <optional>
#include <span>
#include <vector>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"
#include "render/cascades.h"
#include "render/packed_forest.h"
#include "render/packed_motion.h"
#include "verdure/render.h"

namespace verdure {

/// Descriptor sets of the passes that choose a forest's trees, and that draw impostors.
struct ForestLayouts {
  explicit ForestLayouts(const gpu::Device& device);
  gpu::SetLayout choice;    ///< as in src/shaders/forest_set.glsl
  gpu::SetLayout impostor;  ///< as in src/shaders/impostor.glsl
};

/// A forest on the GPU, and the trees that were chosen for each view of a frame: the picture's, the
/// sun's maps' and the one around the eye whose trees move.
class GpuForest {
 public:
  /// The picture's trees are in two parts: meshes, and the impostors that these may hide.
  static constexpr std::uint32_t kPicture = 0, kMotionView = 1 + shared::kMostCascades,
                                 kBehind = kMotionView + 1, kViews = kBehind + 1;

  /// `draws`: of the forest, in their order, without numbers of instances. Throws Error where the
  /// device's storage buffers are too small.
  GpuForest(const gpu::Device& device, gpu::Upload& upload, PackedForest packed,
            std::span<const vk::DrawIndexedIndirectCommand> draws, const ForestLayouts& layouts);
  /// Behind the constructor: what moves its trees, by whose trunks impostors bend.
  void setMotion(const PackedMotions& packed, const gpu::Buffer& beams, const gpu::Buffer& drives,
                 std::span<const gpu::Buffer> texels);

  /// Of the frame that comes: levels by the camera and the picture's size, places by the views.
  /// `terrain`: whose hills hide trees, or null. `lowest`: what shadows fall on, m. `hides`: so
  /// do its meshes.
  void look(const View& view, std::span<const Cascade> cascades, const Terrain* terrain,
            float lowest, bool hides);
  /// In tests alone: from now on what is not seen, or shades nothing that is, is drawn as well.
  void tryAll(bool all) { all_ = all; }
  bool hides() const { return view_data_[kBehind].hides != 0; }
  /// In this wind or weaker ones; none: at rest.
  void setWind(const std::optional<Wind>& wind);
  /// What casts shadows around `eye`, at rest or in the wind that was set.
  Bounds casterBounds(const glm::vec3& eye) const;

  /// The chosen trees as the instances of a draw, 64 bytes each.
  vk::Buffer seats() const { return *seats_.buffer; }
  vk::DeviceSize seatOffset(std::uint32_t view) const;
  void draw(const vk::raii::CommandBuffer& commands, std::uint32_t number,
            std::uint32_t view) const;
  /// The impostors of a kind, with the bound pipeline.
  void drawFar(const vk::raii::CommandBuffer& commands, std::uint32_t kind,
               std::uint32_t view) const;
  const gpu::Buffer& seatBuffer() const { return seats_; }
  const gpu::Buffer& commandBuffer() const { return commands_; }
  /// Where its two dispatches are: branches, then leaves.
  vk::DeviceSize motionCommand(std::uint32_t kind) const;
  bool moves() const { return moves_; }
  /// Trees that the picture shows as meshes and as impostors; after the fence.
  std::pair<std::uint32_t, std::uint32_t> counts() const;
  std::size_t places() const { return packed_.places.size(); }
  std::size_t bytes() const;  ///< of what grows with the number of trees

 private:
  friend class ForestPass;
  friend class ImpostorPass;
  struct Kind {
    std::optional<gpu::Texture> color, normal, light;
    std::optional<gpu::DescriptorSet> set;
  };

  const gpu::Device* device_;
  PackedForest packed_;
  std::uint32_t draw_count_ = 0;
  std::vector<shared::ForestKindData> kind_data_;
  std::vector<shared::ImpostorKind> impostor_data_;
  std::vector<Kind> kinds_;
  gpu::Buffer places_, clusters_, kind_buffer_, views_, counts_, ranges_, commands_, draw_classes_,
      seats_, fars_, slots_, impostors_, horizon_, depth_tiles_;
  std::optional<gpu::DescriptorSet> set_;
  vk::raii::Sampler sampler_ = nullptr;
  std::array<shared::ForestView, kViews> view_data_{};
  std::optional<glm::vec3> horizon_eye_;  ///< that horizon_ is for
  std::uint32_t view_count_ = 1;          ///< picture and cascades of this frame
  std::optional<Wind> wind_;
  bool moves_ = false, all_ = false;
  glm::vec3 low_{0.0f}, high_{0.0f};  ///< of all places
  float tallest_m_ = 0.0f;            ///< of any tree, its farthest point from its place
  Bounds largest_;                    ///< of any tree, however it is turned, from its place
};

/// Chooses: before anything that draws or moves trees.
class ForestPass {
 public:
  explicit ForestPass(const gpu::Device& device);
  const ForestLayouts& layouts() const { return layouts_; }
  /// Of a forest that has looked; `depth`: of the picture's samples.
  void prepare(const GpuForest& forest, const gpu::Texture& depth);
  /// The impostors of the picture as well, unless meshes hide them.
  void record(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const;
  /// With the samples' depths of what was drawn, in use kDepthAttachment before and after.
  void recordBehind(const vk::raii::CommandBuffer& commands, const GpuForest& forest,
                    const gpu::Texture& depth) const;

 private:
  void begin(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const;
  void choose(const vk::raii::CommandBuffer& commands, const GpuForest& forest,
              std::uint32_t first_view, std::uint32_t views) const;
  void end(const vk::raii::CommandBuffer& commands, const GpuForest& forest) const;

  ForestLayouts layouts_;
  gpu::SetLayout tiles_set_layout_;
  vk::raii::PipelineLayout layout_, tiles_layout_;
  vk::raii::Pipeline count_, scan_, list_, tiles_;
  gpu::DescriptorSet tiles_set_;
  vk::raii::Sampler sampler_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GPU_FOREST_H_
