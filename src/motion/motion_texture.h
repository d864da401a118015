#ifndef VERDURE_MOTION_MOTION_TEXTURE_H_
#define VERDURE_MOTION_MOTION_TEXTURE_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/motion.h"

// Motion of branches and leaves by spectral synthesis: Habel, "Real-time Rendering and Animation of
// Vegetation", dissertation, TU Wien 2009, 4.5 and 4.7.2.

namespace verdure {

/// (4.15): power of the turbulent wind at `frequency_hz` >= 0 for a mean wind of `wind_speed`, m/s,
/// above 0; v_m at frequency 0 (the thesis's unit is arbitrary).
double windPower(double frequency_hz, double wind_speed);

/// (4.20): resonance of a branch `length` metres long, Hz: 2.55 L^-0.59, or 2.5 times that without
/// leaves. Throws Error unless the length is above 0.
double branchFrequency(double length, bool leafless = false);

/// A branch as a damped oscillator in turbulent wind, 4.5.1.
struct BranchOscillator {
  double frequency_hz = 1.0;  ///< f_h, its undamped resonance, see branchFrequency()
  /// gamma / (4 pi f_h). A little underdamped is right for most, 0.1 to 0.4; near 1, critical, for
  /// large branches with many leaves. The resonance is a peak below 0.7.
  double damping_ratio = 0.2;
  double wind_speed = 5.0;  ///< v_m of (4.15), m/s
};
/// (4.16): amplitude at `frequency_hz` for a mass of 1 kg,
/// sqrt(P_w) / sqrt((4 pi^2 (f_h^2 - f^2))^2 + (2 pi f gamma)^2), which has one unit throughout;
/// the thesis's print does not.
double branchResponse(const BranchOscillator& branch, double frequency_hz);

/// A field of Gaussian noise that repeats in both directions, of mean 0 and root mean square 1. Its
/// highest frequency has 8 texels a cycle in both directions, for bilinear filtering.
struct MotionTexture {
  int width = 0, height = 0;
  int channels = 0;           ///< independent of each other
  std::vector<float> values;  ///< rows first, channels together
  /// How often the frequency of the branch fits in the width: a branch that moves through
  /// f_h / cycles of the width a second has the resonance f_h. 0 for wind.
  double cycles = 0.0;
  double extent = 0.0;  ///< how wide a texture of wind is, m; 0 for branches

  /// Filtered as by a GPU with bilinear filtering and repetition.
  float sample(const glm::vec2& uv, int channel = 0) const;
};

enum class MotionLayout {
  /// The branch's spectrum along u, a smooth band along v. Trajectories along u with a small slope
  /// have that spectrum, see makeTrajectory().
  kSeparable,
  /// The thesis's: the branch's spectrum around the origin. A line through a field has the
  /// projection of its spectrum, not a slice, so resonances come out low and broad: for comparison.
  kRadial,
};

struct MotionTextureOptions {
  int width = 2048, height = 1024;  ///< multiples of 16 from 64 to 8192, best powers of two
  int channels = 2;                 ///< 1 to 4: a branch bends in two directions
  MotionLayout layout = MotionLayout::kSeparable;
  std::uint64_t seed = 1;  ///< one for each level, or levels move alike
};

/// The motion of all branches of a level, 4.5.3, from frequency 0 to 2 f_h. Deterministic, for any
/// number of threads. Throws Error if a number is out of its range: frequency and speed above 0,
/// damping ratio in [0.02, 4].
MotionTexture makeMotionTexture(const BranchOscillator& branch,
                                const MotionTextureOptions& options = {});

/// Turbulent wind for leaves, 4.7.2: square, the same in all directions, and (4.15) along any line
/// for wind that carries its eddies along (f / v_m cycles a metre), less what that is at the
/// smallest wavelength, m, so that it ends there without a step: take 4 times the longest leaf.
/// `extent` is size / 8 such waves.
MotionTexture makeWindTexture(double smallest_wavelength, int size = 512, int channels = 3,
                              std::uint64_t seed = 1);

/// A trajectory from `offset`, in textures, that goes through `speed` widths a second, in [0, 1),
/// and through `slope` heights in each, such that speed * slope is in [0, 1). Throws Error.
shared::MotionTrajectory makeTrajectory(const glm::dvec2& offset, double slope, double speed);

/// The trajectory of a branch whose resonance is `frequency_hz`. Its slope is 20 to 61 / height
/// (0.02 to 0.06 by default), such that after any number of widths up to height / 23 it is at a row
/// of its own, so that its motion does not repeat
/// within 0.0027 width * height / frequency_hz seconds. Throws Error unless the texture is one of
/// branches, and the branch crosses it slower than once a second.
shared::MotionTrajectory makeTrajectory(const MotionTexture& texture, double frequency_hz,
                                        std::uint64_t seed);

/// Any finite time, s, as motionUv() takes it; exact within 2^-25 s up to 2^27 s.
struct MotionTime {
  std::uint32_t whole;  ///< modulo 2^32
  float fraction;       ///< [0, 1]
};
MotionTime motionTime(double seconds);

}  // namespace verdure

#endif  // VERDURE_MOTION_MOTION_TEXTURE_H_
