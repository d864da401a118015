#ifndef VERDURE_APP_VIEW_GUI_H_
#define VERDURE_APP_VIEW_GUI_H_

#include <filesystem>
#include <optional>
#include <string>

#include "app/view/file_dialog.h"
#include "app/view/panels.h"
#include "app/view/view_session.h"
#include "app/view/window.h"

namespace verdure::app {

/// Dear ImGui for a window, as long as this lives. Before the Screen, which takes its fonts.
class GuiContext {
 public:
  explicit GuiContext(const Window& window);
  ~GuiContext();
  GuiContext(const GuiContext&) = delete;
  GuiContext& operator=(const GuiContext&) = delete;
};

/// What the window shows, and what mouse and keys do in it.
class Gui {
 public:
  Gui(Window& window, Screen& screen, ViewSession& session);

  /// One frame: panels and pictures for this input; `seconds` since the last one.
  void frame(const WindowInput& input, double seconds);
  /// Something goes on that needs the next frame at once.
  bool moves() const { return moves_; }
  /// The window is to be closed, and nothing unsaved stands against it.
  bool closes() const { return closes_; }
  /// Asked for by the window's frame.
  void askToClose();

  /// The next frame, with panels, into a file.
  void captureWindow(const std::filesystem::path& path) { capture_ = path; }
  /// Whether that was done.
  bool captured() const { return capture_.empty(); }
  /// Its picture fills the whole window.
  void hidePanels() { panels_ = false; }

 private:
  void menu();
  void keys(const WindowInput& input);
  void moveCamera(double seconds);
  void drawPictures(const glm::vec2& at, const glm::vec2& size);
  void drawSurface(const glm::vec2& at, const glm::vec2& size);
  void statusBar(float height);
  void growDialog();
  void clipDialog();
  void closeDialog();
  void openDialog();
  void saveDialog();
  void updateTitle();

  Window* window_;
  Screen* screen_;
  ViewSession* session_;
  PanelState panel_state_;
  FileDialog files_;
  bool panels_ = true;
  bool moves_ = false;
  bool closes_ = false, asks_to_close_ = false;
  bool asks_to_grow_ = false, asks_for_clip_ = false;
  GrowOptions grow_;
  std::string clip_path_ = "clip.mp4";
  int clip_frames_ = 48, clip_fps_ = 24;
  bool drags_ = false;  ///< a mouse button went down over the picture
  std::filesystem::path capture_;
  std::string title_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_GUI_H_
