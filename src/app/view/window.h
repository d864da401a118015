#ifndef VERDURE_APP_VIEW_WINDOW_H_
#define VERDURE_APP_VIEW_WINDOW_H_

#include <vulkan/vulkan_core.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

struct GLFWwindow;

namespace verdure::app {

/// What happened to a window since it was last asked.
struct WindowInput {
  struct Key {
    int key = 0;   ///< GLFW_KEY_*
    int held = 0;  ///< GLFW_MOD_* of keys that were held with it
  };
  std::vector<Key> keys;                       ///< pressed or repeated
  std::vector<std::filesystem::path> dropped;  ///< files
  bool any = false;                            ///< anything at all, also what only panels care for
};

/// A window of the display, by GLFW, for one thread. Dear ImGui's own callbacks may be chained
/// behind these.
class Window {
 public:
  /// Throws Error when there is no display or it has no Vulkan.
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  void setTitle(const std::string& title);
  /// In pixels; 0 x 0: minimised.
  glm::ivec2 size() const;
  /// How much larger than usual things are to be shown.
  float scale() const;
  bool shouldClose() const;
  void keepOpen();
  void hide();

  /// Waits for input, at most so many seconds (0: not at all), and returns it.
  WindowInput wait(double seconds);
  /// Ends wait() of the window's thread, from any thread.
  static void wake();

  /// For gpu::WindowSurface.
  static std::vector<std::string> vulkanExtensions();
  VkSurfaceKHR makeSurface(VkInstance instance) const;

 private:
  GLFWwindow* window_ = nullptr;
  WindowInput input_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_WINDOW_H_
