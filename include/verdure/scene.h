#ifndef VERDURE_SCENE_H_
#define VERDURE_SCENE_H_

#include <glm/glm.hpp>
#include <vector>

#include "verdure/motion.h"
#include "verdure/plant.h"
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

/// Coordinates are relative to the origin of the first item's plant; a plant with another origin
/// stands where the difference of both puts it. Scenes hundreds of kilometres from the coordinates'
/// origin therefore look the same as at it.
struct Scene {
  std::vector<SceneItem> items;
  bool ground = true;  ///< textured ground plane at y = ground_height
  float ground_height = 0.0f;
};

/// A camera that shows the whole scene from `azimuth` (as the sun's) and `elevation` (radians),
/// with a small margin, for an image of `aspect` = width / height. At elevation 0 the eye is about
/// as high as a person's: 1.7 m, but at most a third of the scene's height and at least an eighth.
Camera automaticCamera(const Scene& scene, float azimuth, float elevation, float aspect,
                       float vertical_fov = 0.6f);

}  // namespace verdure

#endif  // VERDURE_SCENE_H_
