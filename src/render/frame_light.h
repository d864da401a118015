#ifndef VERDURE_RENDER_FRAME_LIGHT_H_
#define VERDURE_RENDER_FRAME_LIGHT_H_

#include "verdure/harmonics.h"
#include "verdure/render.h"

namespace verdure {

/// The daylight of one frame in the numbers that the passes need: kcd/m^2. Irradiance / pi is the
/// luminance of a white diffuse surface.
struct FrameLight {
  glm::vec3 to_sun{0.0f, 1.0f, 0.0f};
  glm::vec3 sun{0.0f};       ///< irradiance / pi of a surface that faces the sun
  glm::vec3 sun_disk{0.0f};  ///< luminance of the disk
  Harmonics sky;             ///< luminance of the sky
  glm::vec3 open_sky{0.0f};  ///< irradiance / pi of open ground by the sky
  Harmonics open_light;      ///< irradiance / pi by the open sky and the open ground
  float brightest = 0.0f;    ///< largest component of all that
};

/// `sky`: of the view's sky, three bands or more. With ground (of the view's terms) a sun below
/// the horizon is hidden, and light comes from below.
FrameLight makeFrameLight(const View& view, const Harmonics& sky, bool ground);

/// The harmonics of a light from above the horizon, for transfer vectors, which are blind below it
/// (the ground lies there): with the upper half mirrored to the lower one, so that the light does
/// not jump where the vectors do. A truncated product of two functions that jump at the same place
/// loses light; smoothing the jump (Habel 2009, (5.5)) loses more. Over smooth and sharp zonal
/// receivers under four skies the rms error of 5 bands, in shares of the open ground's light, is
/// 0.13 as it is, 0.19 with (5.5) and 0.017 mirrored; an even sky is exact.
Harmonics mirroredAtHorizon(const Harmonics& light);

/// The power of two that brings `brightest` to [2^14, 2^15): just below the largest half float,
/// so that the dark keeps as many digits as there can be. 1 for black.
float frameUnits(float brightest);

}  // namespace verdure

#endif  // VERDURE_RENDER_FRAME_LIGHT_H_
