#include "plant/wood_surface.h"

#include <algorithm>

#include "plant/weld.h"

namespace verdure {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// An edge of a triangle from a point to a higher one.
struct Edge {
  std::uint32_t end = 0, triangle = 0;
  auto operator<=>(const Edge&) const = default;
};

/// Joins triangles at their edges, where at most `most` proper ones meet. `number`: of the points.
void joinByEdges(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& number,
                 std::size_t most, DisjointSets& pieces) {
  std::vector<bool> proper(triangles.size());
  const auto forEdges = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const std::uint32_t corners[] = {number[triangles[t][0]], number[triangles[t][1]],
                                       number[triangles[t][2]]};
      proper[t] = corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [low, high] = std::minmax(corners[c], corners[(c + 1) % 3]);
        if (low != high) visit(low, Edge{high, t});
      }
    }
  };
  std::vector<std::uint32_t> first(number.size() + 2, 0);
  forEdges([&](std::uint32_t low, const Edge&) { ++first[low + 2]; });
  for (std::size_t p = 2; p < first.size(); ++p) first[p] += first[p - 1];
  std::vector<Edge> edges(first.back());
  forEdges([&](std::uint32_t low, const Edge& edge) { edges[first[low + 1]++] = edge; });
  for (std::size_t p = 0; p < number.size(); ++p) {
    std::sort(edges.begin() + first[p], edges.begin() + first[p + 1]);
    for (std::size_t begin = first[p], end = begin; begin < first[p + 1]; begin = end) {
      std::size_t meeting = 0;
      for (; end < first[p + 1] && edges[end].end == edges[begin].end; ++end)
        meeting += proper[edges[end].triangle] ? 1 : 0;
      for (std::size_t i = begin + 1; i < end && meeting <= most; ++i)
        pieces.join(edges[i].triangle, edges[i - 1].triangle);
    }
  }
}

}  // namespace

WoodSurface weldWood(const Plant& plant, const std::vector<bool>& leave_out) {
  WoodSurface surface;
  surface.vertices.resize(plant.meshes.size());
  std::vector<glm::vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> first(plant.meshes.size(), 0);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    const Mesh& mesh = plant.meshes[m];
    if (mesh.kind != PartKind::kWood || leave_out[m]) continue;
    first[m] = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      triangles.push_back({first[m] + mesh.indices[i], first[m] + mesh.indices[i + 1],
                           first[m] + mesh.indices[i + 2]});
    surface.vertices[m].resize(mesh.positions.size());
  }
  DisjointSets sets(positions.size());
  weld(positions, sets);
  std::vector<std::uint32_t> welded(positions.size());
  for (std::uint32_t i = 0; i < welded.size(); ++i) welded[i] = sets.find(i);
  DisjointSets pieces(triangles.size());
  {
    std::vector<std::uint32_t> own(positions.size());
    std::iota(own.begin(), own.end(), 0u);
    joinByEdges(triangles, own, triangles.size(), pieces);
  }
  joinByEdges(triangles, welded, 2, pieces);

  // Pieces by their first triangle; then their points, each piece its own.
  std::vector<std::uint32_t> piece_of(triangles.size());
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t root = pieces.find(t);  // the lowest of the piece
    if (root == t) {
      piece_of[t] = static_cast<std::uint32_t>(members.size());
      members.emplace_back();
    }
    piece_of[t] = piece_of[root];
    members[piece_of[t]].push_back(t);
  }
  surface.patches.resize(members.size());
  std::vector<WoodVertex> of_welded(positions.size()), of_vertex(positions.size());
  for (std::uint32_t p = 0; p < members.size(); ++p) {
    WoodPatch& patch = surface.patches[p];
    for (const std::uint32_t t : members[p]) {
      Triangle local{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = triangles[t][c];
        WoodVertex& known = of_welded[welded[vertex]];
        if (known.patch != p) {
          known = {p, static_cast<std::uint32_t>(patch.points.size())};
          patch.points.push_back(positions[welded[vertex]]);
        }
        local[c] = known.point;
        if (of_vertex[vertex].patch == kNone) of_vertex[vertex] = known;
      }
      if (local[0] != local[1] || local[1] != local[2]) patch.triangles.push_back(local);
    }
  }
  // Pieces without an extent have no branch of their own.
  std::vector<std::uint32_t> kept(surface.patches.size(), kNone);
  std::uint32_t next = 0;
  for (std::uint32_t p = 0; p < kept.size(); ++p) {
    if (surface.patches[p].triangles.empty()) continue;
    kept[p] = next;
    if (next != p) surface.patches[next] = std::move(surface.patches[p]);
    ++next;
  }
  surface.patches.resize(next);
  for (WoodVertex& v : of_vertex)
    if (v.patch != kNone) v.patch = kept[v.patch];
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    std::copy_n(of_vertex.begin() + first[m], surface.vertices[m].size(),
                surface.vertices[m].begin());
  return surface;
}

}  // namespace verdure
