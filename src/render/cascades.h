#ifndef VERDURE_RENDER_CASCADES_H_
#define VERDURE_RENDER_CASCADES_H_

#include <glm/glm.hpp>
#include <vector>

#include "shared/cascade.h"
#include "verdure/plant.h"
#include "verdure/scene.h"

/// Where the sun's maps lie: parallel-split shadow maps (Zhang, Sun, Xu, Lun, "Parallel-Split
/// Shadow Maps for Large-Scale Virtual Environments", VRCIA 2006).
namespace verdure {

/// The sun's orthographic view of the scene, or of a part of it.
struct ShadowFit {
  glm::mat4 shadow_from_world{1.0f};  ///< x, y in [0, 1], z from 0 (nearest the sun) to 1
  float texel_m = 0.0f;
};

/// Fits a square map of size x size texels to the bounds. It depends on the scene and the sun
/// alone, so that shadows do not crawl when the camera moves.
ShadowFit fitShadow(const Bounds& bounds, const glm::vec3& to_sun, int size);

/// The finest of several maps, or the next one, and so on.
struct Cascade : ShadowFit {
  /// Where the map lies, in texels from the world's origin, modulo shared::kCascadeWrap: a point
  /// has the same texel, so counted, in every frame. 0 for a map of the whole scene.
  glm::ivec2 origin{0};
  /// The picture up to here, along the camera's axis, lies in this map and away from its border;
  /// infinite for a map of the whole scene.
  float reach_m = 0.0f;
};

struct CascadeRequest {
  Camera camera;
  int width = 1, height = 1;  ///< of the picture, pixels
  Bounds bounds;              ///< of the scene
  glm::vec3 to_sun{0, 1, 0};  ///< unit
  int size = 2048;            ///< of each map, texels
  int count = 0;              ///< most cascades, 1 to shared::kMostCascades; 0 = automatic
  bool snap = true;           ///< off in tests alone, to see what it does
};

/// The maps for one frame, finest first. The last one is fitShadow() of the whole scene, so nothing
/// is ever outside of all maps, and a single one depends on the scene and the sun alone.
///
/// The others each hold the part of the picture's pyramid from the eye to `reach_m`: the practical
/// split of the depths `near` to `far` (Zhang 2006, (3)) with 9 parts logarithmic and 1 part
/// uniform. `far` is the eye's distance from the farthest corner of the bounds, `near` that from
/// the bounds, at least far / 1000; both rounded to powers of two, so that maps keep their scale
/// while the camera moves. Of each part the smallest sphere around it counts: however the camera
/// turns, its size stays. The map moves by whole texels, and its depths hold all of the
/// bounds that lies behind and in front of it, so that whatever stands towards the sun casts its
/// shadow. A map that would not be a fifth finer
/// than that of the whole scene is left out; maps under 64 texels, whose border would be most of
/// them, too.
///
/// Automatic: the smallest number for which no map's texel is larger than two pixels of the picture
/// at the nearest place where it may be used (the unrounded `near`, or the reach of the map before
/// it); else four.
std::vector<Cascade> fitCascades(const CascadeRequest& request);

/// The smallest sphere around the pyramid of a picture from the eye to depth 1: its centre's depth
/// and its radius. `tan_corner`: tangent of the angle between the axis and a corner.
struct PyramidSphere {
  float center = 0.0f, radius = 0.0f;
};
PyramidSphere pyramidSphere(float tan_corner);

/// Depths at which the picture's pyramid is split into `count` parts, without `near` and `far`.
std::vector<float> cascadeSplits(float near, float far, int count);

}  // namespace verdure

#endif  // VERDURE_RENDER_CASCADES_H_
