#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "verdure/error.h"
#include "verdure/levels.h"

namespace verdure {
namespace {

/// The vertices of `mesh` that `indices` use, in the order in which they are met.
void keepUsed(const Mesh& mesh, const std::vector<std::uint32_t>& indices, Mesh& out,
              std::vector<std::uint32_t>& sources) {
  out.name = mesh.name;
  out.kind = mesh.kind;
  out.material = mesh.material;
  std::vector<std::uint32_t> known(mesh.positions.size(), kNone);
  for (const std::uint32_t v : indices) {
    if (known[v] == kNone) {
      known[v] = static_cast<std::uint32_t>(sources.size());
      sources.push_back(v);
    }
    out.indices.push_back(known[v]);
  }
  for (const std::uint32_t v : sources) {
    out.positions.push_back(mesh.positions[v]);
    out.normals.push_back(mesh.normals[v]);
    if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[v]);
  }
}

/// Which leaves stay, and how much longer they become.
struct LeafChoice {
  std::vector<std::uint32_t> leaves;
  float growth = 1.0f;
};

LeafChoice chooseLeaves(const Plant& plant, const SimplifyOptions& options) {
  LeafChoice choice;
  std::vector<std::uint32_t> order(plant.leaves.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [](std::uint32_t a, std::uint32_t b) { return hash(a) < hash(b); });
  const auto count = static_cast<std::size_t>(
      std::ceil(double{options.leaf_share} * static_cast<double>(order.size())));
  double all = 0.0, kept = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double area = plant.leaves[order[i]].area;
    all += area;
    if (i < count) kept += area;
  }
  order.resize(std::min(count, order.size()));
  std::sort(order.begin(), order.end());
  choice.leaves = std::move(order);
  if (kept > 0.0) choice.growth = static_cast<float>(std::sqrt(all / kept));
  if (options.leaf_growth > 0.0f) choice.growth = options.leaf_growth;
  return choice;
}

void keepLeaves(const Plant& plant, const LeafChoice& choice, PlantLevel& level) {
  std::vector<std::vector<std::uint32_t>> indices(plant.meshes.size());
  for (const std::uint32_t l : choice.leaves) {
    const Leaf& leaf = plant.leaves[l];
    const std::vector<std::uint32_t>& all = plant.meshes[leaf.mesh].indices;
    for (std::uint32_t t = 0; t < leaf.triangle_count; ++t) {
      const std::size_t first = std::size_t{plant.leaf_triangles[leaf.first_triangle + t]} * 3;
      for (std::size_t k = 0; k < 3; ++k) indices[leaf.mesh].push_back(all[first + k]);
    }
  }
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    if (plant.meshes[m].kind == PartKind::kFoliage)
      keepUsed(plant.meshes[m], indices[m], level.meshes[m], level.sources[m]);
  // Vertices were taken in the order of leaves, so each leaf's are found by walking along.
  std::vector<std::size_t> at(plant.meshes.size(), 0);
  std::vector<std::vector<bool>> grown(plant.meshes.size());
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    grown[m].assign(level.meshes[m].positions.size(), false);
  for (const std::uint32_t l : choice.leaves) {
    const Leaf& leaf = plant.leaves[l];
    Mesh& mesh = level.meshes[leaf.mesh];
    for (std::uint32_t k = 0; k < 3 * leaf.triangle_count; ++k) {
      const std::uint32_t v = mesh.indices[at[leaf.mesh]++];
      if (grown[leaf.mesh][v]) continue;
      grown[leaf.mesh][v] = true;
      mesh.positions[v] = leaf.centroid + choice.growth * (mesh.positions[v] - leaf.centroid);
    }
  }
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parents, std::uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

/// Triangles of the largest pieces (by area), at most `most` of them, at least one piece.
std::vector<std::uint32_t> largestPieces(const Mesh& mesh,
                                         const std::vector<std::uint32_t>& indices,
                                         std::size_t most) {
  std::vector<std::uint32_t> same(mesh.positions.size()), parents(mesh.positions.size());
  meshopt_generateVertexRemap(same.data(), nullptr, mesh.positions.size(), mesh.positions.data(),
                              mesh.positions.size(), sizeof(glm::vec3));
  std::iota(parents.begin(), parents.end(), 0u);
  for (std::size_t i = 0; i < indices.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k)
      parents[rootOf(parents, same[indices[i + k]])] = rootOf(parents, same[indices[i]]);
  struct Piece {
    std::uint32_t root = 0;
    double area = 0.0;
    std::size_t triangles = 0;
  };
  std::vector<Piece> pieces(mesh.positions.size());
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[indices[i]];
    const std::uint32_t root = rootOf(parents, same[indices[i]]);
    Piece& piece = pieces[root];
    piece.root = root;
    piece.area += double{glm::length(
        glm::cross(mesh.positions[indices[i + 1]] - a, mesh.positions[indices[i + 2]] - a))};
    ++piece.triangles;
  }
  std::erase_if(pieces, [](const Piece& piece) { return piece.triangles == 0; });
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.area > b.area; });
  std::vector<bool> kept(mesh.positions.size(), false);
  std::size_t triangles = 0;
  for (const Piece& piece : pieces) {
    if (triangles > 0 && triangles + piece.triangles > most) break;
    triangles += piece.triangles;
    kept[piece.root] = true;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    if (kept[rootOf(parents, same[indices[i]])])
      out.insert(out.end(), indices.begin() + static_cast<std::ptrdiff_t>(i),
                 indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  return out;
}

void thinWood(const Mesh& mesh, float height, const SimplifyOptions& options, Mesh& out,
              std::vector<std::uint32_t>& sources) {
  std::vector<std::uint32_t> indices(
      mesh.indices.begin(),
      mesh.indices.begin() + static_cast<std::ptrdiff_t>(mesh.indices.size() / 3 * 3));
  const auto target = static_cast<std::size_t>(
      std::ceil(double{options.wood_share} * static_cast<double>(indices.size() / 3)));
  if (target < indices.size() / 3 && !mesh.positions.empty()) {
    const float extent =
        meshopt_simplifyScale(&mesh.positions[0].x, mesh.positions.size(), sizeof(glm::vec3));
    const float error = extent > 0.0f ? options.wood_error * height / extent : 1.0f;
    std::vector<std::uint32_t> simple(indices.size());
    simple.resize(meshopt_simplify(simple.data(), indices.data(), indices.size(),
                                   &mesh.positions[0].x, mesh.positions.size(), sizeof(glm::vec3),
                                   3 * target, error, 0, nullptr));
    indices = simple.size() / 3 > target ? largestPieces(mesh, simple, target) : std::move(simple);
  }
  keepUsed(mesh, indices, out, sources);
}

}  // namespace

CrownLight lightOf(const PlantLevel& level, const CrownLight& light) {
  CrownLight out;
  for (std::size_t m = 0; m < level.sources.size(); ++m) {
    const MeshLight& from = light.meshes[m];
    MeshLight& to = out.meshes.emplace_back();
    for (const std::uint32_t v : level.sources[m]) {
      to.normals.push_back(from.normals[v]);
      to.ambient.push_back(from.ambient[v]);
      if (!from.visibility.empty()) to.visibility.push_back(from.visibility[v]);
    }
  }
  return out;
}

PlantLevel simplifyPlant(const Plant& plant, const SimplifyOptions& options) {
  const auto share = [](float value) { return value > 0.0f && value <= 1.0f; };
  if (!share(options.leaf_share) || !share(options.wood_share))
    throw Error(plant.name, "a share of leaves or wood is out of range", "choose above 0 to 1");
  if (!(options.leaf_growth >= 0.0f) || !std::isfinite(options.leaf_growth) ||
      !(options.wood_error > 0.0f))
    throw Error(plant.name, "a growth of leaves or an error of wood is out of range",
                "choose numbers above 0");
  PlantLevel level;
  level.leaf_share = options.leaf_share;
  level.meshes.resize(plant.meshes.size());
  level.sources.resize(plant.meshes.size());
  const LeafChoice choice = chooseLeaves(plant, options);
  level.leaf_growth = choice.growth;
  keepLeaves(plant, choice, level);
  const float height = bounds(plant).size().y;
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    if (plant.meshes[m].kind == PartKind::kWood)
      thinWood(plant.meshes[m], height, options, level.meshes[m], level.sources[m]);
  return level;
}

}  // namespace verdure
