#ifndef VERDURE_OPTICAL_DEPTH_H_
#define VERDURE_OPTICAL_DEPTH_H_

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "verdure/density.h"
#include "verdure/plant.h"

/// The optical-depth field: how much surface stands around a point, seen from it.
///
///   X(q) = sum_i w_i,   w_i = G A_i / (4 pi r_i^2 + 2 A_i),   G = 1/2,   r_i = |c_i - q|
///
/// is the mean optical depth over all directions of surfels of area A_i turned every way: a surfel
/// covers the share G A_i / (4 pi r_i^2) of the sphere, on average, and at most G / 2. It has no
/// dimension and no parameter. Sums over all surfels by a tree code, as in Barill et al., "Fast
/// Winding Numbers for Soups and Clouds", SIGGRAPH 2018.
namespace verdure {

/// A small piece of surface, as far as the field knows it.
struct Surfel {
  glm::vec3 position{0.0f};  ///< its centroid
  float area = 0.0f;         ///< m^2, >= 0: opaque, one side of a sheet, half of a closed body
  float extent = 0.0f;       ///< no part of it is farther from its centroid, m
};

/// Sums of the field at a point. d_i is the unit direction to surfel i.
struct DepthSums {
  float depth = 0.0f;       ///< X
  glm::vec3 toward{0.0f};   ///< sum w_i d_i: points to where most surface is, |toward| <= depth
  float hemisphere = 0.0f;  ///< sum 4 max(n . d_i, 0) w_i: X of the normal's hemisphere, weighted
                            ///< by the cosine as the light on a surface is
};

struct DepthFieldOptions {
  /// Nearby surface blocks more than its share of directions tells, since far surfaces hide behind
  /// others: each term is multiplied by 1 + near_gain R^2 / (R^2 + r_i^2), R = near_radius, m.
  float near_gain = 0.0f;    ///< >= 0; 0: the plain X
  float near_radius = 1.0f;  ///< > 0
  /// Nodes of the tree count as one where their radius is below this share of the distance; 0: the
  /// direct sum. The default keeps X within 1 % of it (99.9 % of points).
  float opening = 0.5f;
};

/// Sums are in float (32 bits) in one fixed order: the same for any number of threads.
class OpticalDepthField {
 public:
  /// Throws Error: a surfel that is not finite or negative, options out of range.
  explicit OpticalDepthField(std::span<const Surfel> surfels,
                             const DepthFieldOptions& options = {});
  ~OpticalDepthField();
  OpticalDepthField(OpticalDepthField&&) noexcept;
  OpticalDepthField& operator=(OpticalDepthField&&) noexcept;

  std::size_t surfelCount() const;  ///< those with an area
  const DepthFieldOptions& options() const;

  /// sums[i] = the field at points[i], with the hemisphere of normals[i] (unit; may be empty, then
  /// `hemisphere` is 0). Returns how many terms were evaluated for a point, on average.
  double sumAt(std::span<const glm::vec3> points, std::span<const glm::vec3> normals,
               std::span<DepthSums> sums) const;
  /// The terms of single surfels, to be taken off a sum: those that a point touches do not block
  /// it.
  DepthSums termsOf(std::span<const Surfel> surfels, const glm::vec3& point,
                    const glm::vec3& normal) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// One surfel for each triangle of each mesh, in order. Triangles of wood count half (the far side
/// of a closed tube is hidden behind the near one); those that are cut by alpha with the share that
/// the cut leaves of them. Throws Error for positions that are not finite or indices out of range.
std::vector<Surfel> plantSurfels(const Plant& plant);

/// How openness (the share of all directions that is free) follows from the depth: of an optical
/// depth X + 3 toward . d in direction d, at least 0, the mean over all directions of exp(-k ...),
/// then a + b times it, in [0, 1].
struct DepthModel {
  float a = 0.0f;
  float b = 1.0f;
  float k = 1.0f;
};

/// Found once, over all plants of docs/openness.md.
inline constexpr float kNearGain = 2.0f;
inline constexpr DepthModel kLeafDepth{0.04f, 1.095f, 0.80f};
inline constexpr DepthModel kWoodDepth{0.055f, 0.83f, 0.86f};
/// Of wood's hemisphere: light = a + b exp(-k hemisphere).
inline constexpr DepthModel kWoodLight{0.06f, 0.89f, 0.66f};
/// Of leaves with crown normals, for outwardLightOf().
inline constexpr DepthModel kCrownLight{0.0f, 0.954f, 0.66f};

float opennessOf(const DepthSums& sums, const DepthModel& model);
/// The same for the light of an even sky on a surface that faces away from `toward`, where the
/// plant is thinnest (cosine-weighted mean over that hemisphere).
float outwardLightOf(const DepthSums& sums, const DepthModel& model);

/// Of wood: the light of an even sky on its normal's hemisphere.
float hemisphereLightOf(const DepthSums& sums, const DepthModel& model);

/// The models of a plant's leaves and wood. The defaults were fitted to rays over the eight grown
/// species and ten foreign plants (docs/openness.md).
struct DepthModels {
  DepthModel leaf = kLeafDepth;  ///< openness
  DepthModel wood = kWoodDepth;
  DepthModel crown_light = kCrownLight;  ///< of leaves with crown normals
  DepthModel wood_light = kWoodLight;
  DepthModel of(PartKind kind) const { return kind == PartKind::kFoliage ? leaf : wood; }
};

/// Options of a plant's field: near_radius is the side of a square of a leaf's mean opaque area (of
/// a surfel's, without leaves).
DepthFieldOptions plantDepthOptions(const Plant& plant, std::span<const Surfel> surfels);

/// The field at every vertex of every mesh, one after another, with the vertices' own normals.
/// Triangles that meet at a vertex (by position) are left out: it sees them edge-on. `surfels` are
/// plantSurfels(). `terms`, if given: terms evaluated for a vertex, on average.
std::vector<DepthSums> vertexDepths(const Plant& plant, std::span<const Surfel> surfels,
                                    const OpticalDepthField& field, double* terms = nullptr);

/// What a plant's fit found.
struct DepthFit {
  DepthModels models;
  std::size_t samples = 0;  ///< traced vertices; those that see nothing at all are left out
  Agreement before, after;  ///< of openness at the samples: defaults, fitted models
  /// The same of the light on leaves with crown normals and on wood.
  Agreement light_before, light_after;
};

struct DepthOptions {
  CrownNormals normals = CrownNormals::kOpticalDepth;  ///< or kKeep
  float blend = 1.0f;                                  ///< 0 = leaf normal, 1 = crown normal
  /// Fits the models to rays traced from some hundred of the plant's vertices; else the defaults.
  bool fit = true;
  std::uint32_t seed = 1;                               ///< of the choice of these
  std::size_t max_memory_bytes = std::size_t{4} << 30;  ///< of the rays' scene
  std::function<void(const char* step, double share)> progress;
};

/// Every number that the bake found or measured.
struct DepthReport {
  DepthModels models;
  float near_gain = 0, near_radius = 0;
  std::optional<DepthFit> fit;
  std::size_t surfels = 0;             ///< those with an area
  double area_m2 = 0;                  ///< theirs, as it counts
  double terms_per_vertex = 0;         ///< evaluated, of `surfels`
  float depth_min = 0, depth_max = 0;  ///< X at vertices
  double mean_openness = 0;
  double mean_ambient = 0;
  std::size_t vertices = 0, foliage_vertices = 0;
  double seconds_surfels = 0, seconds_field = 0, seconds_fit = 0, seconds_light = 0,
         seconds_total = 0;
};

struct DepthBake {
  CrownLight light;
  DepthReport report;
};

/// Bakes one plant. Leaf normals turn to where the crown is thinnest, against DepthSums::toward.
/// The ambient coefficient is the share of an even sky's light that reaches the vertex: for leaves
/// that take crown normals outwardLightOf(); for leaves that keep their own, whose back is lit as
/// well, opennessOf(); for wood the light on the hemisphere of its normal, exp of the hemisphere's
/// depth. Throws Error: no triangles, no foliage or none with an area, positions that are not
/// finite, options out of range.
DepthBake bakeOpticalDepth(const Plant& plant, const DepthOptions& options = {});

}  // namespace verdure

#endif  // VERDURE_OPTICAL_DEPTH_H_
