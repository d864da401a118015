#ifndef VERDURE_RENDER_GROUND_LIGHT_H_
#define VERDURE_RENDER_GROUND_LIGHT_H_

#include <optional>
#include <vector>

#include "render/half_texture.h"
#include "render/scene.h"

namespace verdure {

/// A map of the sky's light on the ground among plants with transfer vectors: for each texel the
/// open ground's light times, for each plant, the share of it that the plant lets through and
/// scatters back.
class GroundLight {
 public:
  static constexpr int kMostTexels = 256;  ///< along each side

  explicit GroundLight(const gpu::Device& device);

  /// Computes the map (on the CPU: it is small) if anything changed. `weights`: packWeights() in
  /// frame units; `open`: irradiance / pi of open ground, frame units. `scene_id` tells scenes
  /// apart.
  void update(const std::vector<PackedGround>& grounds, int scene_id,
              const std::vector<glm::vec2>& weights, const glm::vec3& open);
  /// Corner x, z of the map, 1 / its size in m; zeros if there is none.
  glm::vec3 place() const { return place_; }
  void record(const vk::raii::CommandBuffer& commands);
  const gpu::Texture& texture() const { return map_.texture(); }

 private:
  HalfTexture map_;
  glm::vec3 place_{0.0f};
  int scene_id_ = -1;
  std::vector<glm::vec2> weights_;
  bool copied_ = false;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_GROUND_LIGHT_H_
