#ifndef VERDURE_RENDER_MOTION_PASS_H_
#define VERDURE_RENDER_MOTION_PASS_H_

#include <array>
#include <optional>
#include <vector>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"
#include "render/packed_motion.h"

namespace verdure {

/// Set layouts of the motion: what computes it, and what vertex shaders read (motion.glsl).
struct MotionLayouts {
  explicit MotionLayouts(const gpu::Device& device);
  gpu::SetLayout job, vertex;
};

class GpuForest;

/// What moves of a scene, on the GPU, and how far it is bent in this frame and in the last one.
class GpuMotion {
 public:
  /// `instances`: the scene's places, 64 bytes each. Throws Error where the device's storage
  /// buffers are too small.
  /// `forest`: null, or that of the scene.
  GpuMotion(const gpu::Device& device, gpu::Upload& upload, const PackedMotions& packed,
            const gpu::Buffer& instances, GpuForest* forest, const MotionLayouts& layouts);
  /// For set 2 of the pipelines that draw plants.
  vk::DescriptorSet vertexSet() const { return **vertex_set_; }

 private:
  friend class MotionPass;
  std::vector<PackedMotion> items_;
  vk::Buffer instances_;
  const GpuForest* forest_ = nullptr;
  gpu::Buffer beams_, drives_, leaves_, hangs_;
  std::vector<gpu::Buffer> texels_;                          ///< of each item: levels, then wind
  std::array<gpu::Buffer, 2> amplitudes_, turns_;            ///< of this frame, of the last
  std::array<std::vector<gpu::DescriptorSet>, 2> job_sets_;  ///< of each item
  std::optional<gpu::DescriptorSet> vertex_set_;
};

/// Computes how far branches and leaves are bent, once for each place of each plant; vertex shaders
/// do the rest.
class MotionPass {
 public:
  explicit MotionPass(const gpu::Device& device);
  const MotionLayouts& layouts() const { return layouts_; }
  /// `last`: into the results of the last frame. Leaves them as vertex shaders read them.
  void record(const vk::raii::CommandBuffer& commands, const GpuMotion& motion, const Wind& wind,
              double seconds, bool last) const;

 private:
  MotionLayouts layouts_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline branches_, leaves_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_MOTION_PASS_H_
