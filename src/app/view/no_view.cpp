// view, in builds without the libraries that it takes.
#include "app/view/view_command.h"
#include "verdure/error.h"

namespace verdure::app {

void runView(const ViewCommand&) {
  throw Error("view", "this build has no viewer",
              "install its libraries (Debian: libimgui-dev libglfw3-dev) and build again, or use "
              "verdure render");
}

}  // namespace verdure::app
