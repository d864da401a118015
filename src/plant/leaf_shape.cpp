#include "plant/leaf_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace verdure {
namespace {

constexpr float kStalkHalfWidth = 0.013f;
constexpr int kSteps = 120;

/// Teeth: 0 at the root of a tooth, 1 at its tip, leaning forward.
float tooth(float s, float count) {
  const float f = s * count - std::floor(s * count);
  return f < 0.75f ? f / 0.75f : (1 - f) / 0.25f;
}

/// An arch over [0, 1], 0 at both ends, with its top moved by `lean`.
float arch(float s, float lean) {
  return std::max(std::sin(glm::pi<float>() * std::pow(s, lean)), 0.0f);
}

/// Half the width of the blade at s in [0, 1] from its base to its tip, at most 0.485.
float halfWidth(LeafShape shape, float s) {
  switch (shape) {
    case LeafShape::kElliptic:
      return 0.48f * std::pow(arch(s, 1.1f), 0.8f) * (1 - 0.35f * glm::smoothstep(0.82f, 1.0f, s));
    case LeafShape::kRound: {
      const float c = 2 * std::pow(s, 0.82f) - 1;
      const float round = std::sqrt(std::max(0.0f, 1 - c * c));
      return (0.45f + 0.03f * tooth(s, 15)) * round *
             (1 - 0.55f * glm::smoothstep(0.86f, 0.99f, s));
    }
    case LeafShape::kLanceolate:
      return (0.46f + 0.02f * tooth(s, 26)) * std::pow(arch(s, 0.72f), 0.95f);
    case LeafShape::kTriangular: {
      // s^a (1 - s)^b, whose maximum is at a / (a + b).
      const float a = 0.5f, b = 1.25f, peak = a / (a + b);
      const float form = std::pow(s / peak, a) * std::pow((1 - s) / (1 - peak), b);
      return form * (0.42f + 0.035f * tooth(s, 10) + 0.02f * tooth(s, 30));
    }
    default:
      return 0.48f * std::pow(arch(s, 0.95f), 0.62f);
  }
}

/// Right-hand half of black oak's outline, as (half width, height): lobes with a main point and a
/// side point each, rounded sinuses between them.
const glm::vec2 kOakHalf[] = {
    {0.06f, 0.115f},  {0.12f, 0.13f},   {0.20f, 0.15f},   {0.26f, 0.15f},   {0.235f, 0.185f},
    {0.17f, 0.225f},  {0.15f, 0.25f},   {0.17f, 0.275f},  {0.26f, 0.285f},  {0.40f, 0.305f},
    {0.375f, 0.335f}, {0.455f, 0.38f},  {0.385f, 0.40f},  {0.385f, 0.44f},  {0.30f, 0.42f},
    {0.20f, 0.44f},   {0.165f, 0.465f}, {0.185f, 0.495f}, {0.29f, 0.515f},  {0.42f, 0.56f},
    {0.39f, 0.585f},  {0.48f, 0.64f},   {0.40f, 0.65f},   {0.385f, 0.70f},  {0.28f, 0.665f},
    {0.18f, 0.68f},   {0.15f, 0.70f},   {0.165f, 0.73f},  {0.235f, 0.765f}, {0.31f, 0.825f},
    {0.265f, 0.83f},  {0.28f, 0.885f},  {0.20f, 0.865f},  {0.13f, 0.85f},   {0.10f, 0.87f},
    {0.11f, 0.92f},   {0.05f, 0.93f}};

struct Finger {
  float angle_deg, length;
};
const Finger kFingers[] = {{0, 0.645f}, {40, 0.60f}, {80, 0.49f}, {128, 0.29f}};

std::vector<glm::vec2> mirrored(const std::vector<glm::vec2>& right) {
  std::vector<glm::vec2> polygon = right;
  for (auto p = right.rbegin(); p != right.rend(); ++p) polygon.emplace_back(-p->x, p->y);
  return polygon;
}

/// Right-hand side of a palmate blade, foot to tip: fingers from the lowest to the middle one.
void addPalm(std::vector<glm::vec2>& right) {
  const glm::vec2 center = palmCenter();
  const auto at = [&](float angle_deg, float radius) {
    const float a = angle_deg * glm::pi<float>() / 180;
    const glm::vec2 p = center + radius * glm::vec2(std::sin(a), std::cos(a));
    return glm::vec2(std::min(p.x, 0.49f), p.y);
  };
  right.push_back(at(160, 0.05f));
  for (int i = 3; i >= 0; --i) {
    const auto [angle, length] = kFingers[i];
    const float radians = angle * glm::pi<float>() / 180;
    const glm::vec2 along(std::sin(radians), std::cos(radians));
    const glm::vec2 across(-along.y, along.x);  // anticlockwise: towards the middle finger
    const auto side = [&](float sign) {
      // Widest at half the finger, with teeth towards the tip.
      std::vector<glm::vec2> points;
      for (int k = 0; k <= 14; ++k) {
        const float f = 0.34f + 0.63f * static_cast<float>(k) / 14;
        const float body = std::sin(glm::pi<float>() * std::pow((f - 0.1f) / 0.9f, 0.9f));
        const float width = 0.2f * length * body * (k % 2 == 0 ? 1.0f : 0.86f);
        const glm::vec2 p = center + along * (f * length) + sign * across * width;
        points.emplace_back(std::min(p.x, 0.49f), p.y);
      }
      return points;
    };
    const auto outer = side(-1);
    right.insert(right.end(), outer.begin(), outer.end());
    right.push_back(at(angle, length));
    if (i == 0) break;
    const auto inner = side(+1);
    right.insert(right.end(), inner.rbegin(), inner.rend());
    right.push_back(at(0.5f * (angle + kFingers[i - 1].angle_deg), 0.30f * length));
  }
}

}  // namespace

glm::vec2 palmCenter() {
  return {0.0f, 0.34f};
}

std::vector<glm::vec2> palmTips() {
  std::vector<glm::vec2> tips;
  for (const auto& [angle, length] : kFingers)
    for (const float side : {1.0f, -1.0f}) {
      if (angle == 0 && side < 0) continue;
      const float a = angle * glm::pi<float>() / 180;
      tips.push_back(palmCenter() + length * glm::vec2(side * std::sin(a), std::cos(a)));
    }
  return tips;
}

std::vector<glm::vec2> leafOutline(LeafShape shape) {
  if (shape == LeafShape::kNeedles) return {};
  std::vector<glm::vec2> right{{kStalkHalfWidth, 0.0f}};
  if (shape == LeafShape::kPalmate) {
    right.emplace_back(kStalkHalfWidth, palmCenter().y - 0.04f);
    addPalm(right);
  } else if (shape == LeafShape::kLobed) {
    right.emplace_back(kStalkHalfWidth, kLeafStalk);
    right.insert(right.end(), std::begin(kOakHalf), std::end(kOakHalf));
    right.emplace_back(0.0f, 0.995f);
  } else {
    for (int i = 0; i <= kSteps; ++i) {
      const float s = static_cast<float>(i) / kSteps;
      const float w = halfWidth(shape, s);
      right.emplace_back(s < 0.5f ? std::max(w, kStalkHalfWidth) : w,
                         kLeafStalk + (0.995f - kLeafStalk) * s);
    }
  }
  return mirrored(right);
}

std::vector<glm::vec2> leafHull(LeafShape shape) {
  if (shape == LeafShape::kNeedles) return {{0.5f, 0.0f}, {0.5f, 1.0f}};
  // The smallest polyline (0, 0), (a, low), (b, high), (0, 1) that keeps the outline inside, by
  // trial; what the limit of 0.5 cuts off counts twentyfold.
  const std::vector<glm::vec2> outline = leafOutline(shape);
  std::vector<glm::vec2> best;
  float least = 1e9f;
  for (float low = 0.12f; low < 0.46f; low += 0.02f)
    for (float high = low + 0.14f; high < 0.93f; high += 0.02f) {
      // The bounds of the two ends first, then both raised by what the middle lacks.
      float a = 0.02f, b = 0.02f, lack = 0, cut = 0;
      for (const glm::vec2& p : outline) {
        if (p.y > 0.04f && p.y <= low) a = std::max(a, p.x * low / p.y);
        if (p.y >= high && p.y < 0.985f) b = std::max(b, p.x * (1 - high) / (1 - p.y));
      }
      for (const glm::vec2& p : outline)
        if (p.y > low && p.y < high)
          lack = std::max(lack, p.x - glm::mix(a, b, (p.y - low) / (high - low)));
      cut = std::max(a + lack - 0.5f, 0.0f) + std::max(b + lack - 0.5f, 0.0f);
      a = std::min(a + lack, 0.5f);
      b = std::min(b + lack, 0.5f);
      const float area = a * low + (a + b) * (high - low) + b * (1 - high) + 20 * cut;
      if (area < least) {
        least = area;
        best = {{a, low}, {b, high}};
      }
    }
  return best;
}

}  // namespace verdure
