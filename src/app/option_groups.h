#ifndef VERDURE_APP_OPTION_GROUPS_H_
#define VERDURE_APP_OPTION_GROUPS_H_

#include "app/commands.h"

namespace CLI {
class App;
}  // namespace CLI

/// Options that several commands have.
namespace verdure::app {

void addLoadOptions(CLI::App& command, LoadOptions& load);
/// `group`: the heading in the help.
void addBakeOptions(CLI::App& command, BakeParameters& bake, const char* group);
/// The plant or scene, the picture's size and the camera.
void addSceneOptions(CLI::App& command, SceneCommand& scene);
void addGroundOptions(CLI::App& command, GroundSettings& ground);
void addWindOptions(CLI::App& command, WindSettings& wind);
void addDeviceOptions(CLI::App& command, DeviceOptions& device);
void addDaylightOptions(CLI::App& command, DaylightSettings& daylight);
void addExposureOptions(CLI::App& command, ExposureSettings& exposure);
void addLookOptions(CLI::App& command, LookSettings& look);

}  // namespace verdure::app

#endif  // VERDURE_APP_OPTION_GROUPS_H_
