#ifndef VERDURE_APP_OPTION_GROUPS_H_
#define VERDURE_APP_OPTION_GROUPS_H_

#include "app/commands.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// Options that several commands have.
namespace verdure::app {

void addLoadOptions(CLI::App& command, LoadOptions& load);
/// `group`: the heading in the help.
void addBakeOptions(CLI::App& command, BakeParameters& bake, const char* group);
/// The plant, the picture's size and the camera; returns the plant's.
CLI::Option* addSceneOptions(CLI::App& command, SceneOptions& scene);
void addGroundOptions(CLI::App& command, GroundOptions& ground);
void addWindOptions(CLI::App& command, WindOptions& wind);
void addDeviceOptions(CLI::App& command, DeviceOptions& device);
void addDaylightOptions(CLI::App& command, DaylightOptions& daylight);
void addExposureOptions(CLI::App& command, ExposureOptions& exposure);

}  // namespace verdure::app

#endif  // VERDURE_APP_OPTION_GROUPS_H_
