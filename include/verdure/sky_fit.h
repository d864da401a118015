#ifndef VERDURE_SKY_FIT_H_
#define VERDURE_SKY_FIT_H_

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "verdure/harmonics.h"
#include "verdure/sky.h"

/// The harmonics of a family of skies as polynomials of its parameters: Habel, Mustata, Wimmer,
/// "Efficient Spherical Harmonics Lighting with the Preetham Skylight Model", Eurographics 2008.
/// Equation numbers are those of Habel 2009, chapter 5.
namespace verdure {

/// The sky whose sun stands at azimuth 0 and `sun_zenith` radians (0 to pi / 2) from the zenith.
/// Must be a mirror image of itself about the vertical plane through the sun, and black below the
/// horizon. Called from several threads.
using SkyModel = std::function<std::shared_ptr<const Sky>(float sun_zenith, float turbidity)>;

/// preethamDaylight()'s sky, but with the colours outside of the gamut that it clamps: blue, a
/// little below 0 near the horizon, below turbidity 3 while the sun sets. Clamping there makes a
/// kink that polynomials cannot follow; it changes the sum (5.3) by 0.3 % of L_min at most.
SkyModel preethamModel();

struct SkyFitOptions {
  int bands = kMaxBands;       ///< 1 to kMaxBands
  int sun_degree = 13;         ///< degree in the sun's angle from the zenith, 1 to 31
  int turbidity_degree = 7;    ///< 1 to 31
  float turbidity_min = 2.5f;  ///< the range of turbidity, both in [2, 10]
  float turbidity_max = 6.0f;
};

/// (5.1) with Chebyshev polynomials, because powers would lose half of a float's digits:
///   c_lm = sum over i, j of p_lm,ij T_i(x) T_j(y).
/// x and y map the ranges of the sun's angle and of the logarithm of turbidity (less the place of
/// Preetham's pole below 2) to [-1, 1]. The mirror symmetry leaves m >= 0.
class SkyFit {
 public:
  /// Fits projections of the model at twice as many sun's angles and turbidities as there are
  /// polynomials, on all threads. Throws Error for options out of range.
  explicit SkyFit(const SkyModel& model, const SkyFitOptions& options = {});

  const SkyFitOptions& options() const { return options_; }

  /// Weights of the sky's luminance (kcd/m^2) for a sun in a unit direction: the polynomials (5.1),
  /// turned about the zenith (5.2). A sun below the horizon lights as from the horizon, dimmed as
  /// preethamDaylight() does. Throws Error for a turbidity outside of the fitted range.
  Harmonics at(const glm::vec3& to_sun, float turbidity) const;

  /// at() with the sun at azimuth 0 and an angle from the zenith in [0, pi / 2].
  Harmonics atZenithAngle(float sun_zenith, float turbidity) const;

  /// The coefficients p: that of T_i(x) T_j(y) for the weight (l, m >= 0) and channel c stands at
  /// [(i * (turbidity_degree + 1) + j) * stride() + (l * (l + 1) / 2 + m) * 3 + c].
  std::span<const float> coefficients() const { return coefficients_; }
  std::size_t stride() const { return stride_; }  ///< 3 bands (bands + 1) / 2, made a multiple of 8

 private:
  SkyFitOptions options_;
  std::size_t stride_ = 0;
  double air_scale_ = 0.0, air_offset_ = 0.0;
  std::vector<float> coefficients_;
};

/// The fit as a C99 header without dependencies: its coefficients and a function that evaluates,
/// turns and filters (5.5) the weights.
std::string skyFitHeader(const SkyFit& fit);

/// Errors of a fit against plain projection, as parts of L_min, the smallest weight c_00 over the
/// range and the channels; the worst channel counts. Index N - 1: of the first N bands.
struct SkyFitErrors {
  double least_weight = 0.0;                ///< L_min, kcd/m^2
  std::array<double, kMaxBands> maximal{};  ///< highest upper bound (5.3) over the range
  std::array<double, kMaxBands> mean{};     ///< highest (5.4)
  float worst_sun_zenith = 0.0f;            ///< where (5.3) of all bands is highest
  float worst_turbidity = 0.0f;
};

/// Compares at the points of an even grid over the fit's range, its ends included.
SkyFitErrors measureSkyFit(const SkyFit& fit, const SkyModel& model, int sun_steps = 90,
                           int turbidity_steps = 28);

}  // namespace verdure

#endif  // VERDURE_SKY_FIT_H_
