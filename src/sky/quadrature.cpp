#include "sky/quadrature.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace verdure {

std::vector<QuadratureNode> gaussLegendre(int count) {
  std::vector<QuadratureNode> nodes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    // Newton's method on P_count from Tricomi's estimate of its roots.
    double x = std::cos(glm::pi<double>() * (i + 0.75) / (count + 0.5));
    double slope = 0.0;
    for (int step = 0; step < 8; ++step) {
      double p = 1.0, previous = 0.0;
      for (int l = 0; l < count; ++l) {
        const double next = ((2 * l + 1) * x * p - l * previous) / (l + 1);
        previous = p;
        p = next;
      }
      slope = count * (x * p - previous) / (x * x - 1.0);
      x -= p / slope;
    }
    nodes[static_cast<std::size_t>(i)] = {0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)};
  }
  return nodes;
}

}  // namespace verdure
