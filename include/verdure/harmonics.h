#ifndef VERDURE_HARMONICS_H_
#define VERDURE_HARMONICS_H_

#include <array>
#include <glm/glm.hpp>

#include "verdure/sky.h"

/// Light from all directions as weights of real spherical harmonics. src/shared/sh.h states their
/// convention: orthonormal, index l * l + l + m, z axis at the zenith (+Y), azimuth from +Z towards
/// +X. Equation numbers are those of Habel, "Real-Time Rendering and Animation of Vegetation",
/// 2009, chapter 5.
namespace verdure {

inline constexpr int kMaxBands = 7;

/// A coloured function on the sphere; weights from bands^2 on are 0.
struct Harmonics {
  int bands = 0;  ///< 1 to kMaxBands
  std::array<glm::vec3, kMaxBands * kMaxBands> weights{};

  int count() const { return bands * bands; }
};

/// The values of the harmonics of `bands` bands (1 to kMaxBands) in a unit direction (+Y up):
/// values[0 .. bands * bands).
void harmonicsAt(const glm::vec3& direction, int bands, float* values);

/// The function's value in a unit direction.
glm::vec3 valueAt(const Harmonics& function, const glm::vec3& direction);

/// Weights of a sky's luminance, kcd/m^2: Gauss-Legendre quadrature over the cosine of the angle
/// from the zenith, apart above and below the horizon, times a uniform rule over azimuths; as fine
/// as Sky::rows() asks. Throws Error unless 1 <= bands <= kMaxBands.
Harmonics projectSky(const Sky& sky, int bands);

/// Weights of a disk of light around a unit direction (the sun): closed form.
Harmonics diskHarmonics(const glm::vec3& direction, float angular_radius,
                        const glm::vec3& luminance, int bands);

/// Weights of a constant light from below the horizon (the ground): closed form.
Harmonics groundHarmonics(const glm::vec3& luminance, int bands);

/// (5.2): the function turned about the zenith, from azimuth 0 to `azimuth` (radians); exact.
Harmonics turned(const Harmonics& function, float azimuth);

/// (5.5): zonal weights times sinc(pi l / bands): suppresses the ringing that the jump at the
/// horizon causes.
Harmonics withoutRinging(const Harmonics& function);

/// Weights of the irradiance that a surface facing a direction gets, from those of luminance
/// (klx from kcd/m^2): Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance
/// Environment Maps", SIGGRAPH 2001. Three bands are within 1 % for most lights.
Harmonics irradianceHarmonics(const Harmonics& luminance);

/// Irradiance of level ground, klx: exact for light from above the horizon, where the surface's
/// cosine is a harmonic of band 1. 0 below two bands.
glm::vec3 levelIlluminance(const Harmonics& luminance);

}  // namespace verdure

#endif  // VERDURE_HARMONICS_H_
