#include "grass/draw_ribbons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/parallel.h"

namespace verdure {
namespace {

/// Samples a texel along each axis.
constexpr int kSamples = 4;
/// Texels of a block, which one thread draws.
constexpr int kBlock = 32;
constexpr int kBlockSamples = kBlock * kSamples;

/// A corner of a strip as it is drawn: place in samples, depth towards the looker, looks.
struct Corner {
  float x, y, depth;
  glm::vec3 color;
  glm::vec2 normal;
};

/// What is nearest at a sample.
struct Sample {
  glm::vec3 color;
  glm::vec2 normal;
  float transmitted, rank;
};

/// A ribbon as it is drawn, left and right corners in turn.
struct Strip {
  std::array<Corner, static_cast<std::size_t>(2 * kRibbonStations)> corners;
  std::size_t count = 0;
};

/// The samples of a block; those at depth kNothing show nothing.
struct Samples {
  std::vector<float> depths;
  std::vector<Sample> looks;
};
constexpr float kNothing = -1e30f;

/// A ribbon in a block, moved by whole pictures.
struct Entry {
  std::uint32_t ribbon;
  std::int8_t shift_x, shift_y;
};

struct Box {
  float x0 = 1e30f, x1 = -1e30f, y0 = 1e30f, y1 = -1e30f;
};

class Picture {
 public:
  Picture(const std::vector<DrawnRibbon>& ribbons, const RibbonView& view)
      : ribbons_(ribbons),
        view_(view),
        columns_((view.width + kBlock - 1) / kBlock),
        rows_((view.height + kBlock - 1) / kBlock),
        per_m_(static_cast<float>(view.width * kSamples) / view.width_m,
               static_cast<float>(view.height * kSamples) / view.height_m),
        blocks_(static_cast<std::size_t>(columns_ * rows_)) {}

  GrassMap draw() {
    sortIntoBlocks();
    GrassMap map;
    map.width = view_.width;
    map.height = view_.height;
    map.color.resize(map.texelCount());
    map.data.resize(map.texelCount());
    parallelFor(blocks_.size(), 1, [&](std::size_t block) { drawBlock(block, map); });
    return map;
  }

 private:
  glm::vec2 place(const glm::vec3& p) const {
    return {glm::dot(p, view_.right) * per_m_.x, (view_.top_m - glm::dot(p, view_.up)) * per_m_.y};
  }

  Strip stripOf(const DrawnRibbon& drawn) const {
    Strip strip;
    const shared::GrassRibbon& r = drawn.ribbon;
    // Every second station is enough for what is short in the picture or nearly straight.
    const bool coarse = r.profile != shared::kRibbonOval &&
                        (std::abs(r.bend) < 0.2f || r.span * per_m_.x < 20.0f * kSamples);
    for (int k = 0; k < kRibbonStations; k += coarse ? 2 : 1) {
      const float s = static_cast<float>(k) / (kRibbonStations - 1);
      const glm::vec3 middle = shared::ribbonPoint(r, s);
      const glm::vec3 half = 0.5f * shared::ribbonWidth(r.profile, r.width, s) *
                             shared::ribbonAcross(r, s, view_.toward);
      const glm::vec3 color = glm::mix(drawn.root_color, drawn.tip_color, s);
      for (int side = 0; side < 2; ++side) {
        const float t = side == 0 ? -1.0f : 1.0f;
        const glm::vec3 p = middle + t * half;
        const glm::vec2 at = place(p);
        const glm::vec3 n = shared::ribbonNormal(r, s, t, view_.toward);
        strip.corners[strip.count++] = {at.x,
                                        at.y,
                                        glm::dot(p, view_.toward),
                                        color,
                                        {glm::dot(n, view_.right), glm::dot(n, view_.up)}};
      }
    }
    return strip;
  }

  void sortIntoBlocks() {
    std::vector<Box> boxes(ribbons_.size());
    std::vector<std::pair<float, std::uint32_t>> order(ribbons_.size());
    strips_.resize(ribbons_.size());
    parallelFor(ribbons_.size(), 256, [&](std::size_t i) {
      strips_[i] = stripOf(ribbons_[i]);
      Box& box = boxes[i];
      float low = 1e30f, high = -1e30f;
      for (std::size_t k = 0; k < strips_[i].count; ++k) {
        const Corner& c = strips_[i].corners[k];
        box = {std::min(box.x0, c.x), std::max(box.x1, c.x), std::min(box.y0, c.y),
               std::max(box.y1, c.y)};
        low = std::min(low, c.depth);
        high = std::max(high, c.depth);
      }
      if (high < view_.from_m || low >= view_.to_m) box = Box{};
      order[i] = {-high, static_cast<std::uint32_t>(i)};
    });
    // What is behind is then seldom drawn only to be drawn over.
    std::sort(order.begin(), order.end());
    const auto width = static_cast<float>(view_.width * kSamples);
    const auto height = static_cast<float>(view_.height * kSamples);
    const int down = view_.repeats_down ? 1 : 0;
    for (const auto& [nearness, i] : order)
      for (int sy = -down; sy <= down; ++sy)
        for (int sx = -1; sx <= 1; ++sx) {
          const float dx = static_cast<float>(sx) * width, dy = static_cast<float>(sy) * height;
          const Box b{boxes[i].x0 + dx, boxes[i].x1 + dx, boxes[i].y0 + dy, boxes[i].y1 + dy};
          if (!(b.x0 < width && b.x1 >= 0 && b.y0 < height && b.y1 >= 0)) continue;
          const auto blockOf = [](float at, int count) {
            return std::clamp(static_cast<int>(at) / kBlockSamples, 0, count - 1);
          };
          for (int y = blockOf(b.y0, rows_); y <= blockOf(b.y1, rows_); ++y)
            for (int x = blockOf(b.x0, columns_); x <= blockOf(b.x1, columns_); ++x)
              blocks_[static_cast<std::size_t>(y * columns_ + x)].push_back(
                  {i, static_cast<std::int8_t>(sx), static_cast<std::int8_t>(sy)});
        }
  }

  void drawBlock(std::size_t block, GrassMap& map) const {
    const int left = static_cast<int>(block) % columns_ * kBlock;
    const int top = static_cast<int>(block) / columns_ * kBlock;
    if (blocks_[block].empty()) return;
    static thread_local Samples samples;
    constexpr std::size_t kCount = std::size_t{kBlockSamples} * kBlockSamples;
    samples.depths.assign(kCount, kNothing);
    samples.looks.resize(kCount);
    for (const Entry& entry : blocks_[block]) {
      const DrawnRibbon& drawn = ribbons_[entry.ribbon];
      Strip strip = strips_[entry.ribbon];
      auto& corners = strip.corners;
      for (std::size_t k = 0; k < strip.count; ++k) {
        corners[k].x += static_cast<float>((entry.shift_x * view_.width - left) * kSamples);
        corners[k].y += static_cast<float>((entry.shift_y * view_.height - top) * kSamples);
      }
      for (std::size_t k = 0; k + 2 < strip.count; k += 2) {
        drawTriangle(corners[k], corners[k + 1], corners[k + 3], drawn, samples);
        drawTriangle(corners[k], corners[k + 3], corners[k + 2], drawn, samples);
      }
    }
    average(samples, left, top, map);
  }

  /// Samples on a shared edge belong to both triangles: nothing shows through.
  void drawTriangle(const Corner& a, const Corner& b, const Corner& c, const DrawnRibbon& drawn,
                    Samples& samples) const {
    const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0.0f || std::max({a.depth, b.depth, c.depth}) < view_.from_m ||
        std::min({a.depth, b.depth, c.depth}) >= view_.to_m)
      return;
    // The least and the last sample whose middle may be inside.
    const auto first = [](float least) { return std::max(0, static_cast<int>(least - 0.5f)); };
    const auto last = [](float most) {
      return std::min(kBlockSamples - 1, static_cast<int>(std::max(most + 0.5f, -1.0f)));
    };
    const int x0 = first(std::min({a.x, b.x, c.x})), x1 = last(std::max({a.x, b.x, c.x}));
    const int y0 = first(std::min({a.y, b.y, c.y})), y1 = last(std::max({a.y, b.y, c.y}));
    if (x0 > x1 || y0 > y1) return;
    // Shares of the corners change evenly along x.
    const float scale = 1.0f / area;
    const float step_b = (c.y - a.y) * scale, step_c = (a.y - b.y) * scale;
    const float step_a = -step_b - step_c;
    const float per_a = 1.0f / step_a, per_b = 1.0f / step_b, per_c = 1.0f / step_c;
    const float down_b = (a.x - c.x) * scale, down_c = (b.x - a.x) * scale;
    const float px = static_cast<float>(x0) + 0.5f - a.x;
    const float first_b = px * step_b, first_c = px * step_c;
    for (int y = y0; y <= y1; ++y) {
      const float py = static_cast<float>(y) + 0.5f - a.y;
      const float row_b = first_b + py * down_b, row_c = first_c + py * down_c;
      // Where all three shares are positive, and a little more, so that no gaps are left.
      float from = 0.0f, to = static_cast<float>(x1 - x0);
      const auto cut = [&](float row_share, float step, float per_step) {
        if (step > 0.0f)
          from = std::max(from, -row_share * per_step);
        else if (step < 0.0f)
          to = std::min(to, -row_share * per_step);
        else if (row_share < 0.0f)
          to = -1.0f;
      };
      cut(1.0f - row_b - row_c, step_a, per_a);
      cut(row_b, step_b, per_b);
      cut(row_c, step_c, per_c);
      if (!(from <= to)) continue;
      const int first_x = x0 + static_cast<int>(from + 0.999f);
      const int last_x = std::min(x1, x0 + static_cast<int>(to + 0.001f));
      for (int x = first_x; x <= last_x; ++x) {
        const auto along = static_cast<float>(x - x0);
        // What lies in the slack of a sliver would be far outside of its corners.
        const float share_b = std::clamp(row_b + along * step_b, 0.0f, 1.0f);
        const float share_c = std::clamp(row_c + along * step_c, 0.0f, 1.0f - share_b);
        const float share_a = 1.0f - share_b - share_c;
        const float depth = share_a * a.depth + share_b * b.depth + share_c * c.depth;
        const auto at = static_cast<std::size_t>(y * kBlockSamples + x);
        if (depth <= samples.depths[at] || depth < view_.from_m || depth >= view_.to_m) continue;
        samples.depths[at] = depth;
        Sample& look = samples.looks[at];
        look.color = share_a * a.color + share_b * b.color + share_c * c.color;
        look.normal = share_a * a.normal + share_b * b.normal + share_c * c.normal;
        look.transmitted = drawn.transmitted;
        look.rank = drawn.rank;
      }
    }
  }

  void average(const Samples& samples, int left, int top, GrassMap& map) const {
    constexpr float kShare = 1.0f / (kSamples * kSamples);
    for (int y = 0; y < std::min(kBlock, view_.height - top); ++y)
      for (int x = 0; x < std::min(kBlock, view_.width - left); ++x) {
        glm::vec4 color(0.0f), data(0.0f);
        for (int j = 0; j < kSamples; ++j) {
          const int first = (y * kSamples + j) * kBlockSamples + x * kSamples;
          for (int i = first; i < first + kSamples; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (samples.depths[at] == kNothing) continue;
            const Sample& look = samples.looks[at];
            color += glm::vec4(look.color, 1.0f);
            data += glm::vec4(look.normal, look.transmitted, look.rank);
          }
        }
        const auto at = static_cast<std::size_t>(top + y) * static_cast<std::size_t>(map.width) +
                        static_cast<std::size_t>(left + x);
        map.color[at] = color * kShare;
        map.data[at] = data * kShare;
      }
  }

  const std::vector<DrawnRibbon>& ribbons_;
  const RibbonView& view_;
  int columns_, rows_;         ///< of blocks
  glm::vec2 per_m_;            ///< samples
  std::vector<Strip> strips_;  ///< of the ribbons
  std::vector<std::vector<Entry>> blocks_;
};

}  // namespace

GrassMap drawRibbons(const std::vector<DrawnRibbon>& ribbons, const RibbonView& view) {
  return Picture(ribbons, view).draw();
}

}  // namespace verdure
