// view.
#include "app/view/view_command.h"

#include <algorithm>
#include <filesystem>

#include "app/commands.h"
#include "app/view/gui.h"
#include "app/view/screen.h"
#include "app/view/view_session.h"
#include "app/view/window.h"
#include "base/progress.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

// Panels need some frames to settle after input.
constexpr int kFramesAfterInput = 3;

/// What can be said before a window opens.
void checkInput(const std::string& input) {
  if (input.empty()) return;
  if (!std::filesystem::is_regular_file(input))
    throw Error(input, "is no file", "name a plant or a scene file");
  if (isSceneFile(input)) readScene(input);
}

}  // namespace

void runView(const ViewCommand& command) {
  const auto [width, height] = parseSize(command.size);
  checkInput(command.input);
  if (!command.screenshot.empty()) checkOutput(command.screenshot, {".png"});
  Window window("verdure", width, height);
  const GuiContext context(window);
  Screen screen(window, command.device);
  ViewSession session(screen, &Window::wake);
  Gui gui(window, screen, session);
  if (!command.input.empty()) session.open(command.input);

  Timer clock;
  int lively = kFramesAfterInput;
  bool capturing = false;
  while (!gui.closes()) {
    const bool minimised = window.size().x == 0;
    const double rest = minimised ? 0.25 : lively > 0 || gui.moves() ? 0.0 : session.rest();
    const WindowInput input = window.wait(rest);
    lively = input.any ? kFramesAfterInput : std::max(lively - 1, 0);
    if (window.shouldClose()) {
      window.keepOpen();
      gui.askToClose();
      lively = kFramesAfterInput;
    }
    gui.frame(input, clock.lap());
    if (command.screenshot.empty()) continue;
    if (capturing && gui.captured()) break;
    if (!capturing && lively == 0 && session.settled()) {
      if (!command.input.empty() && session.shown() == nullptr)
        throw Error("view", session.message);
      gui.captureWindow(command.screenshot);
      capturing = true;
    }
  }
  window.hide();  // what still runs is waited for unseen
}

}  // namespace verdure::app
