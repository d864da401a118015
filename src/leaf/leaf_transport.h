#ifndef VERDURE_LEAF_LEAF_TRANSPORT_H_
#define VERDURE_LEAF_LEAF_TRANSPORT_H_

#include <array>
#include <vector>

#include "leaf/gaussian_sum.h"
#include "leaf/horizon.h"
#include "leaf/leaf_kernels.h"
#include "leaf/texel_kernel.h"
#include "verdure/leaf_translucency.h"

namespace verdure {

/// One number for each texel, rows padded to a multiple of kPlaneLanes.
using Plane = std::vector<float>;

/// Stratified directions, uniform over the hemisphere z >= 0: Shirley and Chiu, "A Low Distortion
/// Map Between Disk and Square", 1997.
std::vector<glm::vec3> hemisphereDirections(int count, std::uint64_t seed);

/// What each direction adds to the three coefficients: (3.21) with the basis made orthonormal on
/// these very directions, so that what the basis can hold comes out exactly.
std::vector<glm::vec3> projectionWeights(const std::vector<glm::vec3>& directions);

/// A leaf as light sees it, at one wavelength.
class LeafTransport {
 public:
  LeafTransport(const LeafSet& set, const LeafBakeOptions& options);

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t stride() const { return stride_; }
  const Multipole& multipole() const { return multipole_; }
  const ThicknessGrid& grid() const { return grid_; }
  int radius() const { return radius_; }                 ///< of the kernel, texels
  float texel() const { return texel_; }                 ///< mm
  const Plane& thickness() const { return thickness_; }  ///< clamped; 0 outside
  const Plane& places() const { return places_; }        ///< in grid()
  const std::vector<std::uint8_t>& inside() const { return inside_; }
  LeafBakeReport& report() { return report_; }

  /// Sums of weights[m] E(x, directions[m]) (3.13) for light on the front (0) or back (1); unit
  /// directions in that side's frame, z >= 0.
  std::array<Plane, 3> enteringLight(int side, const std::vector<glm::vec3>& directions,
                                     const std::vector<glm::vec3>& weights);

  /// (3.16) of each plane: what leaves on the other side.
  std::vector<Plane> throughGaussians(const GaussianSum& sum,
                                      const std::vector<const Plane*>& planes) const;
  /// The same as the plain sum, of the rows [begin, end) only.
  Plane throughDirectly(const Plane& plane, int begin, int end) const;
  /// texelShare of the direct sum, made when it is first asked for.
  void makeDirectKernel();

 private:
  struct Side {
    Plane x, y, z, entering;
  };

  int width_, height_;
  std::size_t stride_;
  float texel_;
  std::vector<std::uint8_t> inside_;
  std::array<Side, 2> sides_;
  LeafBakeReport report_;
  Multipole multipole_;
  Plane thickness_, places_;
  ThicknessGrid grid_;
  int radius_ = 1;
  std::array<std::vector<float>, 2> relief_mm_;
  std::array<std::vector<Horizon>, 2> horizon_;  ///< one each, made when it is first asked for
  std::vector<float> direct_;  ///< by offset (dy (2 radius + 1) + dx) and thickness
};

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_TRANSPORT_H_
