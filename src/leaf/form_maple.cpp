#include <cmath>

#include "leaf/leaf_form.h"

namespace verdure {
namespace {

struct Finger {
  float angle_deg, length;  ///< from the middle finger; by its length
};
const Finger kFingers[] = {{0, 1.0f}, {37, 0.95f}, {77, 0.78f}, {122, 0.45f}};
constexpr float kSinus = 0.33f;  ///< where fingers part, by the shorter neighbour's length
constexpr int kSide = 3;         ///< fingers on each side of the middle one

glm::vec2 polar(float angle_deg, float radius) {
  const float a = glm::radians(angle_deg);
  return radius * glm::vec2(std::sin(a), std::cos(a));
}

}  // namespace

LeafPlan makeMaple(std::uint64_t seed) {
  Random random(hash(seed ^ 0x6d61706c65ull));
  LeafPlan leaf;
  const float middle = 58 * random.uniform(0.94f, 1.06f);
  leaf.blade_base = 30 * random.uniform(0.9f, 1.1f);
  leaf.stalk_radius = 0.55f;
  const glm::vec2 palm(0, leaf.blade_base);

  // Fingers from the lowest on the right, anticlockwise, to the lowest on the left.
  struct Placed {
    float angle, length;
  };
  std::vector<Placed> fingers;
  for (int i = kSide; i >= -kSide; --i) {
    const Finger& form = kFingers[std::abs(i)];
    const float angle = form.angle_deg + random.vary(2.5f);
    fingers.push_back(
        {i < 0 ? -angle : angle, middle * form.length * (i == 0 ? 1.0f : 1 + random.vary(0.05f))});
  }
  // Where neighbours part; before the first and behind the last finger: the stalk.
  std::vector<glm::vec2> bays{{leaf.stalk_radius, -0.8f}};
  for (std::size_t k = 0; k + 1 < fingers.size(); ++k) {
    const float shorter = std::min(fingers[k].length, fingers[k + 1].length);
    const float share = fingers[k].length / (fingers[k].length + fingers[k + 1].length);
    bays.push_back(polar(glm::mix(fingers[k].angle, fingers[k + 1].angle, share),
                         kSinus * shorter * (1 + random.vary(0.08f)) + 0.03f * middle));
  }
  bays.emplace_back(-leaf.stalk_radius, -0.8f);

  leaf.outline = stalkSide(leaf);
  leaf.guides.push_back({splineThrough({{{0, 0}}, {palm}}, 1.0f), 1, -1});
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    const auto [angle, length] = fingers[k];
    const glm::vec2 along = polar(angle, 1), across(along.y, -along.x);
    const auto local = [&](const glm::vec2& p) {
      return glm::vec2(glm::dot(p, across), glm::dot(p, along)) / length;
    };
    const auto place = [&](const glm::vec2& p) { return palm + p.x * across + p.y * along; };
    const bool lowest = k == 0 || k + 1 == fingers.size();
    BladeShape shape;
    shape.length_mm = length;
    shape.pairs = lowest ? 7 : 10;
    shape.first = 0.12f;
    shape.last = 0.88f;
    shape.angle_base_deg = 47;
    shape.angle_tip_deg = 34;
    shape.bend = 0.05f;
    shape.into_teeth = true;
    shape.tooth_mm = 0.024f * length;
    shape.minor_mm = 0.012f * length;
    shape.pitch_mm = 0.028f * length;
    shape.teeth_to = 0.97f;
    shape.saw = {{}, {}, 0.22f, 0.9f, 1.15f};
    shape.vary = 0.05f;
    const auto half = [&](const glm::vec2& bay, bool outer) {
      const float slim = lowest ? 1.25f : 1.0f;
      shape.margin = {{bay}};
      shape.teeth_from = outer ? 0.25f : std::max(0.44f, bay.y + 0.16f);
      if (outer) shape.margin.push_back({{0.150f, 0.20f}});
      for (const glm::vec2& p :
           {glm::vec2(0.094f, 0.36f), glm::vec2(0.122f, 0.48f), glm::vec2(0.108f, 0.61f),
            glm::vec2(0.060f, 0.77f), glm::vec2(0.019f, 0.905f)})
        if (p.y > bay.y + 0.08f) shape.margin.push_back({{slim * p.x, p.y}});
      shape.margin.push_back({{0, 1}});
      return makeHalfBlade(shape, outer ? 0.0f : 1.0f, random);
    };
    const glm::vec2 before = local(bays[k]), after = local(bays[k + 1]);
    const HalfBlade right = half(before, k == 0);
    const HalfBlade left = half({-after.x, after.y}, k + 1 == fingers.size());
    for (const glm::vec2& p : right.margin) leaf.outline.push_back(place(p));
    const Polyline other = mirrored(left.margin);
    // The bay belongs to the next finger.
    for (std::size_t i = 1; i + 1 < other.size(); ++i) leaf.outline.push_back(place(other[i]));

    const int primary = static_cast<int>(leaf.guides.size());
    Polyline axis = splineThrough({{{0, 0}}, {{0, length}}}, 1.0f);
    for (glm::vec2& p : axis) p = place(p);
    leaf.guides.push_back({wiggled(axis, 0.004f, random), 1, 0});
    for (const bool mirror : {false, true})
      for (Polyline vein : mirror ? left.secondaries : right.secondaries) {
        for (glm::vec2& p : vein) p = place({mirror ? -p.x : p.x, p.y});
        leaf.guides.push_back({vein, 2, primary});
      }
  }
  leaf.outline.push_back(palm + bays.back());
  const Polyline back = mirrored(stalkSide(leaf));
  leaf.outline.insert(leaf.outline.end(), back.begin(), back.end());
  bendForm(leaf, 0.03f, random);
  return leaf;
}

}  // namespace verdure
