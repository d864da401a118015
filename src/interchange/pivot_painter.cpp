#include "interchange/pivot_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "base/check.h"
#include "interchange/wind_quantities.h"
#include "verdure/image.h"

namespace verdure {
namespace {

glm::vec3 unreal(const glm::vec3& v) {
  return {v.x, v.z, v.y};
}

}  // namespace

std::vector<std::uint8_t> pivotTexture(const MotionTree& tree, const glm::dvec3& origin) {
  VERDURE_CHECK_OP(tree.branches.size(), <=, kMostElements);
  const glm::ivec2 size = elementTextureSize(tree.branches.size());
  std::vector<std::uint16_t> bits(4 * static_cast<std::size_t>(size.x * size.y), 0);
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const MotionBranch& branch = tree.branches[b];
    const glm::vec3 cm = unreal(glm::vec3(100.0 * (glm::dvec3(branch.root) + origin)));
    for (int c = 0; c < 3; ++c)
      bits[4 * b + static_cast<std::size_t>(c)] =
          glm::packHalf1x16(std::clamp(cm[c], -65504.0f, 65504.0f));
    const std::size_t parent = branch.parent == kNone ? b : branch.parent;
    bits[4 * b + 3] = static_cast<std::uint16_t>(parent + 1024);
  }
  return encodeExrBits(size.x, size.y, bits);
}

std::vector<std::uint8_t> axisTexture(const MotionTree& tree) {
  const glm::ivec2 size = elementTextureSize(tree.branches.size());
  const auto low = [](int v) { return static_cast<std::uint8_t>(v & 255); };
  const auto high = [](int v) { return static_cast<std::uint8_t>(v >> 8); };
  // True colour, not compressed; 8 bits of alpha.
  const std::array<std::uint8_t, 18> start = {
      0,  0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, low(size.x), high(size.x), low(size.y), high(size.y),
      32, 8};
  const std::size_t header = start.size();
  std::vector<std::uint8_t> out(header + 4 * static_cast<std::size_t>(size.x * size.y), 0);
  std::copy(start.begin(), start.end(), out.begin());
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const MotionBranch& branch = tree.branches[b];
    const auto width = static_cast<std::size_t>(size.x), height = static_cast<std::size_t>(size.y);
    std::uint8_t* const texel = &out[header + 4 * ((height - 1 - b / width) * width + b % width)];
    const glm::vec3 axis = 0.5f * unreal(branch.t) + 0.5f;
    for (int c = 0; c < 3; ++c) texel[2 - c] = toByte(axis[c]);
    const float steps = std::clamp(std::ceil(100.0f * branch.length / 8.0f), 1.0f, 256.0f);
    texel[3] = toByte(steps / 256.0f);
  }
  return out;
}

std::string pivotTextureName(const std::string& mesh, int uv_set) {
  return fmt::format("T_{}_PivPos16bit_ParentIndexInt_UV{}.EXR", mesh, uv_set + 1);
}

std::string axisTextureName(const std::string& mesh, int uv_set) {
  return fmt::format("T_{}_XVector8bit_XExtentDividedby2048_UV{}.TGA", mesh, uv_set + 1);
}

}  // namespace verdure
