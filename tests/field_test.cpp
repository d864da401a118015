// The density field and its surface, against reference values, brute force in double precision,
// and the full lattice.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "bake/marching_cubes.h"
#include "base/parallel.h"
#include "base/random.h"
#include "shared/density.h"
#include "surface_checks.h"
#include "verdure/error.h"
#include "verdure/field.h"

namespace verdure {
namespace {

double bruteSum(const std::vector<Generator>& generators, const glm::dvec3& q, const Norm& norm) {
  double sum = 0;
  for (const Generator& g : generators) {
    const glm::dvec3 d = glm::abs(q - glm::dvec3(g.position));
    double length = 0;
    switch (norm.kind) {
      case Norm::Kind::kL1:
        length = d.x + d.y + d.z;
        break;
      case Norm::Kind::kL2:
        length = glm::length(d);
        break;
      case Norm::Kind::kLinf:
        length = std::max(d.x, std::max(d.y, d.z));
        break;
      case Norm::Kind::kLp: {
        const double p = norm.p;
        const double m = std::max(d.x, std::max(d.y, d.z));  // else high powers underflow
        if (m > 0)
          length = m * std::pow(std::pow(d.x / m, p) + std::pow(d.y / m, p) + std::pow(d.z / m, p),
                                1.0 / p);
      }
    }
    const double s = length / double{g.radius};
    if (s < 1) sum += (1 - s * s) * (1 - s * s);
  }
  return sum;
}

std::vector<Generator> randomEllipsoid(std::size_t count, float radius, std::uint64_t seed,
                                       const glm::vec3& offset = glm::vec3(0.0f)) {
  Random random(seed);
  std::vector<Generator> generators;
  while (generators.size() < count) {
    const glm::vec3 p(random.vary(1), random.vary(1), random.vary(1));
    if (glm::dot(p, p) <= 1)
      generators.push_back({p * glm::vec3(1.5f, 2.0f, 1.5f) + offset, radius});
  }
  return generators;
}

const std::vector<Norm>& allNorms() {
  static const std::vector<Norm> norms = {{Norm::Kind::kL1, 1},  {Norm::Kind::kL2, 2},
                                          {Norm::Kind::kLp, 4},  {Norm::Kind::kLp, 1.5f},
                                          {Norm::Kind::kLp, 32}, {Norm::Kind::kLp, 1000},
                                          {Norm::Kind::kLinf, 0}};
  return norms;
}

TEST(DensityField, MatchesReferenceValues) {
  std::ifstream in(VERDURE_TEST_DATA "/density.json");
  const auto reference = nlohmann::json::parse(in);
  std::vector<Generator> generators;
  for (const auto& g : reference["generators"])
    generators.push_back({{g[0], g[1], g[2]}, reference["rho"]});
  std::vector<glm::vec3> queries;
  for (const auto& q : reference["queries"]) queries.push_back({q[0], q[1], q[2]});
  const std::map<std::string, Norm> norms = {{"1", {Norm::Kind::kL1, 1}},
                                             {"2", {Norm::Kind::kL2, 2}},
                                             {"4", {Norm::Kind::kLp, 4}},
                                             {"inf", {Norm::Kind::kLinf, 0}}};
  for (const auto& [name, norm] : norms) {
    const DensityField field(generators, norm);
    std::vector<float> sums(queries.size());
    field.sumAt(queries, sums);
    for (std::size_t i = 0; i < queries.size(); ++i)
      EXPECT_NEAR(double{sums[i]} - reference["tau"].get<double>(),
                  reference["values"][name][i].get<double>(), 1e-5)
          << "norm " << name << ", query " << i;
  }
}

TEST(DensityField, TransferMatchesReferenceValues) {
  std::ifstream in(VERDURE_TEST_DATA "/density.json");
  const auto reference = nlohmann::json::parse(in);
  ASSERT_GT(reference["transfer"].size(), 10u);
  for (const auto& row : reference["transfer"])
    EXPECT_NEAR(shared::ambientCoefficient(row[0], row[1], row[2], row[3]), row[4].get<double>(),
                1e-6);
}

TEST(DensityField, SumsAreWithinTenThousandthOfDoublePrecision) {
  auto generators = randomEllipsoid(3000, 0.6f, 3, {1000.0f, 50.0f, -300.0f});
  Random random(9);
  for (Generator& g : generators) g.radius = random.uniform(0.2f, 0.7f);
  std::vector<glm::vec3> points;
  for (int i = 0; i < 3001; ++i)
    points.push_back(glm::vec3(random.vary(2.5f), random.vary(2.5f), random.vary(2.5f)) +
                     glm::vec3(1000.0f, 50.0f, -300.0f));
  for (const Norm& norm : allNorms()) {
    const DensityField field(generators, norm, 1.25f);
    std::vector<float> sums(points.size());
    field.sumAt(points, sums);
    std::size_t positive = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double exact = 1.25 * bruteSum(generators, points[i], norm);
      positive += exact > 1 ? 1 : 0;
      EXPECT_NEAR(sums[i], exact, 1e-4 * std::max(exact, 1.0));
    }
    EXPECT_GT(positive, 500u);
  }
}

TEST(DensityField, GradientIsTheDerivative) {
  const auto generators = randomEllipsoid(300, 0.8f, 4);
  Random random(5);
  std::vector<glm::vec3> points;
  for (int i = 0; i < 200; ++i)
    points.push_back({random.vary(1.5f), random.vary(2.0f), random.vary(1.5f)});
  for (const Norm& norm : allNorms()) {
    const DensityField field(generators, norm);
    std::vector<float> sums(points.size());
    std::vector<glm::vec3> gradients(points.size());
    field.gradientAt(points, sums, gradients);
    std::size_t agree = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(sums[i], bruteSum(generators, points[i], norm), 1e-3);
      glm::dvec3 numeric;
      for (int a = 0; a < 3; ++a) {
        glm::dvec3 step(0);
        step[a] = 1e-5;
        numeric[a] = (bruteSum(generators, glm::dvec3(points[i]) + step, norm) -
                      bruteSum(generators, glm::dvec3(points[i]) - step, norm)) /
                     2e-5;
      }
      // L1 and Linf have kinks, where a central difference straddles two slopes.
      if (glm::length(numeric - glm::dvec3(gradients[i])) < 2e-3 * (1 + glm::length(numeric)))
        ++agree;
    }
    EXPECT_GE(agree, norm.kind == Norm::Kind::kL2 ? points.size() : points.size() * 98 / 100);
  }
}

TEST(DensityField, OneGeneratorIsTheKernel) {
  const std::vector<Generator> one = {{{1, 2, 3}, 2.0f}};
  const DensityField field(one);
  const std::vector<glm::vec3> points = {{1, 2, 3}, {2, 2, 3}, {1, 4, 3}, {1, 2, 10}};
  std::vector<float> sums(4);
  field.sumAt(points, sums);
  EXPECT_FLOAT_EQ(sums[0], 1.0f);
  EXPECT_FLOAT_EQ(sums[1], 0.5625f);
  EXPECT_FLOAT_EQ(sums[2], 0.0f);
  EXPECT_FLOAT_EQ(sums[3], 0.0f);
  for (const float s : {0.0f, 0.3f, 0.9f, 1.0f, 1.5f})
    EXPECT_FLOAT_EQ(shared::metaball(s), s < 1 ? (1 - s) * (1 - s) : 0.0f);
}

TEST(DensityField, LatticeMatchesPoints) {
  const auto generators = randomEllipsoid(500, 0.5f, 6);
  for (const Norm& norm : allNorms()) {
    const DensityField field(generators, norm);
    const Lattice lattice = field.lattice(24);
    const std::vector<float> sums = field.sumOn(lattice);
    std::size_t i = 0;
    for (int z = 0; z < lattice.points.z; ++z)
      for (int y = 0; y < lattice.points.y; ++y)
        for (int x = 0; x < lattice.points.x; ++x, ++i) {
          const glm::vec3 p = lattice.origin + lattice.spacing * glm::vec3(x, y, z);
          ASSERT_NEAR(sums[i], bruteSum(generators, p, norm), 2e-3);
          const bool border = x == 0 || y == 0 || z == 0 || x + 1 == lattice.points.x ||
                              y + 1 == lattice.points.y || z + 1 == lattice.points.z;
          if (border) {
            ASSERT_EQ(sums[i], 0.0f);
          }
        }
  }
}

TEST(DensityField, LpHoldsForAnySizeAndPower) {
  for (const float size : {0.01f, 1.0f, 40.0f})
    for (const float p : {1.5f, 20.0f, 64.0f, 1000.0f}) {
      const std::vector<Generator> one = {{{0, 0, 0}, size}};
      const Norm norm{Norm::Kind::kLp, p};
      const DensityField field(one, norm);
      const std::vector<glm::vec3> points = {size * glm::vec3(0.3f, 0.2f, 0.1f),
                                             size * glm::vec3(-0.5f, 0.5f, 0.0f)};
      std::vector<float> sums(2);
      std::vector<glm::vec3> gradients(2);
      field.gradientAt(points, sums, gradients);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(sums[i], bruteSum(one, points[i], norm), 1e-4) << size << ' ' << p;
        // Downhill along the ray from the generator: |q| d/d|q| of the kernel.
        const float s2 = 1 - std::sqrt(sums[i]);
        EXPECT_NEAR(glm::dot(gradients[i], points[i]), -4 * (1 - s2) * s2, 2e-3f)
            << size << ' ' << p;
      }
    }
}

TEST(DensityField, RefusesBadGenerators) {
  const std::vector<Generator> nan = {{{0, NAN, 0}, 1}}, flat = {{{0, 0, 0}, 0}};
  EXPECT_THROW(DensityField{nan}, Error);
  EXPECT_THROW(DensityField{flat}, Error);
  const std::vector<Generator> good = {{{0, 0, 0}, 1}};
  EXPECT_THROW(DensityField(good, {Norm::Kind::kLp, 0.5f}), Error);
  EXPECT_THROW(DensityField(good).lattice(0), Error);
  EXPECT_THROW(DensityField({}).lattice(10), Error);
  const std::vector<Generator> tiny = {{{0, 0, 0}, 1e-25f}},
                               far = {{{-3e38f, 0, 0}, 1}, {{3e38f, 0, 0}, 1}};
  EXPECT_THROW(DensityField{tiny}, Error);
  EXPECT_THROW(DensityField{far}, Error);
  EXPECT_THROW(DensityField(good).surface(DensityField(good).lattice(2000), 0.5f, 1 << 20), Error);
}

TEST(MarchingCubes, CasesAreClosedAndComplementary) {
  for (int bits = 0; bits < 256; ++bits) {
    const CellCase& cell = cellCases()[static_cast<std::size_t>(bits)];
    EXPECT_LE(cell.triangle_count, 5);
    // Exactly the edges with one inside end are used.
    std::array<bool, 12> used{};
    for (std::size_t i = 0; i < 3u * cell.triangle_count; ++i) used[cell.edges[i]] = true;
    for (int e = 0; e < 12; ++e) {
      const int from = edgeCorner(e), to = from | 1 << (e / 4);
      EXPECT_EQ(used[static_cast<std::size_t>(e)], (bits >> from & 1) != (bits >> to & 1));
    }
  }
}

TEST(Surface, RandomFieldsAreClosedAndManifold) {
  // Hard cases for marching cubes: few, small generators, so that many cells are ambiguous.
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const auto generators = randomEllipsoid(200, 0.15f + 0.05f * static_cast<float>(seed), seed);
    for (const Norm& norm : allNorms()) {
      const DensityField field(generators, norm);
      const Surface surface = field.surface(field.lattice(30), 0.3f);
      ASSERT_GT(surface.indices.size(), 0u);
      const MeshTopology topology = meshTopology(surface);
      EXPECT_EQ(topology.open_edges, 0u);
      EXPECT_EQ(topology.non_manifold_edges, 0u);
      EXPECT_EQ(topology.non_manifold_vertices, 0u);
      EXPECT_GT(signedVolume(surface), 0.0);
    }
  }
}

TEST(Surface, SphereHasItsAreaVolumeAndNormals) {
  // One generator: (1 - s^2)^2 = tau at s = sqrt(1 - sqrt(tau)).
  const std::vector<Generator> one = {{{0.3f, -0.2f, 0.1f}, 1.0f}};
  const DensityField field(one);
  const float tau = 0.3f, radius = std::sqrt(1 - std::sqrt(tau));
  const Surface surface = field.surface(field.lattice(96), tau);
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 d = surface.positions[i] - one[0].position;
    ASSERT_NEAR(glm::length(d), radius, 2e-4f);
    ASSERT_NEAR(glm::dot(glm::normalize(d), surface.normals[i]), 1.0f, 1e-5f);
  }
  EXPECT_NEAR(signedVolume(surface), 4.0 / 3.0 * M_PI * std::pow(radius, 3), 2e-3);
  EXPECT_EQ(meshTopology(surface).euler, 2);
}

TEST(Surface, PrunedLatticeGivesTheFullLatticesSurface) {
  // A large radius uses the coarse lattice; the oracle classifies every cell of the full one.
  for (const float radius : {0.35f, 0.9f, 1.5f})
    for (const float share : {0.02f, 0.3f, 0.9f}) {
      const auto generators = randomEllipsoid(800, radius, 11);
      const DensityField field(generators);
      const Lattice lattice = field.lattice(90);
      const std::vector<float> sums = field.sumOn(lattice);
      const float tau = share * *std::max_element(sums.begin(), sums.end());
      SurfaceStatistics statistics;
      const Surface surface = field.surface(lattice, tau, std::size_t{1} << 30, &statistics);
      if (radius > 0.5f) {
        EXPECT_GT(statistics.coarse_step, 1);
        EXPECT_LT(statistics.grid_points_evaluated, sums.size());
      }
      std::size_t crossings = 0, triangles = 0;
      const auto nx = static_cast<std::size_t>(lattice.points.x),
                 ny = static_cast<std::size_t>(lattice.points.y),
                 nz = static_cast<std::size_t>(lattice.points.z);
      const std::size_t step[3] = {1, nx, nx * ny};
      for (std::size_t z = 0; z + 1 < nz; ++z)
        for (std::size_t y = 0; y + 1 < ny; ++y)
          for (std::size_t x = 0; x + 1 < nx; ++x) {
            const std::size_t at = x + nx * (y + ny * z);
            for (const std::size_t s : step)
              crossings += (sums[at] > tau) != (sums[at + s] > tau) ? 1 : 0;
            std::size_t bits = 0;
            for (std::size_t c = 0; c < 8; ++c)
              bits |= (sums[at + (c & 1) + nx * ((c >> 1 & 1) + ny * (c >> 2))] > tau ? 1u : 0u)
                      << c;
            triangles += cellCases()[bits].triangle_count;
          }
      EXPECT_EQ(surface.positions.size(), crossings);
      EXPECT_EQ(surface.indices.size(), 3 * triangles);
      EXPECT_EQ(meshTopology(surface).open_edges, 0u);
    }
}

TEST(Surface, IsTheSameForAnyNumberOfThreads) {
  const auto generators = randomEllipsoid(2000, 0.4f, 21);
  const DensityField field(generators);
  const Lattice lattice = field.lattice(70);
  setThreadCount(1);
  const Surface one = field.surface(lattice, 3.0f);
  setThreadCount(0);
  const Surface all = field.surface(lattice, 3.0f);
  EXPECT_EQ(one.indices, all.indices);
  EXPECT_TRUE(one.positions == all.positions);
  EXPECT_TRUE(one.normals == all.normals);
}

TEST(Surface, MovesWithItsGenerators) {
  auto generators = randomEllipsoid(300, 0.5f, 2);
  const DensityField field(generators);
  const Surface here = field.surface(field.lattice(40), 1.0f);
  for (Generator& g : generators) g.position += glm::vec3(8.0f, -4.0f, 16.0f);
  const DensityField moved(generators);
  const Surface there = moved.surface(moved.lattice(40), 1.0f);
  EXPECT_NEAR(signedVolume(here), signedVolume(there), 1e-3);
}

TEST(Surface, IsEmptyAboveTheMaximum) {
  const auto generators = randomEllipsoid(50, 0.5f, 2);
  const DensityField field(generators);
  EXPECT_TRUE(field.surface(field.lattice(20), 60.0f).indices.empty());
}

TEST(Surface, ThresholdZeroIsClosed) {
  const auto generators = randomEllipsoid(50, 0.5f, 2);
  const DensityField field(generators);
  const Surface surface = field.surface(field.lattice(30), 0.0f);
  EXPECT_EQ(meshTopology(surface).open_edges, 0u);
  for (const glm::vec3& n : surface.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
}

TEST(Isolines, TwoGeneratorsOfTheFigure) {
  // Fig. 2: two generators, tau = 0.3. Every point of the polylines satisfies sum = tau, the lines
  // are closed, and the inside lies on their left.
  const std::vector<Generator2> two = {{{-0.5f, 0.0f}, 1.0f}, {{0.6f, 0.2f}, 0.8f}};
  const std::vector<Polyline> lines = isolines(two, 0.3f, 200);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].front(), lines[0].back());
  double area = 0;
  for (std::size_t i = 0; i + 1 < lines[0].size(); ++i) {
    ASSERT_NEAR(sumAt(two, lines[0][i]), 0.3f, 1e-3f);
    area += 0.5 * (double{lines[0][i].x} * double{lines[0][i + 1].y} -
                   double{lines[0][i + 1].x} * double{lines[0][i].y});
  }
  EXPECT_GT(area, 0.0);
  // Brute-force area of the inside.
  int inside = 0;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j)
      inside += sumAt(two, {-2.0f + 0.01f * (static_cast<float>(i) + 0.5f),
                            -2.0f + 0.01f * (static_cast<float>(j) + 0.5f)}) > 0.3f
                    ? 1
                    : 0;
  EXPECT_NEAR(area, inside * 1e-4, 3e-3);
}

TEST(Isolines, FarApartGeneratorsAreCirclesAndBadInputIsRefused) {
  const std::vector<Generator2> two = {{{-2.0f, 0.0f}, 1.0f}, {{2.0f, 0.0f}, 0.5f}};
  EXPECT_EQ(isolines(two, 0.3f, 100).size(), 2u);
  EXPECT_TRUE(isolines(two, 1.5f, 100).empty());
  EXPECT_THROW(isolines(two, 0.3f, 0), Error);
  const std::vector<Generator2> bad = {{{0.0f, 0.0f}, -1.0f}};
  EXPECT_THROW(isolines(bad, 0.3f, 10), Error);
}

}  // namespace
}  // namespace verdure
