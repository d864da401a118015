#ifndef VERDURE_LEAF_OUTLINE_CURVE_H_
#define VERDURE_LEAF_OUTLINE_CURVE_H_

#include <glm/glm.hpp>
#include <vector>

// Curves that outlines of leaves are made of. Curves run anticlockwise about the leaf: outside is
// to the right of their direction.

namespace verdure {

using Polyline = std::vector<glm::vec2>;

struct ControlPoint {
  glm::vec2 at;
  bool corner = false;  ///< the curve breaks here instead of passing smoothly
};

/// A curve through all points (Catmull-Rom's spline, centripetal, so that it never loops), in
/// steps of at most `step`. The first and last point are corners.
Polyline splineThrough(const std::vector<ControlPoint>& points, float step);

/// A polyline by its arc length.
class ArcCurve {
 public:
  explicit ArcCurve(Polyline points);
  float length() const { return lengths_.back(); }
  glm::vec2 at(float u) const;
  /// Unit.
  glm::vec2 tangent(float u) const;
  /// The arc length at which the curve first meets the ray from `origin` along `direction`, or -1.
  float meet(const glm::vec2& origin, const glm::vec2& direction) const;

 private:
  std::size_t segmentOf(float u) const;
  Polyline points_;
  std::vector<float> lengths_;
};

/// One row of teeth along a curve: each rises slowly to its tip and falls steeply behind it.
struct Saw {
  std::vector<float> tips;     ///< arc lengths, ascending
  std::vector<float> heights;  ///< one each, in the curve's unit
  float fall = 0.18f;          ///< share of the way to the next tip that falls
  float lean = 0.7f;           ///< how far tips lean forward, by their height
  float power = 1.2f;          ///< of the flanks: below 1 round, above 1 hollow
};

/// The place of arc length `u` on the curve with its teeth.
glm::vec2 toothedPoint(const ArcCurve& curve, const std::vector<Saw>& saws, float u);

/// The whole curve with its teeth, in steps of at most `step`.
Polyline toothedCurve(const ArcCurve& curve, const std::vector<Saw>& saws, float step);

/// Shoelace formula: positive for anticlockwise polygons.
double polygonArea(const Polyline& polygon);

/// Whether a point lies inside a closed polygon (even-odd rule).
bool insidePolygon(const Polyline& polygon, const glm::vec2& point);

/// `curve` mirrored at x = 0 and reversed, so that it still runs anticlockwise.
Polyline mirrored(const Polyline& curve);

}  // namespace verdure

#endif  // VERDURE_LEAF_OUTLINE_CURVE_H_
