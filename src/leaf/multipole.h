#ifndef VERDURE_LEAF_MULTIPOLE_H_
#define VERDURE_LEAF_MULTIPOLE_H_

#include "verdure/leaf.h"

namespace verdure {

/// Share of even light inside that a rough surface of that refractive index (at least 1) throws
/// back: Fresnel's reflectance, averaged over the hemisphere.
double insideReflection(double index);

/// Light through a slab: Donner and Jensen, "Light Diffusion in Multi-Layered Translucent
/// Materials", 2005, as (3.3) to (3.8) of Habel 2009 state it, with the misplaced parenthesis of
/// (3.8) put right. Lengths in mm.
class Multipole {
 public:
  /// `reflection`: rho_d of (3.4), in [0, 1). `pairs`: n of (3.5), pairs of dipoles to each side.
  Multipole(const LeafOptics& optics, double reflection, int pairs = 3);

  double meanFreePath() const { return mean_free_path_; }
  double reducedAlbedo() const { return albedo_; }
  double decay() const { return decay_; }  ///< sigma_tr, 1/mm
  /// Below this the model breaks down: the first pole comes to lie on the surface where light
  /// leaves, and its flux is no longer finite.
  double leastThickness() const { return 1.2 * mean_free_path_; }

  /// T(r, d), 1/mm^2: flux that leaves per area at distance r from where unit flux enters a slab of
  /// thickness d > 0. Below 0 at large r, where a finite number of poles leaves a remainder.
  double transmittance(double r, double d) const;
  /// Its integral over the plane beyond radius r: closed form. beyond(0, d) is all that gets
  /// through.
  double beyond(double r, double d) const;
  double total(double d) const { return beyond(0.0, d); }

 private:
  template <typename Term>
  double sumOverPoles(double d, const Term& term) const;

  double albedo_, decay_, mean_free_path_, extrapolation_;
  int pairs_;
};

}  // namespace verdure

#endif  // VERDURE_LEAF_MULTIPOLE_H_
