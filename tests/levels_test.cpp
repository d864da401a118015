#include "verdure/levels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <set>

#include "bake/coverage.h"
#include "base/parallel.h"
#include "base/random.h"
#include "rays/ray_scene.h"
#include "shared/color.h"
#include "shared/forest.h"
#include "shared/octahedron.h"
#include "verdure/error.h"
#include "verdure/grow.h"

namespace verdure {
namespace {

const Plant& smallTree() {
  static const Plant plant = [] {
    GrowOptions options;
    options.species = "japanese-maple";
    options.leaf_form = LeafForm::kCard;
    options.set = {{"Levels", "3"}};
    options.texture_size = 128;
    Plant grown = grow(options);
    findLeaves(grown);
    return grown;
  }();
  return plant;
}

double leafArea(const std::vector<Mesh>& meshes) {
  double sum = 0.0;
  for (const Mesh& mesh : meshes) {
    if (mesh.kind != PartKind::kFoliage) continue;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const glm::vec3& a = mesh.positions[mesh.indices[i]];
      sum += 0.5 * double{glm::length(glm::cross(mesh.positions[mesh.indices[i + 1]] - a,
                                                 mesh.positions[mesh.indices[i + 2]] - a))};
    }
  }
  return sum;
}

std::size_t triangles(const std::vector<Mesh>& meshes, PartKind kind) {
  std::size_t sum = 0;
  for (const Mesh& mesh : meshes) sum += mesh.kind == kind ? mesh.triangleCount() : 0;
  return sum;
}

TEST(Octahedron, UnfoldsTheUpperHemisphere) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const float y = random.uniform(), turn = random.uniform(0.0f, 6.2831853f);
    const float r = std::sqrt(1.0f - y * y);
    const glm::vec3 d(r * std::cos(turn), y, r * std::sin(turn));
    const glm::vec2 at = shared::octahedronPlace(d);
    EXPECT_GE(std::min(at.x, at.y), 0.0f);
    EXPECT_LE(std::max(at.x, at.y), 1.0f);
    EXPECT_LT(glm::length(shared::octahedronDirection(at) - d), 1e-4f);
    const glm::vec3 right = shared::viewRight(d), up = glm::cross(d, right);
    EXPECT_NEAR(glm::dot(right, d), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::length(up), 1.0f, 1e-5f);
    EXPECT_GE(up.y, -1e-6f);
  }
}

TEST(Octahedron, NearestViewsSurroundTheDirection) {
  Random random(2);
  const float views = 8.0f;
  for (int i = 0; i < 1000; ++i) {
    const float y = random.uniform(), turn = random.uniform(0.0f, 6.2831853f);
    const float r = std::sqrt(1.0f - y * y);
    const glm::vec3 d(r * std::cos(turn), y, r * std::sin(turn));
    const shared::NearestViews nearest = shared::nearestViews(d, views);
    const glm::vec3& w = nearest.weights;
    EXPECT_NEAR(w.x + w.y + w.z, 1.0f, 1e-5f);
    EXPECT_GE(std::min({w.x, w.y, w.z}), -1e-5f);
    // Their places, by their weights, are the direction's.
    const glm::vec2 place =
        (w.x * nearest.first + w.y * nearest.second + w.z * nearest.third) / (views - 1.0f);
    EXPECT_LT(glm::length(place - shared::octahedronPlace(d)), 1e-5f);
    for (const glm::vec2& view : {nearest.first, nearest.second, nearest.third}) {
      EXPECT_GE(std::min(view.x, view.y), 0.0f);
      EXPECT_LE(std::max(view.x, view.y), views - 1.0f);
    }
  }
}

TEST(SimplifyPlant, KeepsTheAreaOfLeaves) {
  const Plant& plant = smallTree();
  const double area = leafArea(plant.meshes);
  for (const float share : {0.5f, 0.25f, 0.0625f}) {
    const PlantLevel level = simplifyPlant(plant, {.leaf_share = share});
    EXPECT_NEAR(leafArea(level.meshes) / area, 1.0, 1e-3) << share;
    EXPECT_NEAR(static_cast<double>(triangles(level.meshes, PartKind::kFoliage)) /
                    static_cast<double>(triangles(plant.meshes, PartKind::kFoliage)),
                share, 0.01);
  }
}

TEST(SimplifyPlant, CoarseLeavesAreAmongTheFinerOnes) {
  const Plant& plant = smallTree();
  const PlantLevel fine = simplifyPlant(plant, {.leaf_share = 0.5f});
  const PlantLevel coarse = simplifyPlant(plant, {.leaf_share = 0.1f});
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    if (plant.meshes[m].kind != PartKind::kFoliage) continue;
    const std::set<std::uint32_t> known(fine.sources[m].begin(), fine.sources[m].end());
    EXPECT_FALSE(coarse.sources[m].empty());
    for (const std::uint32_t v : coarse.sources[m]) EXPECT_TRUE(known.contains(v));
  }
}

TEST(SimplifyPlant, ThinsWood) {
  const Plant& plant = smallTree();
  const std::size_t all = triangles(plant.meshes, PartKind::kWood);
  for (const float share : {0.5f, 0.25f, 0.0625f}) {
    const PlantLevel level = simplifyPlant(plant, {.wood_share = share});
    const std::size_t left = triangles(level.meshes, PartKind::kWood);
    EXPECT_LE(static_cast<double>(left), share * static_cast<double>(all) + 1.0) << share;
    EXPECT_GT(left, 0u);
    for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
      const Mesh& mesh = level.meshes[m];
      EXPECT_EQ(mesh.positions.size(), level.sources[m].size());
      for (const std::uint32_t i : mesh.indices) EXPECT_LT(i, mesh.positions.size());
      if (mesh.kind == PartKind::kFoliage) continue;
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        EXPECT_EQ(mesh.positions[v], plant.meshes[m].positions[level.sources[m][v]]);
    }
  }
}

TEST(SimplifyPlant, RefusesSharesOutOfRange) {
  EXPECT_THROW(simplifyPlant(smallTree(), {.leaf_share = 0.0f}), Error);
  EXPECT_THROW(simplifyPlant(smallTree(), {.leaf_share = 1.5f}), Error);
  EXPECT_THROW(simplifyPlant(smallTree(), {.wood_error = -1.0f}), Error);
}

TEST(Levels, CoverWhatThePlantDoes) {
  const Plant& plant = smallTree();
  LevelOptions options;
  options.impostor = {.views = 2, .texels = 16, .samples = 1};
  const PlantLevels levels = makeLevels(plant, nullptr, options);
  const double covered = meanCoverage(plant);
  ASSERT_EQ(levels.meshes.size(), options.leaf_shares.size());
  for (const PlantLevel& level : levels.meshes) {
    Plant coarse = plant;
    coarse.meshes = level.meshes;
    EXPECT_NEAR(meanCoverage(coarse) / covered, 1.0, 0.015) << level.leaf_share;
    EXPECT_GT(level.leaf_growth, 1.0f);
  }
}

TEST(Impostor, ShowsThePlantFromItsViews) {
  const Plant& plant = smallTree();
  const Impostor impostor = bakeImpostor(plant, nullptr, {.views = 4, .texels = 64, .samples = 2});
  ASSERT_EQ(impostor.color.width, 256);
  const RayScene scene(plant);
  Random random(3);
  for (const glm::ivec2 view : {glm::ivec2(0, 0), glm::ivec2(2, 1), glm::ivec2(3, 1)}) {
    const glm::vec3 toward = shared::octahedronDirection(glm::vec2(view) / 3.0f);
    const glm::vec3 right = shared::viewRight(toward), up = glm::cross(toward, right);
    // Other rays, at random: the same share of the square, mean depth and colour.
    constexpr int kRays = 40000;
    double hits = 0.0, depth = 0.0;
    glm::dvec3 color(0.0);
    for (int i = 0; i < kRays; ++i) {
      const glm::vec2 at(random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
      Ray ray;
      ray.origin = impostor.center + impostor.radius * (at.x * right - at.y * up + toward);
      ray.direction = -toward;
      const auto hit = scene.closestHit(ray);
      if (!hit) continue;
      hits += 1.0;
      depth += 1.0 - double{hit->distance} / (2.0 * double{impostor.radius});
      color += glm::dvec3(hit->reflectance);
    }
    double covered = 0.0, mean_depth = 0.0;
    glm::dvec3 mean_color(0.0);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const std::uint8_t* c = impostor.color.at(view.x * 64 + x, view.y * 64 + y);
        const std::uint8_t* n = impostor.normal.at(view.x * 64 + x, view.y * 64 + y);
        covered += c[3] / 255.0;
        mean_depth += n[3] / 255.0;
        for (int k = 0; k < 3; ++k)
          mean_color[k] += double{shared::linearFromSrgb(static_cast<float>(c[k]) / 255.0f)};
      }
    const double texels = 64.0 * 64.0;
    EXPECT_NEAR(covered / texels / (hits / kRays), 1.0, 0.03);
    EXPECT_NEAR(mean_depth / texels / (depth / kRays), 1.0, 0.03);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean_color[k] / texels / (color[k] / kRays), 1.0, 0.05);
  }
}

TEST(Impostor, IsTheSameForAnyNumberOfThreads) {
  const ImpostorOptions options{.views = 2, .texels = 32, .samples = 1};
  setThreadCount(1);
  const Impostor one = bakeImpostor(smallTree(), nullptr, options);
  setThreadCount(0);
  const Impostor all = bakeImpostor(smallTree(), nullptr, options);
  EXPECT_EQ(one.color.rgba, all.color.rgba);
  EXPECT_EQ(one.normal.rgba, all.normal.rgba);
  EXPECT_EQ(one.light.rgba, all.light.rgba);
}

TEST(Impostor, RefusesWhatItCannotDo) {
  EXPECT_THROW(bakeImpostor(Plant{}, nullptr), Error);
  EXPECT_THROW(bakeImpostor(smallTree(), nullptr, {.views = 1}), Error);
  EXPECT_THROW(bakeImpostor(smallTree(), nullptr, {.texels = 4}), Error);
}

TEST(ForestLevel, GivesWayStepByStep) {
  const glm::vec4 reach(10.0f, 30.0f, 30.0f, 90.0f);
  float last = 2.0f;
  std::uint32_t level = 0;
  for (float d = 0.5f; d < 120.0f; d += 0.05f) {
    const shared::ForestLevel at = shared::forestLevel(reach, 4, 1, d, 1e30f);
    EXPECT_GE(at.level, level) << d;
    EXPECT_NE(at.level, 2u);  // ends where the one before does
    EXPECT_NE(at.next, 2u);
    const bool giving_way = at.level == level && at.next != at.level;
    EXPECT_TRUE(!giving_way || at.share <= last) << d;  // no step back
    last = at.level == level ? at.share : 2.0f;
    level = at.level;
    EXPECT_GT(at.share, 0.0f);
    EXPECT_LE(at.share, 1.0f);
  }
  EXPECT_EQ(level, 4u);
  EXPECT_EQ(shared::forestLevel(reach, 4, 1, 8.0f, 5.0f).level, 4u);  // meshes end before
  EXPECT_EQ(shared::forestLevel(glm::vec4(1e30f), 1, 0, 1e6f, 5.0f).level, 0u);
}

TEST(ForestLevel, TwoLevelsShareAPixelsSamples) {
  Random random(4);
  double kept = 0.0;
  for (std::uint32_t share = 1; share < shared::kForestWhole; ++share)
    for (int i = 0; i < 64; ++i) {
      const float noise = random.uniform();
      const std::uint32_t fine = shared::keptSamples(share, noise);
      const std::uint32_t coarse = shared::keptSamples(share | shared::kForestRest, noise);
      EXPECT_EQ(fine & coarse, 0u);
      EXPECT_EQ(fine | coarse, 15u);
      kept +=
          static_cast<double>(__builtin_popcount(fine)) / 4.0 - static_cast<double>(share) / 127.0;
    }
  EXPECT_NEAR(kept / (126.0 * 64.0), 0.0, 0.005);
}

TEST(MeanCosine, IsNearTheMeanOfManyFaces) {
  // Faces spread around an axis: the mean over them of the clamped cosine.
  Random random(5);
  for (const float spread : {0.0f, 0.4f, 0.8f, 1.2f}) {
    std::vector<glm::vec3> faces;
    glm::vec3 mean(0.0f);
    for (int i = 0; i < 4000; ++i) {
      const float angle = spread * std::sqrt(random.uniform());
      const float turn = random.uniform(0.0f, glm::two_pi<float>());
      faces.emplace_back(std::sin(angle) * std::cos(turn), std::cos(angle),
                         std::sin(angle) * std::sin(turn));
      mean += faces.back() / 4000.0f;
    }
    double sphere = 0.0;
    for (int i = 0; i <= 40; ++i) {
      const float y = 1.0f - static_cast<float>(i) / 20.0f;
      const glm::vec3 l(std::sqrt(std::max(1.0f - y * y, 0.0f)), y, 0.0f);
      double truth = 0.0;
      for (const glm::vec3& n : faces) truth += std::max(glm::dot(n, l), 0.0f) / 4000.0;
      EXPECT_NEAR(shared::meanCosine(mean, l), truth, 0.11) << spread << " " << y;
      sphere += (i == 0 || i == 40 ? 0.5 : 1.0) * double{shared::meanCosine(mean, l)} / 40.0;
    }
    EXPECT_NEAR(sphere, 0.25, 0.01);  // no light is lost or gained
  }
}

}  // namespace
}  // namespace verdure
