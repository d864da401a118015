#include "leaf/leaf_raster.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace verdure {
namespace {

constexpr int kTile = 16;

std::size_t indexOf(int x, int y, int size) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
}

/// For each tile the strokes (texels) that come within `reach` plus their own radius of it.
struct Tiles {
  int count = 0;  ///< a side
  std::vector<std::vector<Stroke>> strokes;
};

Tiles tilesOf(std::span<const Stroke> strokes, float reach, const LeafFrame& frame) {
  Tiles tiles;
  tiles.count = (frame.size + kTile - 1) / kTile;
  tiles.strokes.resize(static_cast<std::size_t>(tiles.count) *
                       static_cast<std::size_t>(tiles.count));
  const float scale = 1 / frame.mmPerTexel();
  for (const Stroke& mm : strokes) {
    const Stroke s{frame.toTexel(mm.a), frame.toTexel(mm.b), mm.radius_a * scale,
                   mm.radius_b * scale};
    const float far = reach + std::max(s.radius_a, s.radius_b);
    const glm::vec2 low = glm::min(s.a, s.b) - far, high = glm::max(s.a, s.b) + far;
    const auto tile = [&](float v) {
      return std::clamp(static_cast<int>(std::floor(v / kTile)), 0, tiles.count - 1);
    };
    const glm::vec2 middle = 0.5f * (s.a + s.b), half = 0.5f * (s.b - s.a);
    const float length = glm::length(half);
    for (int ty = tile(low.y); ty <= tile(high.y); ++ty)
      for (int tx = tile(low.x); tx <= tile(high.x); ++tx) {
        const glm::vec2 center = (glm::vec2(tx, ty) + 0.5f) * static_cast<float>(kTile);
        if (glm::length(center - middle) > length + far + 0.71f * kTile) continue;
        tiles.strokes[indexOf(tx, ty, tiles.count)].push_back(s);
      }
  }
  return tiles;
}

/// body(x, y, strokes of that place) for each texel.
template <class Body>
void forTexels(const Tiles& tiles, int size, const Body& body) {
  parallelFor(static_cast<std::size_t>(tiles.count), 1, [&](std::size_t row) {
    const int y0 = static_cast<int>(row) * kTile;
    for (int tx = 0; tx < tiles.count; ++tx) {
      const auto& list = tiles.strokes[indexOf(tx, static_cast<int>(row), tiles.count)];
      for (int y = y0; y < std::min(y0 + kTile, size); ++y)
        for (int x = tx * kTile; x < std::min((tx + 1) * kTile, size); ++x) body(x, y, list);
    }
  });
}

/// Squared distance to the axis; `t` is the nearest point's place on it.
float squaredDistance(const glm::vec2& p, const Stroke& s, float& t) {
  const glm::vec2 ab = s.b - s.a, ap = p - s.a;
  t = std::clamp(glm::dot(ap, ab) / std::max(glm::dot(ab, ab), 1e-12f), 0.0f, 1.0f);
  const glm::vec2 d = ap - t * ab;
  return glm::dot(d, d);
}

}  // namespace

float frameExtent(const Polyline& outline) {
  float half = 0, top = 0;
  for (const glm::vec2& p : outline) {
    half = std::max(half, std::abs(p.x));
    top = std::max(top, p.y);
  }
  constexpr float kMargin = 0.015f;
  return std::max(top * (1 + kMargin), 2 * half * (1 + 2 * kMargin));
}

std::vector<float> coverageOf(const Polyline& polygon, const LeafFrame& frame) {
  const int size = frame.size;
  const auto side = static_cast<std::size_t>(size);
  // Each edge adds to all that lies right of it in its rows. What is stored is the change from
  // texel to texel; its running sum along the row is the coverage.
  std::vector<float> changes(side * side);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    glm::dvec2 a = frame.toTexel(polygon[i]), b = frame.toTexel(polygon[(i + 1) % polygon.size()]);
    if (a.y == b.y) continue;
    const double sign = a.y < b.y ? 1 : -1;
    if (a.y > b.y) std::swap(a, b);
    const double slope = (b.x - a.x) / (b.y - a.y);
    const int first = std::max(static_cast<int>(std::floor(a.y)), 0);
    const int end = std::min(static_cast<int>(std::ceil(b.y)), size);
    for (int y = first; y < end; ++y) {
      const double y0 = std::max<double>(y, a.y), y1 = std::min<double>(y + 1, b.y);
      const double xa = a.x + (y0 - a.y) * slope, xb = a.x + (y1 - a.y) * slope;
      const double low = std::clamp(std::min(xa, xb), 0.0, static_cast<double>(size));
      const double high = std::clamp(std::max(xa, xb), 0.0, static_cast<double>(size));
      // Integral up to x of the share of this piece of edge that lies left of x.
      const auto integral = [&](double x) {
        if (high - low < 1e-9) return std::max(x - low, 0.0);
        const double q = std::clamp(x, low, high) - low;
        return 0.5 * q * q / (high - low) + std::max(x - high, 0.0);
      };
      double before = 0;
      for (int x = static_cast<int>(low); x < size; ++x) {
        const double covered = integral(x + 1) - integral(x);
        changes[indexOf(x, y, size)] += static_cast<float>(sign * (y1 - y0) * (covered - before));
        before = covered;
        if (x >= high) break;
      }
    }
  }
  std::vector<float> coverage(side * side);
  parallelFor(side, 16, [&](std::size_t y) {
    double sum = 0;
    for (std::size_t i = y * side; i < (y + 1) * side; ++i) {
      sum += static_cast<double>(changes[i]);
      // What rounding leaves over is no coverage.
      const double share = std::abs(sum);
      coverage[i] = share < 1e-5 ? 0.0f : share > 1 - 1e-5 ? 1.0f : static_cast<float>(share);
    }
  });
  return coverage;
}

std::vector<float> distanceTo(std::span<const Stroke> strokes, float reach_mm,
                              const LeafFrame& frame) {
  const float scale = 1 / frame.mmPerTexel(), reach = reach_mm * scale;
  Tiles tiles = tilesOf(strokes, reach, frame);
  // Where one stroke is nearer to a whole tile than another is to any of it, the other goes.
  parallelFor(tiles.strokes.size(), 64, [&](std::size_t i) {
    const auto count = static_cast<std::size_t>(tiles.count);
    const glm::vec2 center = (glm::vec2(i % count, i / count) + 0.5f) * static_cast<float>(kTile);
    float nearest = 1e30f, t;
    for (const Stroke& s : tiles.strokes[i])
      nearest = std::min(nearest, std::sqrt(squaredDistance(center, s, t)));
    const float far = nearest + 1.42f * kTile;  // the tile's diagonal
    std::erase_if(tiles.strokes[i],
                  [&](const Stroke& s) { return squaredDistance(center, s, t) > far * far; });
  });
  const auto side = static_cast<std::size_t>(frame.size);
  std::vector<float> distance(side * side);
  forTexels(tiles, frame.size, [&](int x, int y, const std::vector<Stroke>& list) {
    const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    float best = reach * reach, t;
    for (const Stroke& s : list) best = std::min(best, squaredDistance(p, s, t));
    distance[indexOf(x, y, frame.size)] = std::sqrt(best) * frame.mmPerTexel();
  });
  return distance;
}

Ridges ridgesOf(std::span<const Stroke> strokes, const LeafFrame& frame) {
  const Tiles tiles = tilesOf(strokes, 1.0f, frame);
  const auto side = static_cast<std::size_t>(frame.size);
  Ridges ridges{std::vector<float>(side * side), std::vector<float>(side * side)};
  constexpr float kThinnest = 0.75f;  // texels
  const float strong = 0.07f / frame.mmPerTexel();
  forTexels(tiles, frame.size, [&](int x, int y, const std::vector<Stroke>& list) {
    const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    float height = 0, tone = 0, t;
    for (const Stroke& s : list) {
      const float d2 = squaredDistance(p, s, t);
      const float radius = glm::mix(s.radius_a, s.radius_b, t);
      const float wide = std::max(radius, kThinnest);
      if (d2 >= wide * wide) continue;
      // Half a cylinder; (radius / wide)^2 keeps the cross-section's area.
      const float share = radius / wide, off = 1 - d2 / (wide * wide);
      height = std::max(height, std::sqrt(off) * radius * share);
      tone = std::max(tone, share * (1 - std::exp(-radius / strong)) * std::min(1.8f * off, 1.0f));
    }
    ridges.height[indexOf(x, y, frame.size)] = height * frame.mmPerTexel();
    ridges.tone[indexOf(x, y, frame.size)] = tone;
  });
  return ridges;
}

std::vector<float> signedDistance(const Polyline& outline, float reach_mm, const LeafFrame& frame) {
  std::vector<Stroke> edges;
  for (std::size_t i = 0; i < outline.size(); ++i)
    edges.push_back({outline[i], outline[(i + 1) % outline.size()]});
  std::vector<float> distance = distanceTo(edges, reach_mm, frame);
  const auto side = static_cast<std::size_t>(frame.size);
  parallelFor(side, 8, [&](std::size_t row) {
    const float y = frame.toMm({0, static_cast<float>(row) + 0.5f}).y;
    std::vector<float> crossings;
    for (const Stroke& e : edges)
      if ((e.a.y > y) != (e.b.y > y)) {
        const float x = e.a.x + (y - e.a.y) / (e.b.y - e.a.y) * (e.b.x - e.a.x);
        crossings.push_back(frame.toTexel({x, y}).x);
      }
    std::sort(crossings.begin(), crossings.end());
    std::size_t passed = 0;
    for (std::size_t x = 0; x < side; ++x) {
      while (passed < crossings.size() && crossings[passed] < static_cast<float>(x) + 0.5f)
        ++passed;
      if (passed % 2 == 0) distance[row * side + x] = -distance[row * side + x];
    }
  });
  return distance;
}

namespace {

/// Mean over 2 r + 1 values along a line of `n` values `stride` apart; ends repeat.
void boxFilter(const float* in, float* out, int n, std::size_t stride, int r) {
  const auto at = [&](int i) {
    return in[static_cast<std::size_t>(std::clamp(i, 0, n - 1)) * stride];
  };
  double sum = 0;
  for (int i = -r; i <= r; ++i) sum += static_cast<double>(at(i));
  const double weight = 1.0 / (2 * r + 1);
  for (int i = 0; i < n; ++i) {
    out[static_cast<std::size_t>(i) * stride] = static_cast<float>(sum * weight);
    sum += static_cast<double>(at(i + r + 1)) - static_cast<double>(at(i - r));
  }
}

}  // namespace

void blur(std::vector<float>& map, int size, float sigma) {
  // Three boxes of half width r have the variance r (r + 1); two neighbouring r are mixed.
  const auto side = static_cast<std::size_t>(size);
  const int r = static_cast<int>(0.5f * (std::sqrt(1 + 4 * sigma * sigma) - 1));
  const auto whole = static_cast<float>(r);
  const float more = (sigma * sigma - whole * (whole + 1)) / (2 * (whole + 1));
  std::vector<float> other(map.size());
  const auto pass = [&](bool rows) {
    parallelFor(side, 16, [&](std::size_t line) {
      const std::size_t start = rows ? line * side : line, stride = rows ? 1 : side;
      std::vector<float> a(side), b(side);
      for (std::size_t i = 0; i < side; ++i) a[i] = map[start + i * stride];
      for (int k = 0; k < 3; ++k) {
        std::vector<float> wide(side);
        boxFilter(a.data(), b.data(), size, 1, r);
        boxFilter(a.data(), wide.data(), size, 1, r + 1);
        for (std::size_t i = 0; i < side; ++i) a[i] = b[i] + more * (wide[i] - b[i]);
      }
      for (std::size_t i = 0; i < side; ++i) map[start + i * stride] = a[i];
    });
  };
  pass(true);
  pass(false);
}

}  // namespace verdure
