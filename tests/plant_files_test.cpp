// Plants made by others (VERDURE_PLANT_DIR): read, understood, and written back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "gltf_builder.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

class PlantFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* dir = std::getenv("VERDURE_PLANT_DIR");
    if (dir == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
    dir_ = dir;
  }
  fs::path dir_;
};

struct Expected {
  const char* file;
  std::vector<const char*> wood, foliage;  ///< materials
  std::size_t leaves;
};

const std::vector<Expected>& expectations() {
  static const std::vector<Expected> kAll = {
      {"ash_large_mirrored_utm", {"branches"}, {"leaves"}, 4840},
      {"ash_large_unindexed_nonormals", {"branches"}, {"leaves"}, 4840},
      {"callistemon", {"bark"}, {"leaf"}, 4794},
      {"callistemon_arm_anim", {"bark"}, {"leaf"}, 4794},
      {"eztree_oak_medium", {"branches"}, {"leaves"}, 5320},
      {"forest200_gpu_instancing", {"branches", "branches"}, {"leaves", "leaves"}, 429600},
      {"oak_large_draco_edgebreaker", {"branches"}, {"leaves"}, 5280},
      {"oak_large_meshopt_high", {"branches"}, {"leaves"}, 5280},
      {"oak_large_quantized", {"branches"}, {"leaves"}, 5280},
      {"quaking_aspen_L3", {"bark"}, {"leaf"}, 6053},
      {"quaking_aspen_skin", {"bark"}, {"leaf"}, 441},
      {"quaking_aspen_weld", {"bark"}, {"leaf"}, 441},
      {"shapespark_bush_01", {}, {"branch-01", "branch-02"}, 16},
      {"shapespark_tree_01_1", {"bark"}, {"branch-01", "branch-02"}, 50},
      // In these, a few leaves share their stalk's point exactly and are one after welding.
      {"small_maple_hex", {"bark"}, {"leaf"}, 18020},
      {"weeping_willow", {"bark"}, {"leaf"}, 31169}};
  return kAll;
}

TEST_F(PlantFiles, AreUnderstood) {
  for (const Expected& expected : expectations()) {
    SCOPED_TRACE(expected.file);
    const Plant plant = loadPlant(dir_ / (std::string(expected.file) + ".glb"));
    std::vector<std::string> wood, foliage;
    for (const Mesh& mesh : plant.meshes) {
      (mesh.kind == PartKind::kWood ? wood : foliage)
          .push_back(plant.materials[mesh.material].name);
      for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
    }
    EXPECT_EQ(wood, std::vector<std::string>(expected.wood.begin(), expected.wood.end()));
    EXPECT_EQ(foliage, std::vector<std::string>(expected.foliage.begin(), expected.foliage.end()));
    EXPECT_EQ(plant.leaves.size(), expected.leaves);
    std::size_t triangles = 0;
    for (const Leaf& leaf : plant.leaves) triangles += leaf.triangle_count;
    EXPECT_EQ(plant.leaf_triangles.size(), triangles);
  }
}

double leafArea(const Plant& plant) {
  double area = 0.0;
  for (const Leaf& leaf : plant.leaves) area += static_cast<double>(leaf.area);
  return area;
}

/// Bark is open at its ends, so its volume depends on where it is seen from.
double signedVolume(const Mesh& mesh, const glm::dvec3& center) {
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    volume += glm::dot(glm::dvec3(mesh.positions[mesh.indices[t]]) - center,
                       glm::cross(glm::dvec3(mesh.positions[mesh.indices[t + 1]]) - center,
                                  glm::dvec3(mesh.positions[mesh.indices[t + 2]]) - center)) /
              6.0;
  return volume;
}

TEST_F(PlantFiles, VariantsOfOneOakAgree) {
  const Plant a = loadPlant(dir_ / "oak_large_quantized.glb");
  for (const char* name : {"oak_large_meshopt_high.glb", "oak_large_draco_edgebreaker.glb"}) {
    SCOPED_TRACE(name);
    const Plant b = loadPlant(dir_ / name);
    const float step = glm::length(bounds(a).size()) / 8192.0f;  // draco: 14 bits
    EXPECT_LT(glm::length(bounds(a).min - bounds(b).min), step);
    EXPECT_LT(glm::length(bounds(a).max - bounds(b).max), step);
    EXPECT_EQ(triangleCount(a), triangleCount(b));
    EXPECT_NEAR(leafArea(b) / leafArea(a), 1.0, 1e-3);
    EXPECT_NEAR(signedVolume(b.meshes[0], {}) / signedVolume(a.meshes[0], {}), 1.0, 1e-2);
  }
}

TEST_F(PlantFiles, TheMirroredAshIsItsSiblingFarAway) {
  const Plant far = loadPlant(dir_ / "ash_large_mirrored_utm.glb");
  const Plant near = loadPlant(dir_ / "ash_large_unindexed_nonormals.glb");
  EXPECT_NEAR(leafArea(far) / leafArea(near), 0.01, 1e-5);  // a tenth the size
  // Mirrored, and inside out neither of them.
  // The node puts its mesh's origin here, in between float steps of half a metre.
  const glm::dvec3 at(448262.25, 512.5, -5411932.75);
  const double near_volume = signedVolume(near.meshes[0], {});
  EXPECT_GT(near_volume, 0.0);
  EXPECT_NEAR(signedVolume(far.meshes[0], at - far.origin) / near_volume, 0.001, 1e-6);
  EXPECT_LT(glm::length(far.origin - at), 2.0);
  // Each near vertex, mirrored, turned and scaled, is a far vertex: compare the farthest ones.
  const double s = std::sqrt(0.5);
  glm::dvec3 low(1e9), high(-1e9);
  for (const Mesh& mesh : near.meshes)
    for (const glm::vec3& p : mesh.positions) {
      const glm::dvec3 q = glm::dvec3(-p.x, p.y, p.z) * 0.1;
      const glm::dvec3 w(s * q.x + s * q.z, q.y, s * q.z - s * q.x);
      low = glm::min(low, w);
      high = glm::max(high, w);
    }
  EXPECT_LT(glm::length(far.origin + glm::dvec3(bounds(far).min) - (at + low)), 1e-4);
  EXPECT_LT(glm::length(far.origin + glm::dvec3(bounds(far).max) - (at + high)), 1e-4);
}

/// A gzipped JSON file.
Json truth(const fs::path& path) {
  FILE* pipe = popen(("gzip -dc '" + path.string() + "'").c_str(), "r");
  std::string text;
  char chunk[65536];
  for (std::size_t n = 0; (n = fread(chunk, 1, sizeof(chunk), pipe)) > 0;) text.append(chunk, n);
  pclose(pipe);
  return Json::parse(text);
}

/// Distance of a point from a branch of the truth file (Z up there).
float distanceToBranch(const Json& branch, const glm::vec3& p) {
  const Json& points = branch["pts"];
  const auto at = [&](std::size_t i) {
    return glm::vec3(points[i][0].get<float>(), points[i][2].get<float>(),
                     -points[i][1].get<float>());
  };
  float best = 1e9f;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const glm::vec3 a = at(i), d = at(i + 1) - a;
    const float t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0f, 1.0f);
    best = std::min(best, glm::length(p - a - t * d));
  }
  return best;
}

TEST_F(PlantFiles, LeavesAreThoseOfTheGenerator) {
  for (const char* name :
       {"quaking_aspen_L3", "callistemon", "weeping_willow", "small_maple_hex"}) {
    SCOPED_TRACE(name);
    const Plant plant = loadPlant(dir_ / (std::string(name) + ".glb"));
    const Json json = truth(dir_ / (std::string(name) + ".truth.json.gz"));
    const std::size_t count = json["leafParent"].size();
    EXPECT_LE(plant.leaves.size(), count);
    EXPECT_GT(static_cast<double>(plant.leaves.size()), 0.99 * static_cast<double>(count));
    if (plant.leaves.size() != count) continue;  // their numbers differ
    // The stalk lies at the branch that grew the leaf, closer than half a leaf; but some leaves
    // touch another branch with their tips.
    std::size_t close = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Leaf& leaf = plant.leaves[i];
      const Json& branch = json["splines"][json["leafParent"][i][0].get<std::size_t>()];
      if (distanceToBranch(branch, leaf.stalk) < 0.75f * std::sqrt(leaf.area)) ++close;
    }
    EXPECT_GT(static_cast<double>(close), 0.9 * static_cast<double>(count));
  }
}

/// Light that differs from vertex to vertex; wood keeps its normals, as after a bake.
CrownLight syntheticLight(const Plant& plant) {
  const glm::vec3 center = bounds(plant).center();
  CrownLight light;
  for (const Mesh& mesh : plant.meshes) {
    MeshLight& out = light.meshes.emplace_back();
    for (const glm::vec3& p : mesh.positions) {
      out.normals.push_back(glm::normalize(p - center + glm::vec3(1e-3f, 2e-3f, 0)));
      out.ambient.push_back(0.5f + 0.49f * std::sin(p.x + 3.0f * p.y));
    }
    if (mesh.kind == PartKind::kWood) out.normals = mesh.normals;
  }
  return light;
}

TEST_F(PlantFiles, KeepAllButTheirLight) {
  const fs::path out = scratchFolder("plant_files");
  std::vector<std::string> pairs = {"--compare"};
  for (const Expected& expected : expectations()) {
    SCOPED_TRACE(expected.file);
    const fs::path in = dir_ / (std::string(expected.file) + ".glb");
    const fs::path saved = out / in.filename();
    const Plant plant = loadPlant(in);
    const CrownLight light = syntheticLight(plant);
    savePlant(plant, &light, saved);
    pairs.push_back(in.string());
    pairs.push_back(saved.string());
    const Plant back = loadPlant(saved);
    EXPECT_EQ(back.leaves.size(), plant.leaves.size());
    EXPECT_EQ(back.textures.size(), plant.textures.size());
    if (back.meshes.size() != plant.meshes.size()) continue;  // instances became nodes
    for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
      EXPECT_TRUE(back.meshes[m].positions == plant.meshes[m].positions);
      EXPECT_TRUE(back.meshes[m].indices == plant.meshes[m].indices);
      EXPECT_TRUE(back.meshes[m].uvs == plant.meshes[m].uvs);
      EXPECT_EQ(back.meshes[m].kind, plant.meshes[m].kind);
      float worst = 0.0f;
      for (std::size_t i = 0; i < plant.meshes[m].positions.size(); ++i)
        worst =
            std::max(worst, glm::length(back.meshes[m].normals[i] - light.meshes[m].normals[i]));
      EXPECT_LT(worst, 5e-6f);
    }
    for (const char* key : {"materials", "images", "textures", "samplers", "animations", "skins"})
      EXPECT_EQ(glbJson(saved).value(key, Json()).size(), glbJson(in).value(key, Json()).size());
  }
  const int verdict = runValidator(pairs);
  if (verdict > 1) GTEST_SKIP() << "validation needs node and `npm install` in tests/npm";
  EXPECT_EQ(verdict, 0);
}

}  // namespace
}  // namespace verdure
