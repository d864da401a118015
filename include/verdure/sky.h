#ifndef VERDURE_SKY_H_
#define VERDURE_SKY_H_

#include <glm/glm.hpp>
#include <memory>

/// The light of the sky and of the sun. Luminances are kcd/m^2, illuminances klx, both as linear
/// sRGB whose weighted sum (0.2126, 0.7152, 0.0722) is the photometric value. +Y is the zenith; the
/// azimuth runs from +Z (south) towards +X (east).
namespace verdure {

namespace shared {
struct SkyFormula;
}

/// What a sky looks like: luminance for a direction. Models are made by the functions below; others
/// may be derived and go through the same fit, renderer and reference.
class Sky {
 public:
  virtual ~Sky() = default;
  /// kcd/m^2, never negative or NaN, for a unit direction; black below the horizon (y < 0).
  virtual glm::vec3 luminance(const glm::vec3& direction) const = 0;
  /// The closed form that shaders evaluate, where the model has one; null else, and the renderer
  /// draws the dome from an image made of luminance().
  virtual const shared::SkyFormula* formula() const { return nullptr; }
  /// How finely it must be sampled from the zenith to the horizon to see all of it.
  virtual int rows() const { return 128; }
};

/// The sun as a disk of even luminance.
struct Sun {
  static constexpr float kAngularRadius = 0.004654793f;  ///< 16 arc minutes, radians

  glm::vec3 direction{0.0f, 1.0f, 0.0f};  ///< unit, towards the sun
  glm::vec3 luminance{0.0f};              ///< kcd/m^2 of the disk, after the air; black = no sun
  float angular_radius = kAngularRadius;

  /// klx on a surface that faces the sun: luminance times the disk's projected solid angle.
  glm::vec3 illuminance() const;
};

/// The light of a scene.
struct Daylight {
  std::shared_ptr<const Sky> sky;  ///< null = black
  Sun sun;
};

/// The sky of Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999,
/// and the sun through the same air. Turbidity 2 to 10; for lighting 2.5 (very clear) to 6 (haze):
/// below 2.5 the horizon is far too bright (Zotti et al. 2007). `to_sun` need not be unit. A sun
/// below the horizon leaves twilight that fades to night. Throws Error for a turbidity out of range
/// or a direction that is none.
Daylight preethamDaylight(float turbidity, const glm::vec3& to_sun);

/// The same luminance in every direction above the horizon. `below`: in those below it, for tests
/// (a white furnace) and light boxes.
std::shared_ptr<const Sky> uniformSky(const glm::vec3& luminance,
                                      const glm::vec3& below = glm::vec3(0.0f));

}  // namespace verdure

#endif  // VERDURE_SKY_H_
