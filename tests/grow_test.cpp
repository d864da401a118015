#include "verdure/grow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "base/parallel.h"
#include "verdure/error.h"

namespace verdure {
namespace {

Plant growSmall(const std::string& species, std::uint32_t seed = 1,
                LeafForm form = LeafForm::kMesh) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  options.leaf_form = form;
  options.texture_size = 64;
  return grow(options);
}

/// growSmall() of a species with seed 1, made once for the cases that follow each other.
const Plant& grownSmall(const std::string& species) {
  static std::map<std::string, Plant> known;
  const auto at = known.find(species);
  return at != known.end() ? at->second : known.emplace(species, growSmall(species)).first->second;
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expectSame(const Plant& a, const Plant& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_TRUE(sameBits(a.meshes[i].positions, b.meshes[i].positions));
    EXPECT_TRUE(sameBits(a.meshes[i].normals, b.meshes[i].normals));
    EXPECT_TRUE(sameBits(a.meshes[i].uvs, b.meshes[i].uvs));
    EXPECT_TRUE(sameBits(a.meshes[i].indices, b.meshes[i].indices));
    EXPECT_TRUE(sameBits(a.meshes[i].branch_of_vertex, b.meshes[i].branch_of_vertex));
  }
  EXPECT_TRUE(sameBits(a.leaves, b.leaves));
  EXPECT_TRUE(sameBits(a.leaf_triangles, b.leaf_triangles));
  ASSERT_EQ(a.branches.size(), b.branches.size());
  for (std::size_t i = 0; i < a.branches.size(); ++i)
    EXPECT_TRUE(sameBits(a.branches[i].points, b.branches[i].points));
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (std::size_t i = 0; i < a.textures.size(); ++i)
    EXPECT_TRUE(sameBits(a.textures[i].image.rgba, b.textures[i].image.rgba));
}

using Place = std::tuple<float, float, float>;
Place placeOf(const glm::vec3& p) {
  return {p.x, p.y, p.z};
}

/// Checks that the wood of each branch is a closed surface that faces outwards.
void expectClosedStems(const Plant& plant) {
  std::vector<std::vector<std::uint32_t>> triangles(plant.branches.size());
  std::vector<const Mesh*> mesh_of(plant.branches.size(), nullptr);
  for (const Mesh& wood : plant.meshes) {
    if (wood.kind != PartKind::kWood) continue;
    ASSERT_EQ(wood.branch_of_vertex.size(), wood.positions.size());
    for (std::uint32_t t = 0; t < wood.triangleCount(); ++t) {
      const std::uint32_t branch = wood.branch_of_vertex[wood.indices[3 * t]];
      ASSERT_LT(branch, plant.branches.size());
      ASSERT_TRUE(mesh_of[branch] == nullptr || mesh_of[branch] == &wood);
      mesh_of[branch] = &wood;
      triangles[branch].push_back(t);
    }
  }
  for (std::size_t b = 0; b < triangles.size(); ++b) {
    ASSERT_NE(mesh_of[b], nullptr) << "branch " << b << " has no surface";
    const Mesh& wood = *mesh_of[b];
    std::map<Place, int> weld;
    std::map<std::pair<int, int>, int> edges;  // directed
    double volume = 0;
    const glm::dvec3 origin = plant.branches[b].points[0].position;
    for (const std::uint32_t t : triangles[b]) {
      int v[3];
      glm::dvec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t index = wood.indices[3 * t + k];
        ASSERT_EQ(wood.branch_of_vertex[index], b);
        v[k] = weld.try_emplace(placeOf(wood.positions[index]), static_cast<int>(weld.size()))
                   .first->second;
        p[k] = glm::dvec3(wood.positions[index]) - origin;
      }
      for (int k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
      volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6;
    }
    EXPECT_GT(volume, 0) << "branch " << b;
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << "branch " << b;
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << "branch " << b;
    }
  }
}

class EverySpecies : public testing::TestWithParam<std::string> {};
std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const SpeciesInfo& info : speciesList()) list.push_back(info.name);
  return list;
}
INSTANTIATE_TEST_SUITE_P(Grow, EverySpecies, testing::ValuesIn(names()), [](const auto& species) {
  std::string name = species.param;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

TEST_P(EverySpecies, IsTheSameForAnyNumberOfThreads) {
  setThreadCount(1);
  const Plant one = growSmall(GetParam());
  setThreadCount(2);
  const Plant two = growSmall(GetParam());
  setThreadCount(0);
  expectSame(one, two);
}

TEST_P(EverySpecies, HasLeavesAndLevelsOfARealPlant) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const Plant plant = seed == 1 ? grownSmall(GetParam()) : growSmall(GetParam(), seed);
    EXPECT_GE(plant.leaves.size(), 5000u) << seed;
    EXPECT_LE(plant.leaves.size(), 60000u) << seed;
    EXPECT_LE(vertexCount(plant), 400000u) << seed;
    int deepest = 0;
    for (const Branch& branch : plant.branches) deepest = std::max(deepest, branch.level);
    EXPECT_GE(deepest + 2, 4) << "stems of levels 0 to " << deepest << " and leaves";
    for (const Leaf& leaf : plant.leaves) {
      ASSERT_LT(leaf.branch, plant.branches.size());
      ASSERT_EQ(plant.branches[leaf.branch].level, deepest);
    }
    const Bounds box = bounds(plant);
    EXPECT_NEAR(bounds(plant, PartKind::kWood).min.y, 0, 0.3f) << seed;
    EXPECT_GT(box.max.y, 1);
    EXPECT_LT(box.max.y, 30);
  }
}

TEST_P(EverySpecies, HasSoundArrays) {
  for (const LeafForm form : {LeafForm::kMesh, LeafForm::kCard}) {
    const Plant plant = growSmall(GetParam(), 5, form);
    EXPECT_EQ(plant.name, GetParam());
    EXPECT_EQ(plant.meshes[1].kind, PartKind::kFoliage);
    for (const Mesh& mesh : plant.meshes) {
      ASSERT_LT(mesh.material, plant.materials.size());
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_TRUE(std::isfinite(mesh.positions[i].x + mesh.positions[i].y + mesh.positions[i].z));
        ASSERT_TRUE(std::isfinite(mesh.uvs[i].x + mesh.uvs[i].y));
        ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-4);
      }
      for (const std::uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
    }
    for (const glm::vec2& uv : plant.meshes[1].uvs) {
      ASSERT_GE(std::min(uv.x, uv.y), 0);
      ASSERT_LE(std::max(uv.x, uv.y), 1);
    }
    for (const Material& material : plant.materials) {
      ASSERT_LT(material.base_color_texture, static_cast<int>(plant.textures.size()));
      ASSERT_LT(material.normal_texture, static_cast<int>(plant.textures.size()));
    }
  }
}

TEST_P(EverySpecies, HasClosedStemsThatFaceOutwards) {
  expectClosedStems(grownSmall(GetParam()));
}

TEST_P(EverySpecies, RootsEachStemInsideItsParent) {
  const Plant& plant = grownSmall(GetParam());
  for (std::size_t i = 0; i < plant.branches.size(); ++i) {
    const Branch& branch = plant.branches[i];
    ASSERT_GE(branch.points.size(), 2u);
    if (branch.parent == kNone) {
      EXPECT_EQ(branch.level, 0);
      continue;
    }
    ASSERT_LT(branch.parent, i);
    ASSERT_GE(branch.parent_offset, 0);
    ASSERT_LE(branch.parent_offset, 1);
    const Branch& parent = plant.branches[branch.parent];
    const glm::vec3 start = branch.points[0].position;
    float depth = -1e9f;  // under the parent's surface
    for (std::size_t k = 0; k + 1 < parent.points.size(); ++k) {
      const BranchPoint& a = parent.points[k];
      const BranchPoint& b = parent.points[k + 1];
      const glm::vec3 ab = b.position - a.position;
      const float t = glm::clamp(glm::dot(start - a.position, ab) / glm::dot(ab, ab), 0.0f, 1.0f);
      depth = std::max(depth,
                       glm::mix(a.radius, b.radius, t) - glm::length(start - a.position - t * ab));
    }
    EXPECT_GE(depth, -1e-5f) << "branch " << i;
    // A clone goes on with its parent's radius, a child is no thicker (twigs have a least radius).
    if (branch.level > parent.level) {
      EXPECT_LE(branch.points[0].radius, std::max(parent.points[0].radius, 0.00061f));
    }
  }
}

TEST_P(EverySpecies, TapersToTheTip) {
  const Plant& plant = grownSmall(GetParam());
  for (const Branch& branch : plant.branches) {
    if (branch.level == 0) continue;  // levels above the trunk have nTaper = 1
    for (std::size_t k = 1; k < branch.points.size(); ++k)
      ASSERT_LE(branch.points[k].radius, branch.points[k - 1].radius + 1e-7f);
    EXPECT_LE(branch.points.back().radius, 1.1e-5f);
  }
}

TEST_P(EverySpecies, KnowsItsLeaves) {
  for (const LeafForm form : {LeafForm::kMesh, LeafForm::kCard}) {
    const Plant plant =
        form == LeafForm::kMesh ? grownSmall(GetParam()) : growSmall(GetParam(), 1, form);
    const Mesh& mesh = plant.meshes[1];
    ASSERT_EQ(plant.leaf_triangles.size(), mesh.triangleCount());
    std::set<std::uint32_t> used(plant.leaf_triangles.begin(), plant.leaf_triangles.end());
    EXPECT_EQ(used.size(), mesh.triangleCount());  // each triangle belongs to one leaf
    std::map<Place, std::size_t> owner;
    double all = 0, sum = 0;
    for (std::size_t l = 0; l < plant.leaves.size(); ++l) {
      const Leaf& leaf = plant.leaves[l];
      ASSERT_EQ(leaf.mesh, 1u);
      if (form == LeafForm::kMesh) {
        ASSERT_GE(leaf.triangle_count, 4u);
      } else {
        ASSERT_EQ(leaf.triangle_count, 2u);
      }
      double area = 0;
      glm::dvec3 weighted(0);
      std::map<Place, Place> root;  // union by following links
      const auto find = [&root](Place p) {
        root.try_emplace(p, p);
        while (root[p] != p) p = root[p];
        return p;
      };
      bool stalk = false;
      for (std::uint32_t k = 0; k < leaf.triangle_count; ++k) {
        const std::uint32_t t = plant.leaf_triangles[leaf.first_triangle + k];
        glm::dvec3 p[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const glm::vec3& q = mesh.positions[mesh.indices[3 * t + c]];
          p[c] = q;
          ASSERT_EQ(owner.try_emplace(placeOf(q), l).first->second, l) << "two leaves touch";
          stalk = stalk || glm::length(q - leaf.stalk) < 0.51f * std::sqrt(leaf.area) + 0.02f;
          root[find(placeOf(q))] = find(placeOf(mesh.positions[mesh.indices[3 * t]]));
          // The vertex normal lies on the side of the face (tufts of needles are round instead).
          if (GetParam() != "scots-pine") {
            const std::uint32_t* i = &mesh.indices[3 * t];
            const glm::vec3 face = glm::cross(mesh.positions[i[1]] - mesh.positions[i[0]],
                                              mesh.positions[i[2]] - mesh.positions[i[0]]);
            ASSERT_GT(glm::dot(mesh.normals[i[c]], face), 0);
          }
        }
        const double one = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        area += one;
        weighted += one / 3 * (p[0] + p[1] + p[2]);
      }
      std::set<Place> pieces;
      for (const auto& [place, link] : root) pieces.insert(find(place));
      ASSERT_EQ(pieces.size(), 1u) << "leaf " << l << " is not one piece";
      ASSERT_TRUE(stalk);
      ASSERT_NEAR(leaf.area, area, 1e-4 * area);
      ASSERT_LT(glm::length(weighted / area - glm::dvec3(leaf.centroid)), 1e-4);
      sum += leaf.area;
    }
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
      const glm::dvec3 a = mesh.positions[mesh.indices[3 * t]];
      all += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[mesh.indices[3 * t + 1]]) - a,
                                          glm::dvec3(mesh.positions[mesh.indices[3 * t + 2]]) - a));
    }
    EXPECT_NEAR(sum, all, 1e-4 * all);
  }
}

TEST_P(EverySpecies, WrapsBarkAWholeNumberOfTimes) {
  const Plant& plant = grownSmall(GetParam());
  // Vertices of one branch at one place that differ in u alone are the seam.
  std::map<std::pair<std::uint32_t, Place>, glm::vec2> first;
  std::size_t seams = 0;
  for (const Mesh& wood : plant.meshes) {
    if (wood.kind != PartKind::kWood) continue;
    for (std::size_t i = 0; i < wood.positions.size(); ++i) {
      const auto key = std::pair(wood.branch_of_vertex[i], placeOf(wood.positions[i]));
      const auto [at, fresh] = first.try_emplace(key, wood.uvs[i]);
      if (fresh) continue;
      const float turns = wood.uvs[i].x - at->second.x;
      ASSERT_NEAR(turns, std::round(turns), 1e-5);
      ASSERT_GE(turns, 1);
      ASSERT_EQ(wood.uvs[i].y, at->second.y);
      ++seams;
    }
  }
  EXPECT_GE(seams, plant.branches.size());
}

TEST_P(EverySpecies, GrowsTheSameFromItsOwnParameters) {
  GrowOptions options;
  options.species = GetParam();
  options.texture_size = 64;
  for (const ParameterInfo& p : speciesParameters(GetParam())) {
    EXPECT_FALSE(p.help.empty());
    options.set.emplace_back(p.name, p.value);
  }
  expectSame(grow(options), grownSmall(GetParam()));
}

TEST(Grow, DiffersBySeed) {
  const Plant a = growSmall("quaking-aspen", 1), b = growSmall("quaking-aspen", 2);
  EXPECT_FALSE(sameBits(a.meshes[0].positions, b.meshes[0].positions));
  EXPECT_FALSE(sameBits(a.meshes[1].positions, b.meshes[1].positions));
}

TEST(Grow, ClosesStemsOfEveryTaper) {
  for (const char* taper : {"0", "0.5", "1", "1.4", "2", "2.5", "3"}) {
    GrowOptions options;
    options.texture_size = 32;
    options.set = {{"0Taper", taper}, {"1Taper", taper},    {"2Branches", "3"}, {"1Branches", "8"},
                   {"Leaves", "0"},   {"LobeDepth", "0.3"}, {"Lobes", "7"},     {"Ratio", "0.04"}};
    const Plant plant = grow(options);
    expectClosedStems(plant);
  }
}

std::string errorOf(const GrowOptions& options) {
  try {
    grow(options);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Grow, NamesWhatIsWrong) {
  const auto with = [](const std::string& name, const std::string& value) {
    GrowOptions options;
    options.set.emplace_back(name, value);
    return errorOf(options);
  };
  GrowOptions options;
  options.species = "quaking-aspn";
  EXPECT_NE(errorOf(options).find("quaking-aspen"), std::string::npos) << errorOf(options);
  EXPECT_NE(with("1CurvV", "3").find("1CurveV"), std::string::npos) << with("1CurvV", "3");
  EXPECT_NE(with("levels", "3").find("Levels"), std::string::npos);
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"Levels", "9"},
                                                        {"Levels", "2.5"},
                                                        {"Scale", "-1"},
                                                        {"Leaves", "many"},
                                                        {"Leaves", ""},
                                                        {"Leaves", "3x"},
                                                        {"1CurveV", "nan"},
                                                        {"1CurveV", "inf"},
                                                        {"PruneWidthPeak", "1"}}) {
    EXPECT_NE(with(name, value).find("parameter " + name), std::string::npos) << with(name, value);
    EXPECT_NE(with(name, value).find(" to "), std::string::npos) << with(name, value);
  }
  EXPECT_THROW(speciesParameters("grass"), Error);
  GrowOptions forest;
  forest.set = {{"1Branches", "2000"}, {"2Branches", "2000"}};
  EXPECT_NE(errorOf(forest).find("parameter 2Branches"), std::string::npos) << errorOf(forest);
  GrowOptions tiny;
  tiny.texture_size = 0;
  EXPECT_THROW(grow(tiny), Error);
}

TEST(Grow, StaysSoundAtTheEdgesOfItsRanges) {
  using Set = std::vector<std::pair<std::string, std::string>>;
  for (const Set& set :
       {Set{{"Levels", "1"}, {"Leaves", "300"}},
        Set{{"Levels", "2"}, {"1SegSplits", "10"}, {"1Branches", "3"}},
        Set{{"0Length", "0"}, {"1Length", "0"}}, Set{{"Scale", "0.05"}, {"Ratio", "0.0005"}},
        Set{{"Scale", "200"}, {"Ratio", "0.5"}, {"1Branches", "5"}},
        Set{{"0CurveV", "-90"}, {"1CurveV", "-180"}, {"2Branches", "2"}},
        Set{{"PruneRatio", "1"}, {"PruneWidth", "0"}},
        Set{{"AttractionUp", "-20"}, {"Leaves", "2"}},
        Set{{"ZScale", "20"}, {"Lobes", "40"}, {"LobeDepth", "0.9"}},
        Set{{"Shape", "8"}, {"PrunePowerLow", "10"}, {"PrunePowerHigh", "0.0001"}},
        Set{{"0BaseSplits", "30"}, {"0SplitAngle", "180"}, {"Levels", "1"}}}) {
    GrowOptions options;
    options.texture_size = 32;
    options.set = set;
    const Plant plant = grow(options);
    for (const Mesh& mesh : plant.meshes)
      for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_TRUE(std::isfinite(glm::dot(mesh.positions[i], mesh.normals[i]))) << set[0].first;
        ASSERT_NEAR(glm::length(mesh.normals[i]), 1, 1e-3) << set[0].first;
      }
    EXPECT_FALSE(plant.branches.empty());
  }
}

TEST(Grow, PutsLeavesInAFan) {
  GrowOptions options;
  options.texture_size = 32;
  options.set = {{"Leaves", "-7"}, {"3Rotate", "120"}, {"1Branches", "5"}, {"2Branches", "4"}};
  const Plant plant = grow(options);
  std::map<std::uint32_t, int> count;
  for (const Leaf& leaf : plant.leaves) {
    ++count[leaf.branch];
    const Branch& twig = plant.branches[leaf.branch];
    EXPECT_LT(glm::length(leaf.stalk - twig.points.back().position), 0.01f);
  }
  ASSERT_FALSE(count.empty());
  for (const auto& [branch, leaves] : count) EXPECT_EQ(leaves, 7);
}

TEST(Grow, KeepsLeafAreaWhenQualityFalls) {
  const auto areaAt = [](const char* quality) {
    GrowOptions options;
    options.texture_size = 32;
    options.set = {{"LeafQuality", quality}};
    const Plant plant = grow(options);
    double sum = 0;
    for (const Leaf& leaf : plant.leaves) sum += leaf.area;
    return std::pair(sum, plant.leaves.size());
  };
  const auto full = areaAt("1"), quarter = areaAt("0.25");
  EXPECT_NEAR(quarter.first / full.first, 1, 0.05);
  EXPECT_NEAR(static_cast<double>(quarter.second) / static_cast<double>(full.second), 0.25, 0.01);
}

}  // namespace
}  // namespace verdure
