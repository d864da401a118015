#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nanoflann.hpp>

#include "base/parallel.h"
#include "plant/weld.h"
#include "verdure/plant.h"

namespace verdure {
namespace {

/// Appends the components of one foliage mesh, ordered by their first triangle.
void appendLeaves(Plant& plant, std::uint32_t mesh_index) {
  const Mesh& mesh = plant.meshes[mesh_index];
  const std::size_t triangles = mesh.triangleCount();
  DisjointSets sets(mesh.positions.size());
  weld(mesh.positions, sets);
  for (std::size_t t = 0; t < triangles; ++t) {
    sets.join(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
    sets.join(mesh.indices[3 * t], mesh.indices[3 * t + 2]);
  }
  const std::size_t first_leaf = plant.leaves.size();
  std::vector<std::uint32_t> leaf_of_root(mesh.positions.size(), kNone);
  std::vector<std::uint32_t> leaf_of_triangle(triangles);
  for (std::size_t t = 0; t < triangles; ++t) {
    std::uint32_t& leaf = leaf_of_root[sets.find(mesh.indices[3 * t])];
    if (leaf == kNone) {
      leaf = static_cast<std::uint32_t>(plant.leaves.size());
      plant.leaves.emplace_back().mesh = mesh_index;
    }
    leaf_of_triangle[t] = leaf;
    ++plant.leaves[leaf].triangle_count;
  }
  auto next = static_cast<std::uint32_t>(plant.leaf_triangles.size());
  std::vector<std::uint32_t> place(plant.leaves.size() - first_leaf);
  for (std::size_t i = first_leaf; i < plant.leaves.size(); ++i) {
    plant.leaves[i].first_triangle = place[i - first_leaf] = next;
    next += plant.leaves[i].triangle_count;
  }
  plant.leaf_triangles.resize(next);
  for (std::size_t t = 0; t < triangles; ++t)
    plant.leaf_triangles[place[leaf_of_triangle[t] - first_leaf]++] = static_cast<std::uint32_t>(t);
}

/// The vertices of all wood, with the branch of each where it is known.
struct WoodPoints {
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> branch;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using WoodTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, WoodPoints>, WoodPoints,
                                        3, std::size_t>;

WoodPoints collectWood(const Plant& plant) {
  WoodPoints wood;
  for (const Mesh& mesh : plant.meshes) {
    if (mesh.kind != PartKind::kWood) continue;
    wood.points.insert(wood.points.end(), mesh.positions.begin(), mesh.positions.end());
    if (mesh.branch_of_vertex.empty())
      wood.branch.resize(wood.points.size(), kNone);
    else
      wood.branch.insert(wood.branch.end(), mesh.branch_of_vertex.begin(),
                         mesh.branch_of_vertex.end());
  }
  return wood;
}

/// Area and area-weighted centroid (of the corners, if the area is 0).
void measure(const Plant& plant, Leaf& leaf) {
  const Mesh& mesh = plant.meshes[leaf.mesh];
  double area = 0.0;
  glm::dvec3 weighted(0.0), mean(0.0);
  for (std::uint32_t k = 0; k < leaf.triangle_count; ++k) {
    const std::size_t t = plant.leaf_triangles[leaf.first_triangle + k];
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * t]]);
    const glm::dvec3 b(mesh.positions[mesh.indices[3 * t + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[3 * t + 2]]);
    const double triangle = 0.5 * glm::length(glm::cross(b - a, c - a));
    area += triangle;
    weighted += triangle * (a + b + c) / 3.0;
    mean += (a + b + c) / 3.0;
  }
  leaf.area = static_cast<float>(area);
  leaf.centroid = glm::vec3(area > 0.0 ? weighted / area : mean / double(leaf.triangle_count));
}

/// Calls visit(position) for each corner of the leaf's triangles.
template <class Visit>
void forCorners(const Plant& plant, const Leaf& leaf, const Visit& visit) {
  const Mesh& mesh = plant.meshes[leaf.mesh];
  for (std::uint32_t k = 0; k < leaf.triangle_count; ++k) {
    const std::size_t t = plant.leaf_triangles[leaf.first_triangle + k];
    for (std::size_t c = 0; c < 3; ++c) visit(mesh.positions[mesh.indices[3 * t + c]]);
  }
}

void attachToWood(const Plant& plant, const WoodPoints& wood, const WoodTree& tree, Leaf& leaf) {
  float best = std::numeric_limits<float>::max();
  forCorners(plant, leaf, [&](const glm::vec3& p) {
    std::size_t index = 0;
    float distance = 0.0f;
    nanoflann::KNNResultSet<float, std::size_t> result(1);
    result.init(&index, &distance);
    tree.findNeighbors(result, &p[0], nanoflann::SearchParams());
    if (!(distance < best)) return;
    best = distance;
    leaf.stalk = p;
    leaf.branch = wood.branch[index];
  });
}

/// Without wood: the corner farthest from the centroid towards the plant's vertical axis.
void attachToAxis(const Plant& plant, const glm::vec3& axis, Leaf& leaf) {
  glm::vec3 inwards(axis.x - leaf.centroid.x, 0.0f, axis.z - leaf.centroid.z);
  if (glm::dot(inwards, inwards) == 0.0f) inwards = glm::vec3(0.0f, -1.0f, 0.0f);
  float best = std::numeric_limits<float>::lowest();
  forCorners(plant, leaf, [&](const glm::vec3& p) {
    const float along = glm::dot(inwards, p - leaf.centroid);
    if (!(along > best)) return;
    best = along;
    leaf.stalk = p;
  });
}

}  // namespace

void findLeaves(Plant& plant) {
  plant.leaves.clear();
  plant.leaf_triangles.clear();
  for (std::uint32_t m = 0; m < plant.meshes.size(); ++m)
    if (plant.meshes[m].kind == PartKind::kFoliage) appendLeaves(plant, m);
  const WoodPoints wood = collectWood(plant);
  const glm::vec3 axis = bounds(plant).center();
  std::unique_ptr<WoodTree> tree;
  if (!wood.points.empty() && !plant.leaves.empty())
    tree = std::make_unique<WoodTree>(3, wood, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  parallelFor(plant.leaves.size(), 256, [&](std::size_t i) {
    Leaf& leaf = plant.leaves[i];
    leaf.stalk = leaf.centroid;
    measure(plant, leaf);
    if (tree)
      attachToWood(plant, wood, *tree, leaf);
    else
      attachToAxis(plant, axis, leaf);
  });
}

}  // namespace verdure
