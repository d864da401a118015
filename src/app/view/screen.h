#ifndef VERDURE_APP_VIEW_SCREEN_H_
#define VERDURE_APP_VIEW_SCREEN_H_

#include <memory>
#include <string>

#include "verdure/render.h"

struct ImDrawData;

namespace verdure {
enum class Inspection;
struct PackedLight;
struct PackedScene;
}  // namespace verdure

namespace verdure::app {

class Window;

/// Scenes and bakes as Screen takes them, made on any thread. Throw Error.
std::shared_ptr<PackedScene> packedScene(const Scene& scene);
std::shared_ptr<PackedLight> packedLight(const Scene& scene);

/// The GPU's side of the viewer: a scene, pictures of it that stay on the GPU, and the window that
/// shows them and panels over them. Keeps Vulkan out of the other files.
class Screen {
 public:
  /// The current ImGui context's fonts are used; it and the window must outlive this. Throws Error
  /// when no device can draw to the window.
  Screen(const Window& window, const DeviceOptions& options);
  ~Screen();

  const std::string& deviceName() const;
  int validationMessages() const;

  /// Uploads. Until then pictures are of an empty scene.
  void setScene(const std::shared_ptr<PackedScene>& packed);  ///< which loses its contents
  /// Another bake of the scene's plants; false: it does not fit, and the scene must be set.
  bool setLight(const PackedLight& light);

  /// Two pictures can be shown side by side.
  static constexpr int kPictures = 2;
  /// Draws one; Frame::image is empty. `what`: one quantity instead of the light.
  Frame draw(int picture, const View& view, Inspection what);
  /// Or shows one that was made elsewhere.
  void setPicture(int picture, const Image& image);
  /// Of a picture, an ImTextureID; null: there is none yet.
  void* texture(int picture) const;
  /// Draws and reads back, for files.
  Frame read(const View& view, Inspection what);

  /// Shows panels, and pictures where they use them. False: nothing can be shown now. `capture`, if
  /// given, gets what the window shows; it stays empty where that cannot be read.
  bool present(const ImDrawData& panels, Image* capture = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_SCREEN_H_
