#include "plant/leaf_shape.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace verdure {
namespace {

/// The two corners of one side. Points: x the distance from the axis, y along it in [0, 1]; `reach`
/// is what a corner at that y may have.
template <typename Reach>
std::array<glm::vec2, 2> fitSide(const std::vector<glm::vec2>& points, const Reach& reach) {
  // The smallest polyline (0, 0), (a, low), (b, high), (0, 1) that keeps the points inside, by
  // trial; what the reach cuts off counts twentyfold.
  std::array<glm::vec2, 2> best{};
  float least = std::numeric_limits<float>::max();
  for (float low = 0.06f; low < 0.56f; low += 0.02f)
    for (float high = low + 0.14f; high < 0.95f; high += 0.02f) {
      // The bounds of the two ends first, then both raised by what the middle lacks.
      float a = 0.01f, b = 0.01f, lack = 0;
      for (const glm::vec2& p : points) {
        if (p.y > 0.04f && p.y <= low) a = std::max(a, p.x * low / p.y);
        if (p.y >= high && p.y < 0.985f) b = std::max(b, p.x * (1 - high) / (1 - p.y));
      }
      for (const glm::vec2& p : points)
        if (p.y > low && p.y < high)
          lack = std::max(lack, p.x - glm::mix(a, b, (p.y - low) / (high - low)));
      const float most_a = reach(low), most_b = reach(high);
      const float cut = std::max(a + lack - most_a, 0.0f) + std::max(b + lack - most_b, 0.0f);
      a = std::min(a + lack, most_a);
      b = std::min(b + lack, most_b);
      const float area = a * low + (a + b) * (high - low) + b * (1 - high) + 20 * cut;
      if (area < least) {
        least = area;
        best = {glm::vec2(a, low), glm::vec2(b, high)};
      }
    }
  return best;
}

}  // namespace

std::string leafSpeciesOf(LeafShape shape) {
  static const std::array<const char*, kLeafShapeCount> names{
      "black-tupelo",   "quaking-aspen", "weeping-willow", "black-oak",
      "japanese-maple", "silver-birch",  "hedge",          "scots-pine"};
  return names[static_cast<std::size_t>(shape)];
}

LeafHull leafHull(std::span<const glm::vec2> points, float reach_left, float reach_right) {
  LeafHull hull;
  hull.tip = *std::max_element(points.begin(), points.end(),
                               [](const glm::vec2& p, const glm::vec2& q) { return p.y < q.y; });
  for (const float side : {1.0f, -1.0f}) {
    std::vector<glm::vec2> from_axis;
    for (const glm::vec2& p : points) {
      const float along = p.y / hull.tip.y;
      from_axis.emplace_back(side * (p.x - hull.tip.x * along), along);
    }
    const std::array<glm::vec2, 2> corners = fitSide(from_axis, [&](float along) {
      return (side > 0 ? reach_right : reach_left) - side * hull.tip.x * along;
    });
    for (std::size_t k = 0; k < 2; ++k)
      (side > 0 ? hull.right : hull.left)[k] =
          glm::vec2(hull.tip.x * corners[k].y + side * corners[k].x, corners[k].y * hull.tip.y);
  }
  return hull;
}

}  // namespace verdure
