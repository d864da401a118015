#ifndef VERDURE_APP_VIEW_VIEW_COMMAND_H_
#define VERDURE_APP_VIEW_VIEW_COMMAND_H_

#include <string>

#include "verdure/render.h"

namespace verdure::app {

struct ViewCommand {
  std::string input;  ///< a plant or a scene; empty: nothing yet
  std::string size = "1280x800";
  std::string screenshot;  ///< file for a picture of the window once all is drawn; then it closes
  DeviceOptions device;
};
/// Returns when the window is closed. Throws Error without a display, or in a build without viewer.
void runView(const ViewCommand& command);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_VIEW_COMMAND_H_
