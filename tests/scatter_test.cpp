// Places of plants by chance.
#include "verdure/scatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <map>
#include <set>

#include "base/parallel.h"
#include "base/progress.h"
#include "scene/place_limit.h"
#include "verdure/error.h"

namespace verdure {
namespace {

ScatterOptions meadow(float side = 60.0f) {
  ScatterOptions options;
  options.kinds = {{}};
  options.corner = {-20.0f, 5.0f};
  options.size_m = {side, 0.8f * side};
  return options;
}

double areaOf(const ScatterOptions& options) {
  return double{options.size_m.x} * double{options.size_m.y};
}

glm::dvec2 flat(const Placement& place) {
  return {place.position.x, place.position.z};
}

/// The least distance of two places over the sum of their kinds' radii, by looking at all pairs.
double leastDistance(const std::vector<Placement>& places, const ScatterOptions& options) {
  std::map<std::uint32_t, double> radius;
  for (const ScatterKind& kind : options.kinds) radius[kind.plant] = double{kind.radius_m};
  double least = 1e30;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      least = std::min(least, glm::distance(flat(places[i]), flat(places[k])) /
                                  (radius[places[i].plant] + radius[places[k].plant]));
  return least;
}

std::string errorOf(const ScatterOptions& options) {
  try {
    scatterPlants(options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Scatter, PlantsKeepTheirDistanceAndFillTheGround) {
  const ScatterOptions options = meadow();
  const std::vector<Placement> places = scatterPlants(options);
  EXPECT_GE(leastDistance(places, options), 1.0 - 1e-6);
  for (const Placement& place : places) {
    EXPECT_GE(place.position.x, -20.0f);
    EXPECT_LE(place.position.x, 40.0f);
    EXPECT_GE(place.position.z, 5.0f);
    EXPECT_LE(place.position.z, 53.0f);
    EXPECT_EQ(place.position.y, 0.0f);
  }
  // Discs that fall by chance until no more fit cover 0.547 of the plane (Feder 1980; here those
  // at the border stand partly outside of it).
  const double inner = (60.0 + 1.0) * (48.0 + 1.0);
  const double cover = static_cast<double>(places.size()) * M_PI / inner;
  EXPECT_GT(cover, 0.53);
  EXPECT_LT(cover, 0.57);
  // There is hardly a place left for another one.
  std::size_t free = 0;
  constexpr int kTries = 200;
  for (int z = 0; z < kTries; ++z)
    for (int x = 0; x < kTries; ++x) {
      const glm::dvec2 at = glm::dvec2(options.corner) +
                            glm::dvec2(options.size_m) * (glm::dvec2(x, z) + 0.5) / double{kTries};
      free += std::none_of(places.begin(), places.end(), [&](const Placement& place) {
        return glm::distance(flat(place), at) < 2.0;
      });
    }
  EXPECT_LT(static_cast<double>(free), 0.003 * kTries * kTries);
}

TEST(Scatter, IsBlueNoise) {
  // The pair correlation of maximal Poisson-disk sampling: nothing within the distance, a peak
  // there, none farther away.
  ScatterOptions options = meadow(120.0f);
  options.kinds[0].radius_m = 0.75f;
  const std::vector<Placement> places = scatterPlants(options);
  constexpr int kBins = 40;
  constexpr double kBin = 0.15;  // m: a tenth of the distance
  std::vector<double> pairs(kBins);
  double inner = 0;
  const auto isInside = [&](const glm::dvec2& p) {
    const glm::dvec2 from = p - glm::dvec2(options.corner);
    return from.x > 6.0 && from.y > 6.0 && from.x < double{options.size_m.x} - 6.0 &&
           from.y < double{options.size_m.y} - 6.0;
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!isInside(flat(places[i]))) continue;
    ++inner;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double distance = glm::distance(flat(places[i]), flat(places[k]));
      if (k != i && distance < kBins * kBin) ++pairs[static_cast<std::size_t>(distance / kBin)];
    }
  }
  const double density = static_cast<double>(places.size()) / areaOf(options);
  for (int b = 0; b < kBins; ++b) {
    const double ring = M_PI * kBin * kBin * (2.0 * b + 1.0);
    const double correlation = pairs[static_cast<std::size_t>(b)] / (inner * density * ring);
    if (b < 10) {
      EXPECT_EQ(correlation, 0.0) << b;
    } else if (b == 10) {
      EXPECT_GT(correlation, 1.5);
    } else if (b >= 30) {
      EXPECT_NEAR(correlation, 1.0, 0.08) << b;
    }
  }
}

TEST(Scatter, SeveralKindsKeepTheirSharesAndDistances) {
  ScatterOptions options = meadow(150.0f);
  options.kinds = {{.plant = 4, .share = 1.0f, .radius_m = 2.5f},
                   {.plant = 1, .share = 3.0f, .radius_m = 1.0f},
                   {.plant = 7, .share = 6.0f, .radius_m = 0.6f}};
  const std::vector<Placement> places = scatterPlants(options);
  EXPECT_GT(places.size(), 2000u);
  EXPECT_GE(leastDistance(places, options), 1.0 - 1e-6);
  std::map<std::uint32_t, double> counts;
  for (const Placement& place : places) ++counts[place.plant];
  ASSERT_EQ(counts.size(), 3u);
  const auto all = static_cast<double>(places.size());
  EXPECT_NEAR(counts[4] / all, 0.1, 0.015);
  EXPECT_NEAR(counts[1] / all, 0.3, 0.03);
  EXPECT_NEAR(counts[7] / all, 0.6, 0.04);
}

TEST(Scatter, AKindWithoutRoomDoesNotHoldUpTheOthers) {
  ScatterOptions options = meadow(20.0f);
  options.kinds = {{.plant = 0, .radius_m = 1.0f}, {.plant = 1, .radius_m = 30.0f}};
  options.taken = {{{0.0f, 0.0f}, 1.0f}};
  const std::vector<Placement> places = scatterPlants(options);
  EXPECT_GT(places.size(), 40u);
  for (const Placement& place : places) EXPECT_EQ(place.plant, 0u);
}

/// Columns of 0, 1/3, 2/3, 1, from the left, each a quarter of the area. Bilinear between them.
CoverMap stairs(const ScatterOptions& options) {
  CoverMap map{64, 1, options.corner, options.size_m, {}};
  for (int x = 0; x < 64; ++x) map.values.push_back(static_cast<float>(x / 16) / 3.0f);
  return map;
}

/// Chi-square of counts in strips of the area against a density map.
double chiSquare(const std::vector<Placement>& places, const ScatterOptions& options,
                 const CoverMap& map, int strips) {
  std::vector<double> seen(static_cast<std::size_t>(strips)), expected(seen.size());
  double sum = 0.0;
  constexpr int kPieces = 400;
  for (int s = 0; s < strips; ++s)
    for (int i = 0; i < kPieces; ++i) {
      const float x = options.corner.x + options.size_m.x *
                                             (static_cast<float>(s) +
                                              (static_cast<float>(i) + 0.5f) / float{kPieces}) /
                                             static_cast<float>(strips);
      expected[static_cast<std::size_t>(s)] += double{map.at({x, options.corner.y + 1.0f})};
    }
  for (const double e : expected) sum += e;
  for (const Placement& place : places) {
    const auto s = static_cast<int>(static_cast<float>(strips) *
                                    (place.position.x - options.corner.x) / options.size_m.x);
    ++seen[static_cast<std::size_t>(std::min(s, strips - 1))];
  }
  double chi = 0.0;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const double e = expected[s] / sum * static_cast<double>(places.size());
    if (e > 0.0)
      chi += (seen[s] - e) * (seen[s] - e) / e;
    else
      EXPECT_EQ(seen[s], 0.0);
  }
  return chi;
}

TEST(Scatter, FollowsADensityMap) {
  ScatterOptions options = meadow(150.0f);
  const CoverMap map = stairs(options);
  options.density = &map;
  // By chance alone: 11 strips with plants, 10 degrees of freedom, 99.9 % below 29.6.
  options.kinds[0].radius_m = 0.0f;
  options.per_m2 = 0.5f;
  const std::vector<Placement> random = scatterPlants(options);
  EXPECT_NEAR(static_cast<double>(random.size()), 0.5 * 0.5 * areaOf(options),
              4.0 * std::sqrt(0.25 * areaOf(options)));
  EXPECT_LT(chiSquare(random, options, map, 12), 29.6);
  // With distances, counts vary less.
  options.kinds[0].radius_m = 0.5f;
  options.per_m2.reset();
  const std::vector<Placement> discs = scatterPlants(options);
  EXPECT_GE(leastDistance(discs, options), 1.0 - 1e-6);
  EXPECT_LT(chiSquare(discs, options, map, 12), 29.6);
  const double fits = 0.547 / (M_PI * 0.25);  // a square metre
  EXPECT_NEAR(static_cast<double>(discs.size()), 0.5 * fits * areaOf(options),
              0.05 * fits * areaOf(options));
}

TEST(Scatter, MakesAsManyAsAreAskedFor) {
  ScatterOptions options = meadow(200.0f);
  options.per_m2 = 0.02f;
  const std::vector<Placement> places = scatterPlants(options);
  const double wanted = 0.02 * areaOf(options);
  EXPECT_NEAR(static_cast<double>(places.size()), wanted, 4.0 * std::sqrt(wanted));
  EXPECT_GE(leastDistance(places, options), 1.0 - 1e-6);
  options.per_m2 = 0.0f;
  EXPECT_TRUE(scatterPlants(options).empty());
  // More than find room: as many as do.
  options.per_m2 = 100.0f;
  const auto fits = static_cast<double>(scatterPlants(options).size());
  options.per_m2.reset();
  EXPECT_NEAR(static_cast<double>(scatterPlants(options).size()), fits, 0.02 * fits);
}

TEST(Scatter, KeepsOffTakenGround) {
  ScatterOptions options = meadow();
  options.kinds.push_back({.plant = 1, .radius_m = 0.4f});
  options.taken = {{{10.0f, 20.0f}, 7.0f}, {{0.0f, 30.0f}, 0.5f}, {{500.0f, 0.0f}, 10.0f}};
  const std::vector<Placement> places = scatterPlants(options);
  for (const Placement& place : places)
    for (const TakenCircle& circle : options.taken)
      EXPECT_GE(glm::distance(flat(place), glm::dvec2(circle.center)),
                (double{circle.radius_m} + (place.plant == 0 ? 1.0 : 0.4)) * (1.0 - 1e-6));
  // Right up to it.
  EXPECT_TRUE(std::any_of(places.begin(), places.end(), [&](const Placement& place) {
    return glm::distance(flat(place), glm::dvec2(10.0, 20.0)) < 9.0;
  }));
}

TEST(Scatter, StandsOnATerrainWithinItsLimits) {
  // A roof: slopes of 0.2 for x < 0 and of 1 beyond, 10 m high at its ridge.
  Terrain terrain{201, 2, {-100.0f, -100.0f}, {1.0f, 200.0f}, {}};
  for (int z = 0; z < 2; ++z)
    for (int x = -100; x <= 100; ++x)
      terrain.heights.push_back(
          10.0f - (x < 0 ? -0.2f * static_cast<float>(x) : 1.0f * static_cast<float>(x)));
  ScatterOptions options;
  options.kinds = {{.radius_m = 0.8f}};
  options.corner = {-50.0f, -20.0f};
  options.size_m = {100.0f, 40.0f};
  options.terrain = &terrain;
  const std::vector<Placement> all = scatterPlants(options);
  for (const Placement& place : all)
    EXPECT_NEAR(place.position.y, terrain.heightAt({place.position.x, place.position.z}), 1e-5);
  options.most_slope = 0.5f;
  options.lowest_m = 4.0f;
  options.highest_m = 9.0f;
  const std::vector<Placement> some = scatterPlants(options);
  ASSERT_GT(some.size(), 100u);
  for (const Placement& place : some) {
    EXPECT_LT(place.position.x, 1.0f);
    EXPECT_GE(place.position.y, 4.0f);
    EXPECT_LE(place.position.y, 9.0f);
  }
  // As dense there as without limits.
  const auto within = std::count_if(all.begin(), all.end(), [](const Placement& place) {
    return place.position.x < 0.0f && place.position.y >= 4.0f && place.position.y <= 9.0f;
  });
  EXPECT_NEAR(static_cast<double>(some.size()), static_cast<double>(within),
              0.1 * static_cast<double>(within));
  // A number for the area counts where plants may stand.
  options.per_m2 = 0.05f;
  EXPECT_NEAR(static_cast<double>(scatterPlants(options).size()), 0.05 * 25.0 * 40.0, 30.0);
}

TEST(Scatter, EachPlantLooksDifferent) {
  ScatterOptions options = meadow();
  options.kinds[0].scale = {0.5f, 2.0f};
  const std::vector<Placement> places = scatterPlants(options);
  double turn_x = 0.0, turn_z = 0.0, scale = 0.0, red = 0.0, green = 0.0, blue = 0.0;
  std::set<std::uint32_t> phases, tints;
  for (const Placement& place : places) {
    EXPECT_GE(place.scale, 0.5f);
    EXPECT_LE(place.scale, 2.0f);
    EXPECT_LE(place.tint, 0xffffffu);
    turn_x += std::cos(place.angle);
    turn_z += std::sin(place.angle);
    scale += place.scale;
    red += (place.tint >> 16) / 255.0;
    green += (place.tint >> 8 & 255u) / 255.0;
    blue += (place.tint & 255u) / 255.0;
    phases.insert(place.phase);
    tints.insert(place.tint);
  }
  const auto count = static_cast<double>(places.size());
  EXPECT_LT(std::hypot(turn_x, turn_z), 4.0 * std::sqrt(count));
  EXPECT_NEAR(scale / count, 1.25, 0.1);
  EXPECT_EQ(phases.size(), places.size());
  EXPECT_GT(tints.size(), places.size() / 3);
  EXPECT_NEAR(green / count, 0.9 * 0.99125, 0.01);  // the mean of positive hues is 0.025
  EXPECT_NEAR(blue / count, 0.9 * 0.985, 0.01);
  EXPECT_NEAR(red / count, 0.9 * 0.975, 0.01);
  options.hue_spread = options.brightness_spread = 0.0f;
  for (const Placement& place : scatterPlants(options)) EXPECT_EQ(place.tint, 0xffffffu);
}

TEST(Scatter, TheSameSeedGivesTheSameBits) {
  ScatterOptions options = meadow(90.0f);
  options.kinds.push_back({.plant = 1, .share = 0.3f, .radius_m = 2.0f});
  const CoverMap map = stairs(options);
  options.density = &map;
  options.taken = {{{10.0f, 20.0f}, 7.0f}};
  const auto same = [](const std::vector<Placement>& a, const std::vector<Placement>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
  };
  const std::vector<Placement> places = scatterPlants(options);
  EXPECT_TRUE(same(places, scatterPlants(options)));
  for (const int threads : {1, 2, 5}) {
    setThreadCount(threads);
    EXPECT_TRUE(same(places, scatterPlants(options))) << threads;
  }
  setThreadCount(0);
  options.seed = 2;
  EXPECT_FALSE(same(places, scatterPlants(options)));
}

TEST(Scatter, ManyTakeLittleTime) {
  ScatterOptions options = meadow();
  options.corner = {-400.0f, -400.0f};
  options.size_m = {800.0f, 800.0f};
  options.kinds = {{.plant = 0, .radius_m = 1.0f}, {.plant = 1, .radius_m = 1.0f}};
  Timer timer;
  const std::vector<Placement> places = scatterPlants(options);
  std::printf("%zu places in %.0f ms\n", places.size(), 1e3 * timer.seconds());
  EXPECT_GT(places.size(), 100'000u * 0.98);
  EXPECT_LT(timer.seconds(), 10.0);  // sanitizers, busy machines
}

TEST(Scatter, Refuses) {
  const auto with = [](const auto& change) {
    ScatterOptions options = meadow();
    change(options);
    return errorOf(options);
  };
  EXPECT_NE(with([](ScatterOptions& o) { o.kinds.clear(); }).find("0 kinds"), std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) { o.size_m.x = 0; }).find("area"), std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) { o.kinds[0].share = 0; }).find("share"), std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) { o.kinds[0].radius_m = -1; }).find("radius is -1 m"),
            std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) { o.kinds[0].radius_m = 0; }).find("room for any number"),
            std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) {
              o.kinds[0].scale = {2, 1};
            }).find("scales"),
            std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) { o.hue_spread = NAN; }).find("spread"), std::string::npos);
  // More than memory has room for, without trying.
  EXPECT_NE(with([](ScatterOptions& o) {
              o.size_m = glm::vec2(1e6f);
              o.kinds[0].radius_m = 0.1f;
            }).find("places of plants"),
            std::string::npos);
  EXPECT_NE(with([](ScatterOptions& o) {
              o.kinds[0].radius_m = 0.0f;
              o.per_m2 = 1e9f;
            }).find("places of plants"),
            std::string::npos);
  EXPECT_THROW(checkPlaceCount(1e12, "scene.json"), Error);
  EXPECT_NO_THROW(checkPlaceCount(1e5, "scene.json"));
}

}  // namespace
}  // namespace verdure
