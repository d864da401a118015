#ifndef VERDURE_SKY_QUADRATURE_H_
#define VERDURE_SKY_QUADRATURE_H_

#include <vector>

namespace verdure {

struct QuadratureNode {
  double x, weight;
};

/// Gauss-Legendre rule over [0, 1] with `count` nodes: exact for polynomials of degree
/// 2 count - 1.
std::vector<QuadratureNode> gaussLegendre(int count);

}  // namespace verdure

#endif  // VERDURE_SKY_QUADRATURE_H_
