#ifndef VERDURE_TESTS_BRANCH_CHECKS_H_
#define VERDURE_TESTS_BRANCH_CHECKS_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "plant/axis_fit.h"
#include "plant/axis_tree.h"
#include "verdure/motion.h"

/// Branches that were found beside those that are known.
namespace verdure {

/// How much of the true branches was found, by length.
struct Agreement {
  double found = 0.0;       ///< share that belongs to a branch of its own
  double parents = 0.0;     ///< share of branches with the right parent
  double radii = 0.0;       ///< share where the radius is within 15 %
  double radius_rms = 0.0;  ///< of radii, relative
  double axes = 0.0;        ///< mean distance of axes, in radii
  std::size_t extra = 0;    ///< branches that are none
};

inline void print(const std::string& name, const Agreement& a) {
  std::printf("%-28s found %.4f parents %.4f radii %.4f (rms %.3f) axes %.3f r, extra %zu\n",
              name.c_str(), a.found, a.parents, a.radii, a.radius_rms, a.axes, a.extra);
}

inline double lengthOf(const Branch& b) {
  return static_cast<double>(axisLength(b.points));
}

/// `match`: the found branch of each true one, kNone: not found.
inline Agreement agreement(const std::vector<Branch>& truth, const std::vector<Branch>& found,
                           const std::vector<std::uint32_t>& match) {
  Agreement result;
  double all = 0.0, measured = 0.0, squares = 0.0;
  std::vector<bool> used(found.size(), false);
  for (std::size_t t = 0; t < truth.size(); ++t) {
    const double length = lengthOf(truth[t]);
    all += length;
    if (match[t] == kNone) continue;
    used[match[t]] = true;
    result.found += length;
    const std::uint32_t parent = found[match[t]].parent;
    if (truth[t].parent == kNone ? parent == kNone
                                 : parent != kNone && match[truth[t].parent] == parent)
      result.parents += length;
    // Sixteen places a branch, its root within the parent left out.
    const std::vector<BranchPoint>& axis = truth[t].points;
    const float thick = axis.front().radius;
    for (int k = 0; k < 16; ++k) {
      const float along = static_cast<float>(length) * (static_cast<float>(k) + 0.5f) / 16.0f;
      const float radius = std::max(radiusOnAxis(axis, along), 0.1f * thick);
      const auto place = placeOnAxis(found[match[t]].points, pointOnAxis(axis, along));
      const float other = radiusOnAxis(found[match[t]].points, place.first);
      const double error = std::abs(other - radiusOnAxis(axis, along)) / radius;
      measured += length;
      squares += length * error * error;
      if (error <= 0.15) result.radii += length;
    }
    // Axes at the points by which the truth is given: Blender's curves run through them.
    for (const BranchPoint& p : axis)
      result.axes += length / static_cast<double>(axis.size()) *
                     static_cast<double>(placeOnAxis(found[match[t]].points, p.position).second /
                                         std::max(p.radius, 0.1f * thick));
  }
  result.found /= all;
  result.parents /= all;
  if (measured > 0.0) {
    result.radii /= measured;
    result.axes /= measured / 16.0;
    result.radius_rms = std::sqrt(squares / measured);
  }
  result.extra = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  return result;
}

/// One true branch for each found one and the other way round: those that share most.
inline std::vector<std::uint32_t> matchOf(
    std::size_t truths, std::size_t founds,
    const std::map<std::pair<std::uint32_t, std::uint32_t>, double>& shared) {
  std::vector<std::uint32_t> best_found(truths, kNone), best_truth(founds, kNone);
  std::vector<double> most_found(truths, 0.0), most_truth(founds, 0.0);
  for (const auto& [pair, weight] : shared) {
    const auto [t, f] = pair;
    if (weight > most_found[t]) {
      most_found[t] = weight;
      best_found[t] = f;
    }
    if (weight > most_truth[f]) {
      most_truth[f] = weight;
      best_truth[f] = t;
    }
  }
  for (std::uint32_t t = 0; t < truths; ++t)
    if (best_found[t] != kNone && best_truth[best_found[t]] != t) best_found[t] = kNone;
  return best_found;
}

inline std::vector<std::uint32_t> matchByVertices(const Plant& truth, const Plant& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;
  for (std::size_t m = 0; m < truth.meshes.size(); ++m)
    for (std::size_t v = 0; v < truth.meshes[m].branch_of_vertex.size(); ++v)
      shared[{truth.meshes[m].branch_of_vertex[v], found.meshes[m].branch_of_vertex[v]}] += 1.0;
  return matchOf(truth.branches.size(), found.branches.size(), shared);
}

/// By the axes alone: the found branch that most of a true one runs along.
inline std::vector<std::uint32_t> matchByAxes(const std::vector<Branch>& truth,
                                              const std::vector<Branch>& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;
  const AxisTree axes(found);
  for (std::uint32_t t = 0; t < truth.size(); ++t) {
    const float length = axisLength(truth[t].points);
    for (int k = 4; k < 32; ++k) {  // roots lie within the parent
      const glm::vec3 p =
          pointOnAxis(truth[t].points, length * (static_cast<float>(k) + 0.5f) / 32.0f);
      AxisHit nearest;
      for (const AxisHit& hit : axes.within(p, 0.05f * length))
        if (nearest.branch == kNone || hit.distance < nearest.distance) nearest = hit;
      if (nearest.branch != kNone) shared[{t, nearest.branch}] += static_cast<double>(length);
    }
  }
  return matchOf(truth.size(), found.size(), shared);
}

inline void expectTree(const Plant& plant) {
  const std::size_t count = plant.branches.size();
  ASSERT_GT(count, 0u);
  for (std::uint32_t b = 0; b < count; ++b) {
    const Branch& branch = plant.branches[b];
    ASSERT_GE(branch.points.size(), 2u);
    if (branch.parent == kNone) {
      ASSERT_EQ(branch.level, 0);
    } else {
      ASSERT_LT(branch.parent, b);
      ASSERT_EQ(branch.level, plant.branches[branch.parent].level + 1);
    }
    ASSERT_GE(branch.parent_offset, 0.0f);
    ASSERT_LE(branch.parent_offset, 1.0f);
    for (const BranchPoint& p : branch.points) {
      ASSERT_TRUE(std::isfinite(p.position.x + p.position.y + p.position.z));
      ASSERT_GE(p.radius, 0.0f);
      ASSERT_TRUE(std::isfinite(p.radius));
    }
  }
  for (const Mesh& mesh : plant.meshes) {
    if (mesh.kind != PartKind::kWood) continue;
    ASSERT_EQ(mesh.branch_of_vertex.size(), mesh.positions.size());
    for (const std::uint32_t b : mesh.branch_of_vertex) ASSERT_LT(b, count);
  }
  for (const Leaf& leaf : plant.leaves) ASSERT_LT(leaf.branch, count);
  const MotionTree tree = motionTree(plant);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    for (const VertexMotion& v : tree.meshes[m]) {
      ASSERT_LT(v.branch, tree.branches.size());
      for (int k = 0; k < 4; ++k) ASSERT_TRUE(v.places[k] >= 0.0f && v.places[k] <= 1.0f);
    }
  for (const MotionBranch& beam : tree.branches) {
    ASSERT_GT(beam.length, 0.0f);
    ASSERT_TRUE(std::isfinite(beam.fit.x + beam.fit.y + beam.wood_m3));
  }
}

}  // namespace verdure

#endif  // VERDURE_TESTS_BRANCH_CHECKS_H_
