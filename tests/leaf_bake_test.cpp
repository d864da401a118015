#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "leaf/fill_outside.h"
#include "leaf/leaf_maps.h"
#include "leaf/leaf_transport.h"
#include "leaf_sets.h"
#include "scratch.h"
#include "shared/leaf_basis.h"
#include "slab_walk.h"
#include "verdure/error.h"
#include "verdure/image.h"
#include "verdure/leaf_files.h"

namespace verdure {
namespace {

using test::flatLeaf;
using test::roughLeaf;

constexpr double kPi = 3.14159265358979323846;
/// Of light through a leaf that falls off as the cosine: h_i of L = n.w.
const float kCosine = static_cast<float>(std::sqrt(2 * kPi) / 3);

double relativeError(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& truth) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const glm::dvec3 e = glm::dvec3(found[i]) - glm::dvec3(truth[i]);
    error += glm::dot(e, e);
    size += glm::dot(glm::dvec3(truth[i]), glm::dvec3(truth[i]));
  }
  return std::sqrt(error / size);
}

// --- the multipole

TEST(Multipole, IsTheReference) {
  std::ifstream in(VERDURE_TEST_DATA "/leaf_transmittance.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  ASSERT_EQ(json["T"].size(), 105u);
  for (const auto& row : json["T"]) {
    const Multipole multipole(LeafOptics{}, row[0].get<double>());
    const double expected = row[3].get<double>();
    // LeafOptics holds floats; at the spike that is all there is.
    EXPECT_NEAR(multipole.transmittance(row[2].get<double>(), row[1].get<double>()), expected,
                1e-5 * std::abs(expected) + 1e-10)
        << row;
  }
  for (const auto& row : json["totals"]) {
    const Multipole multipole(LeafOptics{}, row[0].get<double>());
    EXPECT_NEAR(multipole.total(row[1].get<double>()), row[2].get<double>(), 2e-6) << row;
  }
}

TEST(Multipole, WhatIsBeyondIsTheIntegral) {
  const Multipole multipole(LeafOptics{}, 0.3);
  for (const double d : {0.13, 0.25, 0.8})
    for (const double from : {0.0, 0.1, 0.7}) {
      double sum = 0;
      constexpr int kSteps = 200000;
      const double step = 12.0 / kSteps;
      for (int i = 0; i < kSteps; ++i) {
        const double r = from + (i + 0.5) * step;
        sum += 2 * kPi * r * multipole.transmittance(r, d) * step;
      }
      EXPECT_NEAR(multipole.beyond(from, d), sum, 1e-6) << d << " " << from;
    }
}

TEST(Multipole, SurfacesThrowBackWhatFresnelSays) {
  EXPECT_NEAR(insideReflection(1.0), 0.0, 1e-12);
  // Inside, past the critical angle all is thrown back: the plain average of it.
  for (const double index : {1.2, 1.33, 1.5}) {
    double sum = 0;
    constexpr int kSteps = 400000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += 2 * cosine * test::fresnel(cosine, 1 / index) / kSteps;
    }
    EXPECT_NEAR(insideReflection(index), sum, 1e-5) << index;
  }
}

TEST(Multipole, AgreesWithRandomWalksUnderEvenLight) {
  const LeafOptics optics;
  const Multipole multipole(optics, insideReflection(1.33));
  for (const double d : {0.15, 0.3, 0.5}) {
    const test::SlabLight walk =
        test::walkThroughSlab(optics, d, 1.33, test::SlabBeam::kDiffuse, 60000, 2);
    const double entered = 1 - walk.mirrored;
    EXPECT_NEAR(multipole.total(d) / (walk.through / entered), 1.0, 0.03) << d;
    EXPECT_NEAR(1 - multipole.beyond(0.5, d) / multipole.total(d), walk.within(0.5), 0.025) << d;
  }
}

TEST(SlabWalk, LosesNothingAndKnowsBeer) {
  LeafOptics clear;
  clear.scattering_per_mm = 1e-6f;
  const test::SlabLight straight =
      test::walkThroughSlab(clear, 0.8, 1.0, test::SlabBeam::kStraight, 100000, 3);
  EXPECT_NEAR(straight.through, std::exp(-0.4 * 0.8), 0.006);
  const test::SlabLight all =
      test::walkThroughSlab(LeafOptics{}, 0.3, 1.33, test::SlabBeam::kDiffuse, 20000, 4);
  EXPECT_NEAR(all.through + all.back + all.absorbed + all.mirrored, 1.0, 1e-9);
  // Nothing absorbed, nothing mirrored: what does not go through comes back.
  LeafOptics white;
  white.absorption_per_mm = 1e-9f;
  const test::SlabLight kept =
      test::walkThroughSlab(white, 0.3, 1.0, test::SlabBeam::kDiffuse, 20000, 5);
  EXPECT_NEAR(kept.through + kept.back, 1.0, 1e-6);
}

// --- its kernel

TEST(TexelKernel, KeepsAllLight) {
  const Multipole multipole(LeafOptics{}, 0.3);
  for (const double d : {multipole.leastThickness(), 0.3, 0.9})
    for (const double texel : {0.03, 0.1, 0.5}) {
      const int reach = static_cast<int>(3.2 / texel);
      double sum = 0;
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) sum += texelShare(multipole, texel, x, y, d);
      EXPECT_NEAR(sum / multipole.total(d), 1.0, 2e-4) << d << " " << texel;
    }
}

TEST(TexelKernel, IsTheMeanOverTheTexel) {
  const Multipole multipole(LeafOptics{}, 0.3);
  constexpr int kSteps = 400;
  for (const double d : {0.18, 0.6})
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {-2, 1}, {4, 4}, {5, -3}, {0, 9}}) {
      double sum = 0;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double x = 0.1 * (dx - 0.5 + (i + 0.5) / kSteps);
          const double y = 0.1 * (dy - 0.5 + (j + 0.5) / kSteps);
          sum += multipole.transmittance(std::hypot(x, y), d);
        }
      const double mean = sum * 0.01 / (kSteps * kSteps);
      EXPECT_NEAR(texelShare(multipole, 0.1, dx, dy, d) / mean, 1.0, 1e-4) << dx << " " << dy;
    }
}

TEST(TexelKernel, ThicknessesStandBetweenTheGrids) {
  const Multipole multipole(LeafOptics{}, 0.3);
  const ThicknessGrid grid(multipole, 0.13, 0.8);
  EXPECT_NEAR(grid.thickness(0), 0.13, 1e-12);
  EXPECT_NEAR(grid.thickness(grid.size() - 1), 0.8, 1e-12);
  for (const float d : {0.13f, 0.14f, 0.31f, 0.8f}) {
    const float place = grid.place(d);
    const int k = std::min(static_cast<int>(place), grid.size() - 2);
    const double share = double{place} - k;
    const double low = multipole.transmittance(0, grid.thickness(k));
    const double high = multipole.transmittance(0, grid.thickness(k + 1));
    EXPECT_NEAR((low + share * (high - low)) / multipole.transmittance(0, double{d}), 1.0, 3e-4);
  }
}

TEST(GaussianSum, IsTheKernel) {
  const Multipole multipole(LeafOptics{}, 0.47);
  for (const double texel : {0.05, 0.2}) {
    const ThicknessGrid grid(multipole, multipole.leastThickness(), 0.8);
    const double radius = kernelRadius(multipole, grid.thickness(0), 0.8);
    const GaussianSum sum = fitGaussians(multipole, texel, grid, radius);
    EXPECT_LT(sum.terms.size(), 14u);
    const int reach = static_cast<int>(std::ceil(radius / texel));
    for (const int t : {0, grid.size() / 2, grid.size() - 1}) {
      double error = 0, size = 0, total = 0;
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
          double value = 0;
          const auto i = static_cast<std::size_t>(std::abs(x));
          const auto j = static_cast<std::size_t>(std::abs(y));
          for (const GaussianTerm& term : sum.terms)
            if (i < term.taps.size() && j < term.taps.size())
              value += double{term.weights[static_cast<std::size_t>(t)]} * double{term.taps[i]} *
                       double{term.taps[j]};
          const double exact = texelShare(multipole, texel, x, y, grid.thickness(t));
          error += std::abs(value - exact);
          size += std::abs(exact);
          total += value;
        }
      EXPECT_LT(error / size, 3e-3) << texel << " " << t;
      EXPECT_NEAR(total / multipole.total(grid.thickness(t)), 1.0, 3e-4);
    }
  }
}

// --- the basis

TEST(GaussianSum, HoldsForThickLeavesToo) {
  const Multipole multipole(LeafOptics{}, 0.47);
  for (const double d : {2.0, 6.0}) {
    const ThicknessGrid grid(multipole, d, d);
    const double radius = kernelRadius(multipole, d, d);
    EXPECT_GT(radius, 2.5);
    EXPECT_LT(multipole.beyond(radius, d), 2e-2 * multipole.total(d));
    EXPECT_LT(fitGaussians(multipole, 0.2, grid, radius).residual, 2e-2) << d;
  }
}

TEST(LeafBasis, IsOrthonormalAndKnowsItsClosedForms) {
  glm::dmat3 gram(0);
  glm::dvec3 of_cosine(0), of_one(0);
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double z = (i + 0.5) / kSteps, phi = 2 * kPi * (j + 0.5) / kSteps;
      const double r = std::sqrt(1 - z * z), area = 2 * kPi / (kSteps * kSteps);
      const glm::dvec3 b = shared::leafBasis(glm::vec3(r * std::cos(phi), r * std::sin(phi), z));
      gram += area * glm::outerProduct(b, b);
      of_cosine += area * z * b;
      of_one += area * b;
    }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(gram[i][j], i == j ? 1 : 0, 1e-5);
    // L = n.w, and L that is the same in all directions.
    EXPECT_NEAR(of_cosine[i], std::sqrt(2 * kPi) / 3, 1e-5);
    EXPECT_NEAR(of_one[i], std::sqrt(kPi / 2), 1e-5);
  }
  const glm::vec3 sun = glm::normalize(glm::vec3(0.3f, -0.5f, -0.6f));
  EXPECT_NEAR(shared::leafTransport(glm::vec3(kCosine), sun), -sun.z, 1e-6f);
  EXPECT_EQ(shared::leafTransport(glm::vec3(-1), sun), 0.0f);
}

TEST(LeafBasis, DirectionsAreEvenAndProjectExactly) {
  for (const int count : {16, 97, 128, 1024}) {
    const auto directions = hemisphereDirections(count, 1);
    ASSERT_EQ(directions.size(), static_cast<std::size_t>(count));
    glm::dvec3 mean(0);
    for (const glm::vec3& w : directions) {
      EXPECT_NEAR(glm::length(w), 1, 1e-5f);
      EXPECT_GE(w.z, 0);
      mean += glm::dvec3(w) / static_cast<double>(count);
    }
    if (count >= 128) {
      EXPECT_NEAR(mean.x, 0, 0.02);
      EXPECT_NEAR(mean.y, 0, 0.02);
      EXPECT_NEAR(mean.z, 0.5, 0.02);
    }
    const auto weights = projectionWeights(directions);
    glm::vec3 h(0);
    const glm::vec3 given(0.7f, -0.2f, 1.1f);
    for (std::size_t m = 0; m < directions.size(); ++m)
      h += weights[m] * glm::dot(given, shared::leafBasis(directions[m]));
    EXPECT_LT(glm::length(h - given), 1e-5f);
  }
}

// --- horizons

struct HeightField {
  int width, height;
  std::vector<float> heights;
  std::vector<std::uint8_t> inside;
  Horizon horizon(float step) const {
    return {heights, inside, width, height, static_cast<std::size_t>(width), step};
  }
};

TEST(Horizon, IsTheHighestSlopeAlongAxesAndDiagonals) {
  HeightField field{37, 26, {}, {}};
  Random random(9);
  for (int i = 0; i < 37 * 26; ++i) {
    field.heights.push_back(random.uniform());
    field.inside.push_back(random.uniform() < 0.95f ? 1 : 0);
  }
  const float step = 0.3f;
  const Horizon horizon = field.horizon(step);
  const int dx[] = {1, 1, 0, -1, -1, -1, 0, 1}, dy[] = {0, -1, -1, -1, 0, 1, 1, 1};
  for (int eighth = 0; eighth < 8; ++eighth) {
    const std::vector<float> found = horizon.slopes(2 * eighth);
    const float run =
        step * std::hypot(static_cast<float>(dx[eighth]), static_cast<float>(dy[eighth]));
    for (int y = 0; y < field.height; ++y)
      for (int x = 0; x < field.width; ++x) {
        const auto at = [&](int u, int v) { return static_cast<std::size_t>(v * 37 + u); };
        float highest = 0;
        for (int k = 1; field.inside[at(x, y)] != 0; ++k) {
          const int u = x + k * dx[eighth], v = y + k * dy[eighth];
          if (u < 0 || v < 0 || u >= 37 || v >= 26 || field.inside[at(u, v)] == 0) break;
          highest = std::max(highest, (field.heights[at(u, v)] - field.heights[at(x, y)]) /
                                          (static_cast<float>(k) * run));
        }
        ASSERT_NEAR(found[at(x, y)], highest, 1e-4f) << eighth << " " << x << " " << y;
      }
  }
}

TEST(Horizon, OfAPlaneIsItsSlopeAtEveryAzimuth) {
  HeightField field{40, 40, {}, std::vector<std::uint8_t>(1600, 1)};
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      field.heights.push_back(0.2f * static_cast<float>(x) + 0.1f * static_cast<float>(y));
  for (int slice = 0; slice < kHorizonSlices; ++slice) {
    const double a = Horizon::azimuth(slice);
    const double rise = 0.2 * std::cos(a) - 0.1 * std::sin(a);  // rows run down, y up
    EXPECT_NEAR(field.horizon(1.0f).slopes(slice)[20 * 40 + 20], std::max(rise, 0.0), 1e-4)
        << slice;
  }
}

// --- the bake

TEST(LeafBake, OfAFlatLeafIsTheClosedForm) {
  // E = rho n.w, so L = rho T n.w and h_i = rho T sqrt(2 pi) / 3, for any thickness and texel.
  for (const float thickness : {0.13f, 0.3f, 0.7f})
    for (const float texel : {0.08f, 0.3f}) {
      const int size = static_cast<int>(7.0f / texel);
      const LeafSet set = flatLeaf(size, size + 3, texel, thickness, 0.2f);
      const LeafTranslucency baked = bakeLeafTranslucency(set);
      const Multipole multipole(set.optics, baked.report.surface_reflection);
      const float expected =
          0.8f * static_cast<float>(multipole.total(double{thickness})) * kCosine;
      const auto middle = static_cast<std::size_t>((size / 2) * size + size / 2);
      for (const glm::vec3& h : {baked.front[middle], baked.back[middle]})
        for (int i = 0; i < 3; ++i)
          EXPECT_NEAR(h[i] / expected, 1.0f, 1e-3f) << thickness << " " << texel;
      for (const double kept : baked.report.conserved) EXPECT_NEAR(kept, 1.0, 0.2);
      EXPECT_EQ(baked.report.clamped, 0u);
    }
}

TEST(FillOutside, GoesOnSmoothlyAndLeavesTheInsideAlone) {
  const int width = 45, height = 30;
  std::vector<glm::vec3> texels;
  std::vector<std::uint8_t> inside;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      inside.push_back(std::hypot(x - 20, y - 14) < 9 ? 1 : 0);
      texels.emplace_back(inside.back() != 0 ? glm::vec3(x < 20 ? 1 : 3, 2, 5) : glm::vec3(-9));
    }
  const std::vector<glm::vec3> before = texels;
  fillOutside(texels, inside, width, height);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (inside[i] != 0) {
      EXPECT_EQ(texels[i], before[i]);
    }
    EXPECT_NEAR(texels[i].y, 2, 1e-5f);
    EXPECT_GE(texels[i].x, 1 - 1e-5f);
    EXPECT_LE(texels[i].x, 3 + 1e-5f);
  }
  EXPECT_LT(texels[14 * 45 + 8].x, 1.7f) << "left of it, what is at its left";
  EXPECT_GT(texels[14 * 45 + 32].x, 2.3f);
}

TEST(LeafBake, IsTheSumOverAllTexelsAndDirections) {
  // Written down a second time: (3.16) for each direction, then (3.21). The relief is flat, so
  // nothing shadows anything; normals, albedo and thickness are what they like.
  LeafSet set = roughLeaf(26, 17, 0.25f);
  for (LeafSide* side : {&set.front, &set.back}) {
    side->relief_mm.assign(set.texelCount(), 0.1f);
    Random random(3);
    for (glm::vec3& n : side->normal)
      n = glm::normalize(glm::vec3(random.vary(0.6f), random.vary(0.6f), 1));
  }
  LeafBakeOptions options;
  options.directions = 32;
  const LeafTranslucency baked = bakeLeafTranslucency(set, options);
  const Multipole multipole(set.optics, insideReflection(1.33));
  const auto directions = hemisphereDirections(32, options.seed);
  const auto weights = projectionWeights(directions);
  for (const bool front : {true, false}) {
    const LeafSide& lit = front ? set.back : set.front;
    std::vector<glm::vec3> expected(set.texelCount());
    for (int yi = 0; yi < set.height; ++yi)
      for (int xi = 0; xi < set.width; ++xi) {
        const auto i = static_cast<std::size_t>(yi * set.width + xi);
        if (set.opacity[i] < 0.5f) continue;
        glm::dvec3 entering(0);
        for (std::size_t m = 0; m < directions.size(); ++m)
          entering += glm::dvec3(weights[m]) *
                      double{(1 - lit.albedo[i].y) *
                             std::max(glm::dot(lit.normal[i], directions[m]), 0.0f)};
        for (int yo = 0; yo < set.height; ++yo)
          for (int xo = 0; xo < set.width; ++xo)
            expected[static_cast<std::size_t>(yo * set.width + xo)] +=
                glm::vec3(entering * texelShare(multipole, double{set.mm_per_texel}, xo - xi,
                                                yo - yi, double{set.thickness_mm[i]}));
      }
    // Outside, the map goes on where light would end.
    std::vector<glm::vec3> found = front ? baked.front : baked.back;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_GT(found[i].z, 0);
      if (set.opacity[i] < 0.5f) found[i] = expected[i] = glm::vec3(0);
    }
    EXPECT_LT(relativeError(found, expected), 1e-3);
  }
}

TEST(LeafBake, GaussiansAreTheDirectSum) {
  for (const float texel : {0.06f, 0.2f}) {
    const LeafSet set = roughLeaf(90, 61, texel);
    LeafBakeOptions options;
    const LeafTranslucency fast = bakeLeafTranslucency(set, options);
    options.method = LeafBakeMethod::kDirect;
    const LeafTranslucency direct = bakeLeafTranslucency(set, options);
    EXPECT_LT(relativeError(fast.front, direct.front), 1e-3) << texel;
    EXPECT_LT(relativeError(fast.back, direct.back), 1e-3) << texel;
    EXPECT_GT(relativeError(fast.back, direct.front), 0.01) << "the sides differ";
  }
}

TEST(LeafBake, LightOfOneDirectionIsTheDirectSum) {
  const LeafSet set = roughLeaf(45, 37, 0.2f);
  const glm::vec3 w = glm::normalize(glm::vec3(0.7f, -0.4f, 0.5f));
  LeafTransport leaf(set, {});
  leaf.makeDirectKernel();
  for (const bool back_lit : {false, true}) {
    const Plane direct = leaf.throughDirectly(
        leaf.enteringLight(back_lit ? 1 : 0, {w}, {glm::vec3(1, 0, 0)})[0], 0, set.height);
    const std::vector<float> found = lightThroughLeaf(set, back_lit, w);
    ASSERT_EQ(found.size(), set.texelCount());
    double error = 0, size = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t at = i / 45 * leaf.stride() + i % 45;
      if (set.opacity[i] < 0.5f) {
        EXPECT_EQ(found[i], 0.0f);
        continue;
      }
      error += std::pow(double{found[i]} - double{direct[at]}, 2);
      size += std::pow(double{direct[at]}, 2);
    }
    EXPECT_LT(std::sqrt(error / size), 1e-3);
  }
}

TEST(LeafBake, ARidgeShadesWhatIsBehindIt) {
  LeafSet set = flatLeaf(120, 40, 0.1f, 0.15f, 0.0f);
  for (int y = 0; y < 40; ++y)
    for (int x = 58; x < 62; ++x) set.front.relief_mm[static_cast<std::size_t>(y * 120 + x)] = 2.0f;
  const LeafTranslucency baked = bakeLeafTranslucency(set);
  const auto light = [&](int x, float direction) {
    const glm::vec3 to_sun = glm::normalize(glm::vec3(direction, 0, -0.5f));
    return shared::leafTransport(baked.back[static_cast<std::size_t>(20 * 120 + x)], to_sun);
  };
  // 1 mm beside the ridge, lit past it and from the open side.
  EXPECT_LT(light(48, 1), 0.6f * light(48, -1));
  EXPECT_LT(light(72, -1), 0.6f * light(72, 1));
  EXPECT_NEAR(light(48, 1) / light(71, -1), 1.0f, 0.1f) << "up to where the directions are";
  // On the other side, nothing has changed.
  const auto even = bakeLeafTranslucency(flatLeaf(120, 40, 0.1f, 0.15f, 0.0f));
  EXPECT_EQ(relativeError(baked.front, even.front), 0.0);
  EXPECT_GT(relativeError(baked.back, even.back), 0.02);
}

TEST(LeafBake, SidesChangePlacesWithTheirResults) {
  const LeafSet set = roughLeaf(64, 48, 0.15f);
  LeafSet turned = set;
  std::swap(turned.front, turned.back);
  const LeafTranslucency a = bakeLeafTranslucency(set), b = bakeLeafTranslucency(turned);
  EXPECT_EQ(a.front, b.back);
  EXPECT_EQ(a.back, b.front);
}

TEST(LeafBake, DoesNotDependOnThreads) {
  const LeafSet set = roughLeaf(200, 130, 0.1f);
  setThreadCount(1);
  const LeafTranslucency one = bakeLeafTranslucency(set);
  setThreadCount(3);
  const LeafTranslucency three = bakeLeafTranslucency(set);
  setThreadCount(0);
  EXPECT_EQ(one.front, three.front);
  EXPECT_EQ(one.back, three.back);
}

TEST(LeafBake, ThinTexelsAreClampedAndCounted) {
  LeafSet set = flatLeaf(40, 40, 0.2f, 0.02f, 0.1f);
  for (std::size_t i = 0; i < 100; ++i) set.thickness_mm[i] = 0.2f;
  const LeafTranslucency thin = bakeLeafTranslucency(set);
  EXPECT_EQ(thin.report.clamped, 1500u);
  EXPECT_EQ(thin.report.texels, 1600u);
  EXPECT_FLOAT_EQ(static_cast<float>(thin.report.least_thickness_mm), 0.02f);
  for (float& d : set.thickness_mm) d = std::max(d, 0.12138378f);  // 1.2 l
  EXPECT_LT(relativeError(bakeLeafTranslucency(set).front, thin.front), 1e-5);
}

TEST(LeafBake, ErrorsOfTheBasisAreNoneOnAFlatLeaf) {
  const LeafSet flat = flatLeaf(64, 64, 0.15f, 0.2f, 0.1f);
  for (const LeafErrors& e : measureLeafErrors(flat, bakeLeafTranslucency(flat))) {
    EXPECT_LT(e.mean_absolute, 1e-4);
    double sum = 0;
    for (const double bin : e.histogram) sum += bin;
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
  const LeafSet rough = roughLeaf(128, 96, 0.1f);
  const auto errors = measureLeafErrors(rough, bakeLeafTranslucency(rough));
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_NEAR(errors[2].elevation, kPi / 8, 1e-9);
  EXPECT_LT(errors[0].mean_absolute, errors[1].mean_absolute);
  EXPECT_LT(errors[1].mean_absolute, errors[2].mean_absolute);
}

TEST(LeafBake, RefusesWhatCannotBe) {
  const LeafSet set = flatLeaf(20, 20, 0.2f, 0.2f, 0.1f);
  LeafBakeOptions options;
  options.directions = 2;
  EXPECT_THROW(bakeLeafTranslucency(set, options), Error);
  options = {};
  options.surface_reflection = 1.0f;
  EXPECT_THROW(bakeLeafTranslucency(set, options), Error);
  LeafSet bad = set;
  bad.opacity.assign(400, 0.0f);
  EXPECT_THROW(bakeLeafTranslucency(bad), Error);
  bad = set;
  bad.thickness_mm[7] = 0;
  EXPECT_THROW(bakeLeafTranslucency(bad), Error);
}

TEST(LeafBake, ComesBackFromItsFiles) {
  const auto folder = scratchFolder("baked");
  const LeafSet set = roughLeaf(50, 34, 0.2f);
  writeLeafSet(set, folder);
  EXPECT_THROW(readLeafTranslucency(folder), Error);
  const LeafTranslucency baked = bakeLeafTranslucency(set);
  writeLeafTranslucency(baked, folder);
  const LeafTranslucency read = readLeafTranslucency(folder);
  EXPECT_EQ(read.width, 50);
  EXPECT_EQ(read.height, 34);
  EXPECT_LT(relativeError(read.front, baked.front), 5e-4);
  EXPECT_LT(relativeError(read.back, baked.back), 5e-4);
  // The leaf is still one, and the bytes are the coefficients by scale and offset.
  EXPECT_EQ(readLeafSet(folder).width, 50);
  std::ifstream in(folder / "leaf.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  const auto& png = json["hl2"]["back"];
  const Image bytes = readImage(folder / png["png"].get<std::string>());
  for (std::size_t i = 0; i < baked.back.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const float scale = png["scale"][k], offset = png["offset"][k];
      ASSERT_NEAR(offset + scale * static_cast<float>(bytes.rgba[4 * i + k]) / 255,
                  baked.back[i][c], 0.51f * scale / 255);
    }
}

TEST(LeafBake, OfTheScannedSetIsNearItsLight) {
  const char* plants = std::getenv("VERDURE_PLANT_DIR");
  if (plants == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  LeafImportOptions options;
  options.mm_per_texel = 0.2f;
  options.thickness_mm = 0.2f;
  const LeafSet set = importLeafSet(std::filesystem::path(plants) / ".." / "leaves", options);
  const LeafTranslucency baked = bakeLeafTranslucency(set);
  for (const double kept : baked.report.conserved) EXPECT_NEAR(kept, 1.0, 5e-3);
  const auto errors = measureLeafErrors(set, baked);
  EXPECT_LT(errors[0].mean_absolute, 0.01);
  EXPECT_LT(errors[1].mean_absolute, 0.03);
}

}  // namespace
}  // namespace verdure
