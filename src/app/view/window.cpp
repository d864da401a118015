#include "app/view/window.h"

#include <GLFW/glfw3.h>

#include <utility>

#include "verdure/error.h"

namespace verdure::app {
namespace {

WindowInput& inputOf(GLFWwindow* window) {
  return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

/// What GLFW says of its last failure.
std::string reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? std::string(" (") + text + ")" : "";
}

constexpr const char* kInstead = "set DISPLAY, or draw pictures without a window: verdure render";

}  // namespace

Window::Window(const std::string& title, int width, int height) {
  if (glfwInit() != GLFW_TRUE) throw Error("view", "there is no display" + reason(), kInstead);
  if (glfwVulkanSupported() != GLFW_TRUE) {
    glfwTerminate();
    throw Error("view", "there is no Vulkan for windows",
                "install a driver (Debian: mesa-vulkan-drivers)");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string why = reason();
    glfwTerminate();
    throw Error("view", "no window opens" + why, kInstead);
  }
  glfwSetWindowUserPointer(window_, &input_);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int held) {
    inputOf(window).any = true;
    if (action != GLFW_RELEASE) inputOf(window).keys.push_back({key, held});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    inputOf(window).any = true;
    for (int i = 0; i < count; ++i) inputOf(window).dropped.emplace_back(paths[i]);
  });
  // All others end a wait, too; that they happened is all that is to be known.
  glfwSetCursorPosCallback(window_,
                           [](GLFWwindow* window, double, double) { inputOf(window).any = true; });
  glfwSetMouseButtonCallback(window_,
                             [](GLFWwindow* window, int, int, int) { inputOf(window).any = true; });
  glfwSetScrollCallback(window_,
                        [](GLFWwindow* window, double, double) { inputOf(window).any = true; });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { inputOf(window).any = true; });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int) { inputOf(window).any = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { inputOf(window).any = true; });
  glfwSetFramebufferSizeCallback(window_,
                                 [](GLFWwindow* window, int, int) { inputOf(window).any = true; });
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::setTitle(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

glm::ivec2 Window::size() const {
  glm::ivec2 size(0);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE) return size;
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

float Window::scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return x;
}

bool Window::shouldClose() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::keepOpen() {
  glfwSetWindowShouldClose(window_, GLFW_FALSE);
}

void Window::hide() {
  glfwHideWindow(window_);
  glfwPollEvents();
}

WindowInput Window::wait(double seconds) {
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  return std::exchange(input_, {});
}

void Window::wake() {
  glfwPostEmptyEvent();
}

std::vector<std::string> Window::vulkanExtensions() {
  std::uint32_t count = 0;
  const char** const names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr)
    throw Error("view", "there is no Vulkan for this display" + reason(), kInstead);
  return {names, names + count};
}

VkSurfaceKHR Window::makeSurface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface) != VK_SUCCESS)
    throw Error("view", "Vulkan cannot draw to the window" + reason(), kInstead);
  return surface;
}

}  // namespace verdure::app
