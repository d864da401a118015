#ifndef VERDURE_FIELD_H_
#define VERDURE_FIELD_H_

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

/// The metaball density field and its level set: Luft, Balzer, Deussen, "Expressive Illumination of
/// Foliage Based on Implicit Surfaces", Eurographics Workshop on Natural Phenomena 2007, section
/// 2.3. Equation numbers are that paper's.
namespace verdure {

/// Which norm measures the distance to a generator in (2).
struct Norm {
  enum class Kind { kL1, kL2, kLp, kLinf };
  Kind kind = Kind::kL2;
  float p = 2.0f;  ///< exponent of kLp, >= 1
};

struct Generator {
  glm::vec3 position{0.0f};
  float radius = 1.0f;  ///< of influence, m, > 0
};

/// Numbers of one field, for reports.
struct SurfaceStatistics {
  glm::ivec3 grid_points{0};                ///< of the full lattice
  std::size_t grid_points_evaluated = 0;    ///< on it (fine lattice)
  std::size_t coarse_points_evaluated = 0;  ///< on the lattice that finds where it may cross
  int coarse_step = 1;                      ///< its spacing in fine cells; 1 = it was not needed
  std::size_t degenerate_gradients = 0;     ///< vertices whose normal had to be taken elsewhere
  std::size_t bytes = 0;                    ///< held by lattices while it ran, at most
};

/// A triangle mesh of the surface where the kernel sum equals a threshold.
struct Surface {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;      ///< outward: against the gradient, unit
  std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise from outside
};

/// A regular lattice: point (i, j, k) lies at origin + spacing * (i, j, k).
struct Lattice {
  glm::vec3 origin{0.0f};
  float spacing = 1.0f;
  glm::ivec3 points{0};
};

/// The sum of (2) over generators, without the threshold: F(q) = sum(q) - tau of (3).
/// All sums run over the generators in one fixed order, so that results are the same to the bit for
/// any number of threads; float arithmetic, within 1e-4 of a sum in double precision.
class DensityField {
 public:
  struct State;  ///< defined in the bake room

  /// `weight` multiplies every term (1/p when a fraction p of the leaves are generators).
  /// Throws Error when a generator is not finite or a radius is not positive.
  explicit DensityField(std::span<const Generator> generators, const Norm& norm = {},
                        float weight = 1.0f);
  ~DensityField();
  DensityField(DensityField&&) noexcept;
  DensityField& operator=(DensityField&&) noexcept;

  std::size_t generatorCount() const;
  float maxRadius() const;

  /// sums[i] = the kernel sum at points[i].
  void sumAt(std::span<const glm::vec3> points, std::span<float> sums) const;
  /// Also its gradient (1/m).
  void gradientAt(std::span<const glm::vec3> points, std::span<float> sums,
                  std::span<glm::vec3> gradients) const;

  /// The lattice of `cells` cells along the longest side of the generators' bounds (or of
  /// `cell_extent`, if positive) that encloses all influence with a margin. Throws Error if
  /// cells < 1.
  Lattice lattice(int cells, float cell_extent = 0.0f) const;

  /// The kernel sum on the whole lattice, x fastest.
  std::vector<float> sumOn(const Lattice& lattice) const;

  /// Marching cubes (Lorensen, Cline 1987; ambiguous faces always separate the inside, so that
  /// neighbouring cells agree) of sum = tau. Evaluates the field only near the surface: a coarse
  /// lattice with a rigorous bound of the second derivatives rules out the rest, so the result is
  /// that of the full lattice. Closed, 2-manifold, vertices welded, ordered independently of
  /// threads. Empty where tau is above the maximum on the lattice. Throws Error if the lattice
  /// would take more than `max_bytes`.
  Surface surface(const Lattice& lattice, float tau, std::size_t max_bytes = std::size_t{4} << 30,
                  SurfaceStatistics* statistics = nullptr) const;

 private:
  std::unique_ptr<State> state_;
};

/// A generator of the plane.
struct Generator2 {
  glm::vec2 position{0.0f};
  float radius = 1.0f;
};

/// A polyline of the 2-D field's level set; closed ones repeat their first point at the end.
using Polyline = std::vector<glm::vec2>;

/// Kernel sum of the plane at one point.
float sumAt(std::span<const Generator2> generators, glm::vec2 point);

/// Marching squares of sum = tau on a regular grid of `cells` along the longer side of the
/// generators' influence, the inside on the left. Throws Error for bad generators or cells < 1.
std::vector<Polyline> isolines(std::span<const Generator2> generators, float tau, int cells);

}  // namespace verdure

#endif  // VERDURE_FIELD_H_
