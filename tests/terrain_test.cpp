// Ground as a height field, and the squares of it that are drawn.
#include "verdure/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scene/terrain_levels.h"
#include "scratch.h"
#include "verdure/error.h"
#include "verdure/image.h"

namespace verdure {
namespace {

using shared::TerrainNode;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Samples of a function; corner and spacing are sums of few powers of two.
Terrain terrainOf(const std::function<float(float, float)>& height) {
  Terrain terrain;
  terrain.width = 9;
  terrain.height = 5;
  terrain.corner = {-3.0f, 1.5f};
  terrain.spacing_m = {0.5f, 2.0f};
  for (int z = 0; z < terrain.height; ++z)
    for (int x = 0; x < terrain.width; ++x) {
      const glm::vec2 place = terrain.corner + terrain.spacing_m * glm::vec2(x, z);
      terrain.heights.push_back(height(place.x, place.y));
    }
  return terrain;
}

glm::vec2 extentOf(const Terrain& terrain) {
  return terrain.spacing_m * glm::vec2(terrain.width - 1, terrain.height - 1);
}

/// What an Error says when `call` throws one.
template <class Call>
std::string errorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void expectError(const std::function<void()>& call, const std::string& part) {
  const std::string text = errorOf(call);
  EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(text.find("; "), std::string::npos) << "no advice: " << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(Terrain, APlaneIsReproducedExactly) {
  const Terrain terrain = terrainOf([](float x, float z) { return 0.5f * x - 0.25f * z + 3.0f; });
  const glm::vec3 normal = glm::normalize(glm::vec3(-0.5f, 1.0f, 0.25f));
  for (int j = 0; j <= 32; ++j)
    for (int i = 0; i <= 32; ++i) {
      const glm::vec2 place = terrain.corner + extentOf(terrain) * glm::vec2(i, j) / 32.0f;
      EXPECT_EQ(terrain.heightAt(place), 0.5f * place.x - 0.25f * place.y + 3.0f);
      EXPECT_EQ(terrain.normalAt(place), normal);
    }
}

TEST(Terrain, ASaddleIsReproducedExactly) {
  const Terrain terrain = terrainOf([](float x, float z) { return 0.5f * x * z + x; });
  for (int j = 0; j <= 32; ++j)
    for (int i = 0; i <= 32; ++i) {
      const glm::vec2 place = terrain.corner + extentOf(terrain) * glm::vec2(i, j) / 32.0f;
      EXPECT_EQ(terrain.heightAt(place), 0.5f * place.x * place.y + place.x);
      // Inside, its central differences are its slopes, and these are linear.
      const glm::vec2 inside = glm::clamp(place, terrain.corner + terrain.spacing_m,
                                          terrain.corner + extentOf(terrain) - terrain.spacing_m);
      EXPECT_EQ(terrain.normalAt(inside),
                glm::normalize(glm::vec3(-0.5f * inside.y - 1.0f, 1.0f, -0.5f * inside.x)));
    }
}

TEST(Terrain, GoesOnAsItsEdge) {
  Random random(1);
  const Terrain terrain = terrainOf([&](float, float) { return random.uniform(); });
  const glm::vec2 low = terrain.corner, high = terrain.corner + extentOf(terrain);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec2 place(random.vary(10.0f), random.vary(20.0f));
    EXPECT_EQ(terrain.heightAt(place), terrain.heightAt(glm::clamp(place, low, high)));
  }
  EXPECT_EQ(terrain.heightAt({-1e30f, -1e30f}), terrain.heights.front());
  EXPECT_EQ(terrain.heightAt({kInfinity, kInfinity}), terrain.heights.back());
  EXPECT_EQ(terrain.normalAt({1e30f, -1e30f}), glm::vec3(0, 1, 0));
  // Beyond one side only that side's slope is gone.
  const glm::vec3 beside = terrain.normalAt({high.x + 5.0f, 4.0f});
  EXPECT_EQ(beside.x, 0.0f);
  EXPECT_NE(beside.z, 0.0f);
}

TEST(Terrain, HeightsAndNormalsDoNotJump) {
  Random random(2);
  const Terrain terrain = terrainOf([&](float, float) { return random.uniform(); });
  constexpr float kStep = 1e-3f;
  for (int i = 0; i < 10000; ++i) {
    const glm::vec2 place(random.uniform(-5.0f, 3.0f), random.uniform(-2.0f, 12.0f));
    const glm::vec2 next = place + glm::vec2(random.vary(kStep), random.vary(kStep));
    EXPECT_NEAR(terrain.heightAt(place), terrain.heightAt(next), 4 * kStep);
    EXPECT_LT(glm::distance(terrain.normalAt(place), terrain.normalAt(next)), 12 * kStep);
    EXPECT_NEAR(glm::length(terrain.normalAt(place)), 1.0f, 1e-6f);
  }
}

TEST(Terrain, SlopesAreThoseOfItsNormals) {
  Random random(3);
  const Terrain terrain = terrainOf([&](float, float) { return random.uniform(); });
  const std::vector<glm::vec2> slopes = terrainSlopes(terrain);
  ASSERT_EQ(slopes.size(), terrain.heights.size());
  for (int z = 0; z < terrain.height; ++z)
    for (int x = 0; x < terrain.width; ++x) {
      const glm::vec2 place = terrain.corner + terrain.spacing_m * glm::vec2(x, z);
      EXPECT_EQ(terrain.normalAt(place),
                shared::slopeNormal(slopes[static_cast<std::size_t>(z * terrain.width + x)]));
    }
  const glm::vec2 range = heightRange(terrain);
  EXPECT_EQ(range.x, *std::ranges::min_element(terrain.heights));
  EXPECT_EQ(range.y, *std::ranges::max_element(terrain.heights));
}

Image16 randomPicture(int width, int height, int channels) {
  Image16 image{width, height, channels, {}};
  Random random(4);
  for (int i = 0; i < width * height * channels; ++i)
    image.values.push_back(static_cast<std::uint16_t>(random.next() >> 16));
  image.values[0] = 0;
  image.values[static_cast<std::size_t>(channels)] = 65535;
  return image;
}

std::filesystem::path written(const std::string& name, const std::vector<std::uint8_t>& bytes) {
  static const std::filesystem::path folder = scratchFolder("terrain");
  writeFile(folder / name, bytes);
  return folder / name;
}

TEST(TerrainFile, KeepsSixteenBits) {
  // 65535 steps of 1/64 m: floats hold all of them.
  const TerrainOptions options{
      .size_m = {12.0f, 8.0f}, .lowest_m = -24.0f, .highest_m = 65535.0f / 64.0f - 24.0f};
  for (int channels = 1; channels <= 4; ++channels) {
    const Image16 image = randomPicture(7, 5, channels);
    const Terrain terrain = readTerrain(written("heights.png", encodePng(image)), options);
    EXPECT_EQ(terrain.width, 7);
    EXPECT_EQ(terrain.height, 5);
    EXPECT_EQ(terrain.corner, glm::vec2(-6.0f, -4.0f));
    EXPECT_EQ(terrain.spacing_m, glm::vec2(2.0f, 2.0f));
    ASSERT_EQ(terrain.heights.size(), 35u);
    for (std::size_t i = 0; i < 35; ++i)
      EXPECT_EQ(terrain.heights[i],
                image.values[i * static_cast<std::size_t>(channels)] / 64.0f - 24.0f);
    EXPECT_EQ(terrain.heightAt({-6.0f, -4.0f}), -24.0f);                // black
    EXPECT_EQ(terrain.heightAt({-4.0f, -4.0f}), options.highest_m);     // white
    EXPECT_EQ(terrain.heightAt({-100.0f, 4.0f}), terrain.heights[28]);  // its last row's first
  }
}

TEST(TerrainFile, EightBitsWillDo) {
  Image image(2, 2);
  const std::uint8_t grey[] = {0, 255, 51, 102};
  for (int i = 0; i < 4; ++i)
    for (int c = 0; c < 4; ++c)
      image.rgba[static_cast<std::size_t>(4 * i + c)] = c == 3 ? std::uint8_t{255} : grey[i];
  const auto path = written("bytes.png", encodePng(image));
  const Terrain terrain = readTerrain(path, {.size_m = {4, 4}, .lowest_m = 1, .highest_m = 6});
  EXPECT_EQ(terrain.heights, (std::vector<float>{1, 6, 2, 3}));
  // Black may be the higher.
  const Terrain upside = readTerrain(path, {.size_m = {4, 4}, .lowest_m = 6, .highest_m = 1});
  EXPECT_EQ(upside.heights, (std::vector<float>{6, 1, 5, 4}));
}

TEST(TerrainFile, BadInputIsNamed) {
  const auto good = written("good.png", encodePng(randomPicture(3, 3, 1)));
  const auto column = written("column.png", encodePng(randomPicture(1, 8, 1)));
  const auto row = written("row.png", encodePng(randomPicture(8, 1, 1)));
  const auto text = written("text.png", {'g', 'r', 'a', 's', 's'});
  std::vector<std::uint8_t> bytes = encodePng(randomPicture(64, 64, 1));
  bytes.resize(bytes.size() / 2);
  const auto half = written("half.png", bytes);
  EXPECT_EQ(errorOf([&] { readTerrain(good, {}); }), "no error");

  expectError([&] { readTerrain(column, {}); }, "1 x 8 texels");
  expectError([&] { readTerrain(row, {}); }, "8 x 1 texels");
  expectError([&] { readTerrain(text, {}); }, "text.png");
  expectError([&] { readTerrain(half, {}); }, "half.png");
  expectError([&] { readTerrain(good.parent_path() / "none.png", {}); }, "none.png");
  for (const glm::vec2& size :
       {glm::vec2(0, 5), glm::vec2(5, -1), glm::vec2(kNan, 5), glm::vec2(5, kInfinity)}) {
    expectError([&] { readTerrain(good, {.size_m = size}); }, "size");
    expectError([&] { readCoverMap(good, size); }, "size");
  }
  expectError([&] { readTerrain(good, {.size_m = {1e-5f, 5}}); }, "0.1 mm");
  expectError([&] { readTerrain(good, {.size_m = {1e9f, 5}}); }, "10,000 km");
  for (const float height : {kNan, kInfinity, -kInfinity}) {
    expectError([&] { readTerrain(good, {.lowest_m = height}); }, "not finite");
    expectError([&] { readTerrain(good, {.highest_m = height}); }, "not finite");
  }
  expectError([&] { readTerrain(good, {.highest_m = 3e38f}); }, "10,000 km");
  expectError([&] { readCoverMap(text, {5, 5}); }, "text.png");
}

TEST(TerrainChecks, NameWhatIsWrong) {
  const Terrain good = terrainOf([](float x, float) { return x; });
  EXPECT_EQ(errorOf([&] { checkTerrain(good, "hill"); }), "no error");
  const auto expectBad = [&](const std::function<void(Terrain&)>& damage, const std::string& part) {
    Terrain bad = good;
    damage(bad);
    expectError([&] { checkTerrain(bad, "hill"); }, part);
    EXPECT_EQ(errorOf([&] { checkTerrain(bad, "hill"); }).find("hill: "), 0u);
  };
  expectBad([](Terrain& t) { t = Terrain{}; }, "fewer than 2");
  expectBad([](Terrain& t) { t.width = 1; }, "fewer than 2");
  expectBad([](Terrain& t) { t.height = -5; }, "fewer than 2");
  expectBad([](Terrain& t) { t.heights.pop_back(); }, "number of heights");
  expectBad([](Terrain& t) { t.spacing_m.x = 0.0f; }, "0.1 mm");
  expectBad([](Terrain& t) { t.spacing_m.y = kNan; }, "10,000 km");
  expectBad([](Terrain& t) { t.corner.y = kInfinity; }, "10,000 km");
  expectBad([](Terrain& t) { t.heights[3] = kNan; }, "a height");
  expectBad([](Terrain& t) { t.heights[4] = -kInfinity; }, "a height");
}

TEST(CoverMap, IsBilinearBetweenTheMiddlesOfItsTexels) {
  const CoverMap map{2, 2, {-4, -2}, {8, 4}, {0.0f, 1.0f, 0.5f, 0.25f}};
  EXPECT_EQ(map.at({-2, -1}), 0.0f);
  EXPECT_EQ(map.at({2, -1}), 1.0f);
  EXPECT_EQ(map.at({-2, 1}), 0.5f);
  EXPECT_EQ(map.at({2, 1}), 0.25f);
  EXPECT_EQ(map.at({0, -1}), 0.5f);
  EXPECT_EQ(map.at({0, 0}), 0.4375f);
  EXPECT_EQ(map.at({-1, 0}), 0.34375f);
  EXPECT_EQ(map.at({-1e30f, -1}), 0.0f);
  EXPECT_EQ(map.at({kInfinity, 1e30f}), 0.25f);
  const CoverMap even{1, 1, {0, 0}, {1, 1}, {0.75f}};
  EXPECT_EQ(even.at({0.2f, 7.0f}), 0.75f);
}

TEST(CoverMap, ReadsTheFirstChannel) {
  const Image16 image = randomPicture(6, 3, 3);
  const CoverMap map = readCoverMap(written("cover.png", encodePng(image)), {12, 6});
  EXPECT_EQ(map.corner, glm::vec2(-6, -3));
  EXPECT_EQ(map.size_m, glm::vec2(12, 6));
  ASSERT_EQ(map.values.size(), 18u);
  for (std::size_t i = 0; i < 18; ++i)
    EXPECT_EQ(map.values[i], static_cast<float>(image.values[3 * i] / 65535.0));
  EXPECT_EQ(map.at({-3, -2}), 1.0f);
  // One texel is enough.
  EXPECT_EQ(readCoverMap(written("texel.png", encodePng(Image16{1, 1, 1, {65535}})), {1, 1}).at({}),
            1.0f);
}

TEST(CoverMap, ChecksNameWhatIsWrong) {
  const CoverMap good{2, 1, {0, 0}, {1, 1}, {0.0f, 1.0f}};
  EXPECT_EQ(errorOf([&] { checkCoverMap(good, "cover"); }), "no error");
  const auto expectBad = [&](const std::function<void(CoverMap&)>& damage,
                             const std::string& part) {
    CoverMap bad = good;
    damage(bad);
    expectError([&] { checkCoverMap(bad, "cover"); }, part);
  };
  expectBad([](CoverMap& m) { m = CoverMap{}; }, "no texels");
  expectBad([](CoverMap& m) { m.values.pop_back(); }, "number of values");
  expectBad([](CoverMap& m) { m.size_m.x = 0.0f; }, "size");
  expectBad([](CoverMap& m) { m.corner.x = kNan; }, "corner");
  expectBad([](CoverMap& m) { m.values[0] = 1.5f; }, "[0, 1]");
  expectBad([](CoverMap& m) { m.values[1] = kNan; }, "[0, 1]");
}

TEST(GrownTerrain, KeepsItsPromises) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    TerrainGrowOptions options;
    options.seed = random.next();
    options.size_m = {random.uniform(20.0f, 900.0f), random.uniform(20.0f, 900.0f)};
    options.relief_m = random.uniform(0.01f, 90.0f);
    options.hill_m = std::exp2(random.uniform(-3.0f, 12.0f));
    options.samples = i % 4 == 0 ? 9 + i / 4 : 9 + static_cast<int>(random.below(250));
    const Terrain terrain = growTerrain(options);
    SCOPED_TRACE(testing::Message() << "samples " << options.samples << " hills " << options.hill_m
                                    << " size " << options.size_m.x << " x " << options.size_m.y);
    EXPECT_NO_THROW(checkTerrain(terrain, "grown"));
    EXPECT_EQ(terrain.width, options.samples);
    EXPECT_EQ(terrain.height, options.samples);
    EXPECT_EQ(terrain.corner, -0.5f * options.size_m);
    const glm::vec2 range = heightRange(terrain);
    EXPECT_EQ(range.y - range.x, options.relief_m);
    EXPECT_EQ(terrain.heightAt({0, 0}), 0.0f);
    EXPECT_NEAR(terrain.normalAt({0, 0}).y, 1.0f, 1e-3f);
    for (int j = 0; j < 50; ++j) {
      const float angle = random.vary(3.14159f), away = random.uniform(0.0f, 2.99f);
      EXPECT_EQ(terrain.heightAt(away * glm::vec2(std::cos(angle), std::sin(angle))), 0.0f);
    }
  }
}

TEST(GrownTerrain, IsDeterministic) {
  TerrainGrowOptions options;
  options.samples = 129;
  const Terrain once = growTerrain(options);
  setThreadCount(1);
  EXPECT_EQ(growTerrain(options).heights, once.heights);
  setThreadCount(0);
  options.seed = 2;
  EXPECT_NE(growTerrain(options).heights, once.heights);
}

TEST(GrownTerrain, RollsAsLargeAsItsHills) {
  // Share of the heights' variance that is left in their differences over a length: little over a
  // tenth of a hill, about twice of it (independent places) over a few hills.
  const Terrain terrain = growTerrain({.seed = 7, .size_m = {800, 800}, .hill_m = 50});
  const auto varianceOver = [&](float away) {
    Random random(6);
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
      const glm::vec2 place(random.vary(200.0f), random.vary(200.0f));
      const float angle = random.vary(3.14159f);
      const double d = terrain.heightAt(place) -
                       terrain.heightAt(place + away * glm::vec2(std::cos(angle), std::sin(angle)));
      sum += d * d;
    }
    return sum / 20000;
  };
  EXPECT_LT(varianceOver(5.0f), 0.1 * varianceOver(150.0f));
  EXPECT_NEAR(varianceOver(100.0f) / varianceOver(150.0f), 1.0, 0.25);
  // No step between two samples is a cliff.
  const std::vector<glm::vec2> slopes = terrainSlopes(terrain);
  EXPECT_LT(glm::length(*std::ranges::max_element(
                slopes, {}, [](const glm::vec2& s) { return glm::dot(s, s); })),
            1.5f);
}

TEST(GrownTerrain, ExtremesWork) {
  EXPECT_EQ(heightRange(growTerrain({.relief_m = 0, .samples = 9})), glm::vec2(0.0f));
  for (const float relief : {1e-44f, 1e-30f, 1e6f})
    for (const float hill : {1e-38f, 1e38f}) {
      const glm::vec2 range =
          heightRange(growTerrain({.relief_m = relief, .hill_m = hill, .samples = 33}));
      EXPECT_EQ(range.y - range.x, relief);
    }
  const glm::vec2 strip = heightRange(growTerrain({.size_m = {1000, 0.01f}, .samples = 10}));
  EXPECT_EQ(strip.y - strip.x, 12.0f);
}

TEST(GrownTerrain, BadNumbersAreNamed) {
  expectError([] { growTerrain({.size_m = {0, 200}}); }, "size");
  expectError([] { growTerrain({.size_m = {200, kNan}}); }, "size");
  expectError([] { growTerrain({.size_m = {1e9f, 200}}); }, "10,000 km");
  expectError([] { growTerrain({.size_m = {1e-3f, 200}}); }, "0.1 mm");
  expectError([] { growTerrain({.relief_m = -1}); }, "relief");
  expectError([] { growTerrain({.relief_m = kNan}); }, "relief");
  expectError([] { growTerrain({.relief_m = 1e8f}); }, "relief");
  expectError([] { growTerrain({.hill_m = 0}); }, "hills");
  expectError([] { growTerrain({.hill_m = kInfinity}); }, "hills");
  expectError([] { growTerrain({.samples = 8}); }, "8 samples");
  expectError([] { growTerrain({.samples = 8194}); }, "8194 samples");
}

// Levels of detail.

/// Everything is in the middle of this picture.
const glm::mat4 kAllSeen = [] {
  glm::mat4 matrix(0.0f);
  matrix[3][3] = 1.0f;
  return matrix;
}();

struct View {
  TerrainLevels levels;
  glm::vec3 eye{0.0f};
  std::vector<TerrainNode> nodes;

  float sideOf(const TerrainNode& node) const {
    return node.cell_m * static_cast<float>(levels.cells);
  }
  glm::vec2 drawn(const TerrainNode& node, int x, int z) const {
    return shared::drawnPlace(node, {static_cast<unsigned>(x), static_cast<unsigned>(z)}, eye,
                              levels.heights);
  }
  int nodeAt(const glm::vec2& place) const {
    int found = -1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const glm::vec2 offset = place - nodes[i].corner;
      if (offset.x < 0 || offset.y < 0 || offset.x >= sideOf(nodes[i]) ||
          offset.y >= sideOf(nodes[i]))
        continue;
      EXPECT_EQ(found, -1) << "two nodes overlap";
      found = static_cast<int>(i);
    }
    return found;
  }
};

View viewFrom(const TerrainLevels& levels, const glm::vec3& eye,
              const glm::mat4& clip_from_world = kAllSeen) {
  return {levels, eye, selectTerrainNodes(levels, eye, clip_from_world)};
}

/// Eyes near and far, in the ground's heights and above, on the lattice and off it.
View randomView(Random& random) {
  TerrainLevels levels;
  levels.finest_m = random.uniform(0.1f, 1.0f);
  levels.cells = 2 << random.below(5);
  levels.radius_m = levels.finest_m * std::exp2(random.uniform(4.0f, 13.0f));
  levels.heights = {random.uniform(-30.0f, 0.0f), random.uniform(0.0f, 30.0f)};
  const float reach = std::exp2(random.uniform(0.0f, 16.0f));
  glm::vec3 eye(random.vary(reach), random.vary(100.0f), random.vary(reach));
  if (random.below(4) == 0) eye = glm::round(eye / 16.0f) * 16.0f;
  if (random.below(8) == 0) eye.y += levels.radius_m;
  return viewFrom(levels, eye);
}

using Places = std::set<std::pair<float, float>>;
using Vertices = std::set<std::array<float, 3>>;  // x, z and drawnCell()

/// What is drawn of a node's border that lies on the segment from `low` to `high`.
Vertices drawnOn(const View& view, const TerrainNode& node, const glm::vec2& low,
                 const glm::vec2& high) {
  Vertices vertices;
  const int n = view.levels.cells;
  for (int i = 0; i <= n; ++i)
    for (const auto& [x, z] :
         {std::pair(0, i), std::pair(n, i), std::pair(i, 0), std::pair(i, n)}) {
      const glm::vec2 place = view.drawn(node, x, z);
      if (place.x >= low.x && place.x <= high.x && place.y >= low.y && place.y <= high.y)
        vertices.insert(
            {place.x, place.y, shared::drawnCell(node, place, view.eye, view.levels.heights)});
    }
  return vertices;
}

TEST(TerrainLevels, NodesCoverTheGroundOnceOnAFixedLattice) {
  Random random(10);
  for (int i = 0; i < 100; ++i) {
    const View view = randomView(random);
    EXPECT_LE(view.nodes.size(), mostTerrainNodes(view.levels));
    for (const TerrainNode& node : view.nodes) {
      const glm::vec2 lattice = node.corner / view.sideOf(node);
      EXPECT_EQ(lattice, glm::floor(lattice));
      const float level = std::log2(node.cell_m);
      EXPECT_EQ(level, std::floor(level));
      EXPECT_GE(2.0f * node.cell_m, view.levels.finest_m);
    }
    for (int j = 0; j < 200; ++j) {
      const glm::vec2 place =
          glm::vec2(view.eye.x, view.eye.z) +
          0.999f * view.levels.radius_m * glm::vec2(random.vary(1.0f), random.vary(1.0f));
      EXPECT_NE(view.nodeAt(place), -1);
    }
  }
}

TEST(TerrainLevels, FinestCellsAreUnderTheEyeAndNotMany) {
  const TerrainLevels levels;
  const View view = viewFrom(levels, {3.1f, 1.7f, -2.2f});
  const int own = view.nodeAt({3.1f, -2.2f});
  ASSERT_NE(own, -1);
  EXPECT_EQ(view.nodes[static_cast<std::size_t>(own)].cell_m, 0.25f);
  EXPECT_EQ(view.nodes.back().cell_m, 0.25f);
  EXPECT_LT(view.nodes.size(), 600u);
  // From high above, fine cells would be lost.
  for (const TerrainNode& node : viewFrom(levels, {0, 300, 0}).nodes) EXPECT_GE(node.cell_m, 4.0f);
}

/// The centre of it all: borders of neighbours are the same polylines, number for number.
TEST(TerrainLevels, NoCracks) {
  Random random(11);
  int same = 0, finer = 0, slid = 0;
  for (int i = 0; i < 120; ++i) {
    const View view = randomView(random);
    for (std::size_t a = 0; a < view.nodes.size(); ++a)
      for (std::size_t b = a + 1; b < view.nodes.size(); ++b) {
        const TerrainNode &p = view.nodes[a], &q = view.nodes[b];
        const glm::vec2 low = glm::max(p.corner, q.corner);
        const glm::vec2 high = glm::min(p.corner + view.sideOf(p), q.corner + view.sideOf(q));
        if (glm::any(glm::lessThan(high, low)) || high == low) continue;
        const float ratio = p.cell_m / q.cell_m;
        EXPECT_TRUE(ratio == 1.0f || ratio == 2.0f || ratio == 0.5f) << ratio;
        const Vertices of_p = drawnOn(view, p, low, high);
        ASSERT_EQ(of_p, drawnOn(view, q, low, high));
        (ratio == 1.0f ? same : finer) += 1;
        for (const auto& [x, z, cell] : of_p) slid += cell != p.cell_m && cell != q.cell_m;
      }
  }
  // The comparison was not of nothing.
  EXPECT_GT(same, 1000);
  EXPECT_GT(finer, 1000);
  EXPECT_GT(slid, 1000);
}

using Triangle = std::array<std::pair<float, float>, 3>;

/// Triangles of a grid that are not empty, each from its smallest corner on.
std::set<Triangle> trianglesOf(const TerrainNode& node, unsigned cells, float morph) {
  std::set<Triangle> triangles;
  for (unsigned v = 0; v < 6 * cells * cells; v += 3) {
    std::array<glm::vec2, 3> p;
    for (unsigned k = 0; k < 3; ++k)
      p[k] = shared::morphedPlace(node.corner, node.cell_m,
                                  shared::terrainGridIndex(node, v + k, cells, glm::vec3(0.0f)),
                                  morph);
    const glm::vec2 e = p[1] - p[0], f = p[2] - p[0];
    const float area = e.y * f.x - e.x * f.y;  // above 0: counter-clockwise from above
    EXPECT_GE(area, 0.0f);
    if (area == 0.0f) continue;
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = {p[k].x, p[k].y};
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    triangles.insert(triangle);
  }
  return triangles;
}

TEST(TerrainLevels, AFullySlidNodeIsThatOfTheNextLevel) {
  const TerrainNode fine{{-32, 16}, 0.5f, 0, 0};
  const TerrainNode coarse{{-32, 16}, 1.0f, 0, 0};
  const std::set<Triangle> slid = trianglesOf(fine, 16, 1.0f);
  EXPECT_EQ(slid.size(), 128u);
  EXPECT_EQ(slid, trianglesOf(coarse, 8, 0.0f));
  EXPECT_EQ(trianglesOf(fine, 16, 0.0f).size(), 512u);
  for (const float morph : {0.1f, 0.5f, 0.99f})  // none is turned over on the way
    EXPECT_EQ(trianglesOf(fine, 16, morph).size(), 512u);
}

/// Height of the drawn ground: the triangles' whose vertices lie on `height`.
float drawnHeight(const View& view, const glm::vec2& place,
                  const std::function<float(const glm::vec2&)>& height) {
  const int index = view.nodeAt(place);
  if (index < 0) return kNan;
  const TerrainNode& node = view.nodes[static_cast<std::size_t>(index)];
  const glm::ivec2 own((place - node.corner) / node.cell_m);
  for (int z = std::max(own.y - 1, 0); z <= std::min(own.y + 1, view.levels.cells - 1); ++z)
    for (int x = std::max(own.x - 1, 0); x <= std::min(own.x + 1, view.levels.cells - 1); ++x)
      for (int beyond = 0; beyond < 2; ++beyond) {
        const glm::vec2 a = view.drawn(node, x + beyond, z + beyond);
        const glm::vec2 b = view.drawn(node, x + 1, z), c = view.drawn(node, x, z + 1);
        const glm::dmat2 edges(glm::dvec2(b - a), glm::dvec2(c - a));
        if (std::abs(glm::determinant(edges)) < 1e-12) continue;
        const glm::dvec2 share = glm::inverse(edges) * glm::dvec2(place - a);
        if (share.x < -1e-6 || share.y < -1e-6 || share.x + share.y > 1 + 1e-6) continue;
        const double at_a = height(a);
        return static_cast<float>(at_a + share.x * (height(b) - at_a) +
                                  share.y * (height(c) - at_a));
      }
  ADD_FAILURE() << "a hole at " << place.x << ' ' << place.y;
  return kNan;
}

TEST(TerrainLevels, NothingPopsWhenTheEyeMoves) {
  const auto height = [](const glm::vec2& p) {
    return 5.0f * std::sin(0.11f * p.x) * std::cos(0.07f * p.y) + 2.0f * std::sin(0.9f * p.x + p.y);
  };
  TerrainLevels levels;
  levels.radius_m = 500.0f;
  levels.heights = {-7.0f, 7.0f};
  constexpr float kStep = 0.02f;
  Random random(12);
  int moved = 0;
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 eye(random.vary(300.0f), random.uniform(-5.0f, 40.0f), random.vary(300.0f));
    const View before = viewFrom(levels, eye);
    const View after = viewFrom(
        levels, eye + glm::vec3(random.vary(kStep), random.vary(kStep), random.vary(kStep)));
    for (int j = 0; j < 200; ++j) {
      const float away = std::exp2(random.uniform(0.0f, 8.5f));
      const glm::vec2 place =
          glm::vec2(eye.x, eye.z) + away * glm::vec2(random.vary(1.0f), random.vary(1.0f));
      const float one = drawnHeight(before, place, height);
      const float other = drawnHeight(after, place, height);
      // A pop would be as high as the ground bends within a cell: a hundred times as much.
      EXPECT_NEAR(one, other, 0.5f * kStep);
      moved += one != other;
    }
  }
  EXPECT_GT(moved, 100);
}

/// Where a ray of the plane enters and leaves a node; empty if exit <= entry.
std::pair<double, double> spanOf(const glm::dvec2& from, const glm::dvec2& along,
                                 const TerrainNode& node, float side) {
  double entry = 0.0, exit = 1e30;
  for (int k = 0; k < 2; ++k) {
    const double a = (node.corner[k] - from[k]) / along[k];
    const double b = (node.corner[k] + side - from[k]) / along[k];
    entry = std::max(entry, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return {entry, exit};
}

TEST(TerrainLevels, NodesComeBackToFront) {
  Random random(13);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const View view = randomView(random);
    for (int j = 0; j < 20; ++j) {
      const double angle = random.vary(3.14159f);
      const glm::dvec2 from(view.eye.x, view.eye.z), along(std::cos(angle), std::sin(angle));
      double last = 1e30;  // where the farther node was entered
      for (const TerrainNode& node : view.nodes) {
        const auto [entry, exit] = spanOf(from, along, node, view.sideOf(node));
        if (exit <= entry + 1e-4) continue;
        EXPECT_LE(exit, last + 1e-4);
        last = entry;
        ++compared;
      }
      EXPECT_EQ(last, 0.0);  // the eye's own node is the last one
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(TerrainLevels, CellsComeBackToFront) {
  Random random(14);
  constexpr unsigned kCells = 8;
  const TerrainNode node{{16, -8}, 1.0f, 1e30f, 1e30f};
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 eye(random.uniform(4.0f, 36.0f), 2.0f, random.uniform(-20.0f, 12.0f));
    std::vector<std::array<glm::dvec2, 3>> triangles;
    Places corners;
    for (unsigned v = 0; v < 6 * kCells * kCells; v += 3) {
      std::array<glm::dvec2, 3> p;
      for (unsigned k = 0; k < 3; ++k)
        p[k] = shared::drawnPlace(node, shared::terrainGridIndex(node, v + k, kCells, eye), eye,
                                  {0.0f, 1.0f});
      triangles.push_back(p);
      const glm::dvec2 middle = (p[0] + p[1] + p[2]) / 3.0;
      corners.insert({static_cast<float>(middle.x), static_cast<float>(middle.y)});
    }
    EXPECT_EQ(corners.size(), 2 * kCells * kCells);  // none is there twice
    for (int j = 0; j < 10; ++j) {
      const double angle = random.vary(3.14159f);
      const glm::dvec2 from(eye.x, eye.z), along(std::cos(angle), std::sin(angle));
      double last = 1e30;
      for (const auto& p : triangles) {
        double entry = 0.0, exit = 1e30;
        for (std::size_t k = 0; k < 3; ++k) {  // cut the ray by each edge's line
          const glm::dvec2 edge = p[(k + 1) % 3] - p[k];
          const glm::dvec2 inward(edge.y, -edge.x);
          const double start = glm::dot(inward, from - p[k]), speed = glm::dot(inward, along);
          if (speed > 0) entry = std::max(entry, -start / speed);
          if (speed < 0) exit = std::min(exit, -start / speed);
        }
        if (exit <= entry + 1e-6) continue;
        EXPECT_LE(exit, last + 1e-6);
        last = entry;
      }
    }
  }
}

/// Reverse depth with the far plane at infinity, y down, as the renderer's.
glm::mat4 clipOf(const glm::vec3& eye, const glm::vec3& toward, float aspect) {
  const float scale = 1.0f / std::tan(0.35f), near = 0.1f;
  glm::mat4 clip(0.0f);
  clip[0][0] = scale / aspect;
  clip[1][1] = -scale;
  clip[2][3] = -1.0f;
  clip[3][2] = near;
  return clip * glm::lookAt(eye, eye + toward, glm::vec3(0, 1, 0));
}

TEST(TerrainLevels, OnlyWhatIsOutsideOfThePictureIsLeftOut) {
  Random random(15);
  double kept = 0;
  for (int i = 0; i < 100; ++i) {
    const View all = randomView(random);
    const float heading = random.vary(3.14159f), pitch = random.vary(0.6f);
    const glm::mat4 clip = clipOf(all.eye,
                                  glm::vec3(std::cos(heading) * std::cos(pitch), std::sin(pitch),
                                            std::sin(heading) * std::cos(pitch)),
                                  1.5f);
    const View seen = viewFrom(all.levels, all.eye, clip);
    // The same nodes in the same order, some left out.
    std::size_t next = 0;
    for (const TerrainNode& node : all.nodes) {
      const auto sameAs = [](const TerrainNode& a, const TerrainNode& b) {
        return a.corner == b.corner && a.cell_m == b.cell_m && a.morph_begin_m == b.morph_begin_m &&
               a.morph_end_m == b.morph_end_m;
      };
      if (next < seen.nodes.size() && sameAs(node, seen.nodes[next])) {
        ++next;
        continue;
      }
      // No point of it is in the picture.
      for (int j = 0; j < 20; ++j) {
        const glm::vec4 p =
            clip * glm::vec4(node.corner.x + all.sideOf(node) * random.uniform(),
                             random.uniform(all.levels.heights.x, all.levels.heights.y),
                             node.corner.y + all.sideOf(node) * random.uniform(), 1.0f);
        EXPECT_FALSE(p.w > 0.0f && std::abs(p.x) < 0.999f * p.w && std::abs(p.y) < 0.999f * p.w);
      }
    }
    EXPECT_EQ(next, seen.nodes.size());
    kept += static_cast<double>(seen.nodes.size()) / static_cast<double>(all.nodes.size());
  }
  EXPECT_LT(kept / 100, 0.4);
}

TEST(TerrainLevels, AnotherPictureOfTheSameEyeHasTheSameNodes) {
  // A shadow's parallel rays, finite depth: nodes of the picture's eye that it meets.
  const TerrainLevels levels;
  const glm::vec3 eye(40, 3, -7);
  const View all = viewFrom(levels, eye);
  const glm::mat4 shadow = glm::ortho(-50.0f, 50.0f, -50.0f, 50.0f, 0.1f, 1.0f) *
                           glm::lookAt(glm::vec3(90, 80, 30), glm::vec3(40, 0, -7), {0, 1, 0});
  const View lit = viewFrom(levels, eye, shadow);
  EXPECT_GT(lit.nodes.size(), 10u);
  EXPECT_LT(lit.nodes.size(), all.nodes.size());
  EXPECT_NE(lit.nodeAt({40, -7}), -1);
  for (const TerrainNode& node : lit.nodes) {
    const int same = all.nodeAt(node.corner + 0.5f * all.sideOf(node));
    ASSERT_NE(same, -1);
    EXPECT_EQ(all.nodes[static_cast<std::size_t>(same)].cell_m, node.cell_m);
  }
}

TEST(TerrainLevels, MorphsExactlyFromZeroToOne) {
  EXPECT_EQ(shared::terrainMorph(3.0f, 3.0f, 7.0f), 0.0f);
  EXPECT_EQ(shared::terrainMorph(5.0f, 3.0f, 7.0f), 0.5f);
  EXPECT_EQ(shared::terrainMorph(7.0f, 3.0f, 7.0f), 1.0f);
  EXPECT_EQ(shared::terrainMorph(-1.0f, 3.0f, 7.0f), 0.0f);
  EXPECT_EQ(shared::terrainMorph(1e30f, 3.0f, 7.0f), 1.0f);
  EXPECT_EQ(shared::morphedPlace({4, 8}, 2.0f, {3, 2}, 0.5f), glm::vec2(9, 12));
  EXPECT_EQ(shared::terrainDistance({3, 4}, {1, 9, 1}, {0, 2}), 7.0f);
  EXPECT_EQ(shared::terrainDistance({3, 4}, {1, 1, 1}, {0, 2}), 3.0f);
}

}  // namespace
}  // namespace verdure
