#ifndef VERDURE_RENDER_TRANSFER_PASS_H_
#define VERDURE_RENDER_TRANSFER_PASS_H_

#include <vector>

#include "gpu/descriptors.h"
#include "gpu/pipeline.h"
#include "render/packed_transfer.h"

namespace verdure {

/// A scene's transfer vectors on the GPU, and the light on its vertices that follows from them.
class GpuTransfer {
 public:
  /// `vertices`: of the whole scene; none of them need have vectors.
  GpuTransfer(const gpu::Device& device, gpu::Upload& upload, std::span<const PackedTransfer> parts,
              std::size_t vertices, const gpu::SetLayout& set_layout);

  /// A vertex stream of two times four halves (front, back; irradiance / pi, frame units) for each
  /// vertex of the scene, or a single one if it has no vectors at all.
  const gpu::Buffer& light() const { return light_; }

 private:
  friend class TransferPass;
  struct Part {
    shared::TransferUniforms uniforms;
    gpu::Buffer words;
    gpu::DescriptorSet set;
  };
  gpu::Buffer weights_, light_;
  std::vector<Part> parts_;
  std::vector<glm::vec2> known_weights_;
};

/// Computes the light on the vertices from their transfer vectors. It need not be done again while
/// the daylight stays, however many instances are drawn from however many cameras.
class TransferPass {
 public:
  explicit TransferPass(const gpu::Device& device);
  const gpu::SetLayout& setLayout() const { return set_layout_; }
  /// `weights`: as packWeights() makes them, in frame units. Leaves the light as vertex input.
  void record(const vk::raii::CommandBuffer& commands, GpuTransfer& transfer,
              std::vector<glm::vec2> weights) const;

 private:
  gpu::SetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_TRANSFER_PASS_H_
