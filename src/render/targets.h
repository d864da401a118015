#ifndef VERDURE_RENDER_TARGETS_H_
#define VERDURE_RENDER_TARGETS_H_

#include <optional>

#include "gpu/resources.h"
#include "verdure/image.h"

namespace verdure {

/// What a frame is drawn to, and the way back to the CPU.
class Targets {
 public:
  Targets(const gpu::Device& device, std::uint32_t width, std::uint32_t height);
  bool fits(int width, int height) const;

  gpu::Texture color;     ///< linear, frame units, samples kept; alpha: share not background
  gpu::Texture depth;     ///< of the samples
  gpu::Texture resolved;  ///< linear average of the samples
  gpu::Texture picture;   ///< sRGB

  /// Copy the picture (then kTransferSource) and, on request, the average (from kFragmentSampled).
  void recordReadback(const vk::raii::CommandBuffer& commands, bool hdr);
  /// Instead: copy the picture to a texture as large, in use kFragmentSampled before and after.
  void recordHandOver(const vk::raii::CommandBuffer& commands, const gpu::Texture& to) const;
  /// After the fence.
  Image readPicture() const;
  /// kcd/m^2; background is black.
  HdrImage readHdr(float units_per_kcd) const;

 private:
  const gpu::Device* device_;
  gpu::Buffer picture_readback_;
  std::optional<gpu::Buffer> hdr_readback_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_TARGETS_H_
