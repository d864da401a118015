#ifndef VERDURE_APP_PLANT_PREP_H_
#define VERDURE_APP_PLANT_PREP_H_

#include <functional>
#include <optional>

#include "app/scene_settings.h"
#include "verdure/motion.h"
#include "verdure/plant.h"

/// What is done to a plant after it is loaded and before it is drawn.
namespace verdure::app {

/// The light that a file brought along in `_AO`, `_VISIBILITY` and NORMAL, if it has any.
std::optional<CrownLight> lightOfFile(const Plant& plant);

/// Adds leaf visibility to a light that has none. Returns the seconds that it took.
double addLeafVisibility(const Plant& plant, CrownLight& light,
                         const std::function<void(double share)>& progress);

/// A baked file has no leaf normals any more: finds them again from its triangles.
void restoreLeafNormals(Plant& plant);

/// A plant's motion, with its branches found first where they are not known. A plant without any
/// sways as a whole: a note says so.
PlantMotion motionFor(Plant& plant, const MotionSettings& settings = {});
/// The same of a plant whose branches are known.
PlantMotion motionOf(const Plant& plant, const MotionSettings& settings);

/// Where a plant stands: on the zero of its own heights, where strands may hang below it; one that
/// was modelled around or away from it stands on its lowest point.
float groundHeight(const Plant& plant);

/// What stands in the place of a plant that cannot be read: a post with a bright sign.
Plant missingPlantMarker();

}  // namespace verdure::app

#endif  // VERDURE_APP_PLANT_PREP_H_
