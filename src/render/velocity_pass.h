#ifndef VERDURE_RENDER_VELOCITY_PASS_H_
#define VERDURE_RENDER_VELOCITY_PASS_H_

#include <map>
#include <optional>

#include "render/frame_layout.h"
#include "render/impostor_pass.h"
#include "render/scene.h"

namespace verdure {

/// Draws how far what is seen in each pixel has come since the last frame.
class VelocityPass {
 public:
  static constexpr vk::Format kFormat = vk::Format::eR32G32Sfloat;

  void prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene,
               int width, int height);
  /// Needs the motion of both frames, and frame.last_clip_from_world.
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const ImpostorPass& impostors,
              const GrassPass& grass) const;
  /// Pixels, x right, y down; after the fence. Where nothing was drawn, the ground's plane and the
  /// sky, which stand still.
  std::vector<glm::vec2> read(const Camera& now, const Camera& last,
                              std::optional<float> ground_height) const;

 private:
  std::map<gpu::Constants, vk::raii::Pipeline> pipelines_;
  std::optional<gpu::Texture> ways_, depth_;
  std::optional<gpu::Buffer> readback_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_VELOCITY_PASS_H_
