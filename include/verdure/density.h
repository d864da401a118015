#ifndef VERDURE_DENSITY_H_
#define VERDURE_DENSITY_H_

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verdure/field.h"
#include "verdure/placement.h"
#include "verdure/plant.h"

/// Illumination of foliage from a density field: Luft, Balzer, Deussen, "Expressive Illumination of
/// Foliage Based on Implicit Surfaces", Eurographics Workshop on Natural Phenomena 2007. Equation
/// numbers are that paper's.
namespace verdure {

enum class CrownNormals {
  kSurfaceVertex,  ///< the normal of the nearest vertex of the surface (the paper's)
  kSurfacePoint,   ///< the normal at the nearest point of the surface, from the gradient there
  kEllipsoid,      ///< the normal of the foliage's bounding ellipsoid (the paper's baseline)
  kKeep,           ///< leaf normals stay
  kOpticalDepth    ///< to where the crown is thinnest (verdure/optical_depth.h)
};

/// Parameters of the bake; what is not set is found from the plant.
struct DensityOptions {
  std::optional<float> rho;  ///< radius of influence, m, > 0
  std::optional<float> tau;  ///< threshold of the kernel sum, >= 0
  float fraction = 1.0f;     ///< share of the leaves used as generators, (0, 1]
  Norm norm;
  int grid = 128;              ///< cells along the longest side of the field's bounds
  std::optional<float> d_min;  ///< field value from which the ambient coefficient is k_min, > 0
  float k_min = 0.2f;          ///< least ambient coefficient, [0, 1]
  float exponent = 1.0f;       ///< n of (4), > 0
  CrownNormals normals = CrownNormals::kSurfacePoint;
  float blend = 1.0f;                                   ///< 0 = leaf normal, 1 = crown normal
  std::uint32_t seed = 1;                               ///< of the random fraction
  std::size_t max_memory_bytes = std::size_t{4} << 30;  ///< a grid that needs more is refused
  /// Called now and then with the step and its share done in [0, 1], from one thread.
  std::function<void(const char* step, double share)> progress;
};

/// How well a prediction agrees with what rays find.
struct Agreement {
  double rms = 0.0;
  double rank = 0.0;  ///< Spearman's correlation
};
Agreement agreementOf(std::span<const float> predicted, std::span<const float> traced);

/// What fitDensity() found.
struct DensityFit {
  std::size_t samples = 0;
  float full = 1.0f;        ///< the openness that counts as 1
  Agreement before, after;  ///< of the coefficient with openness / full, at most 1
  double seconds = 0.0;
};

/// Every number that a bake found or measured.
struct DensityReport {
  float rho = 0, tau = 0, d_min = 0, k_min = 0, exponent = 0;
  std::optional<DensityFit> fit;
  std::size_t leaves = 0;             ///< foliage primitives
  std::size_t generators = 0;         ///< those that were used
  std::size_t skipped_leaves = 0;     ///< zero area
  float field_max_at_generators = 0;  ///< largest kernel sum at a generator (without - tau)
  float field_min_at_vertices = 0, field_max_at_vertices = 0;  ///< F, i.e. with - tau
  glm::ivec3 grid_points{0};
  float voxel_m = 0;
  std::size_t grid_points_evaluated = 0;  ///< on it; the rest was proved to be off the surface
  std::size_t grid_bytes = 0;             ///< memory of all lattices
  std::size_t surface_vertices = 0, surface_triangles = 0, surface_components = 0;
  bool watertight = false;  ///< every edge has exactly two triangles, opposite in direction
  std::size_t degenerate_gradients = 0;  ///< surface vertices without a usable gradient
  std::size_t vertices = 0, foliage_vertices = 0;
  std::size_t vertices_open = 0, vertices_core = 0;  ///< k = 1, k = k_min
  double mean_ambient = 0;
  double seconds_generators = 0, seconds_surface = 0, seconds_ambient = 0, seconds_normals = 0,
         seconds_total = 0;
};

struct DensityBake {
  CrownLight light;
  Surface surface;
  DensityReport report;
};

/// Bakes one plant. `surface`, if given, replaces the extracted surface (its normals are used as
/// they are, or computed from faces if absent). Throws Error: no foliage, fewer than two leaves
/// with an area, tau above the largest kernel sum (says it), parameters out of range, a grid over
/// max_memory_bytes. The plant's leaves must have been found (findLeaves).
DensityBake bakeDensity(const Plant& plant, const DensityOptions& options = {},
                        const Surface* surface = nullptr);

/// Chooses rho, tau, d_min, k_min and the exponent so that the ambient coefficient comes as close
/// as it can (RMS) to openness traced at some hundred vertices, leaves and wood alike, relative to
/// that of the most open twentieth. Returns `options` with these set; those given there, or the
/// plant's own where they are not, are DensityFit::before. Throws as bakeDensity.
DensityOptions fitDensity(const Plant& plant, const DensityOptions& options,
                          DensityFit* fit = nullptr);

/// Bakes a group of plants in one common field, so that neighbours darken each other: one result
/// for each placement, in the plant's own frame (normals rotated back; the surface, the same for
/// all, in the population's frame and only in the first result). Such plants cannot be instanced
/// any more. `grid` counts along the longest side of the largest plant's field; parameters that
/// are not set are found from the placement with the most leaves, so that a plant which stands
/// alone is lit as by bakeDensity.
std::vector<DensityBake> bakeDensityPopulation(std::span<const Plant* const> plants,
                                               std::span<const Placement> placements,
                                               const DensityOptions& options = {});

}  // namespace verdure

#endif  // VERDURE_DENSITY_H_
