#ifndef VERDURE_RENDER_INSPECT_PASS_H_
#define VERDURE_RENDER_INSPECT_PASS_H_

#include <map>
#include <utility>

#include "render/frame_layout.h"
#include "render/scene.h"

namespace verdure {

/// What is shown of plants instead of their light. Numbered as in inspect_pass.frag.
enum class Inspection {
  kNothing,
  kNormals,      ///< that the light takes, without normal maps: 0.5 + 0.5 n as display values
  kCoefficient,  ///< the baked ambient coefficient, black 0 to white 1
  kLayers,       ///< leaves in front of the sun, by the light depth maps: blue 0 to red 12
  kBranchLevel,  ///< trunk orange, its branches yellow, then green, then blue; grey: unknown
  kTexels,       ///< of the base colour a pixel: white 1, red 4 and more, blue 1/4 and less
  kColor,        ///< the base colour, unlit
};

/// Draws wood and foliage as PlantPass does, but one quantity of them. Inside of rendering.
class InspectPass {
 public:
  /// Makes the pipelines that the scene needs, once each; before recording.
  void prepare(const gpu::Device& device, const FrameLayout& layout, const GpuScene& scene,
               const Terms& terms, Inspection what);
  void record(const vk::raii::CommandBuffer& commands, const FrameLayout& layout,
              vk::DescriptorSet frame_set, const GpuScene& scene, const Terms& terms,
              Inspection what) const;

 private:
  std::map<std::pair<bool, gpu::Constants>, vk::raii::Pipeline> pipelines_;
};

/// A view of the same whose exposure shows the pass's values as they are, on plain grey, with all
/// that it looks at: light depth maps, plants as they are bent (at rest by a breath of wind).
View inspectedView(const View& view, Inspection what);

}  // namespace verdure

#endif  // VERDURE_RENDER_INSPECT_PASS_H_
