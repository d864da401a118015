#include "leaf/outline_curve.h"

#include <algorithm>
#include <cmath>

namespace verdure {
namespace {

float cross(const glm::vec2& a, const glm::vec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Centripetal Catmull-Rom between b and c (Barry and Goldman's pyramid).
glm::vec2 catmullRom(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c, const glm::vec2& d,
                     float f) {
  const auto knot = [](const glm::vec2& p, const glm::vec2& q) {
    return std::max(std::sqrt(glm::length(q - p)), 1e-4f);
  };
  const float t1 = knot(a, b), t2 = t1 + knot(b, c), t3 = t2 + knot(c, d);
  const float t = t1 + f * (t2 - t1);
  const auto blend = [t](const glm::vec2& p, const glm::vec2& q, float tp, float tq) {
    return ((tq - t) * p + (t - tp) * q) / (tq - tp);
  };
  const glm::vec2 a1 = blend(a, b, 0, t1), a2 = blend(b, c, t1, t2), a3 = blend(c, d, t2, t3);
  return blend(blend(a1, a2, 0, t2), blend(a2, a3, t1, t3), t1, t2);
}

/// Height of a saw's teeth at u.
float sawHeight(const Saw& saw, float u) {
  const std::size_t n = saw.tips.size();
  if (n == 0) return 0.0f;
  const auto next = static_cast<std::size_t>(std::upper_bound(saw.tips.begin(), saw.tips.end(), u) -
                                             saw.tips.begin());
  const auto pitchAfter = [&](std::size_t k) {
    if (n == 1) return 1.0f;
    return k + 1 < n ? saw.tips[k + 1] - saw.tips[k] : saw.tips[n - 1] - saw.tips[n - 2];
  };
  float height = 0;
  if (next > 0) {  // behind tip next - 1
    const float fall = saw.fall * pitchAfter(next - 1);
    const float f = 1 - (u - saw.tips[next - 1]) / std::max(fall, 1e-6f);
    if (f > 0) height = saw.heights[next - 1] * std::pow(std::min(f, 1.0f), saw.power);
  }
  if (next < n) {  // before tip next
    const float pitch = next == 0 ? pitchAfter(0) : pitchAfter(next - 1);
    const float f = 1 - (saw.tips[next] - u) / std::max((1 - saw.fall) * pitch, 1e-6f);
    if (f > 0) height = std::max(height, saw.heights[next] * std::pow(f, saw.power));
  }
  return height;
}

}  // namespace

Polyline splineThrough(const std::vector<ControlPoint>& points, float step) {
  Polyline curve{points.front().at};
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const glm::vec2 b = points[i].at, c = points[i + 1].at;
    const bool start = i == 0 || points[i].corner, end = i + 2 == n || points[i + 1].corner;
    // At corners the curve leaves as if it had been mirrored there.
    const glm::vec2 a = start ? 2.0f * b - c : points[i - 1].at;
    const glm::vec2 d = end ? 2.0f * c - b : points[i + 2].at;
    const int pieces = std::max(1, static_cast<int>(std::ceil(glm::length(c - b) / step)));
    for (int k = 1; k < pieces; ++k)
      curve.push_back(catmullRom(a, b, c, d, static_cast<float>(k) / static_cast<float>(pieces)));
    curve.push_back(c);
  }
  return curve;
}

ArcCurve::ArcCurve(Polyline points) : points_(std::move(points)), lengths_(points_.size(), 0.0f) {
  for (std::size_t i = 1; i < points_.size(); ++i)
    lengths_[i] = lengths_[i - 1] + glm::length(points_[i] - points_[i - 1]);
}

std::size_t ArcCurve::segmentOf(float u) const {
  const auto above = std::upper_bound(lengths_.begin(), lengths_.end(), u) - lengths_.begin();
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(points_.size()) - 1) - 1);
}

glm::vec2 ArcCurve::at(float u) const {
  const std::size_t i = segmentOf(u);
  const float span = lengths_[i + 1] - lengths_[i];
  const float f = span > 0 ? std::clamp((u - lengths_[i]) / span, 0.0f, 1.0f) : 0.0f;
  return glm::mix(points_[i], points_[i + 1], f);
}

glm::vec2 ArcCurve::tangent(float u) const {
  const float reach = 0.004f * length();
  const glm::vec2 d = at(std::min(u + reach, length())) - at(std::max(u - reach, 0.0f));
  const float size = glm::length(d);
  return size > 0 ? d / size : glm::vec2(0, 1);
}

float ArcCurve::meet(const glm::vec2& origin, const glm::vec2& direction) const {
  float best = -1, nearest = 1e30f;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const glm::vec2 e = points_[i + 1] - points_[i], w = points_[i] - origin;
    const float det = cross(direction, e);
    if (std::abs(det) < 1e-12f) continue;
    const float along = cross(w, e) / det, f = cross(w, direction) / det;
    if (f < 0 || f > 1 || along <= 0 || along >= nearest) continue;
    nearest = along;
    best = lengths_[i] + f * (lengths_[i + 1] - lengths_[i]);
  }
  return best;
}

glm::vec2 toothedPoint(const ArcCurve& curve, const std::vector<Saw>& saws, float u) {
  const glm::vec2 tangent = curve.tangent(u), outward(tangent.y, -tangent.x);
  glm::vec2 p = curve.at(u);
  for (const Saw& saw : saws) {
    const float h = sawHeight(saw, u);
    p += h * (outward + saw.lean * tangent);
  }
  return p;
}

Polyline toothedCurve(const ArcCurve& curve, const std::vector<Saw>& saws, float step) {
  std::vector<float> places;
  const int count = std::max(2, static_cast<int>(std::ceil(curve.length() / step)));
  for (int i = 0; i <= count; ++i)
    places.push_back(curve.length() * static_cast<float>(i) / static_cast<float>(count));
  for (const Saw& saw : saws)
    for (std::size_t k = 0; k < saw.tips.size(); ++k) {
      places.push_back(saw.tips[k]);
      if (k + 1 < saw.tips.size())
        places.push_back(saw.tips[k] + saw.fall * (saw.tips[k + 1] - saw.tips[k]));
    }
  std::sort(places.begin(), places.end());
  Polyline result;
  for (const float u : places) {
    const glm::vec2 p = toothedPoint(curve, saws, std::clamp(u, 0.0f, curve.length()));
    if (result.empty() || glm::length(p - result.back()) > 1e-4f) result.push_back(p);
  }
  return result;
}

double polygonArea(const Polyline& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return 0.5 * sum;
}

bool insidePolygon(const Polyline& polygon, const glm::vec2& point) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const glm::vec2 &a = polygon[i], &b = polygon[j];
    if ((a.y > point.y) != (b.y > point.y) &&
        point.x < (b.x - a.x) * (point.y - a.y) / (b.y - a.y) + a.x)
      inside = !inside;
  }
  return inside;
}

Polyline mirrored(const Polyline& curve) {
  Polyline result;
  result.reserve(curve.size());
  for (auto p = curve.rbegin(); p != curve.rend(); ++p) result.emplace_back(-p->x, p->y);
  return result;
}

}  // namespace verdure
