#include "plant/weber_penn.h"

#include <gtest/gtest.h>

#include <map>

#include <algorithm>
#include <cmath>

#include "plant/bark_texture.h"
#include "plant/species.h"

namespace verdure {
namespace {

constexpr float kDegrees = 180.0f / 3.14159265f;

TreeParameters table(const std::string& text) {
  TreeParameters p;
  setParameters(p, text);
  return p;
}

glm::vec3 along(const glm::quat& frame) {
  return frame * glm::vec3(0, 0, 1);
}
float angleBetween(const glm::vec3& a, const glm::vec3& b) {
  return std::acos(std::clamp(glm::dot(a, b), -1.0f, 1.0f)) * kDegrees;
}

TEST(ShapeRatio, HasThePapersValues) {
  const TreeParameters p;
  // Values at 0, 0.35, 0.7 and 1 by the formulas of the paper, worked out by hand.
  const float expected[8][4] = {{0.2f, 0.48f, 0.76f, 1.0f},      {0.2f, 0.912805f, 0.847214f, 0.2f},
                                {0.2f, 0.617999f, 0.912805f, 1}, {1, 1, 1, 1},
                                {0.5f, 0.675f, 0.85f, 1},        {0, 0.5f, 1, 0},
                                {1, 0.72f, 0.44f, 0.2f},         {0.5f, 0.75f, 1, 0.5f}};
  const float ratios[4] = {0, 0.35f, 0.7f, 1};
  for (int shape = 0; shape < 8; ++shape)
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(shapeRatio(shape, ratios[k], p), expected[shape][k], 1e-5) << shape << ' ' << k;
}

TEST(ShapeRatio, EnvelopePeaksWhereItShould) {
  const TreeParameters p = table("PruneWidthPeak=0.6 PrunePowerLow=2 PrunePowerHigh=0.5");
  EXPECT_NEAR(shapeRatio(8, 0.4f, p), 1, 1e-5);
  EXPECT_NEAR(shapeRatio(8, 0.4001f, p), 1, 1e-3);  // no jump at the peak
  EXPECT_NEAR(shapeRatio(8, 0.1f, p), 0.5f, 1e-5);
  EXPECT_NEAR(shapeRatio(8, 0.7f, p), 0.25f, 1e-5);
  EXPECT_EQ(shapeRatio(8, -0.01f, p), 0);
  EXPECT_EQ(shapeRatio(8, 1.01f, p), 0);
}

TEST(Taper, FollowsThePapersEquations) {
  const float r = 0.5f, length = 10;
  for (const float z : {0.0f, 0.25f, 0.9f, 1.0f}) {
    EXPECT_FLOAT_EQ(taperedRadius(0, z, r, length), r);                      // cylinder
    EXPECT_FLOAT_EQ(taperedRadius(0.5f, z, r, length), r * (1 - 0.5f * z));  // half a cone
    EXPECT_NEAR(taperedRadius(1, z, r, length), r * (1 - z), 1e-6);          // cone
  }
  // 2: a cylinder that ends in a hemisphere.
  EXPECT_FLOAT_EQ(taperedRadius(2, 0.5f, r, length), r);
  EXPECT_NEAR(taperedRadius(2, 0.97f, r, length), std::sqrt(0.25f - 0.04f), 1e-5);
  EXPECT_NEAR(taperedRadius(2, 1, r, length), 0, 1e-6);
  // 3: spheres of radius r in a row: radius 0 each 2 r = 1 m from the tip, r in between.
  EXPECT_NEAR(taperedRadius(3, 0.35f, r, length), r, 1e-5);
  EXPECT_NEAR(taperedRadius(3, 0.4f, r, length), 0, 1e-3);
  EXPECT_NEAR(taperedRadius(3, 0.42f, r, length), std::sqrt(0.25f - 0.09f), 1e-3);
  // 2.5: halfway between the cylinder and the spheres.
  EXPECT_NEAR(taperedRadius(2.5f, 0.4f, r, length), 0.5f * r, 1e-3);
}

TEST(Flare, WidensTheFootAlone) {
  EXPECT_FLOAT_EQ(flareFactor(0.6f, 0), 1 + 0.6f * 0.99f);
  EXPECT_FLOAT_EQ(flareFactor(0.6f, 0.0625f), 1 + 0.6f * 0.09f);
  EXPECT_FLOAT_EQ(flareFactor(0.6f, 0.125f), 1);
  EXPECT_FLOAT_EQ(flareFactor(0.6f, 0.8f), 1);
}

TEST(Stem, BendsByTheSumOfItsSegments) {
  for (const char* resolution : {"1", "4", "9", "30"}) {
    const Skeleton bent =
        growSkeleton(table(std::string("Levels=1 0Curve=90 0CurveRes=") + resolution), 1);
    ASSERT_EQ(bent.stems.size(), 1u);
    const auto& frames = bent.stems[0].frames;
    EXPECT_NEAR(angleBetween(along(frames.front()), along(frames.back())), 90, 0.05);
    // It stays in a plane.
    for (const BranchPoint& p : bent.stems[0].points)
      EXPECT_NEAR(glm::dot(p.position, frames[0] * glm::vec3(1, 0, 0)), 0, 1e-4);
  }
  const Skeleton back = growSkeleton(table("Levels=1 0Curve=40 0CurveBack=-70 0CurveRes=10"), 1);
  const Stem& stem = back.stems[0];
  EXPECT_NEAR(angleBetween(along(stem.frames.front()), along(stem.frames.back())), 30, 0.05);
  float most = 0;
  for (const glm::quat& frame : stem.frames)
    most = std::max(most, angleBetween(along(stem.frames.front()), along(frame)));
  EXPECT_NEAR(most, 40, 0.05);
}

TEST(Stem, AnArcHasTheLengthOfItsChords) {
  // Segments of a stem keep their length whatever it bends: 12 chords of a quarter circle.
  const Skeleton bent = growSkeleton(table("Levels=1 Scale=10 0Curve=90 0CurveRes=12"), 1);
  const auto& points = bent.stems[0].points;
  const float chord = 10.0f / 12, step = 90.0f / 12 / kDegrees;
  const float radius = 0.5f * chord / std::sin(0.5f * step);
  EXPECT_NEAR(points.back().position.y, radius, 1e-3);  // the end of a quarter circle
}

TEST(Stem, CoilsWhenTheVariationIsNegative) {
  const Skeleton coil = growSkeleton(table("Levels=1 0CurveV=-35 0CurveRes=24"), 1);
  for (const glm::quat& frame : coil.stems[0].frames)
    EXPECT_NEAR(angleBetween(along(frame), glm::vec3(0, 1, 0)), 35, 0.6);
  // One turn: the end stands above the beginning.
  const glm::vec3 end = coil.stems[0].points.back().position;
  EXPECT_NEAR(glm::length(glm::vec2(end.x, end.z)), 0, 0.01);
  EXPECT_NEAR(end.y, 10 * std::cos(35 / kDegrees), 0.05);
}

TEST(Stem, SplitsAsOftenAsAsked) {
  const auto clones = [](const TreeParameters& p, std::uint64_t seed) {
    int count = 0;
    for (const Stem& stem : growSkeleton(p, seed).stems) count += stem.parent == 0;
    return count;
  };
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    EXPECT_EQ(clones(table("Levels=1 0BaseSplits=3 0CurveRes=6 0SplitAngle=20"), seed), 3);
    // 11 inner nodes of the trunk, a quarter of a split each: error diffusion keeps 2.75 +- 1.
    EXPECT_NEAR(clones(table("Levels=1 0SegSplits=0.25 0CurveRes=12 0SplitAngle=9"), seed), 2.75,
                1.0);
  }
}

TEST(Stem, ClonesLeaveAtTheSplitAngleAndStraightenOut) {
  const Skeleton tree = growSkeleton(table("Levels=1 0BaseSplits=2 0CurveRes=8 0SplitAngle=40"), 3);
  ASSERT_EQ(tree.stems.size(), 3u);
  for (const Stem& stem : tree.stems) {
    const float turned = angleBetween(along(stem.frames.back()), glm::vec3(0, 1, 0));
    EXPECT_NEAR(turned, 0, 0.1);  // the angle is given back over the segments that follow
    float most = 0;
    for (const glm::quat& frame : stem.frames)
      most = std::max(most, angleBetween(along(frame), glm::vec3(0, 1, 0)));
    EXPECT_NEAR(most, 40, 0.1);
  }
}

TEST(Stem, IsAttractedUpOrDown) {
  const auto tip = [](const char* attraction) {
    const Skeleton tree = growSkeleton(
        table(std::string("Levels=3 1Branches=10 1Length=0.5 1DownAngle=90 2Branches=10 "
                          "2Length=0.5 2DownAngle=50 2CurveRes=8 AttractionUp=") +
              attraction),
        1);
    float sum = 0, count = 0;
    for (const Stem& stem : tree.stems)
      if (stem.level == 2) sum += along(stem.frames.back()).y, ++count;
    return sum / count;
  };
  EXPECT_GT(tip("2"), 0.6f);
  EXPECT_LT(tip("-2"), -0.6f);
  EXPECT_NEAR(tip("0"), 0, 0.35f);
}

TEST(Children, HaveThePapersLengthsRadiiAndAngles) {
  const TreeParameters p = table(
      "Levels=3 Shape=7 Scale=13 BaseSize=0.4 Ratio=0.015 RatioPower=1.2 1Branches=50 1Length=0.3 "
      "1DownAngle=60 1DownAngleV=-50 1Rotate=140 2Branches=30 2Length=0.6 2DownAngle=45");
  const Skeleton tree = growSkeleton(p, 1);
  const Stem& trunk = tree.stems[0];
  EXPECT_FLOAT_EQ(trunk.length, 13);
  EXPECT_FLOAT_EQ(trunk.radius, 13 * 0.015f);
  int first = 0;
  for (const Stem& stem : tree.stems) {
    if (stem.level == 0) continue;
    const Stem& parent = tree.stems[stem.parent];
    if (stem.level == 1) {
      ++first;
      const float ratio = (13 - stem.offset) / (13 - 0.4f * 13);
      EXPECT_GE(stem.offset, 0.4f * 13);
      EXPECT_NEAR(stem.length, 13 * 0.3f * shapeRatio(7, ratio, p), 1e-4);
      const float down = 60 - 50 * (1 - 2 * (0.2f + 0.8f * ratio));
      EXPECT_NEAR(angleBetween(along(stem.frames[0]), glm::vec3(0, 1, 0)), down, 0.05);
    } else {
      EXPECT_NEAR(stem.length, 0.6f * (parent.length - 0.6f * stem.offset), 1e-4);
      EXPECT_NEAR(angleBetween(along(stem.frames[0]), along(parent.frames[0])), 45, 0.05);
    }
    const float own = parent.radius * std::pow(stem.length / parent.length, 1.2f);
    const float limit = parent.radius * (1 - stem.offset / parent.length);
    EXPECT_NEAR(stem.radius, std::max(std::min(own, limit), 0.0006f), 1e-5);
  }
  EXPECT_EQ(first, 50);
}

TEST(Children, TurnAroundTheirParent) {
  const auto azimuths = [](const char* rotate) {
    const Skeleton tree = growSkeleton(
        table(std::string("Levels=2 1Branches=12 1Length=0.3 1DownAngle=90 1Rotate=") + rotate), 1);
    std::vector<float> list;
    for (std::size_t i = 1; i < tree.stems.size(); ++i) {
      const glm::vec3 d = along(tree.stems[i].frames[0]);
      list.push_back(std::atan2(d.z, d.x) * kDegrees);
    }
    return list;
  };
  const auto step = [](float a, float b) { return std::abs(std::remainder(a - b, 360.0f)); };
  const auto helical = azimuths("140");
  for (std::size_t i = 1; i < helical.size(); ++i)
    EXPECT_NEAR(step(helical[i], helical[i - 1]), 140, 0.1);
  // -90: alternately 90 degrees to both sides, that is opposite each other.
  const auto sides = azimuths("-90");
  for (std::size_t i = 2; i < sides.size(); ++i) {
    EXPECT_NEAR(step(sides[i], sides[i - 1]), 180, 0.1);
    EXPECT_NEAR(step(sides[i], sides[i - 2]), 0, 0.1);
  }
}

TEST(Pruning, KeepsStemsInsideTheEnvelope) {
  for (const char* name : {"weeping-willow", "hedge", "quaking-aspen"}) {
    TreeParameters p = findSpecies(name).parameters;
    setParameters(p, "PruneRatio=1");
    if (std::string(name) == "quaking-aspen") setParameters(p, "PruneWidth=0.12");
    const Skeleton tree = growSkeleton(p, 1);
    EXPECT_GT(tree.stems.size(), 500u);
    for (const Stem& stem : tree.stems) {
      if (stem.level == 0) continue;
      for (const BranchPoint& point : stem.points) {
        // The envelope by the paper, written out again.
        const float across = std::hypot(point.position.x, point.position.z) / tree.height;
        const float ratio = (tree.height - point.position.y) / (tree.height * (1 - p.base_size));
        ASSERT_GE(ratio, 0);
        ASSERT_LE(ratio, 1);
        const float peak = 1 - p.prune_width_peak;
        const float width = ratio < peak
                                ? std::pow(ratio / peak, p.prune_power_high)
                                : std::pow((1 - ratio) / p.prune_width_peak, p.prune_power_low);
        ASSERT_LE(across, p.prune_width * width + 1e-5f);
      }
    }
  }
}

TEST(Pruning, HalfARatioShortensHalfAsMuch) {
  const auto lengths = [](const char* ratio) {
    const Skeleton tree = growSkeleton(
        table(std::string("Levels=2 1Branches=30 1Length=0.6 1DownAngle=80 PruneWidth=0.2 "
                          "PrunePowerLow=0.3 PrunePowerHigh=0.3 PruneRatio=") +
              ratio),
        4);
    std::vector<float> list;
    for (const Stem& stem : tree.stems)
      if (stem.level == 1) list.push_back(stem.length);
    return list;
  };
  const auto none = lengths("0"), half = lengths("0.5"), full = lengths("1");
  ASSERT_EQ(none.size(), half.size());
  ASSERT_EQ(none.size(), full.size());
  int shortened = 0;
  for (std::size_t i = 0; i < none.size(); ++i) {
    EXPECT_NEAR(half[i], 0.5f * (none[i] + full[i]), 1e-4);
    shortened += full[i] < 0.95f * none[i];
  }
  EXPECT_GT(shortened, 20);
}

TEST(Leaves, BendTowardsTheLight) {
  const auto mean = [](const char* bend) {
    const Skeleton tree = growSkeleton(
        table(std::string("Levels=2 1Branches=20 1Length=0.4 1DownAngle=70 2DownAngle=50 "
                          "2Rotate=77 Leaves=40 LeafBend=") +
              bend),
        1);
    float sum = 0;
    for (const LeafPlace& leaf : tree.leaves) sum += (leaf.frame * glm::vec3(0, 1, 0)).y;
    return sum / static_cast<float>(tree.leaves.size());
  };
  const float none = mean("0"), some = mean("0.3"), all = mean("1");
  EXPECT_LT(none, some);
  EXPECT_LT(some, all);
  EXPECT_NEAR(all, 1, 1e-3);  // every upper side looks straight up
}

TEST(Leaves, GoToLongStemsByLength) {
  const auto grown = [](const char* share) {
    return growSkeleton(
        table(std::string("Levels=3 Shape=2 1Branches=30 1Length=0.4 2Branches=20 2Length=0.4 "
                          "Leaves=40 LeafByLength=") +
              share),
        3);
  };
  const Skeleton even = grown("0"), by_length = grown("1");
  // Leaves for each metre of a stem: the number varies with the length only in the paper's way.
  const auto spread = [](const Skeleton& tree) {
    std::map<std::uint32_t, int> count;
    for (const LeafPlace& leaf : tree.leaves) ++count[leaf.branch];
    float least = 1e9f, most = 0;
    for (const auto& [branch, leaves] : count) {
      // Stems of one parent's middle: the same LeafDistrib.
      const Stem& stem = tree.stems[branch];
      const float place = stem.offset / stem.parent_length;
      if (place < 0.45f || place > 0.55f || leaves < 8) continue;
      const float density = static_cast<float>(leaves) / stem.length;
      least = std::min(least, density);
      most = std::max(most, density);
    }
    return most / least;
  };
  EXPECT_GT(spread(even), 2.0f);
  EXPECT_LT(spread(by_length), 1.4f);
  EXPECT_NEAR(static_cast<double>(by_length.leaves.size()), static_cast<double>(even.leaves.size()),
              0.15 * static_cast<double>(even.leaves.size()));
}

TEST(Bark, TilesInBothDirections) {
  for (const Species& species : allSpecies()) {
    const int n = 128;
    const BarkTexture bark = makeBark(species.bark, n, 1);
    for (const Image* image : {&bark.color, &bark.normal}) {
      // Differences between neighbouring columns and rows; the last pair wraps around.
      std::vector<int> columns(n), rows(n);
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < n; ++i)
          for (int c = 0; c < 3; ++c) {
            columns[static_cast<std::size_t>(k)] +=
                std::abs(image->at(k, i)[c] - image->at((k + 1) % n, i)[c]);
            rows[static_cast<std::size_t>(k)] +=
                std::abs(image->at(i, k)[c] - image->at(i, (k + 1) % n)[c]);
          }
      EXPECT_LE(columns.back(), *std::max_element(columns.begin(), columns.end() - 1))
          << species.info.name;
      EXPECT_LE(rows.back(), *std::max_element(rows.begin(), rows.end() - 1)) << species.info.name;
    }
    // Normals are unit and point out of the surface.
    for (int i = 0; i < n * n; ++i) {
      const std::uint8_t* p = bark.normal.at(i % n, i / n);
      const glm::vec3 normal = glm::vec3(p[0], p[1], p[2]) / 127.5f - 1.0f;
      ASSERT_NEAR(glm::length(normal), 1, 0.02);
      ASSERT_GT(normal.z, 0);
    }
  }
}

}  // namespace
}  // namespace verdure
