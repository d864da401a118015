#ifndef VERDURE_LEAF_HORIZON_H_
#define VERDURE_LEAF_HORIZON_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace verdure {

inline constexpr int kHorizonSlices = 16;

/// Horizon of every texel of a height field at 16 azimuths: Max, "Horizon Mapping", 1988, found as
/// Timonen and Westerholm do ("Scalable Height Field Self-Shadowing", 2010): along parallel lines,
/// each with the convex hull of what it has passed, so that a texel costs the same however far it
/// sees. What lies beyond a gap in the leaf is another leaf, and throws no shadow.
class Horizon {
 public:
  /// Planes of height x stride texels, rows from the top; heights in mm, `step_mm` a texel's width.
  Horizon(const std::vector<float>& heights, const std::vector<std::uint8_t>& inside, int width,
          int height, std::size_t stride, float step_mm);

  /// Azimuth of a slice in radians: 0 to the right, turning up.
  static double azimuth(int slice);
  /// Slopes (rise over run, at least 0) of the horizon at that azimuth; 0 outside the leaf.
  std::vector<float> slopes(int slice) const;

 private:
  /// The field with rows along the axis in which a line advances texel by texel.
  struct Field {
    int along = 0, across = 0;
    std::vector<float> heights;  ///< kNone outside the leaf
  };
  Field rows_, columns_;
  std::size_t stride_;
  float step_mm_;
};

}  // namespace verdure

#endif  // VERDURE_LEAF_HORIZON_H_
