#ifndef VERDURE_RENDER_H_
#define VERDURE_RENDER_H_

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verdure/image.h"
#include "verdure/scene.h"

/// Headless pictures of plants on Vulkan 1.3.
namespace verdure {

enum class NormalSource {
  kLeaf,   ///< the mesh's own normals, flipped for back-facing leaves
  kCrown,  ///< the baked normals; never flipped: they mean "towards the light outside the crown"
};

enum class AmbientSource {
  kConstant,  ///< k_a = 1
  kBaked,     ///< the baked coefficient
};

/// The terms of illumination model (1) of Luft et al. 2007, each with its switch.
struct Terms {
  NormalSource normal = NormalSource::kCrown;
  AmbientSource ambient_source = AmbientSource::kBaked;
  bool ambient = true;
  bool diffuse = true;   ///< k_d (N.L)
  bool specular = true;  ///< k_s (V.R)^n
  bool shadow = true;    ///< S_i from the shadow map
  bool textures = true;  ///< else a uniform matt colour of the material
};

/// Published combinations: "standard" (leaf normals, constant ambient) and "expressive" (Luft).
/// Throws Error for an unknown name.
Terms presetTerms(const std::string& name);
const std::vector<std::string>& presetNames();

/// One picture. Colours of lights are linear and not bound to 1; what exceeds 1 in the picture is
/// cut. The defaults are a clear summer day.
struct View {
  int width = 960;
  int height = 720;
  Camera camera;
  float sun_azimuth = 0.9f;     ///< radians from +Z (south) towards +X (east)
  float sun_elevation = 0.75f;  ///< radians above the horizon
  Terms terms;
  glm::vec3 sun_color{1.75f, 1.62f, 1.40f};
  glm::vec3 ambient_color{0.50f, 0.56f, 0.62f};
  int shadow_map_size = 2048;
  std::optional<glm::vec3> background;  ///< linear RGB instead of the gradient sky
};

struct FrameTimes {
  double pack_ms = 0;    ///< packing and upload, CPU
  double shadow_ms = 0;  ///< GPU
  double color_ms = 0;   ///< GPU
};

struct Frame {
  Image image;  ///< sRGB, opaque
  FrameTimes times;
};

struct DeviceOptions {
  std::string device;       ///< part of the device's name; empty = the first discrete GPU, else any
  bool validation = false;  ///< validation layer with synchronisation checks
};

/// A Vulkan device and what draws on it. A scene stays packed on the GPU until another is given.
class Renderer {
 public:
  /// Throws Error when there is no Vulkan 1.3 device (says what to install).
  explicit Renderer(const DeviceOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const std::string& deviceName() const;
  /// Packs and uploads; the scene's plants may go afterwards.
  void setScene(const Scene& scene);
  /// Draws the scene that was set. Throws Error for a size of zero or beyond the device's limit.
  Frame render(const View& view);
  /// Messages of the validation layer so far (0 when it is off).
  int validationMessages() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace verdure

#endif  // VERDURE_RENDER_H_
