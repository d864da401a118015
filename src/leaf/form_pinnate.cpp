#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

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

/// Where a vein that leaves at y reaches the margin: arc lengths; -1 where it does not.
struct Root {
  float y, u;
};

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

  std::vector<Root> roots;
  const float spacing =
      (shape.last - shape.first) / static_cast<float>(std::max(shape.pairs - 1, 1));
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

  // Teeth: a row at the veins' ends, and a finer one everywhere.
  std::vector<Saw> saws;
  const auto fade = [&](float u) {  // teeth begin and end gently
    const float y = curve.at(u).y / length;
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

  HalfBlade half;
  half.margin = toothedCurve(curve, saws, kStep * length);
  // The spline's end is the tip itself.
  half.margin.back() = margin.back().at;
  for (const Root& root : roots) {
    const glm::vec2 start(0, root.y);
    const float bow = shape.bend * random.uniform(0.75f, 1.25f);
    if (shape.into_teeth) {
      half.secondaries.push_back(
          wiggled(bowed(start, toothedPoint(curve, saws, root.u), bow), 0.004f, random));
      continue;
    }
    // Loops: on along the margin, ever farther from it, to the next vein.
    const float climb = shape.loop * spacing * length;
    const auto inner = [&](float u, float inset) {
      const float at = std::min(u, 0.985f * curve.length());
      const glm::vec2 t = curve.tangent(at), p = curve.at(at);
      return p - std::min(inset * shape.length_mm, 0.45f * p.x) * glm::vec2(t.y, -t.x);
    };
    const glm::vec2 bowed_end = inner(root.u + 0.25f * climb, 0.05f);
    const glm::vec2 chord = bowed_end - start;
    const glm::vec2 middle = start + 0.55f * chord + bow * glm::vec2(chord.y, -chord.x);
    std::vector<ControlPoint> points{{start}, {middle}, {inner(root.u + 0.35f * climb, 0.05f)}};
    points.push_back({inner(root.u + 0.95f * climb, 0.042f)});
    points.push_back({inner(root.u + 1.5f * climb, 0.065f)});
    half.secondaries.push_back(wiggled(splineThrough(points, 0.02f * length), 0.006f, random));
  }
  return half;
}

Polyline wiggled(const Polyline& points, float amplitude, Random& random) {
  float length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += glm::length(points[i] - points[i - 1]);
  const float waves = random.uniform(1.5f, 2.6f), phase = random.uniform(0, 6.28f);
  Polyline result = points;
  float u = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    u += glm::length(points[i] - points[i - 1]);
    const float t = u / length;
    const glm::vec2 d = glm::normalize(points[i + 1] - points[i - 1] + glm::vec2(0, 1e-9f));
    const float shift = amplitude * length * std::sin(glm::pi<float>() * t) *
                        (std::sin(6.28f * waves * t + phase) +
                         0.5f * std::sin(6.28f * 2.3f * waves * t + 2 * phase));
    result[i] += shift * glm::vec2(-d.y, d.x);
  }
  return result;
}

float stalkRadius(const LeafPlan& form, float y) {
  return form.stalk_radius * (1 + 0.55f * std::exp(-y / (4 * form.stalk_radius)));
}

Polyline stalkSide(const LeafPlan& form) {
  Polyline side;
  const int steps = std::max(2, static_cast<int>(form.blade_base));
  for (int k = 0; k < steps; ++k) {
    const float y = form.blade_base * static_cast<float>(k) / static_cast<float>(steps);
    side.emplace_back(stalkRadius(form, y), y);
  }
  return side;
}

void bendForm(LeafPlan& form, float bend, Random& random) {
  float top = 0;
  for (const glm::vec2& p : form.outline) top = std::max(top, p.y);
  const float sign = random.uniform() < 0.5f ? -1.0f : 1.0f;
  const float a = sign * bend * random.uniform(0.4f, 1.3f), b = random.vary(0.6f * bend);
  const float phase = random.uniform(0.8f, 1.3f);
  const auto shift = [&](glm::vec2& p) {
    const float t = p.y / top;
    p.x += top * (a * (1.6f * t * t - t) + b * (1 - std::cos(3.14f * phase * t)) * 0.35f);
  };
  for (glm::vec2& p : form.outline) shift(p);
  for (VeinGuide& guide : form.guides)
    for (glm::vec2& p : guide.points) shift(p);
}

LeafPlan makePinnate(const PinnateForm& form, std::uint64_t seed) {
  Random random(hash(seed ^ 0x6c656166ull));
  LeafPlan leaf;
  leaf.blade_base = form.stalk_mm;
  leaf.stalk_radius = form.stalk_radius_mm;
  BladeShape shape = form.blade;
  shape.length_mm *= random.uniform(0.92f, 1.08f);
  const float wide = random.uniform(0.92f, 1.08f), broadest = random.vary(0.02f);
  for (std::size_t i = 1; i + 1 < shape.margin.size(); ++i) {
    glm::vec2& p = shape.margin[i].at;
    p += glm::vec2((wide - 1) * p.x, broadest * std::max(p.y, 0.0f) * (1 - p.y) * 4);
  }
  shape.margin.front().at = glm::vec2(form.stalk_radius_mm / shape.length_mm, 0);
  const Polyline stalk = stalkSide(leaf);
  const HalfBlade right = makeHalfBlade(shape, 0.0f, random);
  const HalfBlade left = makeHalfBlade(shape, 1.0f, random);
  const glm::vec2 base(0, form.stalk_mm), tip = base + glm::vec2(0, shape.length_mm);
  const auto lifted = [&](Polyline points) {
    for (glm::vec2& p : points) p += base;
    return points;
  };

  leaf.outline = stalk;
  for (const glm::vec2& p : lifted(right.margin)) leaf.outline.push_back(p);
  const Polyline other = mirrored(lifted(left.margin));
  leaf.outline.insert(leaf.outline.end(), other.begin() + 1, other.end());
  const Polyline back = mirrored(stalk);
  leaf.outline.insert(leaf.outline.end(), back.begin(), back.end());

  leaf.guides.push_back({{{0, 0}, base, 0.5f * (base + tip), tip}, 1, -1});
  for (std::size_t k = std::max(right.secondaries.size(), left.secondaries.size()); k-- > 0;) {
    // From the tip on: loops end at the vein above.
    if (k < right.secondaries.size()) leaf.guides.push_back({lifted(right.secondaries[k]), 2, 0});
    if (k < left.secondaries.size()) {
      Polyline points = lifted(left.secondaries[k]);
      for (glm::vec2& p : points) p.x = -p.x;
      leaf.guides.push_back({points, 2, 0});
    }
  }
  // Bending needs points in between.
  leaf.guides.front().points = splineThrough({{{0, 0}, true}, {base, true}, {tip, true}}, 1.0f);
  bendForm(leaf, form.bend, random);
  return leaf;
}

}  // namespace verdure
