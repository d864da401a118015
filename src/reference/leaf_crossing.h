#ifndef VERDURE_REFERENCE_LEAF_CROSSING_H_
#define VERDURE_REFERENCE_LEAF_CROSSING_H_

#include <array>
#include <optional>
#include <vector>

#include "base/random.h"
#include "leaf/multipole.h"
#include "rays/ray_scene.h"
#include "verdure/leaf_translucency.h"

namespace verdure {

/// Light through one leaf by Monte Carlo: where it leaves a point, where it entered the other side,
/// and in which share, by the multipole's T(r, d) of Habel 2009 (3.8). It knows no baked
/// coefficients, no horizons, and no convolution.
class LeafCrossing {
 public:
  /// `relief`: the set's leafReliefPlant(). Both must outlive it. Of `options`, those of the
  /// multipole count, and the wavelength. Throws Error for a bad set or options.
  LeafCrossing(const LeafSet& set, const Plant& relief, const LeafBakeOptions& options);

  struct Entry {
    RayHit hit;               ///< of the other side
    glm::vec3 outside{0.0f};  ///< unit: the sheet's normal there
    /// rho_t(x_o) T(|x_o - x_i|, d(x_i)) (1 - albedo(x_i)) over the density of x_i on the sheet.
    glm::vec3 weight{0.0f};
  };
  /// None where nothing is on the other side. `exit`: a hit of the relief plant.
  std::optional<Entry> sample(const RayHit& exit, Random& random) const;

 private:
  /// A point of the maps: texels, (0, 0) the first one's middle, and the four around it.
  struct Place {
    std::size_t first = 0;
    float s = 0.0f, t = 0.0f;
  };
  Place placeOf(float x, float y) const;
  template <class Value>
  Value at(const std::vector<Value>& map, const Place& place) const;
  /// Rings of equal shares of T for one thickness: squared radii from 0 on, mm^2.
  const std::vector<double>& ringsOf(float thickness_mm) const;
  double density(double r, const std::vector<double>& rings) const;

  const LeafSet& set_;
  const Plant& relief_;
  Multipole multipole_;
  std::vector<float> thickness_mm_;             ///< clamped as the bake does
  std::array<std::vector<float>, 2> entering_;  ///< 1 - albedo of the front and the back
  std::vector<double> poles_;  ///< heights of poles over the surface where light leaves, mm
  std::vector<std::vector<double>> rings_;  ///< for thicknesses, as poles_ are spaced but finer
};

}  // namespace verdure

#endif  // VERDURE_REFERENCE_LEAF_CROSSING_H_
