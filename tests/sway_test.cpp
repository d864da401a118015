// Plants in wind, on the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.h"
#include "base/random.h"
#include "motion/motion_tables.h"
#include "motion/motion_texture.h"
#include "motion/spectrum.h"
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
  static PlantMotion motionWith(int width, int height) {
    MotionOptions options;
    options.texture_width = width;
    options.texture_height = height;
    return plantMotion(plant(), options);
  }
  /// With small textures: all but spectra and repetition are the same.
  static const PlantMotion& motion() {
    static const PlantMotion known = motionWith(512, 64);
    return known;
  }
  static const PlantMotion& fullMotion() {
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
  static std::vector<double> track(const PlantMotion& motion, std::uint32_t b, const Wind& wind,
                                   double step, int steps, double start = 0.0) {
    const MotionBranch& branch = motion.tree.branches[b];
    const MotionTables& tables = *motion.tables;
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
      const auto values = track(motion(), b, {.speed = speed, .gusts = 0.3f}, 0.37, 2000);
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

// Pulling tests and films of trees in fresh winds (8 m/s) have crowns move by decimetres, and twigs
// by some hundredths to tenths of their length.
TEST_F(InWind, IsPlausiblyStrong) {
  const auto farthest = [](float speed) {
    const Plant moved = at(40.0, {.speed = speed});
    float far = 0.0f;
    for (std::size_t m = 0; m < moved.meshes.size(); ++m)
      for (std::size_t v = 0; v < moved.meshes[m].positions.size(); ++v)
        far = std::max(far,
                       glm::length(moved.meshes[m].positions[v] - plant().meshes[m].positions[v]));
    return far;
  };
  const float height = bounds(plant()).size().y;
  EXPECT_LT(farthest(2.0f), 0.01f * height);
  EXPECT_GT(farthest(8.0f), 0.02f * height);
  EXPECT_LT(farthest(8.0f), 0.10f * height);
}

// Each branch has the spectrum of an oscillator of its own length, though its level shares one
// texture; and it does not repeat.
TEST_F(InWind, BranchesHaveTheirOwnSpectra) {
  constexpr int kRecord = 512, kBins = 205;  // 51 periods; up to 4 f_h
  constexpr double kBinsPerResonance = kRecord / 10.0;
  for (const std::uint32_t b : samples()) {
    const BranchMotion& branch = motion().branches[b];
    const BranchOscillator truth{double{branch.frequency_hz}, double{branch.damping_ratio}, 5.0};
    Spectrum spectrum(kRecord, kBins);
    const double step = 1.0 / (10.0 * truth.frequency_hz);
    for (int record = 0; record < 250; ++record) {
      std::vector<double> signal =
          track(fullMotion(), b, {.speed = 1.0f, .gusts = 0.0f}, step, kRecord, 1000.0 * record);
      double mean = 0.0;
      for (const double x : signal) mean += x / kRecord;
      spectrum.add([&](int i) { return signal[static_cast<std::size_t>(i)] - mean; });
    }
    const auto true_power = [&](std::size_t bin) {
      const double a =
          branchResponse(truth, truth.frequency_hz * static_cast<double>(bin) / kBinsPerResonance);
      return a * a;
    };
    const double error = spectrum.errorTo(true_power);
    // The middle of the resonance: the highest bin alone is noisy.
    const auto peak = [&](const auto& power) {
      double sum = 0.0, weighted = 0.0;
      for (auto bin = static_cast<std::size_t>(0.6 * kBinsPerResonance);
           bin <= static_cast<std::size_t>(1.4 * kBinsPerResonance); ++bin) {
        sum += power(bin);
        weighted += static_cast<double>(bin) * power(bin);
      }
      return weighted / sum;
    };
    const double measured = peak([&](std::size_t bin) { return spectrum.power[bin]; });
    const double expected = peak(true_power);
    const int level = motion().tree.branches[b].level;
    printf("level %d, %.2f m, %.2f Hz: L1 %.3f, peak %.3f f_h (%.3f)\n", level,
           double{motion().tree.branches[b].length}, truth.frequency_hz, error,
           measured / kBinsPerResonance, expected / kBinsPerResonance);
    EXPECT_LT(error, 0.1) << "branch " << b;
    EXPECT_NEAR(measured / expected, 1.0, 0.05) << "branch " << b;
  }
}

TEST_F(InWind, DoesNotRepeatWithinAnHour) {
  for (const std::uint32_t b : samples()) {
    constexpr double kStep = 0.4;
    constexpr std::size_t kCount = 14000, kLongest = 9000;  // an hour
    const std::vector<double> signal =
        track(fullMotion(), b, {.speed = 1.0f, .gusts = 0.0f}, kStep, static_cast<int>(kCount));
    double most = 0.0;
    for (std::size_t lag = 25; lag <= kLongest; lag += 7) {
      const std::vector<double> first(signal.begin(), signal.end() - static_cast<long>(lag));
      const std::vector<double> second(signal.begin() + static_cast<long>(lag), signal.end());
      most = std::max(most, std::abs(correlation(first, second)));
    }
    EXPECT_LT(most, 0.1) << "branch " << b;
  }
}

TEST_F(InWind, NeighbouringLeavesMoveTogether) {
  const Wind wind{.speed = 3.0f, .gusts = 0.0f};
  constexpr std::size_t kTimes = 120;
  std::vector<std::vector<double>> bends(motion().leaves.size());
  for (std::size_t i = 0; i < kTimes; ++i) {
    const auto turns = leafTurns(motion(), wind, 0.9 * static_cast<double>(i));
    for (std::size_t k = 0; k < turns.size(); ++k) bends[k].push_back(double{turns[k].x});
  }
  float size = 0.0f;
  for (const LeafMotion& leaf : motion().leaves) size = std::max(size, leaf.reach);
  double sums[3] = {}, counts[3] = {};
  Random random(7);
  const auto count = static_cast<std::uint32_t>(motion().leaves.size());
  // Neighbours in the list are neighbours on a twig; others are anywhere.
  for (int trial = 0; trial < 40000; ++trial) {
    const std::uint32_t a = random.below(count);
    const std::uint32_t b =
        trial % 2 == 0 ? (a + 1 + random.below(20)) % count : random.below(count);
    if (a == b) continue;
    const float apart = glm::length(motion().leaves[a].stalk - motion().leaves[b].stalk) / size;
    const int bin = apart < 1.0f ? 0 : apart < 4.0f ? 1 : apart > 12.0f ? 2 : -1;
    if (bin < 0) continue;
    sums[bin] += correlation(bends[a], bends[b]);
    counts[bin] += 1.0;
  }
  for (int bin = 0; bin < 3; ++bin) ASSERT_GT(counts[bin], 300.0) << bin;
  const double next = sums[0] / counts[0], near = sums[1] / counts[1], far = sums[2] / counts[2];
  printf("correlation of leaves: %.2f within their size, %.2f within 4, %.2f beyond 12\n", next,
         near, far);
  EXPECT_GT(next, 0.8);
  EXPECT_GT(near, 0.4);
  EXPECT_LT(far, 0.5 * near);
}

// A leaf keeps its shape, and its stalk stays where its twig carries it.
TEST_F(InWind, LeavesDoNotTear) {
  const Wind gale{.speed = 20.0f, .from = 1.0f, .gusts = 1.0f};
  const Plant moved = at(5.0, gale);
  const auto amplitudes = branchAmplitudes(motion(), gale, 5.0);
  const MotionTables& tables = *motion().tables;
  const float height = bounds(plant()).size().y;
  float worst = 0.0f;
  for (std::size_t i = 0; i < plant().leaves.size(); ++i) {
    const Leaf& leaf = plant().leaves[i];
    const Mesh& mesh = plant().meshes[leaf.mesh];
    std::uint32_t beam = motion().leaves[i].branch;
    float place = motion().leaves[i].place;
    shared::MovedVertex stalk{leaf.stalk, {0, 1, 0}};
    while (beam != kNone) {
      stalk = shared::bentByBeam(tables.beams[beam], place, amplitudes[beam], stalk);
      place = tables.beams[beam].places.x;
      beam = motion().tree.branches[beam].parent;
    }
    const auto& now_at = moved.meshes[leaf.mesh].positions;
    for (std::uint32_t k = 0; k < leaf.triangle_count; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t first = 3 * std::size_t{plant().leaf_triangles[leaf.first_triangle + k]};
        const std::uint32_t v = mesh.indices[first + c], next = mesh.indices[first + (c + 1) % 3];
        worst = std::max(worst, std::abs(glm::length(now_at[v] - now_at[next]) -
                                         glm::length(mesh.positions[v] - mesh.positions[next])));
        const float rest = glm::length(mesh.positions[v] - leaf.stalk);
        const float now = glm::length(moved.meshes[leaf.mesh].positions[v] - stalk.position);
        worst = std::max(worst, std::abs(now - rest));
      }
  }
  EXPECT_LT(worst, 1e-4f * height);
}

TEST_F(InWind, TheWholeMovesWithItsPlace) {
  // Turned and moved, in wind that is turned with it: the same, but for leaves and gusts, which
  // know where they are.
  const MotionPlace turned{glm::rotate(glm::mat4(1.0f), 0.9f, glm::vec3(0, 1, 0)), 0};
  const auto first = branchAmplitudes(motion(), {.speed = 8.0f, .from = 0.4f}, 3.0);
  const auto second = branchAmplitudes(motion(), {.speed = 8.0f, .from = 1.3f}, 3.0, turned);
  for (std::size_t b = 0; b < first.size(); ++b)
    ASSERT_LT(glm::length(first[b] - second[b]), 1e-5f + 1e-4f * glm::length(first[b]));
}

// A plant of few vertices, so that many times can be looked at.
TEST(MovedBounds, HoldAtTenThousandTimes) {
  Plant plant;
  plant.materials.resize(1);
  Mesh wood, leaves;
  leaves.kind = PartKind::kFoliage;
  Random random(3);
  // A trunk, and three generations that leave it at random places and ways.
  plant.branches.push_back({.points = {{{0, 0, 0}, 0.1f}, {{0, 6, 0}, 0.03f}}});
  for (std::uint32_t b = 0; b < 40; ++b) {
    const Branch parent = plant.branches[b];
    if (parent.level >= 3) break;
    for (int k = 0; k < 3; ++k) {
      const float share = random.uniform(0.3f, 1.0f);
      const glm::vec3 root = glm::mix(parent.points[0].position, parent.points[1].position, share);
      const glm::vec3 way(random.vary(1.0f), random.uniform(0.0f, 1.0f), random.vary(1.0f));
      const float length =
          0.5f * glm::length(parent.points[1].position - parent.points[0].position);
      const glm::vec3 tip = root + length * glm::normalize(way);
      plant.branches.push_back({.parent = b,
                                .level = parent.level + 1,
                                .parent_offset = share,
                                .points = {{root, 0.02f}, {tip, 0.005f}}});
    }
  }
  for (std::uint32_t b = 0; b < plant.branches.size(); ++b) {
    const Branch& branch = plant.branches[b];
    const auto first = static_cast<std::uint32_t>(wood.positions.size());
    for (const BranchPoint& point : branch.points)
      for (const glm::vec3& off : {glm::vec3(0.0f), glm::vec3(0.05f, 0.0f, 0.02f)}) {
        wood.positions.push_back(point.position + off);
        wood.normals.emplace_back(0, 1, 0);
        wood.branch_of_vertex.push_back(b);
      }
    wood.indices.insert(wood.indices.end(), {first, first + 1, first + 2});
  }
  plant.meshes = {wood};
  const PlantMotion motion =
      plantMotion(plant, {.flexibility = 3.0f, .texture_width = 512, .texture_height = 256});
  float worst = 1.0f;
  for (int trial = 0; trial < 10000; ++trial) {
    const Wind wind{.speed = random.uniform(0.0f, 60.0f),
                    .from = random.uniform(0.0f, 6.3f),
                    .gusts = random.uniform()};
    const Bounds box = movedBounds(motion, wind);
    Plant moved = plant;
    movePlant(motion, wind, double{random.uniform(0.0f, 1e7f)}, {.instance = random.next()}, moved);
    const Bounds is = bounds(moved);
    for (int c = 0; c < 3; ++c) {
      worst = std::min({worst, is.min[c] - box.min[c], box.max[c] - is.max[c]});
      ASSERT_GE(worst, 0.0f) << wind.speed << " m/s";
    }
  }
}

TEST_F(InWind, StaysWithinItsBounds) {
  Random random(5);
  for (int trial = 0; trial < 8; ++trial) {
    const Wind wind{.speed = random.uniform(0.0f, 40.0f),
                    .from = random.uniform(0.0f, 6.3f),
                    .gusts = random.uniform()};
    const Bounds box = movedBounds(motion(), wind);
    const Plant moved = at(double{random.uniform(0.0f, 1e6f)}, wind, {.instance = random.next()});
    const Bounds is = bounds(moved);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(is.min[c], box.min[c]) << wind.speed;
      EXPECT_LE(is.max[c], box.max[c]) << wind.speed;
    }
  }
}

}  // namespace
}  // namespace verdure
