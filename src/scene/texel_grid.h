#ifndef VERDURE_SCENE_TEXEL_GRID_H_
#define VERDURE_SCENE_TEXEL_GRID_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "shared/color.h"
#include "verdure/plant.h"

namespace verdure {

/// A texture sampled bilinearly at its full size, as the GPU does: texel centres at halves,
/// repeating or clamped in each direction.
class TexelGrid {
 public:
  TexelGrid() = default;
  explicit TexelGrid(const Texture& texture)
      : image_(&texture.image), clamp_u_(texture.clamp_u), clamp_v_(texture.clamp_v) {}

  int width() const { return image_->width; }
  int height() const { return image_->height; }
  bool clampU() const { return clamp_u_; }
  bool clampV() const { return clamp_v_; }

  /// The four texels around a point and how far it lies between them.
  struct Cell {
    int x0, x1, y0, y1;
    float s, t;
  };
  Cell cellAt(const glm::vec2& uv) const {
    Cell cell;
    locate(uv.x, width(), clamp_u_, cell.x0, cell.x1, cell.s);
    locate(uv.y, height(), clamp_v_, cell.y0, cell.y1, cell.t);
    return cell;
  }

  /// Alpha in [0, 255].
  float alpha(const glm::vec2& uv) const { return alpha(cellAt(uv)); }
  float alpha(const Cell& c) const {
    const auto a = [this](int x, int y) { return static_cast<float>(image_->at(x, y)[3]); };
    return glm::mix(glm::mix(a(c.x0, c.y0), a(c.x1, c.y0), c.s),
                    glm::mix(a(c.x0, c.y1), a(c.x1, c.y1), c.s), c.t);
  }

  /// Linear RGB of an sRGB texture, decoded before it is interpolated. With `cut`, texels of alpha
  /// 0 take no part: their colour is arbitrary, and the GPU's copy has the neighbours' there.
  glm::vec3 color(const glm::vec2& uv, bool cut) const {
    static const std::array<float, 256> kLinear = linearFromByte();
    const Cell c = cellAt(uv);
    const std::uint8_t* texels[] = {image_->at(c.x0, c.y0), image_->at(c.x1, c.y0),
                                    image_->at(c.x0, c.y1), image_->at(c.x1, c.y1)};
    const float weights[] = {(1.0f - c.s) * (1.0f - c.t), c.s * (1.0f - c.t), (1.0f - c.s) * c.t,
                             c.s * c.t};
    glm::vec3 sum(0.0f), cut_sum(0.0f);
    float cut_weight = 0.0f;
    for (int i = 0; i < 4; ++i) {
      const glm::vec3 part = weights[i] * glm::vec3(kLinear[texels[i][0]], kLinear[texels[i][1]],
                                                    kLinear[texels[i][2]]);
      sum += part;
      if (texels[i][3] == 0) continue;
      cut_sum += part;
      cut_weight += weights[i];
    }
    return cut && cut_weight > 1e-6f ? cut_sum / cut_weight : sum;
  }

  /// Alpha in [0, 1].
  float share(const glm::vec2& uv) const { return alpha(uv) / 255.0f; }

  /// The bytes as they are, in [0, 1]: of normal maps and other data.
  glm::vec3 data(const glm::vec2& uv) const {
    const Cell c = cellAt(uv);
    const auto texel = [this](int x, int y) {
      const std::uint8_t* p = image_->at(x, y);
      return glm::vec3(p[0], p[1], p[2]) / 255.0f;
    };
    return glm::mix(glm::mix(texel(c.x0, c.y0), texel(c.x1, c.y0), c.s),
                    glm::mix(texel(c.x0, c.y1), texel(c.x1, c.y1), c.s), c.t);
  }

 private:
  static std::array<float, 256> linearFromByte() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
      table[i] = shared::linearFromSrgb(static_cast<float>(i) / 255.0f);
    return table;
  }

  static void locate(float u, int size, bool clamps, int& i0, int& i1, float& share) {
    u = clamps ? glm::clamp(u, 0.0f, 1.0f) : u - std::floor(u);
    if (!(u >= 0.0f && u <= 1.0f)) u = 0.0f;  // not finite
    const float x = u * static_cast<float>(size) - 0.5f;
    const float below = std::floor(x);
    share = x - below;
    i0 = static_cast<int>(below);
    i1 = i0 + 1;
    if (i0 < 0) i0 = clamps ? 0 : size - 1;
    if (i1 >= size) i1 = clamps ? size - 1 : 0;
  }

  const Image* image_ = nullptr;
  bool clamp_u_ = false, clamp_v_ = false;
};

}  // namespace verdure

#endif  // VERDURE_SCENE_TEXEL_GRID_H_
