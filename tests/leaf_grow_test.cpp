// Leaves that are grown: outlines, venation, maps.
#include "verdure/leaf_grow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <set>

#include "base/parallel.h"
#include "base/random.h"
#include "leaf/grown_leaf.h"
#include "verdure/error.h"
#include "verdure/grow.h"

namespace verdure {

/// How failures name a species.
static void PrintTo(const LeafSpecies* species, std::ostream* out) {
  *out << species->info.name;
}

namespace {

LeafSet leafOf(const std::string& species, int size, float age = 0.4f, std::uint32_t seed = 1) {
  LeafGrowOptions options;
  options.species = species;
  options.size = size;
  options.age = age;
  options.seed = seed;
  return growLeaf(options);
}

std::vector<const LeafSpecies*> blades() {
  std::vector<const LeafSpecies*> list;
  for (const LeafSpecies& s : allLeafSpecies())
    if (s.form) list.push_back(&s);
  return list;
}

double luminance(const glm::vec3& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

TEST(LeafSpecies, AreThoseOfTrees) {
  // The leaf room stands below the plants', so names are compared here.
  std::set<std::string> leaves;
  for (const LeafSpeciesInfo& s : leafSpeciesList()) leaves.insert(s.name);
  EXPECT_EQ(leaves.size(), leafSpeciesList().size());
  EXPECT_GE(leaves.size(), 8u);
  for (const SpeciesInfo& s : speciesList()) EXPECT_TRUE(leaves.count(s.name)) << s.name;
}

TEST(LeafGrow, BadOptionsAreNamed) {
  EXPECT_THROW(leafOf("beech", 64), Error);
  EXPECT_THROW(leafOf("silver-birch", 15), Error);
  EXPECT_THROW(leafOf("silver-birch", 8193), Error);
  EXPECT_THROW(leafOf("silver-birch", 64, -0.01f), Error);
  EXPECT_THROW(leafOf("silver-birch", 64, 1.01f), Error);
  EXPECT_THROW(leafOf("silver-birch", 64, std::nanf("")), Error);
  try {
    leafOf("beech", 64);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("silver-birch"), std::string::npos);
  }
}

TEST(LeafGrow, SameBitsForAnyNumberOfThreads) {
  for (const LeafSpeciesInfo& s : leafSpeciesList()) {
    setThreadCount(1);
    const LeafSet one = leafOf(s.name, 150, 0.8f);
    setThreadCount(2);
    const LeafSet two = leafOf(s.name, 150, 0.8f);
    setThreadCount(0);
    EXPECT_EQ(one.opacity, two.opacity) << s.name;
    EXPECT_EQ(one.thickness_mm, two.thickness_mm) << s.name;
    for (const auto side : {&LeafSet::front, &LeafSet::back}) {
      EXPECT_EQ((one.*side).albedo, (two.*side).albedo) << s.name;
      EXPECT_EQ((one.*side).translucency, (two.*side).translucency) << s.name;
      EXPECT_EQ((one.*side).normal, (two.*side).normal) << s.name;
      EXPECT_EQ((one.*side).relief_mm, (two.*side).relief_mm) << s.name;
    }
  }
}

TEST(LeafGrow, MapsAreSoundForAllSpeciesAndAges) {
  for (const LeafSpeciesInfo& s : leafSpeciesList())
    for (const float age : {0.0f, 0.4f, 1.0f})
      for (const int size : {16, 77}) {
        const LeafSet set = leafOf(s.name, size, age, 7);
        checkLeafSet(set, s.name);
        EXPECT_EQ(set.name, s.name);
        for (std::size_t i = 0; i < set.texelCount(); ++i) {
          ASSERT_GT(set.thickness_mm[i], 0.05f) << s.name;
          ASSERT_NEAR(set.thickness_mm[i], set.front.relief_mm[i] + set.back.relief_mm[i], 1e-5f);
          // Light is not made.
          const glm::vec3 a = set.front.albedo[i] + set.back.translucency[i];
          const glm::vec3 b = set.back.albedo[i] + set.front.translucency[i];
          ASSERT_LE(std::max({a.x, a.y, a.z, b.x, b.y, b.z}), 1.0f) << s.name << " at " << age;
        }
      }
}

TEST(LeafOutline, IsSimpleAndStandsOnItsFoot) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  for (const LeafSpecies* species : blades())
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u}) {
      const LeafPlan form = species->form(seed);
      const Polyline& p = form.outline;
      EXPECT_GT(polygonArea(p), 300) << species->info.name;
      EXPECT_FLOAT_EQ(p.front().y, 0.0f);
      EXPECT_FLOAT_EQ(p.back().y, 0.0f);
      EXPECT_NEAR(p.front().x + p.back().x, 0.0f, 1e-4f);
      int crossings = 0;
      for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i + 2; j < p.size(); ++j) {
          if (i == 0 && j + 1 == p.size()) continue;
          const glm::dvec2 a = p[i], b = p[i + 1], c = p[j], d = p[(j + 1) % p.size()];
          if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
            continue;
          if (cross(b - a, c - a) * cross(b - a, d - a) < 0 &&
              cross(d - c, a - c) * cross(d - c, b - c) < 0)
            ++crossings;
        }
      EXPECT_EQ(crossings, 0) << species->info.name << ", seed " << seed;
    }
}

TEST(LeafOutline, OpacityHasThePolygonsArea) {
  for (const LeafSpecies* species : blades()) {
    const double area = polygonArea(species->form(1).outline);
    const LeafSet set = leafOf(species->info.name, 256, 0.0f);
    double sum = 0;
    for (const float o : set.opacity) sum += static_cast<double>(o);
    const auto mm = static_cast<double>(set.mm_per_texel);
    EXPECT_NEAR(sum * mm * mm / area, 1.0, 1e-3) << species->info.name;
  }
}

TEST(LeafRaster, CoverageIsExact) {
  // A slanted square against many samples in each texel.
  const LeafFrame frame{24, 12.0f};
  const Polyline square{{-3.1f, 2.2f}, {2.7f, 1.3f}, {3.6f, 7.1f}, {-2.2f, 8.0f}};
  const std::vector<float> coverage = coverageOf(square, frame);
  double sum = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      int hits = 0;
      for (int k = 0; k < 40 * 40; ++k) {
        const glm::vec2 texel(static_cast<float>(x) + (static_cast<float>(k % 40) + 0.5f) / 40,
                              static_cast<float>(y) + (static_cast<float>(k / 40) + 0.5f) / 40);
        hits += insidePolygon(square, frame.toMm(texel));
      }
      const float value = coverage[static_cast<std::size_t>(y * 24 + x)];
      ASSERT_NEAR(value, static_cast<float>(hits) / 1600, 0.02f) << x << ", " << y;
      if (hits == 0 && value < 1e-4f) {
        ASSERT_EQ(value, 0.0f) << x << ", " << y;
      }
      sum += static_cast<double>(value);
    }
  EXPECT_NEAR(sum * 0.25, polygonArea(square), 1e-4);
}

TEST(LeafRaster, BlurHasItsDeviationAndKeepsTheSum) {
  for (const float sigma : {0.6f, 1.3f, 4.0f}) {
    const int n = 81;
    std::vector<float> map(static_cast<std::size_t>(n * n));
    map[static_cast<std::size_t>(40 * n + 40)] = 1;
    blur(map, n, sigma);
    double sum = 0, second = 0;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const auto v = static_cast<double>(map[static_cast<std::size_t>(y * n + x)]);
        sum += v;
        second += v * (x - 40) * (x - 40);
      }
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_NEAR(std::sqrt(second), static_cast<double>(sigma), 0.06 * static_cast<double>(sigma));
  }
}

class Venation : public testing::TestWithParam<const LeafSpecies*> {
 protected:
  const LeafSpecies& species() const { return *GetParam(); }
};

TEST_P(Venation, IsATreeInsideTheOutline) {
  for (const std::uint32_t seed : {1u, 5u}) {
    const GrownLeaf leaf = growForm(species(), seed);
    std::map<int, int> orders;
    for (std::size_t i = 0; i < leaf.veins.size(); ++i) {
      const VeinNode& node = leaf.veins[i];
      ++orders[node.order];
      if (i == 0) {
        EXPECT_EQ(node.parent, -1);
        EXPECT_FLOAT_EQ(node.position.y, 0);
        continue;
      }
      // Parents come first: all nodes reach the foot.
      ASSERT_GE(node.parent, 0);
      ASSERT_LT(node.parent, static_cast<int>(i));
      const VeinNode& parent = leaf.veins[static_cast<std::size_t>(node.parent)];
      ASSERT_LE(parent.order, node.order);
      ASSERT_TRUE(insidePolygon(leaf.form.outline, node.position))
          << node.position.x << ", " << node.position.y << " seed " << seed;
      ASSERT_TRUE(insidePolygon(leaf.form.outline, 0.5f * (node.position + parent.position) +
                                                       glm::vec2(0, i == 1 ? 1e-3f : 0.0f)));
      EXPECT_LT(glm::length(node.position - parent.position), 2.5f * species().veins.step_mm);
    }
    for (const int order : {1, 2, 3}) EXPECT_GT(orders[order], 20) << order;
  }
}

TEST_P(Venation, ReachesEveryPlaceOfTheBlade) {
  const GrownLeaf leaf = growForm(species(), 2);
  const LeafFrame frame{96, frameExtent(leaf.form.outline)};
  const std::vector<float> depth = signedDistance(leaf.form.outline, 5, frame);
  const VenationOptions& options = species().veins;
  // The nearest candidate for a source, what kept it from being one, and how near sources are
  // reached.
  const float reach = (0.4f * 1.415f + 1.0f) * options.spacing_mm +
                      std::max(kKillShare * options.spacing_mm, 1.05f * options.step_mm);
  int places = 0;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) {
      const glm::vec2 p = frame.toMm({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      if (depth[static_cast<std::size_t>(y * 96 + x)] <
          1.5f * options.clearance_mm + 0.6f * options.spacing_mm)
        continue;
      float nearest = 1e30f, stalk = 1e30f;
      for (const VeinNode& node : leaf.veins) {
        const float distance = glm::length(node.position - p);
        nearest = std::min(nearest, distance);
        if (node.midrib && node.position.y < leaf.form.blade_base)
          stalk = std::min(stalk, distance);
      }
      if (stalk < 3 * leaf.form.stalk_radius) continue;
      ++places;
      EXPECT_LT(nearest, reach) << p.x << ", " << p.y;
    }
  EXPECT_GT(places, 200);
}

TEST_P(Venation, WidthsSumAtEveryFork) {
  const GrownLeaf leaf = growForm(species(), 3);
  const auto n = static_cast<double>(species().veins.exponent);
  EXPECT_GE(n, 2);
  EXPECT_LE(n, 3);
  std::vector<double> sums(leaf.veins.size());
  std::size_t ends = 0;
  double end_radius = -1;
  for (const VeinNode& node : leaf.veins)
    if (node.parent >= 0)
      sums[static_cast<std::size_t>(node.parent)] += std::pow(static_cast<double>(node.radius), n);
  for (std::size_t i = 0; i < leaf.veins.size(); ++i) {
    const auto radius = static_cast<double>(leaf.veins[i].radius);
    if (sums[i] > 0) {
      ASSERT_NEAR(sums[i] / std::pow(radius, n), 1, 1e-4);
    } else {
      if (end_radius < 0) end_radius = radius;
      ASSERT_DOUBLE_EQ(radius, end_radius);
      ++ends;
    }
  }
  EXPECT_EQ(static_cast<std::size_t>(leaf.veins.front().tips), ends);
  EXPECT_GT(ends, 300u);
  EXPECT_LT(leaf.veins.front().radius, leaf.form.stalk_radius);
}

TEST_P(Venation, DependsOnTheSeedAlone) {
  const GrownLeaf a = growForm(species(), 1), b = growForm(species(), 1),
                  c = growForm(species(), 2);
  ASSERT_EQ(a.veins.size(), b.veins.size());
  for (std::size_t i = 0; i < a.veins.size(); ++i)
    ASSERT_EQ(a.veins[i].position, b.veins[i].position);
  EXPECT_NE(a.form.outline, c.form.outline);
  EXPECT_NE(a.veins.size(), c.veins.size());
}

INSTANTIATE_TEST_SUITE_P(Species, Venation, testing::ValuesIn(blades()), [](const auto& tested) {
  std::string name = tested.param->info.name;
  std::erase(name, '-');
  return name;
});

TEST(VeinWidths, FollowDaVinciAndMurray) {
  // A stem that forks into an end and a fork of two ends.
  for (const float n : {2.0f, 3.0f}) {
    std::vector<VeinNode> nodes(5);
    const int parents[] = {-1, 0, 0, 2, 2};
    for (std::size_t i = 0; i < 5; ++i) nodes[i].parent = parents[i];
    setVeinWidths(nodes, 2.0f, n);
    EXPECT_FLOAT_EQ(nodes[0].radius, 2.0f);
    EXPECT_NEAR(nodes[1].radius, 2 * std::pow(3.0f, -1 / n), 1e-6f);
    EXPECT_NEAR(nodes[2].radius, 2 * std::pow(1.5f, -1 / n), 1e-6f);
    EXPECT_NEAR(nodes[3].radius, nodes[4].radius, 1e-6f);
  }
}

TEST(LeafMaps, NormalsAreSlopesOfTheRelief) {
  for (const char* name : {"silver-birch", "scots-pine"}) {
    const LeafSet set = leafOf(name, 200);
    const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * 200 + x); };
    Random random(9);
    for (int k = 0; k < 4000; ++k) {
      const int x = 1 + static_cast<int>(random.below(198)),
                y = 1 + static_cast<int>(random.below(198));
      for (const LeafSide* side : {&set.front, &set.back}) {
        // A step to the right and one up the image, along the surface.
        const double step = 2 * static_cast<double>(set.mm_per_texel);
        const glm::dvec3 right(step, 0,
                               side->relief_mm[at(x + 1, y)] - side->relief_mm[at(x - 1, y)]);
        const glm::dvec3 up(0, step, side->relief_mm[at(x, y - 1)] - side->relief_mm[at(x, y + 1)]);
        const glm::dvec3 n = side->normal[at(x, y)];
        ASSERT_NEAR(glm::dot(n, glm::normalize(right)), 0, 1e-4);
        ASSERT_NEAR(glm::dot(n, glm::normalize(up)), 0, 1e-4);
        ASSERT_GT(n.z, 0);
      }
    }
  }
}

TEST(LeafMaps, ThicknessIsThatOfLeaves) {
  for (const LeafSpecies* species : blades()) {
    const LeafSet set = leafOf(species->info.name, 256);
    std::vector<float> inside;
    for (std::size_t i = 0; i < set.texelCount(); ++i)
      if (set.opacity[i] == 1) inside.push_back(set.thickness_mm[i]);
    std::sort(inside.begin(), inside.end());
    EXPECT_GT(inside[inside.size() / 2], 0.13f) << species->info.name;
    EXPECT_LT(inside[inside.size() / 2], 0.45f) << species->info.name;
    EXPECT_GT(inside.back(), 0.6f) << species->info.name;
    EXPECT_LT(inside.back(), 2.5f) << species->info.name;
  }
}

TEST(LeafMaps, ColorsAreThoseOfLeaves) {
  for (const LeafSpecies& species : allLeafSpecies()) {
    const std::string& name = species.info.name;
    const LeafSet set = leafOf(name, 220);
    glm::dvec3 front(0), through(0);
    double back = 0, all = 0;
    for (std::size_t i = 0; i < set.texelCount(); ++i) {
      if (set.opacity[i] < 1) continue;
      front += glm::dvec3(set.front.albedo[i]);
      through += glm::dvec3(set.front.translucency[i]);
      back += luminance(set.back.albedo[i]);
      all += 1;
    }
    front /= all;
    through /= all;
    EXPECT_GT(back / all, 1.08 * luminance(glm::vec3(front))) << name;
    if (name == "japanese-maple") {
      EXPECT_GT(front.x, 2.5 * front.y);
      continue;
    }
    EXPECT_GT(front.y, 0.075) << name;
    EXPECT_LT(front.y, 0.15) << name;
    EXPECT_LT(front.x, 0.8 * front.y) << name;
    EXPECT_LT(front.z, 0.7 * front.y) << name;
    // Against the light greener and more saturated.
    EXPECT_GT(through.y, through.x) << name;
    EXPECT_LT(through.z / through.y, front.z / front.y + 0.05) << name;
  }
}

TEST(LeafMaps, VeinsAreDarkAgainstTheLight) {
  for (const LeafSpecies* species : blades()) {
    const GrownLeaf leaf = growForm(*species, 1);
    const LeafSet set = leafOf(species->info.name, 512);
    const BladeFields fields = rasterise(leaf, *species, {512, frameExtent(leaf.form.outline)});
    double on = 0, off = 0, on_count = 0, off_count = 0;
    for (std::size_t i = 0; i < set.texelCount(); ++i) {
      if (set.opacity[i] < 1 || fields.stalk[i] > 0) continue;
      const double v = luminance(set.back.translucency[i]);
      if (fields.major[i] < 0.06f) {
        on += v;
        ++on_count;
      } else if (fields.major[i] > 0.5f && fields.major[i] < 1.2f) {
        off += v;
        ++off_count;
      }
    }
    ASSERT_GT(on_count, 50) << species->info.name;
    EXPECT_LT(on / on_count, 0.8 * off / off_count) << species->info.name;
  }
}

TEST(LeafMaps, ColorGoesOnOutside) {
  for (const LeafSpeciesInfo& s : leafSpeciesList()) {
    const int n = 180;
    const LeafSet set = leafOf(s.name, n);
    int seen = 0;
    for (int y = 2; y + 2 < n; ++y)
      for (int x = 2; x + 2 < n; ++x) {
        const auto i = static_cast<std::size_t>(y * n + x);
        if (set.opacity[i] > 0) continue;
        for (const int step : {-2, 2, -2 * n, 2 * n}) {
          const std::size_t j = i + static_cast<std::size_t>(step);
          if (set.opacity[j] < 0.9f) continue;
          ++seen;
          ASSERT_LT(std::abs(luminance(set.front.albedo[i]) - luminance(set.front.albedo[j])),
                    0.15);
        }
      }
    for (const glm::vec3& c : set.front.albedo) ASSERT_GT(luminance(c), 0.004) << s.name;
    EXPECT_GT(seen, 10) << s.name;
  }
}

TEST(LeafMaps, ShapeIsTheSameAtAnySize) {
  for (const LeafSpeciesInfo& s : leafSpeciesList()) {
    const int n = 128;
    const LeafSet small = leafOf(s.name, n), large = leafOf(s.name, 2 * n);
    EXPECT_NEAR(small.mm_per_texel, 2 * large.mm_per_texel, 1e-5f);
    double opacity = 0, color = 0, inside = 0;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const auto i = static_cast<std::size_t>(y * n + x);
        const auto j = static_cast<std::size_t>(4 * y * n + 2 * x),
                   row = static_cast<std::size_t>(2 * n);
        const float mean = (large.opacity[j] + large.opacity[j + 1] + large.opacity[j + row] +
                            large.opacity[j + row + 1]) /
                           4;
        opacity += static_cast<double>(std::abs(mean - small.opacity[i]));
        if (small.opacity[i] < 1) continue;
        const glm::vec3 four = large.front.albedo[j] + large.front.albedo[j + 1] +
                               large.front.albedo[j + row] + large.front.albedo[j + row + 1];
        color += luminance(four) / 4 - luminance(small.front.albedo[i]);
        inside += luminance(small.front.albedo[i]);
      }
    EXPECT_LT(opacity / (n * n), 0.015) << s.name;
    EXPECT_LT(std::abs(color / inside), 0.06) << s.name;
  }
}

TEST(LeafMaps, SeedsDiffer) {
  for (const LeafSpeciesInfo& s : leafSpeciesList()) {
    const LeafSet a = leafOf(s.name, 64, 0.4f, 1), b = leafOf(s.name, 64, 0.4f, 2);
    EXPECT_NE(a.opacity, b.opacity) << s.name;
    EXPECT_NE(a.front.albedo, b.front.albedo) << s.name;
  }
}

TEST(LeafAge, ChangesContinuously) {
  for (const char* name : {"silver-birch", "japanese-maple", "scots-pine"})
    for (const float age : {0.02f, 0.3f, 0.45f, 0.6f, 0.7f, 0.8f, 0.95f}) {
      const LeafSet before = leafOf(name, 120, age, 4), after = leafOf(name, 120, age + 0.002f, 4);
      EXPECT_EQ(before.mm_per_texel, after.mm_per_texel);
      EXPECT_EQ(before.front.relief_mm, after.front.relief_mm);
      double color = 0, opacity = 0;
      for (std::size_t i = 0; i < before.texelCount(); ++i) {
        const glm::vec3 d = glm::abs(before.front.albedo[i] - after.front.albedo[i]);
        color += static_cast<double>(std::max({d.x, d.y, d.z}));
        opacity += static_cast<double>(std::abs(before.opacity[i] - after.opacity[i]));
      }
      const auto count = static_cast<double>(before.texelCount());
      EXPECT_LT(color / count, 0.008) << name << " at " << age;
      EXPECT_LT(opacity / count, 0.003) << name << " at " << age;
    }
}

TEST(LeafAge, FadesDriesAndPierces) {
  for (const LeafSpecies* species : blades()) {
    double green_summer = 0, green_autumn = 0, lost = 0;
    for (const std::uint32_t seed : {1u, 2u}) {
      const LeafSet summer = leafOf(species->info.name, 100, 0.2f, seed),
                    autumn = leafOf(species->info.name, 100, 1.0f, seed);
      for (std::size_t i = 0; i < summer.texelCount(); ++i) {
        // Holes only grow.
        ASSERT_LE(autumn.opacity[i], summer.opacity[i] + 1e-6f);
        lost += static_cast<double>(summer.opacity[i] - autumn.opacity[i]);
        if (autumn.opacity[i] < 1) continue;
        const glm::vec3 a = summer.front.albedo[i], b = autumn.front.albedo[i];
        green_summer += static_cast<double>(a.y - a.x);
        green_autumn += static_cast<double>(b.y - b.x);
      }
    }
    EXPECT_GT(lost, 3) << species->info.name;
    EXPECT_LT(green_autumn, green_summer) << species->info.name;
  }
}

}  // namespace
}  // namespace verdure
