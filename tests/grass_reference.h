#ifndef VERDURE_TESTS_GRASS_REFERENCE_H_
#define VERDURE_TESTS_GRASS_REFERENCE_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "motion/motion_tables.h"
#include "render/packed_grass.h"
#include "scene/camera.h"
#include "scene/ground_texture.h"
#include "scene/look.h"
#include "shared/color.h"
#include "shared/sky.h"
#include "verdure/render.h"

/// Grass by brute force: all slices that a ray crosses, found from their numbers, sorted by
/// distance and composited in double precision. It shares the hashes and small formulas of
/// shared/grass.h with the renderer, but neither its walk through the slices nor its paths over the
/// ground.
namespace verdure::test {

/// A picture of bytes as samplers read it.
class ReferenceTexture {
 public:
  ReferenceTexture(const std::vector<gpu::MipLevel>& mips, bool srgb) {
    for (const gpu::MipLevel& mip : mips) {
      Level& level = levels_.emplace_back();
      level.width = static_cast<std::int64_t>(mip.width);
      level.height = static_cast<std::int64_t>(mip.height);
      level.texels.resize(mip.rgba.size() / 4);
      for (std::size_t i = 0; i < mip.rgba.size(); ++i) {
        const double value = mip.rgba[i] / 255.0;
        level.texels[i / 4][static_cast<int>(i % 4)] = srgb && i % 4 != 3 ? linear(value) : value;
      }
    }
  }

  /// Repeats to the right, and down if asked to; else goes on as its edges.
  glm::dvec4 at(double u, double v, double lod, bool repeat_down) const {
    const double last = static_cast<double>(levels_.size() - 1);
    const double level = std::clamp(lod, 0.0, last), below = std::floor(level);
    const auto first = static_cast<std::size_t>(below);
    const glm::dvec4 fine = levels_[first].at(u, v, repeat_down);
    if (below == level) return fine;
    return glm::mix(fine, levels_[first + 1].at(u, v, repeat_down), level - below);
  }

 private:
  struct Level {
    std::int64_t width = 0, height = 0;
    std::vector<glm::dvec4> texels;

    glm::dvec4 at(double u, double v, bool repeat_down) const {
      const double x = u * static_cast<double>(width) - 0.5;
      const double y = v * static_cast<double>(height) - 0.5;
      const double left = std::floor(x), top = std::floor(y);
      const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
      const auto texel = [&](std::int64_t column, std::int64_t row) {
        column = (column % width + width) % width;
        row = repeat_down ? (row % height + height) % height
                          : std::clamp<std::int64_t>(row, 0, height - 1);
        return texels[static_cast<std::size_t>(row * width + column)];
      };
      return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), x - left),
                      glm::mix(texel(i, j + 1), texel(i + 1, j + 1), x - left), y - top);
    }
  };
  static double linear(double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  std::vector<Level> levels_;
};

/// Height field between its samples and beyond them, exactly.
class ReferenceGround {
 public:
  explicit ReferenceGround(const Terrain& terrain) : terrain_(terrain) {}

  double heightAt(const glm::dvec2& place) const {
    const glm::dvec2 last(terrain_.width - 1, terrain_.height - 1);
    const glm::dvec2 at =
        glm::clamp((place - glm::dvec2(terrain_.corner)) / glm::dvec2(terrain_.spacing_m),
                   glm::dvec2(0.0), last);
    const glm::dvec2 before = glm::min(glm::floor(at), last - 1.0), share = at - before;
    const auto width = static_cast<std::size_t>(terrain_.width);
    const float* h = &terrain_.heights[static_cast<std::size_t>(before.y) * width +
                                       static_cast<std::size_t>(before.x)];
    return std::lerp(std::lerp(double{h[0]}, double{h[1]}, share.x),
                     std::lerp(double{h[width]}, double{h[width + 1]}, share.x), share.y);
  }

  /// Where a ray crosses lines between samples, t in (0, far), sorted, with 0 and far.
  std::vector<double> seams(const glm::dvec3& eye, const glm::dvec3& direction, double far) const {
    std::vector<double> t{0.0, far};
    const auto add = [&](double start, double step, double corner, double spacing, int count) {
      if (step == 0.0) return;
      const double a = (start - corner) / spacing, b = a + step * far / spacing;
      const auto first = std::max(static_cast<int>(std::floor(std::min(a, b))), 0);
      const auto last = std::min(static_cast<int>(std::ceil(std::max(a, b))), count - 1);
      for (int i = first; i <= last; ++i)
        if (const double at = (corner + i * spacing - start) / step; at > 0.0 && at < far)
          t.push_back(at);
    };
    add(eye.x, direction.x, double{terrain_.corner.x}, double{terrain_.spacing_m.x},
        terrain_.width);
    add(eye.z, direction.z, double{terrain_.corner.y}, double{terrain_.spacing_m.y},
        terrain_.height);
    std::sort(t.begin(), t.end());
    return t;
  }

 private:
  Terrain terrain_;
};

/// What a ray through grass has met. Distances from the eye; below 0: none.
struct SeenGrass {
  glm::dvec3 color{0.0};  ///< premultiplied reflectance
  double alpha = 0.0;
  double depth = -1.0;       ///< where alpha passed what writes depth
  double depth_alpha = 0.0;  ///< alpha there
  int slices = 0;
};

class GrassReference {
 public:
  /// Looks for grass up to `far` from the eye, m.
  GrassReference(const GrassLayer& layer, const Terrain& ground, const View& view,
                 double far = 200.0)
      : layer_(layer),
        set_(*layer.set),
        packed_(packGrass(layer)),
        ground_(ground),
        ground_picture_(packed_.ground_colors[0], true),
        noise_({noiseLevel()}, false),
        view_(view),
        eye_(view.camera.eye),
        top_(packed_.uniforms.placing.y),
        far_(far) {
    for (std::size_t k = 0; k < set_.slices.size(); ++k) {
      colors_.emplace_back(packed_.slice_colors[k], true);
      data_.emplace_back(packed_.slice_data[k], false);
    }
    if (layer.middle && !set_.middle.empty()) {
      middle_.emplace_back(packed_.ground_colors[1], true);
      middle_.emplace_back(packed_.ground_data[1], false);
    }
    rows_ = glm::dvec4(packed_.uniforms.rows);
    pixel_ = 2.0 * std::tan(0.5 * double{view.camera.vertical_fov}) / view.height;
  }

  /// Unit, through a point of the picture, pixels from its upper left corner.
  glm::dvec3 ray(double x, double y) const {
    const float aspect = static_cast<float>(view_.width) / static_cast<float>(view_.height);
    const CameraRays rays = cameraRays(view_.camera, aspect);
    return glm::normalize(glm::dvec3(rays.forward) +
                          glm::dvec3(rays.right) * (2.0 * x / view_.width - 1.0) +
                          glm::dvec3(rays.down) * (2.0 * y / view_.height - 1.0));
  }

  /// How far a ray stays above the ground, at least; below 0: it meets it.
  double leastHeight(const glm::dvec3& direction) const {
    double least = 1e9;
    const std::vector<double> seams = ground_.seams(eye_, direction, far_);
    for (std::size_t i = 0; i + 1 < seams.size(); ++i)
      for (int k = 0; k <= 8; ++k)
        least = std::min(least, heightAbove(direction, std::lerp(seams[i], seams[i + 1], k / 8.0)));
    return least;
  }

  /// Up to `end` from the eye.
  SeenGrass trace(const glm::dvec3& direction, double end = 1e9) const {
    SeenGrass seen;
    for (const Stay& stay : stays(direction)) {
      if (stay.from >= end) break;
      const SeenGrass part = traceStay(direction, stay, end);
      const double share = 1.0 - seen.alpha;
      const double at = part.depth >= 0.0 ? part.depth : stay.from;
      const double clear = 1.0 - hazeAt(at);
      seen.color += share * clear * part.color;
      seen.alpha += share * clear * part.alpha;
      seen.slices += part.slices;
      if (seen.depth < 0.0 && part.depth >= 0.0) {
        seen.depth = part.depth;
        seen.depth_alpha = part.depth_alpha;
      }
    }
    return seen;
  }

  double hazeAt(double distance) const {
    const float from_target = glm::length(view_.camera.eye - view_.camera.target);
    const float half = std::max(look::kHazeHalf * from_target, look::kHazeHalfLeast_m);
    return double{shared::hazeShare(static_cast<float>(distance), half)};
  }

  const glm::dvec3& eye() const { return eye_; }

 private:
  /// A stretch of a ray in the shell.
  struct Stay {
    double from = 0.0, to = 0.0;
    bool on_ground = false;  ///< it ends there
  };
  enum class Kind { kAcrossU, kAcrossV, kMiddle };
  struct Crossing {
    double t = 0.0;
    Kind kind = Kind::kAcrossU;
    std::uint32_t plane = 0;
  };

  static gpu::MipLevel noiseLevel() {
    const Image image = makeGroundNoise(look::kGroundNoiseSize);
    return {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height),
            image.rgba};
  }

  double heightAbove(const glm::dvec3& direction, double t) const {
    const glm::dvec3 at = eye_ + direction * t;
    return at.y - ground_.heightAt({at.x, at.z});
  }

  /// Where the ray passes a height over the ground: between seams it is a parabola.
  void addPassings(const glm::dvec3& direction, double from, double to, double height,
                   std::vector<std::pair<double, bool>>& sinking_at) const {
    const double w_0 = heightAbove(direction, from), w_1 = heightAbove(direction, to);
    const double w_half = heightAbove(direction, 0.5 * (from + to));
    const double a = 2.0 * (w_0 - 2.0 * w_half + w_1), b = 4.0 * w_half - 3.0 * w_0 - w_1;
    const double c = w_0 - height;
    const auto add = [&](double share) {
      if (share > 0.0 && share <= 1.0)
        sinking_at.emplace_back(std::lerp(from, to, share), 2.0 * a * share + b < 0.0);
    };
    if (std::abs(a) < 1e-9 * std::abs(b)) {
      add(-c / b);
      return;
    }
    const double root = std::sqrt(b * b - 4.0 * a * c);
    if (std::isnan(root)) return;
    const double q = -0.5 * (b + std::copysign(root, b));
    add(q / a);
    add(c / q);
  }

  std::vector<Stay> stays(const glm::dvec3& direction) const {
    const std::vector<double> seams = ground_.seams(eye_, direction, far_);
    std::vector<std::pair<double, bool>> tops, grounds;
    for (std::size_t i = 0; i + 1 < seams.size() && grounds.empty(); ++i) {
      addPassings(direction, seams[i], seams[i + 1], top_, tops);
      addPassings(direction, seams[i], seams[i + 1], 0.0, grounds);
    }
    std::sort(tops.begin(), tops.end());
    std::sort(grounds.begin(), grounds.end());
    const double ground = grounds.empty() ? far_ : grounds.front().first;
    std::vector<Stay> all;
    const double w = heightAbove(direction, 0.0);
    bool inside = w > 0.0 && w < top_;
    double from = 0.0;
    for (const auto& [t, sinking] : tops) {
      if (t >= ground) break;
      if (inside && !sinking) all.push_back({from, t, false});
      inside = sinking;
      from = t;
    }
    if (inside) all.push_back({from, ground, ground < far_});
    return all;
  }

  /// Planes that the ray crosses in (from, to): those whose numbers may lie there.
  void addPlanes(const Stay& stay, double start, double step, double spacing, std::uint32_t salt,
                 std::vector<Crossing>& crossings) const {
    if (std::abs(step) < 1e-7) return;
    const double a = start + step * stay.from, b = start + step * stay.to;
    const auto first = static_cast<std::int64_t>(std::floor(std::min(a, b) / spacing)) - 1;
    const auto last = static_cast<std::int64_t>(std::ceil(std::max(a, b) / spacing)) + 1;
    for (std::int64_t n = first; n <= last; ++n) {
      const auto number = static_cast<std::uint32_t>(n);
      const std::uint32_t random = shared::grassHash(number, 7u, salt);
      const double place =
          spacing * (static_cast<double>(n) +
                     double{layer_.scatter} * static_cast<double>(random >> 8) * 0x1p-24);
      const double t = (place - start) / step;
      if (t > stay.from && t < stay.to)
        crossings.push_back({t, salt == 0u ? Kind::kAcrossU : Kind::kAcrossV, number});
    }
  }

  glm::dvec2 windNoise(const glm::dvec3& place, const shared::MotionMoment& moment) const {
    const shared::MotionMoment ripple = momentOf(view_.wind, view_.seconds, shared::kWindRipple_m);
    const auto read = [&](double u, double v) { return noise_.at(u, v, 0.0, true).r; };
    const glm::dvec2 at(place.x, place.z);
    const glm::dvec2 broad = at / double{shared::kWindNoise_m} -
                             glm::dvec2(double{moment.drift.x}, double{moment.drift.y});
    const glm::dvec2 fine = at / double{shared::kWindRipple_m} -
                            glm::dvec2(double{ripple.drift.x}, double{ripple.drift.y});
    const glm::dvec2 waves(read(broad.x, broad.y), read(broad.y + 0.37, broad.x + 0.37));
    const glm::dvec2 ripples(read(fine.x, fine.y), read(fine.y + 0.61, fine.x + 0.61));
    return 2.0 * glm::mix(waves, ripples, 0.4) - 1.0;
  }

  /// u, v of a place.
  glm::dvec2 along(const glm::dvec2& place) const {
    return {rows_.x * place.x + rows_.y * place.y, rows_.z * place.x + rows_.w * place.y};
  }

  double wang(std::uint32_t line, double at, std::uint32_t salt) const {
    const double tile = std::floor(at / double{set_.tile_m}),
                 share = at / double{set_.tile_m} - tile;
    const auto number = static_cast<std::uint32_t>(static_cast<std::int64_t>(tile));
    const std::uint32_t column = shared::wangColumn(shared::wangColor(line, number, salt),
                                                    shared::wangColor(line, number + 1u, salt));
    return (column + share) / 4.0;
  }

  glm::dvec2 levelPlace(const glm::dvec2& at) const {
    const glm::dvec2 tile = glm::floor(at / double{set_.tile_m});
    const auto x = static_cast<std::uint32_t>(static_cast<std::int64_t>(tile.x));
    const auto y = static_cast<std::uint32_t>(static_cast<std::int64_t>(tile.y));
    return {wang(y, at.x, shared::kBorderOfGround), wang(x, at.y, shared::kBorderOfGround + 1u)};
  }

  double standing(const glm::dvec4& color, const glm::dvec4& data, double lod) const {
    const auto rank = static_cast<float>(data.w / color.a);
    const float blur = std::clamp(0.15f * static_cast<float>(lod), 0.02f, 1.0f);
    return double{shared::plantsStanding(layer_.density, rank, blur)};
  }

  SeenGrass traceStay(const glm::dvec3& direction, const Stay& stay, double end) const {
    const double height = double{set_.height_m}, density = double{layer_.density};
    const double tall = double{shared::grassHeight(layer_.density)};
    const glm::dvec3 entry = eye_ + direction * stay.from;
    const shared::MotionMoment moment = momentOf(view_.wind, view_.seconds, shared::kWindNoise_m);
    const glm::vec2 world_bend =
        shared::grassBend(moment, glm::vec3(entry), glm::vec2(windNoise(entry, moment)));
    const glm::dvec2 bend = along(glm::dvec2(world_bend)) * height;
    const double sinks = double{shared::heightAtRest(1.0f, world_bend)};

    const glm::dvec2 start = along({eye_.x, eye_.z}), d = along({direction.x, direction.z});
    std::vector<Crossing> crossings;
    addPlanes(stay, start.x, d.x, double{set_.spacing_m.x}, 0u, crossings);
    addPlanes(stay, start.y, d.y, double{set_.spacing_m.y}, 1u, crossings);
    std::vector<std::pair<double, bool>> halves;
    if (!middle_.empty()) addPassings(direction, stay.from, stay.to, 0.5 * height * tall, halves);
    for (const auto& [t, sinking] : halves)
      if (sinking) crossings.push_back({t, Kind::kMiddle, 0});
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.t < b.t; });

    SeenGrass seen;
    const auto meet = [&seen](const glm::dvec4& color, double t) {
      const double share = 1.0 - seen.alpha;
      seen.color += share * glm::dvec3(color);
      seen.alpha += share * color.a;
      if (seen.depth >= 0.0 || seen.alpha <= 0.49) return;
      seen.depth = t;
      seen.depth_alpha = seen.alpha;
    };
    const double texels_along = colorWidth() / (4.0 * double{set_.tile_m});
    const double texels_up = static_cast<double>(set_.slices[0].height) / height;
    const double level_texels = set_.ground.width / (4.0 * double{set_.tile_m});
    const auto levelLod = [&](double t) {
      return std::log2(std::max(
          level_texels * pixel_ * t / std::sqrt(std::max(std::abs(direction.y), 0.05)), 1.0));
    };
    for (const Crossing& crossing : crossings) {
      if (density == 0.0 || crossing.t >= end || seen.alpha > 0.999999) break;
      const glm::dvec2 here = start + d * crossing.t;
      if (crossing.kind == Kind::kMiddle) {
        const double share = glm::smoothstep(0.3, 0.9, -direction.y), lod = levelLod(crossing.t);
        const glm::dvec2 uv = levelPlace(here - bend * 0.25);
        const glm::dvec4 color = middle_[0].at(uv.x, uv.y, lod, true) * share;
        const glm::dvec4 data = middle_[1].at(uv.x, uv.y, lod, true) * share;
        if (color.a > 0.0) meet(color * standing(color, data, lod), crossing.t);
        continue;
      }
      ++seen.slices;
      const bool across_u = crossing.kind == Kind::kAcrossU;
      const std::uint32_t salt = across_u ? 0u : 1u;
      const double above = heightAbove(direction, crossing.t), w = above / tall * sinks;
      if (above >= top_ * tall) continue;
      const double share = std::clamp(w / height, 0.0, 1.0);
      const glm::dvec2 at = here - bend * share * share;
      const double u = wang(crossing.plane, across_u ? at.y : at.x, shared::kBorderOfU + salt);
      const double v = 1.0 - w / height;
      const double across = std::max(std::abs(across_u ? d.x : d.y), 0.1);
      const double lod = std::max(
          std::log2(std::max(texels_along, texels_up) * pixel_ * crossing.t / std::sqrt(across)),
          0.0);
      const std::size_t kind = shared::sliceKind(
          crossing.plane, static_cast<std::uint32_t>(colors_.size()), shared::kSliceKindOfU + salt);
      const glm::dvec4 color = colors_[kind].at(u, v, lod, false);
      if (color.a <= 0.0) continue;
      meet(color * standing(color, data_[kind].at(u, v, lod, false), lod), crossing.t);
    }
    if (stay.on_ground && stay.to < end) {
      const glm::dvec2 uv = levelPlace(start + d * stay.to);
      glm::dvec4 color = ground_picture_.at(uv.x, uv.y, levelLod(stay.to), true);
      const glm::dvec3 soil(set_.species.soil_color);
      color = glm::dvec4(
          glm::mix(soil * color.a, glm::dvec3(color), glm::smoothstep(0.0, 0.4, density)), color.a);
      meet(color, stay.to);
    }
    return seen;
  }

  double colorWidth() const { return static_cast<double>(set_.slices[0].width); }

  GrassLayer layer_;
  GrassSet set_;
  PackedGrass packed_;
  ReferenceGround ground_;
  ReferenceTexture ground_picture_, noise_;
  View view_;
  glm::dvec3 eye_;
  double top_, far_;
  std::vector<ReferenceTexture> colors_, data_, middle_;
  glm::dvec4 rows_{0.0};
  double pixel_ = 0.0;
};

}  // namespace verdure::test

#endif  // VERDURE_TESTS_GRASS_REFERENCE_H_
