#include "plant/leaf_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/tile_noise.h"

namespace verdure {
namespace {

constexpr int kRowsPerPixel = 8;  ///< supersampling of coverage across rows; exact along them

/// Adds the coverage of row `y` by a polygon in pixels (even-odd rule) to `row`.
void coverRow(const std::vector<glm::vec2>& polygon, int y, std::vector<float>& row) {
  std::vector<float> crossings;
  for (int k = 0; k < kRowsPerPixel; ++k) {
    const float line = static_cast<float>(y) + (static_cast<float>(k) + 0.5f) / kRowsPerPixel;
    crossings.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::vec2& a = polygon[i];
      const glm::vec2& b = polygon[(i + 1) % polygon.size()];
      if ((a.y <= line) != (b.y <= line))
        crossings.push_back(a.x + (line - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const float x0 = std::max(crossings[i], 0.0f);
      const float x1 = std::min(crossings[i + 1], static_cast<float>(row.size()));
      for (int x = static_cast<int>(x0); x < static_cast<int>(row.size()); ++x) {
        const auto left = static_cast<float>(x);
        if (left >= x1) break;
        row[static_cast<std::size_t>(x)] +=
            std::max(std::min(x1, left + 1) - std::max(x0, left), 0.0f) / kRowsPerPixel;
      }
    }
  }
}

float distanceToSegment(const glm::vec2& p, const glm::vec2& a, const glm::vec2& b, float& t) {
  const glm::vec2 ab = b - a;
  t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
  return glm::length(p - a - t * ab);
}

/// How much of a vein is at a place: 1 on it, 0 beyond `width` (in leaf lengths).
float line(float distance, float width) {
  return 1 - glm::smoothstep(0.45f * width, width, distance);
}

struct Veins {
  float spacing, angle_deg, bend;  ///< of side veins along the midrib; in leaf lengths
};

Veins veinsOf(LeafShape shape) {
  switch (shape) {
    case LeafShape::kElliptic:
      return {0.1f, 52, 0.9f};
    case LeafShape::kRound:
      return {0.15f, 45, 0.3f};
    case LeafShape::kLanceolate:
      return {0.055f, 50, 3.0f};
    case LeafShape::kLobed:
      return {0.17f, 50, 0.0f};
    case LeafShape::kTriangular:
      return {0.105f, 44, 0.0f};
    case LeafShape::kPalmate:
      return {0.06f, 45, 0.0f};
    default:
      return {0.11f, 48, 0.8f};
  }
}

/// Strength of main and side veins at (x, y): x and y in leaf lengths, y from the foot.
glm::vec2 veinsAt(LeafShape shape, float x, float y, float leaf_scale_x) {
  const Veins veins = veinsOf(shape);
  const float slope = 1 / std::tan(veins.angle_deg * 3.14159265f / 180);
  const float sine = std::sin(veins.angle_deg * 3.14159265f / 180);
  if (shape == LeafShape::kPalmate) {
    const glm::vec2 center(0, palmCenter().y);
    const glm::vec2 p(x, y);
    float t, main = line(distanceToSegment(p, {0, 0}, center, t), 0.013f);
    float nearest = 1e9f, side = 0;
    for (const glm::vec2& tip : palmTips()) {
      const glm::vec2 end(tip.x * leaf_scale_x, tip.y);
      const float d = distanceToSegment(p, center, end, t);
      main = std::max(main, line(d, 0.011f * (1.1f - t)));
      if (d < nearest) {
        nearest = d;
        const float along = (t * glm::length(end - center) - d * slope) / veins.spacing;
        side = line(std::abs(along - std::round(along)) * veins.spacing * sine, 0.005f);
      }
    }
    return {main, side};
  }
  // Narrow leaves have finer veins.
  const float fine = std::min(1.0f, 0.3f + 0.8f * leaf_scale_x);
  const float main = line(std::abs(x), fine * (y < kLeafStalk ? 0.02f : 0.016f * (1.15f - y)));
  const float root = y - std::abs(x) * slope - veins.bend * x * x;  // where its vein leaves
  const float phase = (root - kLeafStalk) / veins.spacing + (x > 0 ? 0.5f : 0.0f);
  const float first = x > 0 ? 0.4f : -0.1f;
  float side = line(std::abs(phase - std::round(phase)) * veins.spacing * sine,
                    fine * 0.0085f * (1.1f - glm::smoothstep(0.0f, 0.5f, std::abs(x))));
  if (std::round(phase) < first || y < kLeafStalk || root > 0.97f) side = 0;
  return {main, side};
}

/// A needle as a thin four-sided polygon in pixels, with its own brightness.
struct Needle {
  std::vector<glm::vec2> polygon;
  float low, high;  ///< rows that it touches
  float shade;
  bool shoot = false;
};

std::vector<Needle> makeNeedles(int size, std::uint32_t seed) {
  Random random(hash(seed ^ 0x6e65656465ull));
  std::vector<Needle> needles;
  const auto add = [&](glm::vec2 a, glm::vec2 b, float wa, float wb, float shade, bool shoot) {
    const auto side = static_cast<float>(size);
    // Leaf coordinates to pixels: foot at the lower edge.
    const auto pixel = [&](glm::vec2 p) {
      return glm::vec2((p.x + 0.5f) * side, (1 - p.y) * side);
    };
    const glm::vec2 d = glm::normalize(b - a);
    const glm::vec2 n(-d.y, d.x);
    const glm::vec2 middle = glm::mix(a, b, 0.6f);
    Needle needle;
    needle.polygon = {pixel(a + wa * n), pixel(middle + wa * n), pixel(b + wb * n),
                      pixel(b - wb * n), pixel(middle - wa * n), pixel(a - wa * n)};
    needle.low = 1e9f;
    needle.high = -1e9f;
    for (const glm::vec2& p : needle.polygon) {
      needle.low = std::min(needle.low, p.y);
      needle.high = std::max(needle.high, p.y);
    }
    needle.shade = shade;
    needle.shoot = shoot;
    needles.push_back(needle);
  };
  add({0, 0}, {0, 0.58f}, 0.013f, 0.01f, 1.0f, true);
  const int count = 46;
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + random.uniform()) / static_cast<float>(count);
    const float root = 0.03f + 0.55f * t;
    for (const float side : {-1.0f, 1.0f}) {
      // Needles lean forward, more so at the tip of the shoot.
      const float angle = (0.95f - 0.8f * t * t + random.vary(0.2f)) * side;
      const float length =
          std::min(random.uniform(0.36f, 0.47f), (0.985f - root) / std::max(std::cos(angle), 0.1f));
      const glm::vec2 foot(0, root);
      glm::vec2 tip = foot + length * glm::vec2(std::sin(angle), std::cos(angle));
      tip.x = std::clamp(tip.x, -0.485f, 0.485f);
      add(foot, tip, 0.0095f, 0.004f, random.uniform(0.72f, 1.12f), false);
    }
  }
  return needles;
}

void paintNeedles(const LeafLook& look, int size, int x0, int y0, std::uint32_t seed,
                  Image& image) {
  const std::vector<Needle> needles = makeNeedles(size, seed);
  const float mix_variant = Random(hash(seed + 5)).uniform(0.0f, 0.5f);
  const glm::vec3 green = glm::mix(look.color, look.other, mix_variant);
  parallelFor(static_cast<std::size_t>(size), 8, [&](std::size_t row_index) {
    const int y = static_cast<int>(row_index);
    const auto n = static_cast<std::size_t>(size);
    std::vector<glm::vec3> colors(n, green * 0.9f);
    std::vector<float> alpha(n, 0.0f), row(n);
    for (const Needle& needle : needles) {
      if (needle.high < static_cast<float>(y) || needle.low > static_cast<float>(y + 1)) continue;
      std::fill(row.begin(), row.end(), 0.0f);
      coverRow(needle.polygon, y, row);
      const glm::vec3 color = needle.shoot ? look.vein : green * needle.shade;
      for (std::size_t x = 0; x < n; ++x) {
        if (row[x] <= 0) continue;
        const float c = std::min(row[x], 1.0f);
        colors[x] = glm::mix(colors[x], color, c);
        alpha[x] = alpha[x] + (1 - alpha[x]) * c;
      }
    }
    for (std::size_t x = 0; x < n; ++x) {
      std::uint8_t* pixel = image.at(x0 + static_cast<int>(x), y0 + y);
      for (int c = 0; c < 3; ++c) pixel[c] = toByte(colors[x][c]);
      pixel[3] = toByte(alpha[x]);
    }
  });
}

void paintBlade(LeafShape shape, const LeafLook& look, float leaf_scale_x, int size, int x0, int y0,
                std::uint32_t seed, Image& image) {
  const auto side = static_cast<float>(size);
  std::vector<glm::vec2> polygon;
  for (const glm::vec2& p : leafOutline(shape))
    polygon.emplace_back((p.x + 0.5f) * side, (1 - p.y) * side);
  Random random(hash(seed));
  const float turned = random.uniform(0.0f, 0.45f);  // how far this leaf is towards `other`
  const float bright = random.uniform(0.9f, 1.08f);
  parallelFor(static_cast<std::size_t>(size), 8, [&](std::size_t row_index) {
    const int py = static_cast<int>(row_index);
    std::vector<float> alpha(static_cast<std::size_t>(size), 0.0f);
    coverRow(polygon, py, alpha);
    for (int px = 0; px < size; ++px) {
      const float u = (static_cast<float>(px) + 0.5f) / side;
      const float v = (static_cast<float>(py) + 0.5f) / side;
      const float x = (u - 0.5f) * leaf_scale_x, y = 1 - v;
      const glm::vec2 veins = veinsAt(shape, x, y, leaf_scale_x);
      const float mottle = fractalNoise(u, v, 5, 5, 4, seed + 1);
      const float grain = fractalNoise(u, v, 60, 60, 2, seed + 9);
      glm::vec3 color =
          glm::mix(look.color, look.other,
                   std::clamp(turned + 0.5f * (glm::smoothstep(0.42f, 0.75f, mottle)), 0.0f, 1.0f));
      color *= bright * (0.9f + 0.1f * mottle + 0.12f * grain);
      // The blade is paler along its veins, as if quilted.
      color = glm::mix(color, look.vein, 0.38f * veins.y);
      color = glm::mix(color, look.vein, 0.85f * veins.x);
      std::uint8_t* pixel = image.at(x0 + px, y0 + py);
      for (int c = 0; c < 3; ++c) pixel[c] = toByte(color[c]);
      pixel[3] = toByte(alpha[static_cast<std::size_t>(px)]);
    }
  });
}

}  // namespace

Image makeLeafTexture(LeafShape shape, const LeafLook& look, float leaf_scale_x, int size,
                      std::uint32_t seed) {
  Image image(size, size);
  const int half = size / 2;
  for (int k = 0; k < 4; ++k) {
    const auto own = static_cast<std::uint32_t>(hash(seed * 4u + static_cast<std::uint32_t>(k)));
    const int x0 = (k & 1) * half, y0 = (k >> 1) * half;
    if (shape == LeafShape::kNeedles) {
      paintNeedles(look, half, x0, y0, own, image);
    } else {
      paintBlade(shape, look, leaf_scale_x, half, x0, y0, own, image);
    }
  }
  return image;
}

}  // namespace verdure
