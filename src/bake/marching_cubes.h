#ifndef VERDURE_BAKE_MARCHING_CUBES_H_
#define VERDURE_BAKE_MARCHING_CUBES_H_

#include <array>
#include <cstdint>

/// The cases of marching cubes (Lorensen, Cline, SIGGRAPH 1987), generated instead of typed: the
/// loops in which the surface crosses the faces of a cell, with one rule for ambiguous faces (the
/// inside corners are separated), so that two cells that share a face always agree on it; loops are
/// triangulated without diagonals that lie in a face. Hence the mesh is closed and 2-manifold.
namespace verdure {

/// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Edge e runs along axis e / 4 from the
/// corner whose coordinates on the next two axes (cyclically) are the bits of e % 4.
struct CellCase {
  std::uint8_t triangle_count = 0;       ///< at most 5
  std::array<std::uint8_t, 15> edges{};  ///< three per triangle, counter-clockwise from outside
};

/// Indexed by the inside corners' bits.
const std::array<CellCase, 256>& cellCases();

/// The corner at which an edge starts.
constexpr int edgeCorner(int edge) {
  const int axis = edge / 4, b = (axis + 1) % 3, c = (axis + 2) % 3;
  return ((edge & 1) << b) | ((edge >> 1 & 1) << c);
}

}  // namespace verdure

#endif  // VERDURE_BAKE_MARCHING_CUBES_H_
