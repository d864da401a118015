#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "plant/weber_penn.h"

namespace verdure {
namespace {}  // namespace

float shapeRatio(int shape, float ratio, const TreeParameters& p) {
  switch (shape) {
    case 0:
      return 0.2f + 0.8f * ratio;
    case 1:
      return 0.2f + 0.8f * std::sin(glm::pi<float>() * ratio);
    case 2:
      return 0.2f + 0.8f * std::sin(0.5f * glm::pi<float>() * ratio);
    case 3:
      return 1.0f;
    case 4:
      return 0.5f + 0.5f * ratio;
    case 5:
      return ratio <= 0.7f ? ratio / 0.7f : (1 - ratio) / 0.3f;
    case 6:
      return 1.0f - 0.8f * ratio;
    case 7:
      return ratio <= 0.7f ? 0.5f + 0.5f * ratio / 0.7f : 0.5f + 0.5f * (1 - ratio) / 0.3f;
    default:
      if (ratio < 0 || ratio > 1) return 0.0f;
      return ratio < 1 - p.prune_width_peak
                 ? std::pow(ratio / (1 - p.prune_width_peak), p.prune_power_high)
                 : std::pow((1 - ratio) / p.prune_width_peak, p.prune_power_low);
  }
}

float taperedRadius(float taper, float z, float radius, float length) {
  const float unit = taper < 1 ? taper : taper < 2 ? 2 - taper : 0.0f;
  const float cone = radius * (1 - unit * z);
  if (taper < 1) return cone;
  const float to_tip = (1 - z) * length;
  const float depth = taper < 2 || to_tip < cone ? 1.0f : taper - 2;
  const float in_sphere =
      taper < 2 ? to_tip : std::abs(to_tip - 2 * cone * std::floor(to_tip / (2 * cone) + 0.5f));
  if (taper < 2 && in_sphere >= cone) return cone;
  const float h = in_sphere - cone;
  return (1 - depth) * cone + depth * std::sqrt(std::max(cone * cone - h * h, 0.0f));
}

float flareFactor(float flare, float z) {
  const float y = std::max(0.0f, 1 - 8 * z);
  return flare * (std::pow(100.0f, y) - 1) / 100 + 1;
}

bool insideEnvelope(const TreeParameters& p, float height, float z_scale, const glm::vec3& point) {
  const float across = std::sqrt(point.x * point.x + point.z * point.z) / height;
  const float ratio = (height - point.y / z_scale) / (height * (1 - p.base_size));
  return across < p.prune_width * shapeRatio(8, ratio, p);
}

}  // namespace verdure
