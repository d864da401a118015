#ifndef VERDURE_RENDER_HALF_TEXTURE_H_
#define VERDURE_RENDER_HALF_TEXTURE_H_

#include <cstdint>
#include <glm/glm.hpp>

#include "gpu/resources.h"

namespace verdure {

/// A texture of half floats that the CPU fills anew now and then, in a frame's own commands.
class HalfTexture {
 public:
  HalfTexture(const gpu::Device& device, std::uint32_t width, std::uint32_t height);

  int width() const { return static_cast<int>(texture_.request.width); }
  int height() const { return static_cast<int>(texture_.request.height); }
  /// Values beyond what halves hold are cut. Not while commands of the last frame run.
  void set(int x, int y, const glm::vec3& color);
  /// Copies what was set and leaves the texture as kDrawSampled.
  void record(const vk::raii::CommandBuffer& commands) const;
  const gpu::Texture& texture() const { return texture_; }

 private:
  gpu::Texture texture_;
  gpu::Buffer staging_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_HALF_TEXTURE_H_
