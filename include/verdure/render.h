#ifndef VERDURE_RENDER_H_
#define VERDURE_RENDER_H_

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "verdure/image.h"
#include "verdure/scene.h"
#include "verdure/sky.h"

/// Headless pictures of plants on Vulkan 1.3.
namespace verdure {

enum class NormalSource {
  kLeaf,   ///< the mesh's own normals, flipped for back-facing leaves
  kCrown,  ///< the baked normals; never flipped: they mean "towards the light outside the crown"
};

/// Where the light on a surface comes from that is not the sun's own.
enum class AmbientSource {
  kConstant,  ///< everywhere that of open ground under this sky: k_a = 1
  kSky,       ///< of the sky and the open ground that the normal faces
  kBaked,     ///< kSky times the baked coefficient
  kTransfer,  ///< the transfer vectors' for this sky and sun; kBaked where an item has none
  /// kSky times how much of the leaf's face is seen from around (MeshLight::visibility): (3) of
  /// Gumbau et al. 2008; kBaked where a mesh has none
  kLeafVisibility,
};

/// How much of the sun reaches a surface behind others. The last three know wood by its nearest
/// surface and leaves by their layers (light depth maps: Gumbau, Chover, Rebollo, Remolar,
/// "Real-Time Illumination of Foliage Using Depth Maps", ICCS 2008): the ground and wood see
/// alpha^C of the leaves in front of them, alpha what a leaf lets through, tinted as it is, and the
/// ground's half-shadow is as wide as the sun's disk and the distance make it.
enum class ShadowSource {
  kShadowMap,    ///< all or nothing, by the nearest surface
  kDepthPaper,   ///< leaves by the paper's (4)
  kDepthLayers,  ///< leaves see the share of the layers in front of them, spread evenly
  /// ... of which the first and the last are where they are. Below the crown arrives the share of
  /// the light through leaves that a tree alone casts there (shared::shareBelowCrown()). Where
  /// transfer vectors, which know all light through leaves, light a surface, the sun alone passes.
  kDepthOrdered,
};

/// What leaves do with light.
enum class LeafModel {
  kColor,  ///< what their colour lets guess (shared/leaf.h): for all leaves without LeafTextures
  /// By their maps, but light that gets through leaves evenly: (3.24) of Habel 2009, to compare
  kDiffuse,
  kMaps,  ///< by their maps: light through them as it falls on the other side's relief, (3.23)
};

/// The terms of illumination model (1) of Luft et al. 2007, each with its switch, and light through
/// leaves.
struct Terms {
  NormalSource normal = NormalSource::kCrown;
  AmbientSource ambient_source = AmbientSource::kBaked;
  bool ambient = true;
  bool diffuse = true;   ///< k_d (N.L)
  bool specular = true;  ///< k_s (V.R)^n
  bool shadow = true;    ///< S_i
  ShadowSource shadow_source = ShadowSource::kShadowMap;
  bool textures = true;       ///< else a uniform matt colour of the material
  bool transmission = false;  ///< leaves show the light on their far side (shared/leaf.h)
  /// Leaves scatter light within them, by their thickness: (6) of Gumbau et al. 2008.
  bool scattering = false;
  /// Leaves and wood mirror the sky dimly; what they mirror is missing below (shared/gloss.h).
  bool gloss = false;
  LeafModel leaf = LeafModel::kColor;
};

/// Published combinations: "standard" (leaf normals, constant ambient), "expressive" (Luft: crown
/// normals, baked ambient), "transfer" (Habel: leaf normals, transfer vectors, transmission; and
/// gloss) and "depth-maps" (Gumbau: leaf normals, leaf visibility, transmission, scattering, light
/// depth maps). "best" is what comes closest to the path tracer (docs/fidelity.md): transfer with
/// kDepthOrdered.
/// Throws Error for an unknown name.
Terms presetTerms(const std::string& name);
const std::vector<std::string>& presetNames();

/// From luminance to display: Reinhard et al., "Photographic Tone Reproduction for Digital Images",
/// SIGGRAPH 2002.
struct Exposure {
  /// Exposure value at ISO 100 (15 = full sun): of the luminance 0.125 cd/m^2 2^ev that takes the
  /// place of the picture's log-average. Unset: that average, measured.
  std::optional<float> ev;
  float key = 0.3f;  ///< a: to which the average is scaled, > 0; 0.09 is a dark, 0.36 a light key
  /// Smallest scaled luminance that becomes pure white, > 0. Unset: found from the picture
  /// (shared::automaticWhite()), 2 for most, up to 10 towards a low sun.
  std::optional<float> white;
};

/// How a picture is drawn. The drawn styles take the sky and the ground from the photo and draw the
/// plants on them; Frame::hdr is empty.
enum class Style {
  kPhoto,       ///< light as it is
  kNormals,     ///< what StyleNormals says as colours (Luft et al. 2007, Figure 7, top row)
  kEdges,       ///< lines where depths and normals jump (Saito and Takahashi 1990)
  kToon,        ///< few even tones, with lines
  kWatercolor,  ///< layers of pigment on paper (Luft and Deussen 2006)
};

/// What the drawn styles take for a surface's normal (Luft et al. 2007, Figure 7).
enum class StyleNormals {
  kRaw,        ///< the leaf's own
  kRealigned,  ///< the crown's
  kScaled,     ///< the crown's, as long as the ambient coefficient
};

/// One picture. The defaults are a clear summer day.
struct View {
  int width = 960;
  int height = 720;
  Camera camera;
  Daylight daylight = preethamDaylight(3.0f, directionOf(0.9f, 0.75f));
  int sky_bands = 5;  ///< of spherical harmonics that light the scene, 2 to 7
  Terms terms;
  /// n of AmbientSource::kLeafVisibility, > 0: above 1 leaves darken rapidly inwards, below slowly.
  float visibility_exponent = 1.0f;
  Exposure exposure;
  float bloom = 0.01f;         ///< share of the light that lens and eye spread, [0, 1]
  int shadow_map_size = 2048;  ///< side of each of the sun's maps, pixels, at least 16
  /// Most of the sun's maps: one of the whole scene, the others finer and finer around the eye,
  /// where they are finer than it. 1 to 4; 0 = as many as it takes to keep their texels under two
  /// pixels of the picture, which may change while the camera moves.
  int shadow_cascades = 0;
  /// Linear display RGB in [0, 1] instead of the sky and the sun's disk; not exposed.
  std::optional<glm::vec3> background;
  bool hdr = false;      ///< Frame::hdr is wanted, too
  Wind wind;             ///< over items that have a motion
  double seconds = 0.0;  ///< any finite time: pictures depend on it alone, not on earlier ones
  /// The frame before, at its own wind: Frame::motion is wanted, too.
  struct Moment {
    Camera camera;
    Wind wind;
    double seconds = 0.0;
  };
  std::optional<Moment> last = {};
  Style style = Style::kPhoto;
  StyleNormals style_normals = StyleNormals::kScaled;
};

struct FrameTimes {
  double motion_ms = 0;  ///< GPU; branches and leaves in wind
  double pack_ms = 0;    ///< packing and upload, CPU
  double shadow_ms = 0;  ///< GPU; with the light from transfer vectors, when it changed
  double color_ms = 0;   ///< GPU
  double tone_ms = 0;    ///< GPU; exposure, bloom, tone curve; drawn styles
};

struct Frame {
  Image image;  ///< sRGB, opaque, tone-mapped
  /// kcd/m^2, unexposed and without bloom: the plain average over each pixel. Halves (11 bits) of a
  /// range that the daylight sets. Background is black. Empty unless View::hdr.
  HdrImage hdr;
  /// How far what is seen at each pixel's centre has come since View::last, in pixels, x right and
  /// y down, rows first: for temporal filters. The ground and the sky stand still. Empty without
  /// it.
  std::vector<glm::vec2> motion;
  float average_luminance =
      0.0f;                 ///< kcd/m^2: log-average of the picture, or what the EV stands for
  float white = 0.0f;       ///< white point of the picture, in scaled luminance
  int shadow_cascades = 1;  ///< maps of the sun that were drawn
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
