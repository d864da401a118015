#ifndef VERDURE_APP_VIEW_GUI_H_
#define VERDURE_APP_VIEW_GUI_H_

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

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
  /// Panels see a key at the start of a frame only; a slow one would miss those that were pressed
  /// and let go since the last.
  void feedKeys(const WindowInput& input);
  void moveCamera(double seconds);
  void drawPictures(const glm::vec2& at, const glm::vec2& size);
  void drawSurface(const glm::vec2& at, const glm::vec2& size);
  void statusBar(float height);
  void growDialog();
  void clipDialog();
  void openDialog();
  void saveQuestion();
  /// Does what the scene does not survive: at once if all of it is in a file, else when the user
  /// has answered whether it is to be saved. Of several the newest.
  void leaveScene(std::function<void()> then);
  /// A plant, a scene, or a panorama as the sky.
  void openFile(const std::filesystem::path& path);
  // `then`: once it is saved; may be empty.
  void save(const std::function<void()>& then = {});
  void saveDialog(const std::function<void()>& then = {});
  void saveThen(const std::filesystem::path& path, const std::function<void()>& then);
  void updateTitle();

  Window* window_;
  Screen* screen_;
  ViewSession* session_;
  PanelState panel_state_;
  FileDialog files_;
  bool panels_ = true;
  bool moves_ = false;
  bool closes_ = false;
  std::function<void()> leave_;  ///< what waits for the answer
  bool asks_to_close_ = false;   ///< it is to close
  bool asks_to_grow_ = false, asks_for_clip_ = false;
  GrowOptions grow_;
  std::string clip_path_ = "clip.mp4";
  int clip_frames_ = 48, clip_fps_ = 24;
  std::vector<int> brief_keys_;  ///< let go already when they were fed
  std::set<int> commands_;       ///< keys that went down with Ctrl, which may be let go before them
  bool drags_ = false;           ///< a mouse button went down over the picture
  std::filesystem::path capture_;
  std::string title_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_GUI_H_
