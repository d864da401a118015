// Plants in wind, on the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "motion/motion_tables.h"
#include "motion/motion_texture.h"
#include "verdure/error.h"
#include "verdure/grow.h"
#include "verdure/motion.h"

namespace verdure {
namespace {

class InWind : public testing::Test {
 protected:
  static const Plant& plant() {
    static const Plant grown = [] {
      GrowOptions options;
      options.species = "silver-birch";
      options.seed = 3;
      options.texture_size = 32;
      return grow(options);
    }();
    return grown;
  }
  static const PlantMotion& motion() {
    static const PlantMotion known = plantMotion(plant());
    return known;
  }
  static Plant at(double seconds, const Wind& wind = {.speed = 8.0f, .from = 0.7f},
                  const MotionPlace& place = {}) {
    Plant moved = plant();
    movePlant(motion(), wind, seconds, place, moved);
    return moved;
  }
  /// Branch b's deflections along r at `steps` times, in lengths of the branch.
  static std::vector<double> track(std::uint32_t b, const Wind& wind, double step, int steps,
                                   double start = 0.0) {
    const MotionBranch& branch = motion().tree.branches[b];
    const MotionTables& tables = *motion().tables;
    std::vector<double> out;
    for (int i = 0; i < steps; ++i) {
      const double seconds = start + step * i;
      const shared::MotionMoment moment = momentOf(wind, seconds, tables.wind_extent);
      const MotionTime time = motionTime(seconds);
      const shared::MotionDrive& drive = tables.drives[b];
      const glm::vec2 noise =
          readMotion(&tables.texels[drive.texels], {drive.size & 0xffffu, drive.size >> 16},
                     shared::branchUv(drive, {}, time.whole, time.fraction));
      const glm::vec2 amplitudes =
          shared::branchAmplitudes(tables.beams[b], drive, glm::vec3(moment.toward),
                                   shared::gustySpeed(moment, glm::vec3(0.0f)), noise);
      out.push_back(double{amplitudes.x * (branch.fit.x + branch.fit.y) / branch.length});
    }
    return out;
  }
  /// A branch in the middle of each level that has some.
  static std::vector<std::uint32_t> samples() {
    std::vector<std::uint32_t> out;
    for (int level = 0; level < kMotionLevels; ++level) {
      std::vector<std::uint32_t> all;
      for (std::uint32_t b = 0; b < motion().tree.branches.size(); ++b)
        if (motion().tree.branches[b].level == level) all.push_back(b);
      if (all.empty()) continue;
      out.push_back(all[all.size() / 2]);
      out.push_back(all.front());
    }
    return out;
  }
};

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / n, mb += b[i] / n;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST_F(InWind, RestsWithoutWindToTheBit) {
  const Plant still = at(1234.5, {.speed = 0.0f});
  for (std::size_t m = 0; m < still.meshes.size(); ++m) {
    EXPECT_EQ(still.meshes[m].positions, plant().meshes[m].positions);
    EXPECT_EQ(still.meshes[m].normals, plant().meshes[m].normals);
  }
}

TEST_F(InWind, IsAFunctionOfTimeAlone) {
  const Plant first = at(77.7);
  at(3.0);
  setThreadCount(1);
  const Plant again = at(77.7);
  setThreadCount(0);
  const Plant other = at(77.8);
  std::size_t moved = 0;
  for (std::size_t m = 0; m < first.meshes.size(); ++m) {
    ASSERT_EQ(first.meshes[m].positions, again.meshes[m].positions);
    ASSERT_EQ(first.meshes[m].normals, again.meshes[m].normals);
    for (std::size_t v = 0; v < first.meshes[m].positions.size(); ++v)
      moved += first.meshes[m].positions[v] != other.meshes[m].positions[v] ? 1 : 0;
  }
  EXPECT_GT(moved, vertexCount(plant()) * 9 / 10);
}

TEST_F(InWind, DeflectionsGrowAsTheSpeedsSquare) {
  for (const std::uint32_t b : samples()) {
    const auto rms = [&](float speed) {
      double sum = 0;
      const auto values = track(b, {.speed = speed, .gusts = 0.3f}, 0.37, 2000);
      for (const double x : values) sum += x * x;
      return std::sqrt(sum / static_cast<double>(values.size()));
    };
    const double exponent = std::log(rms(3.0f) / rms(1.5f)) / std::log(2.0);
    EXPECT_GT(exponent, 1.9) << b;
    EXPECT_LT(exponent, 2.1) << b;
  }
}

TEST_F(InWind, NothingBendsFartherThanItsMost) {
  const auto amplitudes = branchAmplitudes(motion(), {.speed = 60.0f, .gusts = 1.0f}, 5.0);
  float most = 0.0f;
  for (std::size_t b = 0; b < amplitudes.size(); ++b) {
    const MotionBranch& branch = motion().tree.branches[b];
    most =
        std::max(most, glm::length(amplitudes[b]) * (branch.fit.x + branch.fit.y) / branch.length);
  }
  EXPECT_LE(most, shared::kMostTip * 1.0001f);
  EXPECT_GT(most, shared::kMostTip * 0.8f);
}

TEST_F(InWind, IsPlausiblyStrong) {
  // Figures of measured trees: tips of crowns move by decimetres in a fresh breeze.
  for (const float speed : {3.0f, 8.0f, 15.0f}) {
    double far = 0.0;
    float rms[kMotionLevels] = {};
    int counts[kMotionLevels] = {};
    const auto amplitudes = branchAmplitudes(motion(), {.speed = speed}, 40.0);
    for (std::size_t b = 0; b < amplitudes.size(); ++b) {
      const MotionBranch& branch = motion().tree.branches[b];
      const float tip = glm::length(amplitudes[b]) * (branch.fit.x + branch.fit.y) / branch.length;
      rms[branch.level] += tip * tip;
      ++counts[branch.level];
    }
    const Plant moved = at(40.0, {.speed = speed});
    for (std::size_t m = 0; m < moved.meshes.size(); ++m)
      for (std::size_t v = 0; v < moved.meshes[m].positions.size(); ++v)
        far = std::max(far, double{glm::length(moved.meshes[m].positions[v] -
                                               plant().meshes[m].positions[v])});
    printf("%g m/s: farthest vertex %.3f m of %.1f m; rms tip by level", double{speed}, far,
           double{bounds(plant()).size().y});
    for (int l = 0; l < kMotionLevels; ++l)
      if (counts[l] > 0) printf(" %.4f (%d)", std::sqrt(double{rms[l]} / counts[l]), counts[l]);
    printf("\n");
  }
}

TEST_F(InWind, StaysWithinItsBounds) {
  Random random(5);
  float worst = 1e9f;
  for (int trial = 0; trial < 60; ++trial) {
    const Wind wind{.speed = random.uniform(0.0f, 40.0f),
                    .from = random.uniform(0.0f, 6.3f),
                    .gusts = random.uniform()};
    const Bounds box = movedBounds(motion(), wind);
    const Plant moved = at(double{random.uniform(0.0f, 1e6f)}, wind, {.instance = random.next()});
    const Bounds is = bounds(moved);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(is.min[c], box.min[c]) << wind.speed;
      EXPECT_LE(is.max[c], box.max[c]) << wind.speed;
      worst = std::min({worst, is.min[c] - box.min[c], box.max[c] - is.max[c]});
    }
  }
  for (const float speed : {0.0f, 3.0f, 8.0f, 15.0f, 60.0f}) {
    const Bounds box = movedBounds(motion(), {.speed = speed});
    printf("%g m/s: bounds %.1f x %.1f x %.1f m\n", double{speed}, double{box.size().x},
           double{box.size().y}, double{box.size().z});
  }
  printf("least room %.3f m\n", double{worst});
}

}  // namespace
}  // namespace verdure
