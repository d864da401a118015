#include "verdure/placement.h"

#include <cmath>

namespace verdure {

glm::mat4 matrixOf(const Placement& place) {
  const float c = place.scale * std::cos(place.angle), s = place.scale * std::sin(place.angle);
  return {glm::vec4(c, 0.0f, -s, 0.0f), glm::vec4(0.0f, place.scale, 0.0f, 0.0f),
          glm::vec4(s, 0.0f, c, 0.0f), glm::vec4(place.position, 1.0f)};
}

}  // namespace verdure
