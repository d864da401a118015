#include <algorithm>
#include <cmath>

#include "leaf/leaf_form.h"

namespace verdure {
namespace {

// All in blade lengths unless named otherwise.
struct Lobe {
  float root;  ///< where its vein leaves the midrib
  glm::vec2 tip;
  float lower, upper;  ///< reach of its side teeth, by its length; 0 = none
  glm::vec2 sinus;     ///< bottom of the bay above it
};

const Lobe kLobes[] = {
    {0.03f, {0.240f, 0.140f}, 0.0f, 0.0f, {0.112f, 0.163f}},
    {0.15f, {0.405f, 0.350f}, 0.21f, 0.23f, {0.135f, 0.405f}},
    {0.37f, {0.430f, 0.630f}, 0.22f, 0.22f, {0.120f, 0.655f}},
    {0.61f, {0.285f, 0.850f}, 0.20f, 0.19f, {0.072f, 0.850f}},
};

/// A pointed tooth that ends in a bristle.
void addTooth(std::vector<ControlPoint>& points, const glm::vec2& tip, const glm::vec2& along,
              float length_mm) {
  const glm::vec2 across(along.y, -along.x);
  const float half = 0.16f / length_mm;
  points.push_back({tip + half * across, true});
  points.push_back({tip + (2.2f / length_mm) * along, true});
  points.push_back({tip - half * across, true});
}

struct Half {
  Polyline margin;                ///< mm
  std::vector<VeinGuide> guides;  ///< parent -1: the midrib; else counted within this half
};

Half makeHalf(float length, float stalk_radius, Random& random) {
  std::vector<ControlPoint> points{{{stalk_radius / length, 0}, true}};
  points.push_back({{0.035f, 0.03f + random.vary(0.006f)}});
  Half half;
  const float wide = 1 + random.vary(0.05f);
  for (const Lobe& form : kLobes) {
    const glm::vec2 root(0, form.root + random.vary(0.012f));
    glm::vec2 tip = form.tip * glm::vec2(wide * (1 + random.vary(0.08f)), 1);
    tip.y += random.vary(0.018f);
    const glm::vec2 axis = tip - root;
    const float size = glm::length(axis);
    const glm::vec2 along = axis / size, up(-along.y, along.x);
    const auto local = [&](float u, float v) {
      return root + size * ((u + random.vary(0.012f)) * along + (v + random.vary(0.012f)) * up);
    };
    std::vector<glm::vec2> teeth;
    const float broad = 1 + random.vary(0.12f);
    if (form.lower > 0) {
      points.push_back({local(0.60f, -0.155f * broad)});
      const glm::vec2 tooth = local(0.78f, -form.lower * broad);
      addTooth(points, tooth, glm::normalize(0.8f * along - 0.6f * up), length);
      points.push_back({local(0.835f, -0.10f * broad)});
      teeth.push_back(tooth);
    } else {
      points.push_back({local(0.50f, -0.21f * broad)});
      points.push_back({local(0.80f, -0.11f * broad)});
    }
    addTooth(points, tip, along, length);
    points.push_back({local(0.82f, 0.095f * broad)});
    if (form.upper > 0) {
      const glm::vec2 tooth = local(0.76f, form.upper * broad);
      addTooth(points, tooth, glm::normalize(0.8f * along + 0.6f * up), length);
      teeth.push_back(tooth);
    }
    points.push_back({local(0.58f, (form.upper > 0 ? 0.125f : 0.10f) * broad)});
    // A round bay.
    glm::vec2 sinus = form.sinus;
    sinus.x *= 1 + random.vary(0.12f);
    sinus.y += random.vary(0.008f);
    points.push_back({sinus + glm::vec2(0.012f, -0.022f)});
    points.push_back({sinus + glm::vec2(0.010f, 0.018f)});

    const auto vein = [&](const glm::vec2& from, const glm::vec2& to, float bow) {
      const glm::vec2 chord = to - from;
      const glm::vec2 middle = from + 0.5f * chord + bow * glm::vec2(chord.y, -chord.x);
      Polyline line = splineThrough({{from}, {middle}, {to}}, 0.01f);
      for (glm::vec2& p : line) p *= length;
      return wiggled(line, 0.006f, random);
    };
    const int secondary = static_cast<int>(half.guides.size());
    half.guides.push_back({vein(root, tip, 0.02f), 2, -1});
    for (const glm::vec2& t : teeth) {
      const float side = glm::dot(t - root, up) > 0 ? 1.0f : -1.0f;
      const glm::vec2 from = root + (0.42f + random.vary(0.03f)) * axis;
      half.guides.push_back({vein(from, t, 0.05f * side), 3, secondary});
    }
  }
  // The last lobe, shared by both halves.
  const glm::vec2 tooth(0.115f + random.vary(0.01f), 0.925f + random.vary(0.012f));
  addTooth(points, tooth, glm::normalize(glm::vec2(0.75f, 0.65f)), length);
  points.push_back({{0.045f, 0.945f}});
  points.push_back({{0.16f / length, 1.0f}, true});
  points.push_back({{0, 1.0f + 2.2f / length}, true});
  half.margin = splineThrough(points, 0.005f);
  for (glm::vec2& p : half.margin) p *= length;
  Polyline last =
      splineThrough({{{0, 0.80f}}, {0.52f * tooth + glm::vec2(0.005f, 0.4f)}, {tooth}}, 0.01f);
  for (glm::vec2& p : last) p *= length;
  half.guides.push_back({last, 2, -1});
  return half;
}

}  // namespace

LeafPlan makeOak(std::uint64_t seed) {
  Random random(hash(seed ^ 0x6f616bull));
  LeafPlan leaf;
  const float length = 118 * random.uniform(0.94f, 1.06f);
  leaf.blade_base = 26 * random.uniform(0.85f, 1.15f);
  leaf.stalk_radius = 0.75f;
  const glm::vec2 base(0, leaf.blade_base);
  const Half right = makeHalf(length, leaf.stalk_radius, random);
  const Half left = makeHalf(length, leaf.stalk_radius, random);
  const Polyline stalk = stalkSide(leaf);

  leaf.outline = stalk;
  for (const glm::vec2& p : right.margin) leaf.outline.push_back(p + base);
  Polyline other = mirrored(left.margin);
  for (std::size_t i = 1; i < other.size(); ++i) leaf.outline.push_back(other[i] + base);
  const Polyline back = mirrored(stalk);
  leaf.outline.insert(leaf.outline.end(), back.begin(), back.end());

  leaf.guides.push_back(
      {splineThrough({{{0, 0}, true}, {base, true}, {base + glm::vec2(0, length), true}}, 1.0f), 1,
       -1});
  for (const bool mirror : {false, true}) {
    const Half& half = mirror ? left : right;
    const int first = static_cast<int>(leaf.guides.size());
    for (VeinGuide guide : half.guides) {
      for (glm::vec2& p : guide.points) p = base + glm::vec2(mirror ? -p.x : p.x, p.y);
      guide.parent = guide.parent < 0 ? 0 : first + guide.parent;
      leaf.guides.push_back(guide);
    }
  }
  bendForm(leaf, 0.045f, random);
  return leaf;
}

}  // namespace verdure
