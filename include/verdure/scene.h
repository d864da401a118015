#ifndef VERDURE_SCENE_H_
#define VERDURE_SCENE_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/grass.h"
#include "verdure/levels.h"
#include "verdure/motion.h"
#include "verdure/placement.h"
#include "verdure/plant.h"
#include "verdure/terrain.h"
#include "verdure/transfer.h"

/// What is looked at, and from where: the same for the renderer and for the reference.
namespace verdure {

/// Unit direction of an azimuth from +Z (south) towards +X (east) and an elevation, radians.
glm::vec3 directionOf(float azimuth, float elevation);

struct Camera {
  glm::vec3 eye{0.0f, 2.0f, 10.0f};
  glm::vec3 target{0.0f, 2.0f, 0.0f};
  float vertical_fov = 0.6f;  ///< radians
};

/// A plant drawn at one or more places. `light` may be null: then normals are the mesh's own, as
/// with NormalSource::kLeaf, and the ambient coefficient is 1. Foliage is drawn from both sides
/// whatever its material says; alpha that is masked or blended is cut.
struct SceneItem {
  const Plant* plant = nullptr;
  const CrownLight* light = nullptr;
  std::vector<glm::mat4> world_from_plant{glm::mat4(1.0f)};
  const PlantTransfer* transfer = nullptr;  ///< may be null; of plants that stand unturned
  /// False: the camera sees what is behind it; its shadow and the light off it stay.
  bool seen = true;
  const PlantMotion* motion = nullptr;  ///< may be null: it stands still in any wind
};

/// A kind of grass on the ground.
struct GrassLayer {
  const GrassSet* set = nullptr;
  const CoverMap* cover = nullptr;  ///< where it grows how densely; null: everywhere
  float density = 1.0f;             ///< times that, [0, 1]
  float turn = 0.5f;                ///< of u and v against x and z, about the vertical, radians
  bool mirrored = false;            ///< v runs against z
  int most_slices = 32;             ///< on a ray, [1, 256]; what is open behind them is filled
  float scatter = 0.6f;  ///< how far slices are off even distances, in shares of them, [0, 0.9]
  bool blades = true;    ///< plants near the eye are drawn one by one, as ribbons
  bool middle = true;    ///< the level slice, where the set has one
  /// Rays end at what stands in the grass; else it is hidden by whole pixels, where they are more
  /// than about half covered.
  bool ends_at_depth = true;
  /// Slices that are nearer to each other than pixels are composited as what they look like on the
  /// mean; else one by one, as in the thesis, with patterns that are none of the grass'.
  bool medium = true;
  float variation = 0.7f;  ///< share of the patches of tones that are laid over it, [0, 1]
};

/// Of a forest's plants one. `levels` may be null: then it is drawn as it is at all distances.
struct ForestKind {
  const Plant* plant = nullptr;
  const CrownLight* light = nullptr;    ///< may be null
  const PlantMotion* motion = nullptr;  ///< may be null
  const PlantLevels* levels = nullptr;
};

/// Many plants of a few kinds. They are chosen and drawn by the GPU: those that are seen, each as
/// fine as its size in the picture asks for.
struct Forest {
  std::vector<ForestKind> kinds;
  std::vector<Placement> places;  ///< Placement::plant: index into kinds
  float detail = 1.0f;            ///< finer levels reach so many times farther, (0, 100]
};

/// Coordinates are relative to the origin of the first item's plant; a plant with another origin
/// stands where the difference of both puts it. Scenes hundreds of kilometres from the coordinates'
/// origin therefore look the same as at it.
struct Scene {
  std::vector<SceneItem> items;
  bool ground = true;  ///< textured ground plane at y = ground_height
  float ground_height = 0.0f;
  const Terrain* terrain = nullptr;    ///< takes the plane's place
  std::vector<GrassLayer> grass = {};  ///< on either; the first covers it, the others add to it
  const Forest* forest = nullptr;      ///< beside the items
};

/// A camera that shows the whole scene from `azimuth` (as the sun's) and `elevation` (radians),
/// with a small margin, for an image of `aspect` = width / height. At elevation 0 the eye is about
/// as high as a person's: 1.7 m, but at most a third of the scene's height and at least an eighth.
Camera automaticCamera(const Scene& scene, float azimuth, float elevation, float aspect,
                       float vertical_fov = 0.6f);

}  // namespace verdure

#endif  // VERDURE_SCENE_H_
