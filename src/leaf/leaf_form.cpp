#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "leaf/leaf_form.h"

namespace verdure {

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

}  // namespace verdure
