#ifndef VERDURE_SKY_PROJECTION_H_
#define VERDURE_SKY_PROJECTION_H_

#include <vector>

#include "sky/quadrature.h"
#include "verdure/harmonics.h"

namespace verdure {

using HarmonicSums = std::array<glm::dvec3, kMaxBands * kMaxBands>;

/// The quadrature of skies: rows from the zenith to the horizon, each of twice as many azimuths,
/// none of them 0 or pi. Each row is a Fourier sum over azimuths, then one over the bands.
class SkyProjection {
 public:
  SkyProjection(int bands, int rows);

  std::size_t rows() const { return nodes_.size(); }
  /// Adds the row above the horizon and its image below it.
  void addRow(const Sky& sky, std::size_t row, HarmonicSums& sums) const;
  /// All of a sky that is black below the horizon and its own mirror image about azimuth 0: half
  /// the azimuths are looked at, and weights of m < 0 are 0.
  HarmonicSums ofSymmetric(const Sky& sky) const;

 private:
  void addHalfRow(const Sky& sky, std::size_t row, double side, bool symmetric,
                  HarmonicSums& sums) const;

  int bands_;
  std::vector<QuadratureNode> nodes_;
  std::vector<double> cosines_, sines_;  ///< kMaxBands for each azimuth: of m times it
};

}  // namespace verdure

#endif  // VERDURE_SKY_PROJECTION_H_
