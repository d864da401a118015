// findBranches() against branches that are known: those of growth, of formulas and of the programs
// that made foreign plants (VERDURE_PLANT_DIR).
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/transform.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "plant/axis_fit.h"
#include "plant/axis_tree.h"
#include "verdure/grow.h"
#include "verdure/motion.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

/// How much of the true branches was found, by length.
struct Agreement {
  double found = 0.0;        ///< share that belongs to a branch of its own
  double parents = 0.0;      ///< share of branches with the right parent
  double radii = 0.0;        ///< share where the radius is within 15 %
  double radius_rms = 0.0;   ///< of radii, relative
  double axes = 0.0;         ///< mean distance of axes, in radii
  std::size_t extra = 0;     ///< branches that are none
};

void print(const std::string& name, const Agreement& a) {
  std::printf("%-28s found %.4f parents %.4f radii %.4f (rms %.3f) axes %.3f r, extra %zu\n",
              name.c_str(), a.found, a.parents, a.radii, a.radius_rms, a.axes, a.extra);
}

double lengthOf(const Branch& b) { return static_cast<double>(axisLength(b.points)); }

/// `match`: the found branch of each true one, kNone: not found.
Agreement agreement(const std::vector<Branch>& truth, const std::vector<Branch>& found,
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
      result.axes += length * static_cast<double>(place.second / radius);
    }
  }
  result.found /= all;
  result.parents /= all;
  if (measured > 0.0) {
    result.radii /= measured;
    result.axes /= measured;
    result.radius_rms = std::sqrt(squares / measured);
  }
  result.extra = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
  return result;
}

/// One true branch for each found one and the other way round: those that share most.
std::vector<std::uint32_t> matchOf(
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

std::vector<std::uint32_t> matchByVertices(const Plant& truth, const Plant& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;
  for (std::size_t m = 0; m < truth.meshes.size(); ++m)
    for (std::size_t v = 0; v < truth.meshes[m].branch_of_vertex.size(); ++v)
      shared[{truth.meshes[m].branch_of_vertex[v], found.meshes[m].branch_of_vertex[v]}] += 1.0;
  return matchOf(truth.branches.size(), found.branches.size(), shared);
}

/// By the axes alone: the found branch that most of a true one runs along.
std::vector<std::uint32_t> matchByAxes(const std::vector<Branch>& truth,
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
      if (nearest.branch != kNone)
        shared[{t, nearest.branch}] += static_cast<double>(length);
    }
  }
  return matchOf(truth.size(), found.size(), shared);
}

// --- what always holds

void expectTree(const Plant& plant) {
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

// --- plants that were grown here

Plant grown(const std::string& species, std::uint32_t seed) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  options.texture_size = 32;
  return grow(options);
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const SpeciesInfo& info : speciesList()) list.push_back(info.name);
  return list;
}

class FoundIn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Species, FoundIn, testing::ValuesIn(names()), [](const auto& species) {
  std::string name = species.param;
  std::erase(name, '-');
  return name;
});

TEST_P(FoundIn, WhatHasGrown) {
  const Plant truth = grown(GetParam(), 1);
  Plant plant = truth;
  findBranches(plant);
  expectTree(plant);
  const Agreement a = agreement(truth.branches, plant.branches, matchByVertices(truth, plant));
  print(GetParam(), a);
  std::size_t leaves = 0;
  const auto match = matchByVertices(truth, plant);
  for (std::size_t l = 0; l < truth.leaves.size(); ++l)
    leaves += match[truth.leaves[l].branch] == plant.leaves[l].branch ? 1 : 0;
  const double on_theirs =
      static_cast<double>(leaves) / static_cast<double>(std::max<std::size_t>(1, truth.leaves.size()));
  std::printf("%-28s leaves on their branch %.4f\n", "", on_theirs);
  EXPECT_GE(a.parents, 0.95);
  EXPECT_GE(a.radii, 0.95);
  EXPECT_LT(a.axes, 0.1);
  if (!truth.leaves.empty()) {
    EXPECT_GE(on_theirs, 0.95);
  }
}

TEST(FindBranches, DoesNotDependOnThreads) {
  const auto found = [](int threads) {
    setThreadCount(threads);
    Plant plant = grown("black-oak", 2);
    findBranches(plant);
    setThreadCount(0);
    return plant;
  };
  const Plant one = found(1), two = found(2), five = found(5);
  for (const Plant* other : {&two, &five}) {
    ASSERT_EQ(one.branches.size(), other->branches.size());
    for (std::size_t b = 0; b < one.branches.size(); ++b) {
      ASSERT_EQ(one.branches[b].parent, other->branches[b].parent);
      ASSERT_EQ(one.branches[b].points.size(), other->branches[b].points.size());
      for (std::size_t i = 0; i < one.branches[b].points.size(); ++i) {
        ASSERT_EQ(one.branches[b].points[i].position, other->branches[b].points[i].position);
        ASSERT_EQ(one.branches[b].points[i].radius, other->branches[b].points[i].radius);
      }
    }
    for (std::size_t m = 0; m < one.meshes.size(); ++m)
      ASSERT_EQ(one.meshes[m].branch_of_vertex, other->meshes[m].branch_of_vertex);
    for (std::size_t l = 0; l < one.leaves.size(); ++l)
      ASSERT_EQ(one.leaves[l].branch, other->leaves[l].branch);
  }
}

// --- closed forms

/// A tube along a curve from 0 to 1, without ends.
Mesh tube(const std::function<glm::vec3(float)>& curve, const std::function<float(float)>& radius,
          int rings, int sides) {
  Mesh mesh;
  for (int i = 0; i <= rings; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(rings);
    const glm::vec3 along = glm::normalize(curve(t + 1e-3f) - curve(t - 1e-3f));
    const glm::vec3 a = glm::normalize(
        glm::cross(along, std::abs(along.z) < 0.7f ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0)));
    const glm::vec3 b = glm::cross(along, a);
    for (int s = 0; s < sides; ++s) {
      const float angle = glm::two_pi<float>() * static_cast<float>(s) / static_cast<float>(sides);
      const glm::vec3 n = std::cos(angle) * a + std::sin(angle) * b;
      mesh.positions.push_back(curve(t) + radius(t) * n);
      mesh.normals.push_back(n);
    }
  }
  const auto at = [sides](int i, int s) { return static_cast<std::uint32_t>(i * sides + s % sides); };
  for (int i = 0; i < rings; ++i)
    for (int s = 0; s < sides; ++s)
      for (const std::uint32_t v : {at(i, s), at(i, s + 1), at(i + 1, s + 1), at(i, s),
                                    at(i + 1, s + 1), at(i + 1, s)})
        mesh.indices.push_back(v);
  return mesh;
}

Plant plantOf(std::vector<Mesh> meshes) {
  Plant plant;
  plant.name = "formula";
  plant.materials.resize(1);
  plant.meshes = std::move(meshes);
  findLeaves(plant);
  return plant;
}

Mesh cone(const glm::vec3& from, const glm::vec3& to, float base, float tip, int rings, int sides) {
  return tube([=](float t) { return glm::mix(from, to, t); },
              [=](float t) { return glm::mix(base, tip, t); }, rings, sides);
}

TEST(FindBranches, FindsACone) {
  for (const auto& [rings, sides] : {std::pair{1, 3}, {2, 5}, {9, 8}, {200, 24}}) {
    Plant plant = plantOf({cone({1, 0, 2}, {2, 5, 2}, 0.2f, 0.0f, rings, sides)});
    findBranches(plant);
    expectTree(plant);
    ASSERT_EQ(plant.branches.size(), 1u) << rings;
    const std::vector<BranchPoint>& axis = plant.branches[0].points;
    EXPECT_LT(glm::length(axis.front().position - glm::vec3(1, 0, 2)), 2e-3f);
    EXPECT_LT(glm::length(axis.back().position - glm::vec3(2, 5, 2)), 2e-3f);
    for (int k = 0; k <= 10; ++k) {
      const float along = 0.1f * static_cast<float>(k) * axisLength(axis);
      EXPECT_NEAR(radiusOnAxis(axis, along), 0.2f * (1 - 0.1f * static_cast<float>(k)), 0.004f);
    }
  }
}

TEST(FindBranches, FollowsACurve) {
  // A quarter of a circle of radius 2, up and over.
  const auto curve = [](float t) {
    const float a = t * glm::half_pi<float>();
    return glm::vec3(2 - 2 * std::cos(a), 2 * std::sin(a), 0);
  };
  for (const int rings : {12, 60, 400}) {
    Plant plant = plantOf({tube(curve, [](float t) { return 0.2f - 0.15f * t; }, rings, 12)});
    findBranches(plant);
    ASSERT_EQ(plant.branches.size(), 1u);
    const std::vector<BranchPoint>& axis = plant.branches[0].points;
    EXPECT_NEAR(axisLength(axis), glm::pi<float>(), 0.02f);
    for (int k = 0; k <= 20; ++k) {
      const float t = 0.05f * static_cast<float>(k);
      const auto [along, off] = placeOnAxis(axis, curve(t));
      EXPECT_LT(off, 0.01f) << rings << " " << t;
      EXPECT_NEAR(radiusOnAxis(axis, along), 0.2f - 0.15f * t, 0.015f) << rings << " " << t;
    }
  }
}

/// One closed surface: a smooth union of capsules by marching tetrahedra would need a mesher; here
/// three tubes share the vertices of a fork's rim. The trunk's last ring has 2n points; each arm
/// begins with one half of it and a seam of n - 1 points across.
Plant fork(float thick, float thin) {
  constexpr int kSides = 16, kHalf = kSides / 2;
  Mesh mesh;
  const auto ring = [&mesh](const glm::vec3& center, const glm::vec3& a, const glm::vec3& b) {
    std::vector<std::uint32_t> points;
    for (int s = 0; s < kSides; ++s) {
      const float angle = glm::two_pi<float>() * static_cast<float>(s) / kSides;
      points.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(center + std::cos(angle) * a + std::sin(angle) * b);
    }
    return points;
  };
  const auto connect = [&mesh](const std::vector<std::uint32_t>& low,
                               const std::vector<std::uint32_t>& high) {
    for (std::size_t s = 0; s < low.size(); ++s) {
      const std::size_t n = (s + 1) % low.size();
      for (const std::uint32_t v : {low[s], low[n], high[n], low[s], high[n], high[s]})
        mesh.indices.push_back(v);
    }
  };
  std::vector<std::uint32_t> below, foot;
  for (int i = 0; i <= 8; ++i) {
    const auto next = ring({0, 0.25f * static_cast<float>(i), 0}, {0.2f, 0, 0}, {0, 0, 0.2f});
    if (i > 0) connect(below, next);
    below = next;
  }
  // The seam from point kHalf over the middle to point 0... its points are between them.
  std::vector<std::uint32_t> seam;
  for (int s = 1; s < kHalf; ++s) {
    seam.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    const float x = 0.2f - 0.4f * static_cast<float>(s) / kHalf;
    mesh.positions.emplace_back(x, 2.08f, 0.0f);
  }
  const auto arm = [&](bool front, const glm::vec3& way, float base) {
    std::vector<std::uint32_t> low;
    for (int s = 0; s <= kHalf; ++s)
      low.push_back(below[static_cast<std::size_t>(front ? s : (s + kHalf) % kSides)]);
    for (int s = 1; s < kHalf; ++s)  // back to the first along the seam
      low.push_back(seam[static_cast<std::size_t>(front ? kHalf - 1 - s : s - 1)]);
    const glm::vec3 t = glm::normalize(way);
    const glm::vec3 a = front ? glm::vec3(1, 0, 0) : glm::vec3(-1, 0, 0);
    const glm::vec3 b = front ? glm::cross(a, t) : glm::cross(a, t);
    for (int i = 1; i <= 12; ++i) {
      const float radius = base * (1 - 0.06f * static_cast<float>(i));
      const auto next = ring(glm::vec3(0, 2.1f, front ? 0.1f : -0.1f) +
                                 way * (static_cast<float>(i) / 12.0f),
                             radius * a, radius * b);
      connect(low, next);
      low = next;
    }
  };
  arm(true, {0, 1.6f, 1.2f}, thin);
  arm(false, {0, 2.0f, -0.3f}, thick);
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 1, 0));
  return plantOf({mesh});
}

TEST(FindBranches, SplitsAFork) {
  Plant plant = fork(0.16f, 0.1f);
  findBranches(plant);
  expectTree(plant);
  ASSERT_EQ(plant.branches.size(), 2u);
  EXPECT_EQ(plant.branches[1].parent, 0u);
  // The thick and straight arm goes on as the trunk.
  EXPECT_LT(plant.branches[0].points.front().position.y, 0.01f);
  EXPECT_LT(glm::length(plant.branches[0].points.back().position - glm::vec3(0, 4.1f, -0.4f)), 0.02f);
  EXPECT_LT(glm::length(plant.branches[1].points.back().position - glm::vec3(0, 3.7f, 1.3f)), 0.02f);
  // The other leaves it where the arms part.
  const glm::vec3 root = plant.branches[1].points.front().position;
  EXPECT_LT(placeOnAxis(plant.branches[0].points, root).second, 1e-3f);
  EXPECT_NEAR(root.y, 2.0f, 0.2f);
  const std::vector<BranchPoint>& arm = plant.branches[1].points;
  EXPECT_NEAR(radiusOnAxis(arm, 0.7f * axisLength(arm)), 0.1f * (1 - 0.72f * 0.65f), 0.01f);
}

/// A trunk and boughs as separate tubes that begin on its axis, and twigs on those.
Plant tubes() {
  std::vector<Mesh> meshes{cone({0, 0, 0}, {0, 6, 0}, 0.3f, 0.02f, 12, 12)};
  for (int i = 0; i < 5; ++i) {
    const float turn = 2.4f * static_cast<float>(i);
    const glm::vec3 out(std::cos(turn), 0.5f, std::sin(turn));
    const glm::vec3 root(0, 1.5f + 0.8f * static_cast<float>(i), 0);
    meshes.push_back(cone(root, root + 2.0f * out, 0.08f, 0.01f, 6, 8));
    meshes.push_back(cone(root + 1.2f * out, root + 1.2f * out + glm::vec3(0.1f, 0.9f, 0), 0.03f,
                          0.004f, 4, 5));
  }
  return plantOf(std::move(meshes));
}

TEST(FindBranches, HangsTubesOnEachOther) {
  Plant plant = tubes();
  findBranches(plant);
  expectTree(plant);
  ASSERT_EQ(plant.branches.size(), 11u);
  const auto branch = [&](std::size_t mesh) { return plant.meshes[mesh].branch_of_vertex[0]; };
  EXPECT_EQ(plant.branches[branch(0)].parent, kNone);
  for (std::size_t i = 0; i < 5; ++i) {
    const Branch& bough = plant.branches[branch(1 + 2 * i)];
    EXPECT_EQ(bough.parent, branch(0));
    EXPECT_NEAR(bough.parent_offset, (1.5f + 0.8f * static_cast<float>(i)) / 6, 0.01f);
    EXPECT_EQ(plant.branches[branch(2 + 2 * i)].parent, branch(1 + 2 * i));
    EXPECT_NEAR(plant.branches[branch(2 + 2 * i)].parent_offset, 0.6f, 0.01f);
  }
}

TEST(FindBranches, IsTheSameTurnedScaledMovedAndMirrored) {
  Plant plant = tubes();
  findBranches(plant);
  const glm::mat4 moves[] = {
      glm::translate(glm::vec3(40, -7, 12)), glm::scale(glm::vec3(100.0f)),
      glm::scale(glm::vec3(0.01f)), glm::scale(glm::vec3(-1, 1, 1)),
      glm::translate(glm::vec3(3, 1, 2)) * glm::rotate(0.7f, glm::vec3(0, 1, 0)) *
          glm::rotate(0.2f, glm::vec3(1, 0, 0)) * glm::scale(glm::vec3(2.5f))};
  for (const glm::mat4& move : moves) {
    const float size = std::cbrt(std::abs(glm::determinant(glm::mat3(move))));
    Plant other = tubes();
    for (Mesh& mesh : other.meshes) {
      for (glm::vec3& p : mesh.positions) p = glm::vec3(move * glm::vec4(p, 1));
      if (glm::determinant(glm::mat3(move)) < 0)
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
          std::swap(mesh.indices[i], mesh.indices[i + 1]);
    }
    findBranches(other);
    ASSERT_EQ(other.branches.size(), plant.branches.size());
    for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
      const Branch& a = plant.branches[plant.meshes[m].branch_of_vertex[0]];
      const Branch& b = other.branches[other.meshes[m].branch_of_vertex[0]];
      EXPECT_EQ(a.level, b.level);
      EXPECT_NEAR(a.parent_offset, b.parent_offset, 2e-3f);
      EXPECT_NEAR(axisLength(b.points), size * axisLength(a.points), 2e-3f * size);
      for (const BranchPoint& p : a.points) {
        const auto [along, off] = placeOnAxis(b.points, glm::vec3(move * glm::vec4(p.position, 1)));
        EXPECT_LT(off, 2e-3f * size);
        EXPECT_NEAR(radiusOnAxis(b.points, along), size * p.radius, 3e-3f * size);
      }
    }
  }
}

TEST(FindBranches, TakesAnyTrianglesForWhatTheyAre) {
  // Unindexed, in any order, and without area: the same branches.
  Plant plant = tubes();
  findBranches(plant);
  Plant loose = tubes();
  for (Mesh& mesh : loose.meshes) {
    Mesh other;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t from = mesh.indices.size() - 3 - i / 3 * 3 + i % 3;
      other.indices.push_back(static_cast<std::uint32_t>(i));
      other.positions.push_back(mesh.positions[mesh.indices[from]]);
      other.normals.push_back(mesh.normals[mesh.indices[from]]);
    }
    other.indices.insert(other.indices.end(), {0, 0, 1, 2, 2, 2});
    mesh = other;
  }
  findBranches(loose);
  expectTree(loose);
  ASSERT_EQ(loose.branches.size(), plant.branches.size());
  for (std::size_t b = 0; b < plant.branches.size(); ++b) {
    EXPECT_EQ(plant.branches[b].level, loose.branches[b].level);
    EXPECT_NEAR(axisLength(plant.branches[b].points), axisLength(loose.branches[b].points), 1e-3f);
  }
}

TEST(FindBranches, NeverFailsOnScraps) {
  Mesh triangle;
  triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.normals.assign(3, glm::vec3(0, 0, 1));
  triangle.indices = {0, 1, 2};
  Mesh point = triangle;
  point.positions.assign(3, glm::vec3(2, 3, 4));
  Mesh line = triangle;
  line.positions[2] = {2, 0, 0};
  Mesh card = triangle;
  card.positions.push_back({1, 1, 0});
  card.normals.push_back({0, 0, 1});
  card.indices = {0, 1, 2, 1, 3, 2};
  Mesh foliage = card;
  foliage.kind = PartKind::kFoliage;
  for (const std::vector<Mesh>& meshes : std::vector<std::vector<Mesh>>{
           {triangle}, {point}, {line}, {card}, {foliage}, {foliage, point}, {foliage, card},
           {triangle, point, line, card, foliage}}) {
    Plant plant = plantOf(meshes);
    findBranches(plant);
    expectTree(plant);
  }
  Plant nothing = plantOf({});
  findBranches(nothing);
  EXPECT_TRUE(nothing.branches.empty());
  Mesh empty;
  Plant without = plantOf({empty});
  findBranches(without);
  EXPECT_TRUE(without.branches.empty());
}

TEST(FindBranches, LetsFoliageWithoutWoodSwayAsAWhole) {
  Mesh card = cone({0, 0, 0}, {0, 1, 0}, 0.5f, 0.5f, 1, 4);
  card.kind = PartKind::kFoliage;
  Plant plant = plantOf({card});
  findBranches(plant);
  ASSERT_EQ(plant.branches.size(), 1u);
  EXPECT_NEAR(plant.branches[0].points.front().position.y, 0.0f, 1e-6f);
  EXPECT_NEAR(plant.branches[0].points.back().position.y, 1.0f, 1e-6f);
  ASSERT_FALSE(plant.notes.empty());
  EXPECT_NE(plant.notes.back().find("upright"), std::string::npos);
  findBranches(plant);  // again, and still one note
  EXPECT_EQ(std::count_if(plant.notes.begin(), plant.notes.end(),
                          [](const std::string& n) { return n.starts_with("branches: "); }),
            1);
}

// --- foreign plants

class SkeletonOf : public testing::Test {
 protected:
  void SetUp() override {
    const char* dir = std::getenv("VERDURE_PLANT_DIR");
    if (dir == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
    dir_ = dir;
  }

  /// Blender's axes (Z up) and splines.
  std::vector<Branch> truthOf(const std::string& name) const {
    std::string text;
    const gzFile file = gzopen((dir_ / (name + ".truth.json.gz")).c_str(), "rb");
    EXPECT_NE(file, nullptr);
    char buffer[1 << 16];
    for (int n = 0; (n = gzread(file, buffer, sizeof buffer)) > 0;)
      text.append(buffer, static_cast<std::size_t>(n));
    gzclose(file);
    std::vector<Branch> branches;
    const auto json = nlohmann::json::parse(text);
    for (const auto& spline : json["splines"]) {
      Branch branch;
      if (!spline["parent"].is_null()) branch.parent = spline["parent"][0];
      for (const auto& p : spline["pts"])
        branch.points.push_back({{p[0], p[2], -p[1].get<float>()}, p[3]});
      branches.push_back(branch);
    }
    return branches;
  }
  Plant found(const std::string& name) const {
    Plant plant = loadPlant(dir_ / (name + ".glb"));
    findBranches(plant);
    return plant;
  }
  fs::path dir_;
};

TEST_F(SkeletonOf, PlantsOfKnownBranches) {
  for (const char* name : {"quaking_aspen_L3", "weeping_willow", "callistemon",
                           "callistemon_arm_anim", "small_maple_hex"}) {
    SCOPED_TRACE(name);
    const bool rigged = std::string(name) == "callistemon_arm_anim";
    const std::vector<Branch> truth = truthOf(rigged ? "callistemon" : name);
    const Plant plant = found(name);
    const Agreement a =
        agreement(truth, plant.branches, matchByAxes(truth, plant.branches));
    print(name, a);
    EXPECT_GE(a.parents, 0.95);
    if (!rigged) {
      EXPECT_GE(a.radii, 0.95);
    }
  }
}

TEST_F(SkeletonOf, OneContinuousBark) {
  // The same aspen's trunk and boughs under one skin of bark, and its rings welded.
  std::vector<Branch> truth = truthOf("quaking_aspen_L3");
  std::erase_if(truth, [&](const Branch& b) { return b.parent != kNone && b.parent != 0; });
  for (const char* name : {"quaking_aspen_skin", "quaking_aspen_weld"}) {
    const Plant plant = found(name);
    const Agreement a = agreement(truth, plant.branches, matchByAxes(truth, plant.branches));
    print(name, a);
    EXPECT_GE(a.parents, 0.9);
  }
}

TEST_F(SkeletonOf, EveryPlantIsATree) {
  for (const auto& entry : fs::directory_iterator(dir_)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().stem().string());
    Plant plant = loadPlant(entry.path());
    findBranches(plant);
    expectTree(plant);
  }
}

}  // namespace
}  // namespace verdure
