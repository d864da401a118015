#ifndef VERDURE_RENDER_FRAME_H_
#define VERDURE_RENDER_FRAME_H_

#include <optional>

#include "gpu/timers.h"
#include "render/backdrop_pass.h"
#include "render/blocker_pass.h"
#include "render/bloom_pass.h"
#include "render/cascades.h"
#include "render/exposure_pass.h"
#include "render/frame_layout.h"
#include "render/frame_light.h"
#include "render/grass_billboards.h"
#include "render/grass_blades.h"
#include "render/grass_pass.h"
#include "render/ground_light.h"
#include "render/impostor_pass.h"
#include "render/inspect_pass.h"
#include "render/light_depth_pass.h"
#include "render/motion_pass.h"
#include "render/plant_pass.h"
#include "render/shadow_pass.h"
#include "render/sky_image.h"
#include "render/style_pass.h"
#include "render/targets.h"
#include "render/tone_pass.h"
#include "render/transfer_pass.h"
#include "render/velocity_pass.h"

namespace verdure {

/// Everything that one frame needs beside the scene, and the order of its passes.
class FrameDrawer {
 public:
  explicit FrameDrawer(const gpu::Device& device);
  const FrameLayout& layout() const { return layout_; }
  SceneLayouts sceneLayouts() const {
    return {*layout_.material_set, transfer_pass_.setLayout(), motion_pass_.layouts(),
            grass_pass_.setLayout(), forest_pass_.layouts()};
  }
  /// The next frame shows another scene.
  void forgetScene() {
    ++scene_id_;
    grass_blades_.forget();
  }

  /// Draws and reads back. With a `target` (of the picture's size and format, in use
  /// kFragmentSampled before and after), the picture goes there and Frame::image stays empty.
  /// Throws Error for sizes out of range.
  Frame draw(GpuScene& scene, const View& view, const gpu::Texture* target = nullptr);

  /// In tests alone, which look at what moves in a picture when only the cascades do.
  struct CascadeTrial {
    std::optional<Camera> camera = {};  ///< that cascades are fitted to, instead of the view's
    bool snap = true;                   ///< CascadeRequest::snap
  };
  void tryCascades(const CascadeTrial& trial) { cascade_trial_ = trial; }
  /// In tests and measurements alone: the first layer of grass as polygons instead of rays.
  void tryBillboards(const std::optional<BillboardTrial>& trial) { billboard_trial_ = trial; }
  const GrassBillboards& billboards() const { return grass_billboards_; }
  /// From now on: plants alone, one quantity of them; views should be inspectedView().
  void inspect(Inspection what) { inspection_ = what; }

 private:
  void checkView(const View& view) const;
  bool resize(const View& view);  ///< whether the targets are new
  std::vector<Cascade> cascadesOf(const GpuScene& scene, const View& view);
  const Harmonics& skyOf(const View& view);
  shared::FrameUniforms makeUniforms(const GpuScene& scene, const View& view,
                                     const FrameLight& light, float units,
                                     const std::vector<Cascade>& cascades) const;
  void recordColor(const vk::raii::CommandBuffer& commands, const GpuScene& scene, const View& view,
                   const DrawKind& kind) const;
  /// Begins rendering to the samples: onto what is there unless `first`; `last`: with their
  /// average.
  void beginColor(const vk::raii::CommandBuffer& commands, const View& view, bool first,
                  bool last) const;
  void recordTone(const vk::raii::CommandBuffer& commands, const View& view, float units) const;

  const gpu::Device* device_;
  ForestPass forest_pass_;
  MotionPass motion_pass_;
  FrameLayout layout_;
  ImpostorPass impostor_pass_;
  TransferPass transfer_pass_;
  ShadowPass shadow_pass_;
  LightDepthPass light_depth_pass_;
  BlockerPass blocker_pass_;
  PlantPass plant_pass_;
  InspectPass inspect_pass_;
  VelocityPass velocity_pass_;
  BackdropPass backdrop_pass_;
  GrassPass grass_pass_;
  GrassBlades grass_blades_;
  GrassBillboards grass_billboards_;
  ExposurePass exposure_pass_;
  BloomPass bloom_pass_;
  TonePass tone_pass_;
  std::optional<StylePass> style_pass_;  ///< since a drawn style was first asked for
  gpu::Timers timers_;
  gpu::Texture ground_texture_, ground_noise_;
  vk::raii::Sampler ground_sampler_ = nullptr;  ///< repeats both ways
  vk::raii::Sampler sky_sampler_ = nullptr;     ///< repeats around the horizon
  vk::raii::Sampler edge_sampler_ = nullptr;
  vk::raii::Sampler foliage_sampler_ = nullptr;
  vk::raii::Sampler texel_sampler_ = nullptr;  ///< the nearest texel
  vk::raii::Sampler shadow_sampler_ = nullptr;
  gpu::Buffer uniforms_;
  gpu::DescriptorSet frame_set_;
  SkyImage sky_image_;
  GroundLight ground_light_;
  std::optional<gpu::Texture> shadow_maps_, foliage_maps_;  ///< a layer for each cascade
  CascadeTrial cascade_trial_;
  std::optional<BillboardTrial> billboard_trial_;
  Inspection inspection_ = Inspection::kNothing;
  std::optional<Targets> targets_;
  std::shared_ptr<const Sky> known_sky_;
  Harmonics known_harmonics_;  ///< of it
  int scene_id_ = 0;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_FRAME_H_
