#ifndef VERDURE_APP_SCENE_OPTIONS_H_
#define VERDURE_APP_SCENE_OPTIONS_H_

#include <optional>
#include <string>

#include "verdure/motion.h"
#include "verdure/plant_io.h"
#include "verdure/scene.h"

/// What render and reference have in common: the plant, and the camera.
namespace verdure::app {

struct SceneOptions {
  std::string input;
  LoadOptions load;
  std::string size = "960x720";
  std::string camera = "auto";
  double fov_deg = 34.0;
  bool no_ground = false;

  /// All throw Error that names the option.
  std::pair<int, int> sizeInPixels() const;
  void checkCamera() const;
  /// The camera that shows `scene` in a picture of `aspect` = width / height.
  Camera cameraFor(const Scene& scene, float aspect) const;
  /// The plant alone, on the ground unless that is left out.
  Scene sceneOf(const Plant& plant, const CrownLight* light) const;
};

/// Wind and time; a plant whose motion is asked for moves, others are at rest.
struct WindOptions {
  std::optional<float> speed;  ///< unset: 5 m/s if `time` or frames are asked for, else 0
  float from_deg = 240.0f;
  float gusts = 0.4f;
  std::optional<double> time;

  /// Throws Error that names the option. `film`: frames are asked for.
  Wind wind(bool film) const;
};

/// A plant's motion, with its branches found first where they are not known. A plant without any
/// sways as a whole: a note says so.
PlantMotion motionFor(Plant& plant);

/// A baked file has no leaf normals any more: finds them again from its triangles.
void restoreLeafNormals(Plant& plant);

}  // namespace verdure::app

#endif  // VERDURE_APP_SCENE_OPTIONS_H_
