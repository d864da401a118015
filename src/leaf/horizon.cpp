#include "leaf/horizon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace verdure {
namespace {

constexpr float kNone = -1e30f;  // no height, no slope: outside the leaf

struct HullPoint {
  float at, height;
};

}  // namespace

Horizon::Horizon(const std::vector<float>& heights, const std::vector<std::uint8_t>& inside,
                 int width, int height, std::size_t stride, float step_mm)
    : stride_(stride), step_mm_(step_mm) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  rows_.heights.resize(w * h);
  columns_.heights.resize(w * h);
  rows_.along = columns_.across = width;
  rows_.across = columns_.along = height;
  parallelFor(h, 16, [&](std::size_t y) {
    for (std::size_t x = 0; x < w; ++x)
      rows_.heights[y * w + x] = inside[y * stride + x] != 0 ? heights[y * stride + x] : kNone;
  });
  parallelChunks(w, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = 0; y < h; ++y)
      for (std::size_t x = begin; x < end; ++x)
        columns_.heights[x * h + y] = rows_.heights[y * w + x];
  });
}

double Horizon::azimuth(int slice) {
  return 2.0 * std::numbers::pi * slice / kHorizonSlices;
}

std::vector<float> Horizon::slopes(int slice) const {
  const double dx = std::cos(azimuth(slice)), dy = -std::sin(azimuth(slice));
  const bool transposed = std::abs(dy) > std::abs(dx);
  const Field& field = transposed ? columns_ : rows_;
  const double major = transposed ? dy : dx, minor = transposed ? dx : dy;
  double lean = minor / major;  // texels across per texel along
  if (std::abs(lean - std::round(lean)) < 1e-9) lean = std::round(lean);
  const auto along = static_cast<std::size_t>(field.along);
  const auto across = static_cast<std::size_t>(field.across);
  const auto drift = static_cast<int>(std::ceil(std::abs(lean) * (field.along - 1)));
  const int first_line = lean > 0 ? -drift : 0;
  const auto lines = static_cast<std::size_t>(field.across + drift + 1);
  const auto per_texel = static_cast<float>(1.0 / (double{step_mm_} * std::hypot(1.0, lean)));

  // Line l passes through (a, first_line + l + lean a): where it is between two rows hangs on a.
  struct Crossing {
    std::ptrdiff_t row;  ///< less first_line + l
    float share;         ///< of the row after it
  };
  std::vector<Crossing> crossings;
  for (std::size_t a = 0; a < along; ++a) {
    const double b = lean * static_cast<double>(a);
    crossings.push_back(
        {static_cast<std::ptrdiff_t>(std::floor(b)), static_cast<float>(b - std::floor(b))});
  }

  std::vector<float> found(lines * along);
  parallelChunks(lines, 8, [&](std::size_t begin, std::size_t end) {
    std::vector<HullPoint> hull(along);
    for (std::size_t l = begin; l < end; ++l) {
      std::size_t size = 0;
      const std::ptrdiff_t start = first_line + static_cast<std::ptrdiff_t>(l);
      for (std::size_t k = 0; k < along; ++k) {
        // From the far end towards the light's azimuth back.
        const std::size_t a = major > 0 ? along - 1 - k : k;
        const std::ptrdiff_t row = start + crossings[a].row;
        const float share = crossings[a].share;
        const auto sample = [&](std::ptrdiff_t j) {
          return j >= 0 && j < static_cast<std::ptrdiff_t>(across)
                     ? field.heights[static_cast<std::size_t>(j) * along + a]
                     : kNone;
        };
        const float low = sample(row), high = share > 0.0f ? sample(row + 1) : low;
        float& slope = found[l * along + a];
        if ((share < 0.5f ? low : high) == kNone) {
          size = 0;
          slope = kNone;
          continue;
        }
        const float height = low == kNone ? high : high == kNone ? low : low + share * (high - low);
        const auto at = static_cast<float>(k);
        // The hull's point that is seen highest from here; those before it are hidden for ever.
        while (size >= 2) {
          const HullPoint &near = hull[size - 1], &far = hull[size - 2];
          if ((near.height - height) * (at - far.at) > (far.height - height) * (at - near.at))
            break;
          --size;
        }
        slope = size == 0 ? 0.0f
                          : std::max(0.0f, (hull[size - 1].height - height) /
                                               (at - hull[size - 1].at) * per_texel);
        hull[size++] = {at, height};
      }
    }
  });

  // Each texel lies between two lines, and at least the nearer one passes through the leaf there.
  std::vector<float> slopes(stride_ * static_cast<std::size_t>(rows_.across), 0.0f);
  const auto resample = [&](std::size_t j, std::size_t a) {
    if (field.heights[j * along + a] == kNone) return 0.0f;
    // The line through this texel would begin at j - lean a.
    const Crossing& c = crossings[a];
    const std::ptrdiff_t line = static_cast<std::ptrdiff_t>(j) - c.row - first_line;
    const std::size_t after = static_cast<std::size_t>(line) * along + a;
    const float high = found[after];
    const float low = c.share > 0.0f && line > 0 ? found[after - along] : high;
    const float slope = low == kNone ? high : high == kNone ? low : high + c.share * (low - high);
    return std::max(slope, 0.0f);
  };
  if (transposed) {
    parallelChunks(along, 32, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = 0; j < across; ++j)
        for (std::size_t a = begin; a < end; ++a) slopes[a * stride_ + j] = resample(j, a);
    });
  } else {
    parallelFor(across, 8, [&](std::size_t j) {
      for (std::size_t a = 0; a < along; ++a) slopes[j * stride_ + a] = resample(j, a);
    });
  }
  return slopes;
}

}  // namespace verdure
