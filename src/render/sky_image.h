#ifndef VERDURE_RENDER_SKY_IMAGE_H_
#define VERDURE_RENDER_SKY_IMAGE_H_

#include <memory>
#include <optional>
#include <vector>

#include "render/half_texture.h"
#include "verdure/sky.h"

namespace verdure {

/// The upper half of the dome as a texture, for skies without a formula; a black texel else.
class SkyImage {
 public:
  explicit SkyImage(const gpu::Device& device) : device_(&device) {}

  /// Looks at the sky; null or one with a formula has no image.
  void look(const std::shared_ptr<const Sky>& sky);
  /// Largest component of any direction, kcd/m^2, as far as is known.
  float brightest() const { return brightest_; }
  /// Fills the texture, if anything changed since. Returns whether the texture itself is another.
  bool fill(float units_per_kcd);
  /// Copies what was filled.
  void record(const vk::raii::CommandBuffer& commands);
  const gpu::Texture& texture() const { return image_->texture(); }

 private:
  const gpu::Device* device_;
  std::shared_ptr<const Sky> sky_;
  bool looked_ = false;
  int width_ = 0, height_ = 0;
  std::vector<glm::vec3> luminance_;
  float brightest_ = 0.0f;
  std::optional<HalfTexture> image_;
  float units_ = 0.0f;  ///< that the texture is filled with; 0 = none
  bool copied_ = false;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_SKY_IMAGE_H_
