#ifndef VERDURE_LEAF_TRANSLUCENCY_H_
#define VERDURE_LEAF_TRANSLUCENCY_H_

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "verdure/leaf.h"

/// Light through leaves: Habel, "Real-time Rendering and Animation of Vegetation", dissertation, TU
/// Wien 2009, 3.3.4 to 3.3.9.
namespace verdure {

enum class LeafBakeMethod {
  kGaussians,  ///< T(r, d) as a sum of separable Gaussians
  kDirect,     ///< the sum over all texels in reach of each, as (3.16) says: slow, to compare
};

struct LeafBakeOptions {
  LeafBakeMethod method = LeafBakeMethod::kGaussians;
  int directions = 128;    ///< N_L, at least 16
  std::uint64_t seed = 1;  ///< of the directions
  int pairs = 3;           ///< n of (3.5)
  /// rho_d of (3.4), in [0, 1); unset: what a rough surface of LeafOptics::refractive_index throws
  /// back inside on the mean, with which the multipole agrees with random walks (docs/leaves.md).
  std::optional<float> surface_reflection;
  /// Weights of the albedo's R, G, B at the wavelength for which LeafOptics holds; sum 1. Green
  /// stands for 510 nm; red leaves want (1, 0, 0).
  glm::vec3 wavelength{0, 1, 0};
};

/// What a bake did, of the side that is lit from the back (front) and of the other.
struct LeafBakeReport {
  double surface_reflection = 0;  ///< rho_d
  double least_thickness_mm = 0;  ///< as given
  double most_thickness_mm = 0;
  std::size_t texels = 0;             ///< of the leaf
  std::size_t clamped = 0;            ///< thinner than 1.2 mean free paths: taken for that
  double radius_mm = 0;               ///< of the kernel
  int terms = 0;                      ///< rank: Gaussians; 0 for the direct sum
  double residual = 0;                ///< of the fit of T: sum of |error| over sum of |T|
  std::array<double, 2> conserved{};  ///< light out over the closed form's
  double horizon_seconds = 0, projection_seconds = 0, fit_seconds = 0, convolution_seconds = 0;
};

/// Coefficients of the Half-Life 2 basis of L_D (3.16) for both sides, width * height each, rows
/// from the top: what shared/leaf_basis.h evaluates. Outside of the leaf its border's go on, so
/// that filtering shows no fringe.
struct LeafTranslucency {
  int width = 0, height = 0;
  std::vector<glm::vec3> front;  ///< lit from the back, seen from the front
  std::vector<glm::vec3> back;   ///< lit from the front
  LeafBakeReport report;
};

/// Throws Error for a bad set or options.
LeafTranslucency bakeLeafTranslucency(const LeafSet& set, const LeafBakeOptions& options = {});

/// L_D (3.16) of light from the unit direction `w` itself, which the coefficients stand for: for
/// each texel, 0 outside of the leaf. `w` is in the frame of the side that is lit, z >= 0.
std::vector<float> lightThroughLeaf(const LeafSet& set, bool back_lit, const glm::vec3& w,
                                    const LeafBakeOptions& options = {});

/// How far three coefficients are from the light that they stand for (figure 3.19), at one
/// elevation of the sun, over all texels of the leaf, both sides and four azimuths. Texels with
/// less than a hundredth of the mean light are left out: a share of next to nothing says nothing.
struct LeafErrors {
  double elevation = 0;  ///< above the leaf's plane, radians
  double mean = 0;       ///< of L_rec / L - 1
  double mean_absolute = 0;
  double rms = 0;
  double low = 0, high = 0;       ///< what 5 % of the texels are below, and above
  double dark = 0;                ///< share of the texels left out
  std::vector<double> histogram;  ///< shares of the others, kLeafErrorBins from -0.5 to 0.5
};
inline constexpr int kLeafErrorBins = 100;

/// The errors of `baked` at elevations of pi/2, pi/4 and pi/8; `options` those of the bake.
std::vector<LeafErrors> measureLeafErrors(const LeafSet& set, const LeafTranslucency& baked,
                                          const LeafBakeOptions& options = {});

/// Adds a bake to a leaf's folder: front_hl2.exr and back_hl2.exr (halves) and the same as PNG of 8
/// bits with the scale and offset in leaf.json. Throws Error.
void writeLeafTranslucency(const LeafTranslucency& baked, const std::filesystem::path& folder);

/// Reads the EXR files that writeLeafTranslucency wrote (no report). Throws Error; a folder without
/// a bake says so.
LeafTranslucency readLeafTranslucency(const std::filesystem::path& folder);

}  // namespace verdure

#endif  // VERDURE_LEAF_TRANSLUCENCY_H_
