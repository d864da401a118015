#include "sky/projection.h"

#include "shared/sh.h"
#include "sky/harmonic_basis.h"

namespace verdure {

SkyProjection::SkyProjection(int bands, int rows) : bands_(bands), nodes_(gaussLegendre(rows)) {
  const int columns = 2 * rows;
  for (int column = 0; column < columns; ++column)
    for (int m = 0; m < kMaxBands; ++m) {
      const double angle = m * 2.0 * glm::pi<double>() * (column + 0.5) / columns;
      cosines_.push_back(std::cos(angle));
      sines_.push_back(std::sin(angle));
    }
}

void SkyProjection::addHalfRow(const Sky& sky, std::size_t row, double side, bool symmetric,
                               HarmonicSums& sums) const {
  const double up = side * nodes_[row].x, across = std::sqrt(1.0 - up * up);
  const std::size_t columns = 2 * rows(), bands = static_cast<std::size_t>(bands_);
  std::array<glm::dvec3, kMaxBands> with_cosine{}, with_sine{};
  for (std::size_t column = 0; column < (symmetric ? columns / 2 : columns); ++column) {
    const double* c = &cosines_[column * kMaxBands];
    const double* s = &sines_[column * kMaxBands];
    const glm::vec3 d(glm::dvec3(across * c[1], across * s[1], up));
    const glm::dvec3 luminance(sky.luminance(shared::worldFromSh(d)));
    for (std::size_t m = 0; m < bands; ++m) with_cosine[m] += luminance * c[m];
    if (!symmetric)
      for (std::size_t m = 1; m < bands; ++m) with_sine[m] += luminance * s[m];
  }
  const double weight = nodes_[row].weight * 2.0 * glm::pi<double>() /
                        static_cast<double>(columns) * (symmetric ? 2.0 : 1.0);
  std::array<double, kMaxBands> powers{};  // of `across`, times the weight
  powers[0] = weight;
  for (std::size_t m = 1; m < bands; ++m) powers[m] = powers[m - 1] * across;
  forEachLegendre(up, bands_, [&](int l, int m, double q) {
    const auto sm = static_cast<std::size_t>(m);
    const double factor = q * powers[sm];
    sums[static_cast<std::size_t>(l * l + l + m)] += with_cosine[sm] * factor;
    if (m > 0 && !symmetric)
      sums[static_cast<std::size_t>(l * l + l - m)] += with_sine[sm] * factor;
  });
}

void SkyProjection::addRow(const Sky& sky, std::size_t row, HarmonicSums& sums) const {
  addHalfRow(sky, row, 1.0, false, sums);
  addHalfRow(sky, row, -1.0, false, sums);
}

HarmonicSums SkyProjection::ofSymmetric(const Sky& sky) const {
  HarmonicSums sums{};
  for (std::size_t row = 0; row < rows(); ++row) addHalfRow(sky, row, 1.0, true, sums);
  return sums;
}

}  // namespace verdure
