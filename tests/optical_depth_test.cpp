#include "verdure/optical_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <glm/gtc/constants.hpp>

#include "bake/density_fit.h"
#include "bake/depth_fit.h"
#include "base/parallel.h"
#include "base/random.h"
#include "crowns.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/occlusion.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

std::vector<Surfel> randomSurfels(std::size_t count, std::uint64_t seed, float size = 1.0f) {
  Random random(seed);
  std::vector<Surfel> surfels;
  while (surfels.size() < count) {
    const glm::vec3 p(random.vary(1), random.vary(1), random.vary(1));
    if (glm::dot(p, p) > 1.0f) continue;
    surfels.push_back({size * p, size * size * random.uniform(0.5e-3f, 2e-3f), 0.0f});
  }
  return surfels;
}

std::vector<glm::vec3> randomPoints(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<glm::vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(random.vary(1.3f), random.vary(1.3f), random.vary(1.3f));
  return points;
}

std::vector<glm::vec3> unitNormals(std::size_t count, std::uint64_t seed) {
  std::vector<glm::vec3> normals = randomPoints(count, seed);
  for (glm::vec3& n : normals) n = glm::normalize(n);
  return normals;
}

struct Truth {
  double depth = 0, hemisphere = 0;
  glm::dvec3 toward{0.0};
};

/// The definition, in double precision.
Truth direct(const std::vector<Surfel>& surfels, const glm::vec3& q, const glm::vec3& n) {
  Truth sum;
  for (const Surfel& s : surfels) {
    const glm::dvec3 o = glm::dvec3(s.position) - glm::dvec3(q);
    const double r2 = glm::dot(o, o), area = s.area;
    const double w = 0.5 * area / (4.0 * glm::pi<double>() * r2 + 2.0 * area);
    sum.depth += w;
    if (!(r2 > 0.0)) continue;
    const glm::dvec3 d = o / std::sqrt(r2);
    sum.toward += w * d;
    sum.hemisphere += 4.0 * w * std::max(0.0, glm::dot(glm::dvec3(n), d));
  }
  return sum;
}

std::vector<DepthSums> sumsAt(const OpticalDepthField& field, const std::vector<glm::vec3>& points,
                              const std::vector<glm::vec3>& normals) {
  std::vector<DepthSums> sums(points.size());
  field.sumAt(points, normals, sums);
  return sums;
}

TEST(OpticalDepth, OneSurfelIsTheClosedForm) {
  const std::vector<Surfel> one{{{1, 2, 3}, 0.04f, 0.1f}};
  const OpticalDepthField field(one);
  // At its centre a quarter (it hides one half, seen every way one quarter); at 2 m the formula.
  const auto sums = sumsAt(field, {{1, 2, 3}, {1, 4, 3}}, {{0, 1, 0}, {0, -1, 0}});
  EXPECT_NEAR(sums[0].depth, 0.25f, 1e-6f);
  EXPECT_NEAR(sums[1].depth, 0.02f / (16.0f * glm::pi<float>() + 0.08f), 1e-9f);
  EXPECT_NEAR(sums[1].toward.y, -sums[1].depth, 1e-9f);
  EXPECT_NEAR(sums[1].hemisphere, 4.0f * sums[1].depth, 1e-8f);
  EXPECT_EQ(sumsAt(field, {{1, 4, 3}}, {{0, 1, 0}})[0].hemisphere, 0.0f);
}

TEST(OpticalDepth, TwoSurfelsAddAndTheirPullCancelsInTheMiddle) {
  const std::vector<Surfel> two{{{-1, 0, 0}, 0.1f, 0.0f}, {{1, 0, 0}, 0.1f, 0.0f}};
  const auto sums = sumsAt(OpticalDepthField(two), {{0, 0, 0}}, {{1, 0, 0}});
  const float each = 0.05f / (4.0f * glm::pi<float>() + 0.2f);
  EXPECT_NEAR(sums[0].depth, 2.0f * each, 1e-7f);
  EXPECT_NEAR(glm::length(sums[0].toward), 0.0f, 1e-7f);
  EXPECT_NEAR(sums[0].hemisphere, 4.0f * each, 1e-7f);
}

TEST(OpticalDepth, TreeIsWithinOnePercentOfTheDirectSum) {
  const auto surfels = randomSurfels(20000, 1);
  const auto points = randomPoints(3000, 2), normals = unitNormals(3000, 3);
  const auto sums = sumsAt(OpticalDepthField(surfels), points, normals);
  std::vector<double> relative;
  double hemisphere2 = 0.0, toward2 = 0.0, full = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Truth truth = direct(surfels, points[i], normals[i]);
    relative.push_back(std::abs(double{sums[i].depth} - truth.depth) / truth.depth);
    hemisphere2 += std::pow(double{sums[i].hemisphere} - truth.hemisphere, 2);
    toward2 += std::pow(glm::length(glm::dvec3(sums[i].toward) - truth.toward), 2);
    full = std::max(full, truth.hemisphere);
  }
  std::sort(relative.begin(), relative.end());
  const auto n = static_cast<double>(points.size());
  EXPECT_LT(relative[static_cast<std::size_t>(0.999 * n)], 0.01);
  EXPECT_LT(std::sqrt(hemisphere2 / n) / full, 0.01);
  EXPECT_LT(std::sqrt(toward2 / n) / full, 0.01);
  RecordProperty("largest_relative_error", std::to_string(relative.back()));
}

TEST(OpticalDepth, WithoutOpeningItIsTheDirectSum) {
  const auto surfels = randomSurfels(3000, 5);
  const auto points = randomPoints(200, 6), normals = unitNormals(200, 7);
  const auto sums = sumsAt(OpticalDepthField(surfels, {.opening = 0.0f}), points, normals);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Truth truth = direct(surfels, points[i], normals[i]);
    EXPECT_NEAR(sums[i].depth, truth.depth, 2e-5 * truth.depth);
    EXPECT_NEAR(sums[i].hemisphere, truth.hemisphere, 1e-4);
  }
}

TEST(OpticalDepth, TowardIsAPotentialsGradient) {
  // w(r) is the derivative of -A / (2 c) atan(c / (g r)) ..., whose sum's finite differences give
  // `toward`: with c = sqrt(2 A), g = sqrt(4 pi), int w dr = A / (2 c g) atan(g r / c).
  const auto surfels = randomSurfels(500, 8);
  const auto potential = [&](const glm::dvec3& q) {
    double sum = 0.0;
    const double g = std::sqrt(4.0 * glm::pi<double>());
    for (const Surfel& s : surfels) {
      const double c = std::sqrt(2.0 * double{s.area});
      sum -= double{s.area} / (2.0 * c * g) *
             std::atan(g * glm::length(glm::dvec3(s.position) - q) / c);
    }
    return sum;
  };
  const auto points = randomPoints(50, 9);
  const auto sums = sumsAt(OpticalDepthField(surfels, {.opening = 0.0f}), points, {});
  constexpr double kStep = 1e-4;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int a = 0; a < 3; ++a) {
      glm::dvec3 low(points[i]), high(points[i]);
      low[a] -= kStep;
      high[a] += kStep;
      EXPECT_NEAR(sums[i].toward[a], (potential(high) - potential(low)) / (2.0 * kStep), 1e-4);
    }
}

TEST(OpticalDepth, MovesTurnsAndScalesWithThePlant) {
  const auto surfels = randomSurfels(4000, 10);
  const auto points = randomPoints(300, 11), normals = unitNormals(300, 12);
  const auto sums = sumsAt(OpticalDepthField(surfels), points, normals);
  const float c = std::cos(0.7f), s = std::sin(0.7f), scale = 250.0f;
  const glm::mat3 turn(glm::vec3(c, 0, -s), glm::vec3(0, 1, 0), glm::vec3(s, 0, c));
  const glm::vec3 shift(40, -3, 7);
  auto moved = surfels;
  auto moved_points = points, moved_normals = normals;
  for (Surfel& m : moved) {
    m.position = scale * (turn * m.position) + shift;
    m.area *= scale * scale;
  }
  for (glm::vec3& p : moved_points) p = scale * (turn * p) + shift;
  for (glm::vec3& n : moved_normals) n = turn * n;
  const auto again = sumsAt(OpticalDepthField(moved), moved_points, moved_normals);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Another tree, other nodes: within the tree's own error.
    EXPECT_NEAR(again[i].depth, sums[i].depth, 0.015f * sums[i].depth);
    EXPECT_LT(glm::length(again[i].toward - turn * sums[i].toward), 0.02f * sums[i].depth);
  }
}

TEST(OpticalDepth, OrderAndThreadsDoNotMatter) {
  auto surfels = randomSurfels(20000, 13);
  const auto points = randomPoints(5000, 14), normals = unitNormals(5000, 15);
  setThreadCount(1);
  const auto one = sumsAt(OpticalDepthField(surfels), points, normals);
  setThreadCount(0);
  const auto all = sumsAt(OpticalDepthField(surfels), points, normals);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(one[i].depth, all[i].depth);
    ASSERT_EQ(one[i].toward, all[i].toward);
    ASSERT_EQ(one[i].hemisphere, all[i].hemisphere);
  }
  std::reverse(surfels.begin(), surfels.end());
  const auto reversed = sumsAt(OpticalDepthField(surfels), points, normals);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_NEAR(reversed[i].depth, one[i].depth, 1e-4f * one[i].depth);
}

TEST(OpticalDepth, FarGroupsAddUp) {
  const auto a = randomSurfels(3000, 16);
  auto b = randomSurfels(3000, 17);
  for (Surfel& s : b) s.position.x += 8.0f;
  auto both = a;
  both.insert(both.end(), b.begin(), b.end());
  const auto points = randomPoints(300, 18);
  const auto sum_a = sumsAt(OpticalDepthField(a), points, {}),
             sum_b = sumsAt(OpticalDepthField(b), points, {}),
             sum = sumsAt(OpticalDepthField(both), points, {});
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(sum[i].depth, sum_a[i].depth + sum_b[i].depth, 0.01f * sum[i].depth);
}

TEST(OpticalDepth, WoodCountsHalfAndCutCardsTheirCutShare) {
  Plant plant = makeBallCrown(50);
  double leaf = 0.0, wood = 0.0;
  const auto areas = [&] {
    leaf = wood = 0.0;
    const auto surfels = plantSurfels(plant);
    for (std::size_t i = 0; i < surfels.size(); ++i)
      (i < plant.meshes[0].triangleCount() ? wood : leaf) += double{surfels[i].area};
  };
  areas();
  EXPECT_NEAR(leaf, 50 * 0.01, 1e-5);
  EXPECT_NEAR(wood, 0.5 * 4 * 0.1 * 2.0, 1e-5);
  // A disc of radius 0.4 in the card: pi 0.16 of its area.
  Image image(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const glm::vec2 p((static_cast<float>(x) + 0.5f) / 128.0f - 0.5f,
                        (static_cast<float>(y) + 0.5f) / 128.0f - 0.5f);
      image.at(x, y)[3] = glm::length(p) < 0.4f ? 255 : 0;
    }
  plant.textures.push_back({"disc", image, true, true});
  plant.materials[1].base_color_texture = 0;
  plant.materials[1].alpha_mode = AlphaMode::kMask;
  areas();
  EXPECT_NEAR(leaf, 50 * 0.01 * glm::pi<double>() * 0.16, 0.01 * 50 * 0.01);
}

TEST(OpticalDepth, ALoneFlatLeafIsOpen) {
  Plant plant = makeBallCrown(1);
  plant.meshes.erase(plant.meshes.begin());  // no trunk
  plant.leaves[0].mesh = 0;
  const auto surfels = plantSurfels(plant);
  const OpticalDepthField field(surfels, plantDepthOptions(plant, surfels));
  const auto sums = vertexDepths(plant, surfels, field);
  // Corners 0 and 2 touch both triangles; 1 and 3 see the other one, edge-on in truth.
  EXPECT_NEAR(sums[0].depth, 0.0f, 1e-5f);
  EXPECT_NEAR(sums[2].depth, 0.0f, 1e-5f);
  EXPECT_LT(sums[1].depth, 0.15f);
  const DepthBake bake = bakeOpticalDepth(plant);
  EXPECT_GT(bake.light.meshes[0].ambient[0], 0.94f);
}

/// Mean over directions by quadrature.
TEST(OpticalDepth, ModelsAreTheirIntegrals) {
  for (const float depth : {0.0f, 0.1f, 1.0f, 3.0f})
    for (const float share : {0.0f, 1e-5f, 0.2f, 1.0f / 3.0f, 0.7f, 1.0f}) {
      const DepthSums sums{depth, {0, share * depth, 0}, 0.0f};
      const DepthModel model{0.02f, 0.95f, 0.8f};
      double mean = 0.0, outward = 0.0;
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        const double mu = (i + 0.5) / kSteps * 2.0 - 1.0;
        const double t =
            std::exp(-0.8 * std::max(0.0, double{depth} * (1.0 - 3.0 * double{share} * mu)));
        mean += t / kSteps;
        if (mu > 0) outward += 2.0 * mu * t * 2.0 / kSteps;
      }
      EXPECT_NEAR(opennessOf(sums, model), 0.02 + 0.95 * mean, 2e-4);
      EXPECT_NEAR(outwardLightOf(sums, model), 0.02 + 0.95 * outward, 2e-4);
    }
}

Plant grown(const std::string& species,
            const std::vector<std::pair<std::string, std::string>>& set) {
  GrowOptions options;
  options.species = species;
  options.texture_size = 64;
  options.set = set;
  return grow(options);
}

void expectGoodPrediction(const Plant& plant, double rms, double rank) {
  DepthOptions options;
  options.fit = true;
  const DepthBake bake = bakeOpticalDepth(plant, options);
  // Other vertices than those that it was fitted to.
  const TracedSamples samples = traceSamples(plant, 300, 128, 99, std::size_t{1} << 30);
  const auto surfels = plantSurfels(plant);
  const OpticalDepthField field(surfels, plantDepthOptions(plant, surfels));
  const auto sums = vertexDepths(plant, surfels, field);
  std::vector<std::size_t> first{0};
  for (const Mesh& mesh : plant.meshes) first.push_back(first.back() + mesh.positions.size());
  std::vector<float> plain, fitted;
  for (const VertexId id : samples.vertices) {
    const DepthSums& s = sums[first[id.mesh] + id.vertex];
    plain.push_back(opennessOf(s, DepthModels{}.of(plant.meshes[id.mesh].kind)));
    fitted.push_back(opennessOf(s, bake.report.models.of(plant.meshes[id.mesh].kind)));
  }
  const Agreement before = agreementOf(plain, samples.openness),
                  after = agreementOf(fitted, samples.openness);
  EXPECT_LT(before.rms, 1.5 * rms) << plant.name;
  EXPECT_LT(after.rms, rms) << plant.name;
  EXPECT_GT(after.rank, rank) << plant.name;
  EXPECT_LE(bake.report.fit->after.rms, bake.report.fit->before.rms + 1e-6) << plant.name;
}

TEST(OpticalDepth, PredictsTracedOpenness) {
  expectGoodPrediction(grown("scots-pine", {}), 0.085, 0.80);
  expectGoodPrediction(grown("hedge", {}), 0.085, 0.80);
}

TEST(OpticalDepth, PredictsTracedOpennessOfForeignPlants) {
  const char* const folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb" || entry.file_size() > 4000000) continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Plant plant = loadPlant(entry.path());
    if (vertexCount(plant) > 200000) continue;
    expectGoodPrediction(plant, 0.10, 0.75);
  }
}

TEST(OpticalDepth, BakeTurnsLeavesOutwardAndDarkensTheMiddle) {
  const Plant plant = makeBallCrown(3000);
  const DepthBake bake = bakeOpticalDepth(plant);
  const Mesh& mesh = plant.meshes[1];
  double in = 0, out = 0, in_count = 0, out_count = 0, along = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const float r = glm::length(mesh.positions[v]);
    EXPECT_NEAR(glm::length(bake.light.meshes[1].normals[v]), 1.0f, 1e-4f);
    if (r < 0.4f) in += double{bake.light.meshes[1].ambient[v]}, ++in_count;
    if (r > 0.9f) {
      out += double{bake.light.meshes[1].ambient[v]}, ++out_count;
      along += double{glm::dot(bake.light.meshes[1].normals[v], mesh.positions[v] / r)};
    }
  }
  EXPECT_LT(in / in_count, 0.4 * out / out_count);
  EXPECT_GT(along / out_count, 0.85);
  EXPECT_EQ(bake.light.meshes[0].normals, plant.meshes[0].normals);  // wood keeps its own
  DepthOptions keep;
  keep.normals = CrownNormals::kKeep;
  EXPECT_EQ(bakeOpticalDepth(plant, keep).light.meshes[1].normals, mesh.normals);
}

template <class Call>
std::string messageOf(const Call& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(OpticalDepth, RefusesWhatCannotBeBaked) {
  EXPECT_NE(messageOf([] { bakeOpticalDepth(Plant{}); }).find("no triangles"), std::string::npos);
  Plant plant = makeBallCrown(20);
  plant.meshes[1].positions[7].y = NAN;
  EXPECT_NE(messageOf([&] { bakeOpticalDepth(plant); }).find("position 7 of part 'leaves'"),
            std::string::npos);
  EXPECT_NE(messageOf([] {
              OpticalDepthField(std::vector<Surfel>{{{NAN, 0, 0}, 1.0f, 0.0f}});
            }).find("surfel 0"),
            std::string::npos);
  DepthOptions surface;
  surface.normals = CrownNormals::kSurfacePoint;
  EXPECT_NE(messageOf([&] { bakeOpticalDepth(makeBallCrown(20), surface); }).find("metaball"),
            std::string::npos);
}

/// The least RMS of (4) against `target` on a dense grid of tau, d_min and the exponent; k_min by
/// least squares.
double exhaustiveFalloff(const std::vector<float>& sums, const std::vector<float>& target) {
  const float most = *std::max_element(sums.begin(), sums.end());
  double least = 1e30;
  for (int t = 0; t < 24; ++t)
    for (int d = 1; d <= 30; ++d)
      for (int n = 0; n < 16; ++n) {
        const float tau = most * static_cast<float>(t) / 25.0f,
                    d_min = most * static_cast<float>(d) / 10.0f,
                    exponent = 0.1f * std::pow(1.4f, static_cast<float>(n));
        double gg = 0.0, gt = 0.0, tt = 0.0;
        for (std::size_t i = 0; i < sums.size(); ++i) {
          const float u = std::clamp((sums[i] - tau) / d_min, 0.0f, 1.0f);
          const double g = 1.0 - double{std::pow(1.0f - u, exponent)}, t1 = 1.0 - double{target[i]};
          gg += g * g, gt += g * t1, tt += t1 * t1;
        }
        const double slope = gg > 0.0 ? std::clamp(gt / gg, 0.0, 1.0) : 0.0;
        least = std::min(least, tt - 2.0 * slope * gt + slope * slope * gg);
      }
  return std::sqrt(least / static_cast<double>(sums.size()));
}

TEST(DensityFit, IsAsGoodAsAnExhaustiveSearch) {
  for (const Plant& plant :
       {makeBallCrown(1500), grown("hedge", {}), grown("scots-pine", {{"Leaves", "8"}})}) {
    DensityFit fit;
    fitDensity(plant, {}, &fit);
    const TracedSamples samples = traceSamples(plant, 256, 128, 1, std::size_t{1} << 30);
    ASSERT_EQ(samples.vertices.size(), fit.samples);
    std::vector<glm::vec3> points;
    std::vector<float> target;
    for (std::size_t i = 0; i < samples.vertices.size(); ++i) {
      const VertexId id = samples.vertices[i];
      points.push_back(plant.meshes[id.mesh].positions[id.vertex]);
      target.push_back(std::min(samples.openness[i] / fit.full, 1.0f));
    }
    // From leaf to crown: an eighth of the crown's height, down and up.
    const float height = bounds(plant).size().y;
    constexpr int kRhos = 36;
    std::vector<double> least(kRhos);
    parallelFor(kRhos, 1, [&](std::size_t r) {
      const float rho = 0.002f * height * std::pow(1.19f, static_cast<float>(r));
      std::vector<Generator> generators;
      for (const Leaf& leaf : plant.leaves) generators.push_back({leaf.centroid, rho});
      std::vector<float> sums(points.size());
      DensityField(generators).sumAt(points, sums);
      least[r] = exhaustiveFalloff(sums, target);
    });
    EXPECT_LT(fit.after.rms, 1.05 * *std::min_element(least.begin(), least.end())) << plant.name;
  }
}

TEST(DensityFit, ImprovesOnTheDefaults) {
  const Plant plant = grown("hedge", {});
  DensityFit fit;
  const DensityOptions options = fitDensity(plant, {}, &fit);
  EXPECT_LT(fit.after.rms, fit.before.rms);
  EXPECT_GT(fit.after.rank, fit.before.rank - 0.05);
  EXPECT_NO_THROW(bakeDensity(plant, options));
}

}  // namespace
}  // namespace verdure
