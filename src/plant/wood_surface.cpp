#include "plant/wood_surface.h"

#include <algorithm>

#include "plant/weld.h"

namespace verdure {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// An edge of a triangle, by welded points.
struct Edge {
  std::uint64_t key = 0;   ///< its welded points, the lower one first
  std::uint64_t file = 0;  ///< its vertices in the file
  std::uint32_t triangle = 0;
  auto operator<=>(const Edge&) const = default;
};

std::uint64_t pairKey(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

void joinByEdges(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& welded,
                 DisjointSets& pieces) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      if (welded[a] != welded[b])
        edges.push_back({pairKey(welded[a], welded[b]), pairKey(a, b), t});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key == edges[begin].key) ++end;
    for (std::size_t i = begin + 1; i < end; ++i)
      if (end - begin <= 2 || edges[i].file == edges[i - 1].file)
        pieces.join(edges[i].triangle, edges[i - 1].triangle);
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
  std::erase_if(triangles, [&](const Triangle& t) {
    return welded[t[0]] == welded[t[1]] && welded[t[1]] == welded[t[2]];
  });
  DisjointSets pieces(triangles.size());
  joinByEdges(triangles, welded, pieces);

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
      patch.triangles.push_back(local);
    }
  }
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    std::copy_n(of_vertex.begin() + first[m], surface.vertices[m].size(),
                surface.vertices[m].begin());
  return surface;
}

}  // namespace verdure
