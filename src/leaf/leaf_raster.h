#ifndef VERDURE_LEAF_LEAF_RASTER_H_
#define VERDURE_LEAF_LEAF_RASTER_H_

#include <span>
#include <vector>

#include "leaf/outline_curve.h"

// From millimetres to texels.

namespace verdure {

/// A square image of the leaf's plane: the foot of the stalk, the origin, is the middle of the
/// lower edge. Texel (i, j) covers [i, i + 1] x [j, j + 1], rows from the top.
struct LeafFrame {
  int size = 0;
  float extent_mm = 0;  ///< a side
  float mmPerTexel() const { return extent_mm / static_cast<float>(size); }
  glm::vec2 toTexel(const glm::vec2& mm) const {
    const float s = static_cast<float>(size) / extent_mm;
    return {0.5f * static_cast<float>(size) + mm.x * s, static_cast<float>(size) - mm.y * s};
  }
  glm::vec2 toMm(const glm::vec2& texel) const {
    const float s = mmPerTexel();
    return {(texel.x - 0.5f * static_cast<float>(size)) * s,
            (static_cast<float>(size) - texel.y) * s};
  }
};

/// LeafFrame::extent_mm of the smallest frame that shows the polygon with a margin.
float frameExtent(const Polyline& outline);

/// Share of each texel that a simple polygon (mm) covers, exactly: size x size values in [0, 1].
std::vector<float> coverageOf(const Polyline& polygon, const LeafFrame& frame);

/// A line of varying half width, mm.
struct Stroke {
  glm::vec2 a, b;
  float radius_a = 0, radius_b = 0;
};

/// At each texel's centre: distance to the nearest stroke's axis, at most `reach`, mm.
std::vector<float> distanceTo(std::span<const Stroke> strokes, float reach_mm,
                              const LeafFrame& frame);

struct Ridges {
  std::vector<float> height;  ///< mm: strokes as half cylinders
  std::vector<float> tone;    ///< [0, 1]: strokes as lines, the fainter the thinner
};

/// The highest and the strongest stroke at each texel's centre. Strokes thinner than a texel become
/// as wide as one and lose as much height and tone.
Ridges ridgesOf(std::span<const Stroke> strokes, const LeafFrame& frame);

/// Distance to the outline, positive inside, within [-reach, reach], at texel centres.
std::vector<float> signedDistance(const Polyline& outline, float reach_mm, const LeafFrame& frame);

/// A Gaussian of standard deviation sigma (texels) by three box filters each way; borders repeat.
void blur(std::vector<float>& map, int size, float sigma);

}  // namespace verdure

#endif  // VERDURE_LEAF_LEAF_RASTER_H_
