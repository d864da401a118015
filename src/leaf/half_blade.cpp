#include <algorithm>
#include <cmath>

#include "leaf/leaf_form.h"

namespace verdure {
namespace {

constexpr float kStep = 0.006f;  ///< of outlines, in blade lengths

glm::vec2 direction(float angle_deg) {
  const float a = glm::radians(angle_deg);
  return {std::sin(a), std::cos(a)};
}

/// From `root` to `tip`, bowed away from the leaf's tip by `bow` of its length.
Polyline bowed(const glm::vec2& root, const glm::vec2& tip, float bow) {
  const glm::vec2 chord = tip - root, below(chord.y, -chord.x);
  const glm::vec2 middle = root + 0.5f * chord + bow * below;
  Polyline points;
  for (int k = 0; k <= 24; ++k) {
    const float t = static_cast<float>(k) / 24;
    points.push_back((1 - t) * (1 - t) * root + 2 * t * (1 - t) * middle + t * t * tip);
  }
  return points;
}

/// A secondary vein: it leaves the midrib at y, mm, and reaches the margin at arc length u.
struct Root {
  float y, u;
};

/// Distance between secondary veins, in blade lengths.
float spacingOf(const BladeShape& shape) {
  return (shape.last - shape.first) / static_cast<float>(std::max(shape.pairs - 1, 1));
}

std::vector<Root> rootsOf(const BladeShape& shape, float side, const ArcCurve& curve,
                          Random& random) {
  const float length = shape.length_mm, spacing = spacingOf(shape);
  std::vector<Root> roots;
  for (int k = 0; k < shape.pairs; ++k) {
    float s = shape.first + spacing * (static_cast<float>(k) + side * shape.stagger);
    s += random.vary(0.16f) * spacing;
    if (s < 0.004f || s > 0.97f) continue;
    const float angle = glm::mix(shape.angle_base_deg, shape.angle_tip_deg, s) + random.vary(3.0f);
    const float u = curve.meet({0, s * length}, direction(angle));
    if (u < 0 || u > 0.985f * curve.length()) continue;
    if (!roots.empty() && u < roots.back().u + 0.3f * spacing * length) continue;
    roots.push_back({s * length, u});
  }
  return roots;
}

/// A row of teeth at the veins' ends, and a finer one everywhere.
std::vector<Saw> teethOf(const BladeShape& shape, const std::vector<Root>& roots,
                         const ArcCurve& curve, Random& random) {
  std::vector<Saw> saws;
  const auto fade = [&](float u) {  // teeth begin and end gently
    const float y = curve.at(u).y / shape.length_mm;
    return glm::smoothstep(shape.teeth_from - 0.06f, shape.teeth_from + 0.05f, y) *
           (1 - glm::smoothstep(shape.teeth_to - 0.12f, shape.teeth_to + 0.03f, y));
  };
  const auto add = [&](Saw& saw, float u, float height) {
    saw.tips.push_back(u);
    saw.heights.push_back(height * fade(u));
  };
  if (shape.tooth_mm > 0) {
    Saw saw = shape.saw;
    for (const Root& root : roots) add(saw, root.u, shape.tooth_mm * random.uniform(0.85f, 1.15f));
    saws.push_back(saw);
  }
  if (shape.minor_mm > 0) {
    Saw saw = shape.saw;
    // Between the ends of veins, the same number of teeth each.
    std::vector<float> stops{0.0f};
    if (shape.into_teeth)
      for (const Root& root : roots) stops.push_back(root.u);
    stops.push_back(0.995f * curve.length());
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      const float gap = stops[i + 1] - stops[i];
      const int count = std::max(1, static_cast<int>(std::lround(gap / shape.pitch_mm)));
      for (int k = 1; k <= count; ++k) {
        if (i + 2 == stops.size() && k == count) continue;
        const float f = static_cast<float>(k) + (k < count ? random.vary(0.14f) : 0.0f);
        const float u = stops[i] + gap * f / static_cast<float>(count);
        const bool shared = shape.tooth_mm > 0 && shape.into_teeth && k == count;
        add(saw, u, shape.minor_mm * (shared ? 0.6f : random.uniform(0.75f, 1.15f)));
      }
    }
    saws.push_back(saw);
  }
  return saws;
}

/// A vein that turns before the margin and goes on along it, ever farther from it, to the next.
Polyline loopOf(const BladeShape& shape, const Root& root, float bow, const ArcCurve& curve) {
  const float length = shape.length_mm;
  const glm::vec2 start(0, root.y);
  const float climb = shape.loop * spacingOf(shape) * length;
  const auto inner = [&](float u, float inset) {
    const float at = std::min(u, 0.985f * curve.length());
    const glm::vec2 t = curve.tangent(at), p = curve.at(at);
    return p - std::min(inset * length, 0.45f * p.x) * glm::vec2(t.y, -t.x);
  };
  const glm::vec2 bowed_end = inner(root.u + 0.25f * climb, 0.05f);
  const glm::vec2 chord = bowed_end - start;
  const glm::vec2 middle = start + 0.55f * chord + bow * glm::vec2(chord.y, -chord.x);
  std::vector<ControlPoint> points{{start}, {middle}, {inner(root.u + 0.35f * climb, 0.05f)}};
  points.push_back({inner(root.u + 0.95f * climb, 0.042f)});
  points.push_back({inner(root.u + 1.5f * climb, 0.065f)});
  return splineThrough(points, 0.02f * length);
}

}  // namespace

HalfBlade makeHalfBlade(const BladeShape& shape, float side, Random& random) {
  const float length = shape.length_mm;
  std::vector<ControlPoint> margin = shape.margin;
  const float wide = 1 + random.vary(shape.vary);
  for (std::size_t i = 1; i + 1 < margin.size(); ++i) {
    margin[i].at.x *= wide * (1 + random.vary(0.7f * shape.vary));
    margin[i].at.y += random.vary(0.2f * shape.vary);
  }
  for (ControlPoint& p : margin) p.at *= length;
  const ArcCurve curve(splineThrough(margin, kStep * length));
  const std::vector<Root> roots = rootsOf(shape, side, curve, random);
  const std::vector<Saw> saws = teethOf(shape, roots, curve, random);

  HalfBlade half;
  half.margin = toothedCurve(curve, saws, kStep * length);
  // The spline's end is the tip itself.
  half.margin.back() = margin.back().at;
  for (const Root& root : roots) {
    const float bow = shape.bend * random.uniform(0.75f, 1.25f);
    if (shape.into_teeth) {
      half.secondaries.push_back(
          wiggled(bowed({0, root.y}, toothedPoint(curve, saws, root.u), bow), 0.004f, random));
      continue;
    }
    half.secondaries.push_back(wiggled(loopOf(shape, root, bow, curve), 0.006f, random));
  }
  return half;
}

}  // namespace verdure
