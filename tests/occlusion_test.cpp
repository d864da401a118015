// What rays from vertices find, against closed forms and loops over all triangles.
#include "verdure/occlusion.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "light_paths.h"
#include "ray_plants.h"
#include "shared/leaf.h"
#include "shared/sky.h"
#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

using namespace test;

constexpr VertexId kProbe{0, 0};

RayOptions manyRays(int rays, int bounces = 0) {
  RayOptions options;
  options.rays = rays;
  options.bounces = bounces;
  return options;
}

Openness openness(const Plant& plant, const RayOptions& options = manyRays(4096)) {
  return traceOpenness(plant, std::array{kProbe}, options)[0];
}

glm::vec3 ambient(const Plant& plant, const RayOptions& options = manyRays(4096)) {
  return traceAmbient(plant, std::array{kProbe}, options)[0];
}

TEST(Openness, ALoneLeafSeesEverything) {
  const Plant plant = probe({0, 1, 0}, {0, 1, 0});
  EXPECT_EQ(openness(plant).share, 1.0f);
  EXPECT_LT(glm::length(openness(plant).direction), 0.01f);
  EXPECT_EQ(ambient(plant), glm::vec3(1.0f));
}

TEST(Openness, OnAFoldOfALeafItsOwnHalvesDoNotBlock) {
  // A narrow V of two triangles: whatever side a ray leaves on, it starts in the open.
  Plant plant = probe({0, 1, 0}, {0, 1, 0});
  Mesh& mesh = plant.meshes[0];
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {0.3f, 1, 0.5f}, {-0.3f, 1, 0.5f}, {0, 0, 0}, {0, 0, 1}};
  mesh.normals.assign(6, {0, 1, 0});
  mesh.indices = {0, 1, 2, 5, 4, 3};  // the halves share positions, not vertices
  EXPECT_GT(openness(plant).share, 0.995f);
  // From the tip of one half the other half is in the way.
  const float tip = traceOpenness(plant, std::array{VertexId{0, 2}}, manyRays(4096))[0].share;
  EXPECT_LT(tip, 0.97f);
  EXPECT_GT(tip, 0.7f);
}

TEST(Openness, WoodSeesTheHalfOutsideOfIt) {
  Plant plant;
  plant.materials.resize(1);
  plant.meshes.resize(1);
  addTube(plant.meshes[0], {0, -20, 0}, {0, 20, 0}, 0.3f, 0.3f, 256);
  // In the middle of the tube: a vertex of its own there.
  addTube(plant.meshes[0], {0, 0, 0}, {0, 20, 0}, 0.3f, 0.3f, 256);
  const VertexId at{0, 2 * 257};
  const Openness seen = traceOpenness(plant, std::array{at}, manyRays(8192))[0];
  EXPECT_NEAR(seen.share, 0.5f, 0.01f);
  EXPECT_NEAR(glm::dot(seen.direction, plant.meshes[0].normals[at.vertex]), 0.5f, 0.02f);
  EXPECT_NEAR(traceAmbient(plant, std::array{at}, manyRays(4096))[0].r, 1.0f, 0.01f);
}

TEST(Openness, BesideAWallAndABallAreClosedForms) {
  Plant wall = probe({0, 0.02f, 0}, {0, 1, 0});
  addSheet(wall, 400.0f, 0.0f);
  const Openness seen = openness(wall);
  EXPECT_NEAR(seen.share, 0.5f, 0.003f);
  EXPECT_NEAR(seen.direction.y, 0.5f, 0.003f);
  EXPECT_NEAR(ambient(wall).g, 1.0f, 0.002f);
  wall.meshes[0].normals.assign(3, {0, -1, 0});
  EXPECT_NEAR(ambient(wall).g, 0.0f, 0.002f);
  wall.meshes[0].normals.assign(3, {1, 0, 0});
  EXPECT_NEAR(ambient(wall).g, 0.5f, 0.005f);

  for (const float distance : {1.1f, 1.5f, 3.0f}) {
    Plant plant = probe({0, distance, 0}, {0, -1, 0});
    plant.meshes.push_back(ball(glm::vec3(0.0f), 1.0f, 64));
    const float sine = 1.0f / distance, cosine = std::sqrt(1.0f - sine * sine);
    EXPECT_NEAR(openness(plant).share, 1.0f - 0.5f * (1.0f - cosine), 0.004f) << distance;
    EXPECT_NEAR(ambient(plant).r, 1.0f - sine * sine, 0.006f) << distance;
  }
}

TEST(Ambient, UnderASheetIsItsTransmittance) {
  Plant plant = probe({0, 0, 0}, {0, 1, 0});
  addSheet(plant, 2000.0f, 0.5f);
  const glm::vec3 color(0.3f, 0.6f, 0.2f);
  plant.materials[1].base_color = glm::vec4(color, 1.0f);
  EXPECT_EQ(ambient(plant, manyRays(512, 4)).g, 0.0f);  // opaque
  plant.meshes[1].kind = PartKind::kFoliage;
  EXPECT_EQ(ambient(plant, manyRays(512, 0)).g, 0.0f);
  // The sky is on both sides of it: what it reflects comes from below.
  const glm::vec3 lit = ambient(plant, manyRays(2048, 1));
  const glm::vec3 shines = shared::leafTransmittance(color) + color;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(lit[c], shines[c], 0.01f);
  // With a black ground below the probe (a sheet) only what comes through is left.
  addSheet(plant, 2000.0f, -0.5f);
  plant.materials.push_back({});
  plant.meshes.back().material = 2;
  plant.materials[2].base_color = {0, 0, 0, 1};
  plant.meshes.back().kind = PartKind::kWood;
  const glm::vec3 through = ambient(plant, manyRays(2048, 1));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(through[c], shared::leafTransmittance(color)[c], 0.01f);
}

TEST(Ambient, InsideAClosedBoxIsDark) {
  Plant plant = probe({0, 0, 0}, {0, 1, 0});
  plant.meshes.push_back(ball(glm::vec3(0.0f), 2.0f, 12));
  plant.meshes[1].material = 1;
  plant.materials.emplace_back();
  turnOver(plant.meshes[1]);
  EXPECT_EQ(openness(plant).share, 0.0f);
  EXPECT_EQ(ambient(plant, manyRays(256, 20)), glm::vec3(0.0f));
}

TEST(Ambient, InAWhiteFurnaceEverythingIsWhite) {
  // Half a white ball, open above, seen from its bottom: with enough bounces all light arrives.
  Plant plant = probe({0, -0.99f, 0}, {0, 1, 0});
  Mesh bowl = ball(glm::vec3(0.0f), 1.0f, 32);
  turnOver(bowl);
  bowl.indices.resize(bowl.indices.size() / 2);
  for (glm::vec3& p : bowl.positions) p = {p.x, -p.y, -p.z};
  plant.meshes.push_back(bowl);
  plant.materials[0].base_color = glm::vec4(1.0f);
  float before = -1.0f;
  for (const int bounces : {0, 1, 2, 4, 64}) {
    const float lit = ambient(plant, manyRays(1024, bounces)).g;
    EXPECT_GT(lit, before);
    before = lit;
  }
  EXPECT_NEAR(before, 1.0f, 0.005f);
  // In a bowl every point sees every other with the same factor: k bounces of albedo a give
  // direct * sum (a / 2)^j, direct = 1/2 of the sphere's area is open.
  plant.materials[0].base_color = glm::vec4(0.6f, 0.6f, 0.6f, 1.0f);
  float sum = 0.0f, power = 1.0f;
  for (int j = 0; j <= 3; ++j, power *= 0.6f * 0.5f) sum += 0.5f * power;
  EXPECT_NEAR(ambient(plant, manyRays(2048, 3)).g, sum, 0.01f);
}

TEST(Ambient, TheGroundReflects) {
  Plant plant = probe({0, 5, 0}, {1, 0, 0}, 0.01f);
  RayOptions options = manyRays(2048, 2);
  options.ground_height = 0.0f;
  const glm::vec3 lit = ambient(plant, options);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(lit[c], 0.5f + 0.5f * shared::groundMeanColor()[c], 0.005f);
  EXPECT_NEAR(openness(plant, options).share, 0.5f, 0.003f);
  EXPECT_NEAR(openness(plant, options).direction.y, 0.5f, 0.005f);
  // A root's vertex below the ground stands for where it enters it.
  for (glm::vec3& p : plant.meshes[0].positions) p.y = -1.0f;
  plant.meshes[0].normals.assign(3, {0, 1, 0});
  EXPECT_EQ(ambient(plant, options), glm::vec3(1.0f));
}

TEST(Openness, EqualsALoopOverAllTriangles) {
  const Plant plant = ballTree(120, 0.4f, true);
  const std::vector<VertexId> all = allVertices(plant);
  ASSERT_EQ(all.size(), vertexCount(plant));
  std::vector<VertexId> some;
  for (std::size_t i = 5; i < all.size(); i += all.size() / 40) some.push_back(all[i]);
  const std::vector<Openness> seen = traceOpenness(plant, some, manyRays(2048));
  Random random(1);
  double error = 0.0, bias = 0.0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Mesh& mesh = plant.meshes[some[i].mesh];
    const bool wood = mesh.kind == PartKind::kWood;
    const glm::vec3 at = mesh.positions[some[i].vertex];
    int open = 0;
    constexpr int kRays = 800;
    for (int r = 0; r < kRays; ++r) {
      const glm::vec3 d = randomDirection(random);
      Ray ray;
      ray.origin = wood ? at + 1e-4f * mesh.normals[some[i].vertex] : at;
      ray.direction = d;
      open += !blockedByLoop(plant, ray, at, wood);
    }
    const double difference = seen[i].share - static_cast<double>(open) / kRays;
    EXPECT_LT(std::abs(difference), 0.08) << i;
    error += difference * difference;
    bias += difference;
  }
  // The loop's own noise is 0.018.
  EXPECT_LT(std::sqrt(error / static_cast<double>(some.size())), 0.025);
  EXPECT_LT(std::abs(bias / static_cast<double>(some.size())), 0.008);
}

TEST(Ambient, AnAlphaCutIsTheGeometryThatItLeaves) {
  Image image(64, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t texel[] = {200, 200, 200, static_cast<std::uint8_t>(x < 32 ? 0 : 255)};
      std::copy_n(texel, 4, image.at(x, y));
    }
  const auto under = [&](bool cut) {
    Plant plant = probe({0.1f, -0.3f, 0}, {0, 1, 0});
    plant.textures = {{"half", image, true, true}};
    plant.materials.emplace_back();
    plant.materials[1].base_color_texture = 0;
    plant.materials[1].alpha_mode = cut ? AlphaMode::kMask : AlphaMode::kOpaque;
    Mesh mesh;
    mesh.kind = PartKind::kFoliage;
    mesh.material = 1;
    if (cut)
      addQuad(mesh, {0, 0, 1}, {2, 0, 0}, {0, 0, -2});
    else
      addQuad(mesh, {0.5f, 0, 1}, {1, 0, 0}, {0, 0, -2});
    if (!cut)
      for (glm::vec2& uv : mesh.uvs) uv.x = 0.75f;
    plant.meshes.push_back(mesh);
    return plant;
  };
  EXPECT_NEAR(openness(under(true)).share, openness(under(false)).share, 0.003f);
  EXPECT_NEAR(ambient(under(true), manyRays(2048, 2)).g, ambient(under(false), manyRays(2048, 2)).g,
              0.006f);
}

/// The bounced part of some vertices' light, gathered, against whole paths: bounds of the mean
/// difference and of the root of the mean squares, beside the mean.
void expectLightOfPaths(const Plant& plant, double most_bias, double most_rms) {
  RayOptions options = manyRays(256, 3);
  options.ground_height = 0.0f;
  const std::vector<VertexId> all = allVertices(plant);
  std::vector<VertexId> some;
  for (std::size_t i = 5; i < all.size(); i += 1 + all.size() / 200) some.push_back(all[i]);
  const std::vector<glm::vec3> lit = traceAmbient(plant, some, options);
  RayOptions sky_only = options;
  sky_only.bounces = 0;
  const std::vector<glm::vec3> direct = traceAmbient(plant, some, sky_only);  // by the same rays
  Scene world;
  world.items.emplace_back().plant = &plant;
  const RayScene scene(world);
  const RayStarts starts(plant, scene, 0.0f);
  glm::dvec3 error(0.0), bias(0.0), mean(0.0);
  for (std::size_t i = 0; i < some.size(); ++i) {
    Random random(i);
    glm::vec3 passed(0.0f);
    constexpr int kPaths = 2048;
    followPaths(scene, starts, some[i], plant.meshes[some[i].mesh].normals[some[i].vertex], kPaths,
                options.bounces, true, random,
                [&](const glm::vec3&, const glm::vec3& throughput, int surfaces) {
                  if (surfaces > 0) passed += throughput / static_cast<float>(kPaths);
                });
    const glm::dvec3 difference(lit[i] - direct[i] - passed);
    error += difference * difference;
    bias += difference;
    mean += glm::dvec3(passed);
  }
  const auto n = static_cast<double>(some.size());
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(mean[c] / n, 0.002);
    EXPECT_LT(std::abs(bias[c]), most_bias * mean[c]) << mean[c] / n;
    EXPECT_LT(std::sqrt(error[c] / n), most_rms * mean[c] / n) << mean[c] / n;
  }
}

TEST(Ambient, IsTheLightOfWholePaths) {
  expectLightOfPaths(ballTree(150, 0.5f, true), 0.05, 0.5);
  GrowOptions options;
  options.species = "quaking-aspen";
  options.texture_size = 64;
  options.set = {{"Levels", "2"}};
  expectLightOfPaths(grow(options), 0.05, 0.5);
}

TEST(Ambient, TakesTheNormalsThatItIsGiven) {
  Plant plant = probe({0, 0.02f, 0}, {0, 1, 0});
  addSheet(plant, 400.0f, 0.0f);
  CrownLight normals;
  for (const Mesh& mesh : plant.meshes)
    normals.meshes.push_back({std::vector(mesh.positions.size(), glm::vec3(0, -1, 0)), {}});
  EXPECT_LT(traceAmbient(plant, std::array{kProbe}, manyRays(1024), &normals)[0].g, 0.01f);
  const CrownLight baked = bakeAmbient(plant, manyRays(64), &normals);
  EXPECT_EQ(baked.meshes[0].normals[0], glm::vec3(0, -1, 0));
  EXPECT_EQ(baked.meshes[0].ambient[0], 1.0f / 255.0f);
  normals.meshes.pop_back();
  EXPECT_THROW(bakeAmbient(plant, manyRays(64), &normals), Error);
}

TEST(Ambient, NeitherThreadsNorTheOtherVerticesChangeIt) {
  const Plant plant = ballTree(200, 0.3f, true);
  std::vector<VertexId> all = allVertices(plant);
  RayOptions options = manyRays(64, 3);
  options.ground_height = 0.0f;
  setThreadCount(1);
  const auto one = traceAmbient(plant, all, options);
  const auto open_one = traceOpenness(plant, all, options);
  setThreadCount(2);
  const auto two = traceAmbient(plant, all, options);
  const auto open_two = traceOpenness(plant, all, options);
  EXPECT_TRUE(one == two);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(open_one[i].share, open_two[i].share);
    ASSERT_EQ(open_one[i].direction, open_two[i].direction);
  }
  setThreadCount(0);
  std::reverse(all.begin(), all.end());
  all.resize(100);
  const auto some = traceAmbient(plant, all, options);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(some[i], one[one.size() - 1 - i]);
  options.seed = 2;
  EXPECT_FALSE(traceAmbient(plant, allVertices(plant), options) == one);
}

TEST(Ambient, SaysWhatIsWrongAndStopsWhenAsked) {
  const Plant plant = ballTree(500);
  EXPECT_THROW(ambient(plant, manyRays(0)), Error);
  EXPECT_THROW(ambient(plant, manyRays(16, -1)), Error);
  EXPECT_THROW(traceOpenness(plant, std::array{VertexId{9, 0}}), Error);
  EXPECT_THROW(traceOpenness(plant, std::array{VertexId{0, 1u << 20}}), Error);
  RayOptions options = manyRays(64);
  double told = 0.0;
  options.progress = [&](double share) {
    told = share;
    return true;
  };
  bakeAmbient(plant, options);
  EXPECT_GT(told, 0.5);
  options.progress = [](double) { return false; };
  EXPECT_THROW(bakeAmbient(plant, options), Error);
}

TEST(Ambient, ForeignPlants) {
  const char* folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf") continue;
    SCOPED_TRACE(entry.path());
    const Plant plant = loadPlant(entry.path());
    if (vertexCount(plant) > 60000) continue;
    std::vector<VertexId> some, all = allVertices(plant);
    for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / 200) some.push_back(all[i]);
    double mean = 0.0;
    for (const Openness& seen : traceOpenness(plant, some, manyRays(64))) {
      ASSERT_GE(seen.share, 0.0f);
      ASSERT_LE(seen.share, 1.0f);
      ASSERT_LE(glm::length(seen.direction), 1.0f);
      mean += static_cast<double>(seen.share) / static_cast<double>(some.size());
    }
    EXPECT_GT(mean, 0.02);
    EXPECT_LT(mean, 0.98);
    for (const glm::vec3& k : traceAmbient(plant, some, manyRays(4, 2))) {
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(k, glm::vec3(0.0f))));
      ASSERT_TRUE(glm::all(glm::lessThan(k, glm::vec3(1.3f))));
    }
  }
}

}  // namespace
}  // namespace verdure
