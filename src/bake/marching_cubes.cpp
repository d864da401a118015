#include "bake/marching_cubes.h"

#include <algorithm>
#include <vector>

#include "base/check.h"

namespace verdure {
namespace {

using Face = std::array<int, 4>;
using Triangle = std::array<int, 3>;

// Corners of the six faces, counter-clockwise seen from outside the cell.
std::array<Face, 6> cellFaces() {
  std::array<Face, 6> faces{};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      constexpr int kRound[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      Face& face = faces[static_cast<std::size_t>(2 * axis + side)];
      for (int i = 0; i < 4; ++i) {
        const int* uv = kRound[side == 1 ? i : 3 - i];
        face[static_cast<std::size_t>(i)] =
            side << axis | uv[0] << (axis + 1) % 3 | uv[1] << (axis + 2) % 3;
      }
    }
  return faces;
}

int edgeBetween(int corner_a, int corner_b) {
  const int difference = corner_a ^ corner_b;
  const int axis = difference == 1 ? 0 : difference == 2 ? 1 : 2;
  const int low = std::min(corner_a, corner_b);
  return 4 * axis + (low >> (axis + 1) % 3 & 1) + 2 * (low >> (axis + 2) % 3 & 1);
}

bool onCommonFace(int edge_a, int edge_b) {
  for (const Face& face : cellFaces()) {
    int hits = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const int edge = edgeBetween(face[i], face[(i + 1) % 4]);
      hits += (edge == edge_a ? 1 : 0) + (edge == edge_b ? 1 : 0);
    }
    if (hits == 2) return true;
  }
  return false;
}

// Triangulates loop[begin..end] without inner diagonals in a face; false if that cannot be done.
bool triangulate(const std::vector<int>& loop, std::size_t begin, std::size_t end,
                 std::vector<Triangle>& out) {
  if (end - begin < 2) return true;
  const auto allowed = [&](std::size_t i, std::size_t j) {
    const bool side = j == i + 1 || (i == 0 && j + 1 == loop.size());
    return side || !onCommonFace(loop[i], loop[j]);
  };
  for (std::size_t k = begin + 1; k < end; ++k) {
    if (!allowed(begin, k) || !allowed(k, end)) continue;
    const std::size_t kept = out.size();
    if (triangulate(loop, begin, k, out) && triangulate(loop, k, end, out)) {
      out.push_back({loop[begin], loop[k], loop[end]});
      return true;
    }
    out.resize(kept);
  }
  return false;
}

CellCase buildCase(int inside) {
  // On each face, seen from outside, the surface runs from the crossing where a run of inside
  // corners begins to the one where it ends, with the inside on its right.
  std::array<int, 12> next{};
  next.fill(-1);
  for (const Face& face : cellFaces()) {
    const auto is_inside = [&](std::size_t i) { return (inside >> face[i % 4] & 1) != 0; };
    for (std::size_t i = 0; i < 4; ++i) {
      if (!is_inside(i) || is_inside(i + 1)) continue;
      std::size_t first = i + 4;  // walk back to the first corner of this run
      while (is_inside(first - 1)) --first;
      const int entry = edgeBetween(face[(first - 1) % 4], face[first % 4]);
      next[static_cast<std::size_t>(entry)] = edgeBetween(face[i], face[(i + 1) % 4]);
    }
  }
  CellCase result;
  std::array<bool, 12> seen{};
  std::size_t filled = 0;
  for (std::size_t start = 0; start < 12; ++start) {
    if (next[start] < 0 || seen[start]) continue;
    std::vector<int> loop;
    for (auto e = start; !seen[e]; e = static_cast<std::size_t>(next[e])) {
      seen[e] = true;
      loop.push_back(static_cast<int>(e));
    }
    std::vector<Triangle> triangles;
    VERDURE_CHECK_EQ(triangulate(loop, 0, loop.size() - 1, triangles), true);
    for (const Triangle& t : triangles) {
      for (const int edge : t) result.edges[filled++] = static_cast<std::uint8_t>(edge);
      ++result.triangle_count;
    }
  }
  return result;
}

}  // namespace

const std::array<CellCase, 256>& cellCases() {
  static const std::array<CellCase, 256> cases = [] {
    std::array<CellCase, 256> all;
    for (int i = 0; i < 256; ++i) all[static_cast<std::size_t>(i)] = buildCase(i);
    return all;
  }();
  return cases;
}

}  // namespace verdure
