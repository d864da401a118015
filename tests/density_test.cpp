// The bake of crown light from the density field.
#include "verdure/density.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/crown_parameters.h"
#include "bake/nearest_surface.h"
#include "base/parallel.h"
#include "crowns.h"
#include "shared/density.h"
#include "surface_checks.h"
#include "verdure/error.h"

namespace verdure {
namespace {

double bruteSum(const std::vector<glm::vec3>& centers, float rho, const glm::vec3& q) {
  double sum = 0;
  for (const glm::vec3& c : centers) {
    const double s = glm::length(glm::dvec3(q) - glm::dvec3(c)) / double{rho};
    if (s < 1) sum += (1 - s * s) * (1 - s * s);
  }
  return sum;
}

std::vector<glm::vec3> centersOf(const Plant& plant) {
  std::vector<glm::vec3> centers;
  for (const Leaf& leaf : plant.leaves) centers.push_back(leaf.centroid);
  return centers;
}

TEST(DensityBake, AmbientIsTheTransferOfTheExactField) {
  const Plant plant = makeBallCrown(2000);
  DensityOptions options;
  options.k_min = 0.1f;
  options.exponent = 2.0f;
  const DensityBake bake = bakeDensity(plant, options);
  const DensityReport& r = bake.report;
  const auto centers = centersOf(plant);
  ASSERT_EQ(bake.light.meshes.size(), 2u);
  std::size_t open = 0, core = 0;
  for (std::size_t m = 0; m < 2; ++m) {
    ASSERT_EQ(bake.light.meshes[m].ambient.size(), plant.meshes[m].positions.size());
    for (std::size_t i = 0; i < plant.meshes[m].positions.size(); ++i) {
      const double d = bruteSum(centers, r.rho, plant.meshes[m].positions[i]) - double{r.tau};
      const double k = d <= 0                 ? 1.0
                       : d >= double{r.d_min} ? 0.1
                                              : 0.1 + 0.9 * std::pow(1 - d / double{r.d_min}, 2.0);
      ASSERT_NEAR(bake.light.meshes[m].ambient[i], k, 2e-4);
      open += d <= -1e-3 ? 1 : 0;
      core += d >= double{r.d_min} + 1e-3 ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(r.vertices_open), static_cast<double>(open), 8);
  EXPECT_NEAR(static_cast<double>(r.vertices_core), static_cast<double>(core), 8);
  EXPECT_GT(r.vertices_core, 100u);
  EXPECT_GT(r.vertices_open, 100u);
  // The trunk's foot stands in the open, its top in the middle of the crown.
  EXPECT_EQ(
      *std::max_element(bake.light.meshes[0].ambient.begin(), bake.light.meshes[0].ambient.end()),
      1.0f);
  EXPECT_LT(
      *std::min_element(bake.light.meshes[0].ambient.begin(), bake.light.meshes[0].ambient.end()),
      0.3f);
}

TEST(DensityBake, BallHasRadialNormalsAndADarkCore) {
  const Plant plant = makeBallCrown(6000);
  for (const CrownNormals mode :
       {CrownNormals::kSurfacePoint, CrownNormals::kSurfaceVertex, CrownNormals::kEllipsoid}) {
    DensityOptions options;
    options.normals = mode;
    const DensityBake bake = bakeDensity(plant, options);
    const Mesh& mesh = plant.meshes[1];
    double cosine = 0, outer = 0, inner = 0;
    std::size_t counted = 0, outers = 0, inners = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const float radius = glm::length(mesh.positions[i]);
      const glm::vec3 n = bake.light.meshes[1].normals[i];
      ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
      if (radius > 0.5f) {
        cosine += double{glm::dot(n, mesh.positions[i] / radius)};
        ++counted;
      }
      (radius > 0.9f ? outer : inner) +=
          radius > 0.9f || radius < 0.3f ? double{bake.light.meshes[1].ambient[i]} : 0.0;
      outers += radius > 0.9f ? 1 : 0;
      inners += radius < 0.3f ? 1 : 0;
    }
    EXPECT_GT(cosine / static_cast<double>(counted), 0.93);
    EXPECT_GT(outer / static_cast<double>(outers), inner / static_cast<double>(inners) + 0.3);
    EXPECT_LT(inner / static_cast<double>(inners), 0.45);
    // Bark keeps its normals.
    EXPECT_TRUE(bake.light.meshes[0].normals == plant.meshes[0].normals);
    if (mode != CrownNormals::kEllipsoid) {
      EXPECT_TRUE(bake.report.watertight);
      EXPECT_EQ(meshTopology(bake.surface).open_edges, 0u);
      EXPECT_EQ(bake.report.surface_vertices, bake.surface.positions.size());
    }
  }
}

TEST(DensityBake, NearestVertexIsBruteForceWithLowestIndexOnTies) {
  // A lattice of points has many ties.
  Surface surface;
  for (int i = 0; i < 125; ++i)
    surface.positions.push_back(
        {static_cast<float>(i % 5), static_cast<float>(i / 5 % 5), static_cast<float>(i / 25)});
  std::reverse(surface.positions.begin(), surface.positions.end());
  surface.normals.assign(125, glm::vec3(0, 1, 0));
  for (std::uint32_t i = 0; i + 2 < 125; ++i)
    surface.indices.insert(surface.indices.end(), {i, i + 1, i + 2});
  const NearestSurface nearest(surface);
  Random random(3);
  for (int q = 0; q < 2000; ++q) {
    // Half-integers lie exactly between vertices.
    const glm::vec3 p = 0.5f * glm::vec3(random.below(11), random.below(11), random.below(11));
    std::uint32_t best = 0;
    for (std::uint32_t v = 1; v < 125; ++v)
      if (glm::dot(surface.positions[v] - p, surface.positions[v] - p) <
          glm::dot(surface.positions[best] - p, surface.positions[best] - p))
        best = v;
    ASSERT_EQ(nearest.vertex(p), best);
  }
}

TEST(DensityBake, NearestPointIsBruteForce) {
  const Plant plant = makeBallCrown(3000);
  DensityOptions options;
  options.grid = 48;
  const DensityBake bake = bakeDensity(plant, options);
  const Surface& s = bake.surface;
  const NearestSurface nearest(s);
  Random random(8);
  std::size_t exact = 0;
  constexpr std::size_t kQueries = 400;
  for (std::size_t q = 0; q < kQueries; ++q) {
    const glm::vec3 p(random.vary(1.2f), random.vary(1.2f), random.vary(1.2f));
    // Brute force by dense sampling would be too coarse: minimise the distance to each triangle
    // by projecting on its plane and clamping to its edges.
    double best = 1e30;
    for (std::size_t i = 0; i < s.indices.size(); i += 3) {
      const glm::dvec3 a(s.positions[s.indices[i]]), b(s.positions[s.indices[i + 1]]),
          c(s.positions[s.indices[i + 2]]), point(p);
      const glm::dvec3 n = glm::cross(b - a, c - a);
      const double area2 = glm::dot(n, n);
      const auto segment = [&](const glm::dvec3& u, const glm::dvec3& v) {
        const double l2 = glm::dot(v - u, v - u);
        const double t = l2 > 0 ? std::clamp(glm::dot(point - u, v - u) / l2, 0.0, 1.0) : 0.0;
        return glm::length(point - (u + t * (v - u)));
      };
      double d = std::min(segment(a, b), std::min(segment(b, c), segment(c, a)));
      if (area2 > 0) {
        const glm::dvec3 foot = point - n * (glm::dot(point - a, n) / area2);
        if (glm::dot(glm::cross(b - a, foot - a), n) >= 0 &&
            glm::dot(glm::cross(c - b, foot - b), n) >= 0 &&
            glm::dot(glm::cross(a - c, foot - c), n) >= 0)
          d = std::min(d, glm::length(point - foot));
      }
      best = std::min(best, d);
    }
    const double found = glm::length(glm::dvec3(nearest.point(p).position) - glm::dvec3(p));
    const double by_vertex =
        glm::length(glm::dvec3(s.positions[nearest.vertex(p)]) - glm::dvec3(p));
    EXPECT_LE(found, by_vertex + 1e-6);
    EXPECT_GE(found, best - 1e-5);
    EXPECT_LE(found, best + 0.05 * double{bake.report.voxel_m});
    exact += found <= best + 1e-5 ? 1 : 0;
  }
  // Elsewhere another sheet is nearer by a hair, as the bound above says.
  EXPECT_GE(exact, kQueries * 97 / 100);
}

TEST(DensityBake, SurfacePointNormalsDoNotFacet) {
  // On a coarse grid the nearest vertex's normals jump; those at the nearest point stay close to
  // the fine grid's.
  const Plant plant = makeBallCrown(4000);
  const auto deviation = [&](CrownNormals mode) {
    DensityOptions fine, coarse;
    fine.grid = 160;
    coarse.grid = 24;
    coarse.normals = mode;
    const DensityBake a = bakeDensity(plant, fine), b = bakeDensity(plant, coarse);
    double sum = 0;
    for (std::size_t i = 0; i < a.light.meshes[1].normals.size(); ++i)
      // Deep inside, opposite sides of the surface are equally near, whatever the method.
      if (glm::length(plant.meshes[1].positions[i]) > 0.8f)
        sum += double{1.0f - glm::dot(a.light.meshes[1].normals[i], b.light.meshes[1].normals[i])};
    return sum;
  };
  EXPECT_LT(deviation(CrownNormals::kSurfacePoint), 0.7 * deviation(CrownNormals::kSurfaceVertex));
}

TEST(DensityBake, IsTheSameForAnyNumberOfThreads) {
  const Plant plant = makeBallCrown(5000);
  setThreadCount(1);
  const DensityBake one = bakeDensity(plant);
  setThreadCount(0);
  const DensityBake all = bakeDensity(plant);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_TRUE(one.light.meshes[m].ambient == all.light.meshes[m].ambient);
    EXPECT_TRUE(one.light.meshes[m].normals == all.light.meshes[m].normals);
  }
  EXPECT_EQ(one.report.mean_ambient, all.report.mean_ambient);
}

TEST(DensityBake, ScalesWithThePlant) {
  Plant plant = makeBallCrown(3000);
  const DensityBake small = bakeDensity(plant);
  for (Mesh& mesh : plant.meshes)
    for (glm::vec3& p : mesh.positions) p *= 64.0f;
  for (Leaf& leaf : plant.leaves) {
    leaf.centroid *= 64.0f;
    leaf.area *= 4096.0f;
  }
  const DensityBake large = bakeDensity(plant);
  EXPECT_NEAR(large.report.rho, 64.0f * small.report.rho, 1e-3f * large.report.rho);
  EXPECT_NEAR(large.report.tau, small.report.tau, 1e-3f * small.report.tau);
  for (std::size_t i = 0; i < small.light.meshes[1].ambient.size(); ++i)
    ASSERT_NEAR(small.light.meshes[1].ambient[i], large.light.meshes[1].ambient[i], 1e-3f);
}

TEST(DensityBake, AFractionOfTheLeavesGivesNearlyTheSameLight) {
  const Plant plant = makeBallCrown(20000, 0.05f);
  DensityOptions options;
  options.rho = 0.4f;
  const DensityBake full = bakeDensity(plant, options);
  options.fraction = 0.25f;
  options.tau = full.report.tau;
  options.d_min = full.report.d_min;
  const DensityBake part = bakeDensity(plant, options), again = bakeDensity(plant, options);
  EXPECT_EQ(part.report.generators, 5000u);
  EXPECT_TRUE(part.light.meshes[1].ambient == again.light.meshes[1].ambient);
  double difference = 0, angle = 0;
  const std::size_t n = full.light.meshes[1].ambient.size();
  for (std::size_t i = 0; i < n; ++i) {
    difference +=
        double{std::abs(full.light.meshes[1].ambient[i] - part.light.meshes[1].ambient[i])};
    angle += double{glm::dot(full.light.meshes[1].normals[i], part.light.meshes[1].normals[i])};
  }
  // 320 generators in reach instead of 1,280: a few percent of noise in F.
  EXPECT_LT(difference / static_cast<double>(n), 0.06);
  EXPECT_GT(angle / static_cast<double>(n), 0.85);
  EXPECT_NEAR(signedVolume(full.surface), signedVolume(part.surface),
              0.05 * signedVolume(full.surface));
  options.seed = 2;
  EXPECT_FALSE(bakeDensity(plant, options).light.meshes[1].ambient == part.light.meshes[1].ambient);
}

TEST(DensityBake, ThresholdsDoNotDependOnTheFraction) {
  const Plant plant = makeBallCrown(1500);
  DensityOptions options;
  const DensityReport full = bakeDensity(plant, options).report;
  for (const float fraction : {0.3f, 0.05f}) {
    options.fraction = fraction;
    const DensityReport part = bakeDensity(plant, options).report;
    EXPECT_EQ(part.rho, full.rho);
    EXPECT_EQ(part.tau, full.tau);
    EXPECT_EQ(part.d_min, full.d_min);
  }
  // Nor does a plant that stands alone in a population see other thresholds.
  const Plant* plants[] = {&plant};
  const Placement place[] = {{0, {3.0f, 0.0f, 0.0f}}};
  const DensityReport alone = bakeDensityPopulation(plants, place, options)[0].report;
  EXPECT_NEAR(alone.tau, full.tau, 1e-3f * full.tau);
  EXPECT_NEAR(alone.d_min, full.d_min, 1e-3f * full.d_min);
}

TEST(DensityBake, BlendLeadsFromLeafToCrown) {
  const Plant plant = makeBallCrown(1000);
  DensityOptions options;
  options.blend = 0.0f;
  EXPECT_LT(glm::length(bakeDensity(plant, options).light.meshes[1].normals[10] -
                        plant.meshes[1].normals[10]),
            1e-5f);
  options.normals = CrownNormals::kKeep;
  options.blend = 1.0f;
  EXPECT_TRUE(bakeDensity(plant, options).light.meshes[1].normals == plant.meshes[1].normals);
}

TEST(DensityBake, GivenSurfaceReplacesTheExtractedOne) {
  const Plant plant = makeBallCrown(1000);
  // A large tetrahedron without normals, and a vertex that no triangle uses.
  Surface given;
  given.positions = {{9, 9, 9}, {0, 5, 0}, {5, -3, 3}, {-5, -3, 3}, {0, -3, -6}};
  given.indices = {1, 3, 2, 1, 2, 4, 1, 4, 3, 2, 3, 4};
  const DensityBake bake = bakeDensity(plant, {}, &given);
  EXPECT_EQ(bake.report.surface_vertices, 4u);
  EXPECT_TRUE(bake.report.watertight);
  for (const glm::vec3& n : bake.light.meshes[1].normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
  // Triangles without an area lead nowhere, and may not lead astray.
  Surface thin = given;
  thin.positions.push_back({0.1f, 0.1f, 0.1f});
  thin.indices.insert(thin.indices.end(), {5, 5, 5});
  const DensityBake led = bakeDensity(plant, {}, &thin);
  for (const glm::vec3& n : led.light.meshes[1].normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
  thin.positions[1].x = NAN;
  EXPECT_THROW(bakeDensity(plant, {}, &thin), Error);
  given.indices.push_back(77);
  given.indices.push_back(1);
  given.indices.push_back(2);
  EXPECT_THROW(bakeDensity(plant, {}, &given), Error);
  EXPECT_THROW(bakeDensity(plant, {}, std::make_unique<Surface>().get()), Error);
}

TEST(Population, LonePlantIsLitAsByItself) {
  const Plant plant = makeBallCrown(1500);
  const Plant* plants[] = {&plant};
  Placement place;
  place.position = {10.0f, 0.0f, -4.0f};
  place.angle = 1.1f;
  const Placement far_apart[] = {place, {0, {60.0f, 0.0f, 0.0f}}};
  const DensityBake alone = bakeDensity(plant);
  const auto group = bakeDensityPopulation(plants, far_apart);
  ASSERT_EQ(group.size(), 2u);
  double cosine = 0;
  const std::size_t n = alone.light.meshes[1].ambient.size();
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_NEAR(group[0].light.meshes[1].ambient[i], alone.light.meshes[1].ambient[i], 2e-3f);
    cosine +=
        double{glm::dot(group[0].light.meshes[1].normals[i], alone.light.meshes[1].normals[i])};
  }
  // The lattices differ, so a few inner vertices go to another side.
  EXPECT_GT(cosine / static_cast<double>(n), 0.97);
}

TEST(Population, NeighboursDarkenEachOther) {
  const Plant large = makeBallCrown(4000), small_plant = makeBallCrown(400, 0.1f, 5);
  const Plant* plants[] = {&large, &small_plant};
  const Placement near[] = {{0, {0, 0, 0}}, {1, {0.9f, 0, 0}, 0.0f, 0.4f}};
  const Placement apart[] = {{0, {0, 0, 0}}, {1, {5.0f, 0, 0}, 0.0f, 0.4f}};
  EXPECT_LT(bakeDensityPopulation(plants, near)[1].report.mean_ambient,
            bakeDensityPopulation(plants, apart)[1].report.mean_ambient - 0.05);
  const Placement wrong[] = {{7, {0, 0, 0}}};
  EXPECT_THROW(bakeDensityPopulation(plants, wrong), Error);
  EXPECT_THROW(bakeDensityPopulation(plants, {}), Error);
}

std::string messageOf(const Plant& plant, const DensityOptions& options = {}) {
  try {
    bakeDensity(plant, options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(DensityBake, SaysWhatIsWrong) {
  const Plant plant = makeBallCrown(500);
  DensityOptions o;
  o.tau = 1e6f;
  const DensityBake good = bakeDensity(plant);
  const std::string too_high = messageOf(plant, o);
  EXPECT_TRUE(has(too_high, "above the largest kernel sum")) << too_high;
  // The other kinds of normals refuse it as well.
  o.normals = CrownNormals::kEllipsoid;
  EXPECT_TRUE(has(messageOf(plant, o), "above the largest kernel sum"));
  // The maximum it names is that of the field, no lower than at the leaves.
  const std::size_t number = too_high.find("kernel sum, ") + 12;
  const float named = std::stof(too_high.substr(number));
  EXPECT_GE(named, 0.999f * good.report.field_max_at_generators) << too_high;
  EXPECT_LE(named, 1.5f * good.report.field_max_at_generators) << too_high;
  o = {};
  o.rho = 0.0f;
  EXPECT_TRUE(has(messageOf(plant, o), "rho must be above 0"));
  o.rho = NAN;
  EXPECT_TRUE(has(messageOf(plant, o), "rho must be above 0"));
  o = {};
  o.grid = 0;
  EXPECT_TRUE(has(messageOf(plant, o), "grid needs at least one cell"));
  o.grid = 100000;
  EXPECT_TRUE(has(messageOf(plant, o), "MiB are allowed"));
  o = {};
  o.fraction = 0.0f;
  EXPECT_TRUE(has(messageOf(plant, o), "fraction"));
  o = {};
  o.exponent = 0.0f;
  EXPECT_TRUE(has(messageOf(plant, o), "exponent"));

  Plant bare = plant;
  bare.meshes.resize(1);
  bare.leaves.clear();
  EXPECT_TRUE(has(messageOf(bare), "no foliage"));
  EXPECT_TRUE(has(messageOf(makeBallCrown(1)), "single leaf"));
  Plant flat = plant;
  for (Leaf& leaf : flat.leaves) leaf.area = 0.0f;
  EXPECT_TRUE(has(messageOf(flat), "zero area"));
  // Some without area are left out and counted.
  Plant some = plant;
  some.leaves[3].area = 0.0f;
  EXPECT_EQ(bakeDensity(some).report.skipped_leaves, 1u);
}

TEST(CrownParameters, AWeldedCrownIsTakenTriangleByTriangle) {
  Plant plant = makeBallCrown(300);
  plant.leaves = {plant.leaves[0], plant.leaves[1], plant.leaves[2]};
  plant.leaves[2].first_triangle = 4;
  plant.leaves[2].triangle_count = 596;
  std::size_t skipped = 0;
  EXPECT_EQ(foliageCenters(plant, skipped).size(), 2u + 596u);
}

TEST(CrownParameters, ManyOrFewLeavesBothGetNeighbours) {
  for (const std::size_t count : {std::size_t{40}, std::size_t{500}, std::size_t{50000}}) {
    const Plant plant = makeBallCrown(count, 0.05f);
    const DensityBake bake = bakeDensity(plant);
    EXPECT_GT(bake.report.field_max_at_generators, 3.0f) << count;
    EXPECT_GE(bake.report.rho, 0.15f) << count;
    EXPECT_LE(bake.report.rho, 1.6f) << count;
    EXPECT_GT(bake.report.mean_ambient, 0.3) << count;
    EXPECT_LT(bake.report.mean_ambient, 0.9) << count;
  }
}

}  // namespace
}  // namespace verdure
