#include "rays/cut_table.h"

#include <algorithm>
#include <cmath>

namespace verdure {
namespace {

/// The range of x that a triangle covers between two values of y.
struct Extent {
  float low = 1e30f, high = -1e30f;
  void add(float x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

Extent extentInBand(const std::array<glm::vec2, 3>& p, float y0, float y1) {
  Extent extent;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec2 a = p[i], b = p[(i + 1) % 3];
    if (a.y >= y0 && a.y <= y1) extent.add(a.x);
    for (const float y : {y0, y1})
      if ((a.y < y) != (b.y < y)) extent.add(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
  }
  return extent;
}

int wrapped(int i, int size, bool clamps) {
  if (clamps) return std::clamp(i, -1, size - 1);
  const int rest = i % size;
  return rest < 0 ? rest + size : rest;
}

}  // namespace

CutTable::CutTable(const Texture& texture, float cutoff)
    : grid_(texture), cutoff_(cutoff * 255.0f), columns_(texture.image.width + 1) {
  const Image& image = texture.image;
  const int w = image.width, h = image.height;
  cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(h + 1));
  run_end_.resize(cells_.size());
  const auto texel = [](int i, int size, bool clamps) {
    if (clamps) return std::clamp(i, 0, size - 1);
    return (i + size) % size;
  };
  for (int y = -1; y < h; ++y) {
    const int ys[] = {texel(y, h, grid_.clampV()), texel(y + 1, h, grid_.clampV())};
    for (int x = w - 1; x >= -1; --x) {
      const int xs[] = {texel(x, w, grid_.clampU()), texel(x + 1, w, grid_.clampU())};
      int opaque = 0;
      for (const int j : ys)
        for (const int i : xs) opaque += static_cast<float>(image.at(i, j)[3]) >= cutoff_;
      const std::size_t c = cellIndex(x, y);
      cells_[c] = opaque == 4 ? Cut::kOpaque : opaque == 0 ? Cut::kTransparent : Cut::kMixed;
      run_end_[c] = x < w - 1 && cells_[c] == cells_[c + 1] ? run_end_[c + 1] : x;
    }
  }
}

/// Whether all cells of a row's range are of one kind, that of `seen` if it has a value.
bool CutTable::uniform(int first_x, int last_x, int y, std::optional<Cut>& seen) const {
  const int w = grid_.width();
  if (grid_.clampU()) {
    first_x = std::clamp(first_x, -1, w - 1);
    last_x = std::clamp(last_x, -1, w - 1);
  } else {
    last_x = std::min(last_x, first_x + w - 1);
  }
  for (int x = first_x; x <= last_x;) {
    const int cell_x = wrapped(x, w, grid_.clampU());
    const std::size_t c = cellIndex(cell_x, y);
    if (cells_[c] == Cut::kMixed || (seen && *seen != cells_[c])) return false;
    seen = cells_[c];
    x += run_end_[c] - cell_x + 1;
  }
  return true;
}

Cut CutTable::classify(const std::array<glm::vec2, 3>& uvs) const {
  const glm::vec2 size(static_cast<float>(grid_.width()), static_cast<float>(grid_.height()));
  std::array<glm::vec2, 3> p;
  float largest = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = uvs[i] * size - 0.5f;
    largest = std::max(largest, std::max(std::abs(p[i].x), std::abs(p[i].y)));
    if (!(std::abs(p[i].x) < 1e6f && std::abs(p[i].y) < 1e6f)) return Cut::kMixed;
  }
  // Sampling rounds: so far a point may stray over the border of a cell.
  const float margin = 1e-3f + 1e-6f * largest;
  const float low = std::min({p[0].y, p[1].y, p[2].y}) - margin;
  const float high = std::max({p[0].y, p[1].y, p[2].y}) + margin;
  constexpr int kMostRows = 16384;
  const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::floor(high));
  if (last - first > kMostRows) return Cut::kMixed;
  std::optional<Cut> seen;
  for (int y = first; y <= last; ++y) {
    const Extent extent =
        extentInBand(p, static_cast<float>(y) - margin, static_cast<float>(y + 1) + margin);
    if (extent.low > extent.high) continue;
    if (!uniform(static_cast<int>(std::floor(extent.low - margin)),
                 static_cast<int>(std::floor(extent.high + margin)),
                 wrapped(y, grid_.height(), grid_.clampV()), seen))
      return Cut::kMixed;
  }
  return seen.value_or(Cut::kMixed);
}

}  // namespace verdure
