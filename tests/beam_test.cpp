#include "motion/beam.h"
#include "motion/large_deflection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "shared/beam.h"
#include "verdure/error.h"

namespace verdure {
namespace {

const nlohmann::json& reference() {
  static const nlohmann::json json =
      nlohmann::json::parse(std::ifstream(VERDURE_TEST_DATA "/beam.json"));
  return json;
}

shared::BeamFrame anyFrame(float length) {
  const glm::vec3 t = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));
  const glm::vec3 r = glm::normalize(glm::cross(t, glm::vec3(0, 0, 1)));
  return {{1.0f, -2.0f, 0.5f}, length, t, r, glm::cross(t, r)};
}

TEST(Beam, DeflectsAsIntegratedNumerically) {
  for (const auto& beam : reference()["beams"])
    for (const auto& [x, u] : beam["deflection"].items())
      EXPECT_NEAR(beamDeflectionExact(beam["alpha"], std::stod(x)), u, 2e-6)
          << beam["alpha"] << " at " << x;
}

TEST(Beam, HasTheThesisCoefficients) {
  for (const auto& [taper, printed] : reference()["thesis_table_4_1"].items()) {
    const glm::dvec2 fit = fitBeam(std::stod(taper));
    EXPECT_NEAR(fit.x, printed[0], 0.6e-6) << taper;
    EXPECT_NEAR(fit.y, printed[1], 0.6e-6) << taper;
  }
  for (const auto& beam : reference()["beams"]) {
    const glm::dvec2 fit = fitBeam(beam["alpha"]);
    EXPECT_NEAR(fit.x, beam["c2"], 1e-6) << beam["alpha"];
    EXPECT_NEAR(fit.y, beam["c4"], 1e-6) << beam["alpha"];
  }
}

TEST(Beam, HasNoStepAtAnyTaper) {
  // Through both ways to evaluate (4.7), and through 1.
  double last = beamDeflectionExact(0.9, 0.8);
  for (double taper = 0.9001; taper < 1.1; taper += 1e-4) {
    const double now = beamDeflectionExact(taper, 0.8);
    EXPECT_LT(now, last);
    EXPECT_NEAR(now, last, 4e-5);
    last = now;
  }
  // The limit: (x^2 / 2 - x^3 / 3 + x^4 / 12) 2 / pi.
  EXPECT_NEAR(beamDeflectionExact(1.0, 1.0), 0.5 / glm::pi<double>(), 1e-12);
  EXPECT_NEAR(beamDeflectionExact(1.0, 0.5), (0.125 - 1.0 / 24 + 1.0 / 192) * 2 / glm::pi<double>(),
              1e-12);
  EXPECT_EQ(beamDeflectionExact(0.0, 1.0), beamDeflectionExact(kLeastTaper, 1.0));
}

/// A bend whose tip would go `share` of the length aside, without the correction of the length.
glm::vec2 bendTo(const glm::vec2& fit, float length, float share, float turn) {
  return share * length / shared::beamDeflection(fit, 1.0f) *
         glm::vec2(std::cos(turn), std::sin(turn));
}

class BentBeam : public testing::TestWithParam<double> {
 protected:
  const glm::vec2 fit_{fitBeam(GetParam())};
};
INSTANTIATE_TEST_SUITE_P(Tapers, BentBeam, testing::Values(0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.0));

TEST_P(BentBeam, KeepsItsLength) {
  const float length = 3.0f;
  const shared::BeamFrame frame = anyFrame(length);
  for (const float share : {0.05f, 0.25f, 0.5f, 0.65f})
    for (const float turn : {0.0f, 0.8f, 2.5f}) {
      const glm::vec2 amplitudes = bendTo(fit_, length, share, turn);
      double arc = 0.0;
      glm::vec3 last = frame.root;
      constexpr int kSteps = 2000;
      for (int i = 1; i <= kSteps; ++i) {
        const float x = static_cast<float>(i) / kSteps;
        const glm::vec3 now = shared::posedPoint(shared::poseOfBeam(frame, fit_, x, amplitudes),
                                                 frame.root + frame.t * (x * length));
        arc += glm::length(now - last);
        last = now;
      }
      EXPECT_NEAR(arc / length, 1.0, 0.01) << share << " turned by " << turn;
      // All directions are alike.
      const glm::vec3 tip = shared::posedPoint(
          shared::poseOfBeam(frame, fit_, 1.0f, bendTo(fit_, length, share, 0.0f)),
          frame.root + frame.t * length);
      EXPECT_NEAR(glm::length(tip - frame.root), glm::length(last - frame.root), 1e-4);
    }
}

TEST_P(BentBeam, TurnsNormalsAsTheSurfaceTurns) {
  const float length = 3.0f, root_radius = 0.06f;
  const shared::BeamFrame frame = anyFrame(length);
  const auto taper = static_cast<float>(GetParam());
  double worst = 0.0;
  for (const float share : {0.1f, 0.5f})
    for (const float turn : {0.0f, 1.1f, 3.0f}) {
      const glm::vec2 amplitudes = bendTo(fit_, length, share, turn);
      const auto at = [&](float x, float around) {
        const float radius = root_radius * glm::mix(1.0f, taper, x);
        const glm::vec3 rest = frame.root + frame.t * (x * length) +
                               radius * (frame.r * std::cos(around) + frame.s * std::sin(around));
        return shared::posedPoint(shared::poseOfBeam(frame, fit_, x, amplitudes), rest);
      };
      for (float x = 0.05f; x < 1.0f; x += 0.05f)
        for (float around = 0.0f; around < 6.2f; around += 0.7f) {
          const float h = 1e-3f;
          const glm::dvec3 true_normal = glm::normalize(
              glm::cross(glm::dvec3(at(x, around + 0.05f)) - glm::dvec3(at(x, around - 0.05f)),
                         glm::dvec3(at(x + h, around)) - glm::dvec3(at(x - h, around))));
          // Of the cone at rest.
          const float slope = root_radius * (1.0f - taper) / length;
          const glm::vec3 rest = glm::normalize(frame.r * std::cos(around) +
                                                frame.s * std::sin(around) + frame.t * slope);
          const glm::dvec3 normal =
              shared::posedVector(shared::poseOfBeam(frame, fit_, x, amplitudes), rest);
          EXPECT_NEAR(glm::length(normal), 1.0, 1e-5);
          worst =
              std::max(worst, std::acos(std::min(std::abs(glm::dot(normal, true_normal)), 1.0)));
        }
    }
  EXPECT_LT(glm::degrees(worst), 2.5);
  RecordProperty("worst_deg", std::to_string(glm::degrees(worst)));
}

TEST_P(BentBeam, DoesNotShear) {
  // Sections stay flat, round and as wide as they were; children keep their shape and their angle.
  const float length = 2.0f;
  const shared::BeamFrame frame = anyFrame(length);
  const glm::vec2 amplitudes = bendTo(fit_, length, 0.5f, 0.9f);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const shared::BeamPose pose = shared::poseOfBeam(frame, fit_, random.uniform(), amplitudes);
    const auto any = [&] {
      return glm::vec3(random.vary(1.0f), random.vary(1.0f), random.vary(1.0f));
    };
    const glm::vec3 p = any(), q = any(), v = any();
    const glm::vec3 moved = shared::posedPoint(pose, p) - shared::posedPoint(pose, q);
    EXPECT_NEAR(glm::length(moved), glm::length(p - q), 2e-6f);
    EXPECT_LT(glm::length(shared::posedVector(pose, p - q) - moved), 3e-6f);
    EXPECT_NEAR(glm::dot(shared::posedVector(pose, v), moved), glm::dot(v, p - q), 5e-6f);
  }
}

TEST_P(BentBeam, RestsWithoutForceToTheBit) {
  const shared::BeamFrame frame = anyFrame(2.0f);
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const shared::BeamPose pose = shared::poseOfBeam(frame, fit_, random.uniform(), {0, 0});
    const glm::vec3 p(random.vary(9.0f), random.vary(9.0f), random.vary(9.0f));
    EXPECT_EQ(shared::posedPoint(pose, p), p);
    EXPECT_EQ(shared::posedVector(pose, p), p);
  }
}

// The theory of large deflections, solved numerically, against the fit with its length correction.
TEST(BentBeam, IsNearTheTheoryOfLargeDeflections) {
  const shared::BeamFrame frame{{0, 0, 0}, 1.0f, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const double taper : {0.2, 0.5, 1.0})
    for (const double tip : {0.1, 0.3, 0.5}) {
      const auto truth = bentBeam(taper, tip, 100);
      const glm::vec2 fit(fitBeam(taper));
      const auto at = [&](float amplitude, float x) {
        const glm::vec3 p = shared::posedPoint(shared::poseOfBeam(frame, fit, x, {amplitude, 0.0f}),
                                               {x, 0.0f, 0.0f});
        return glm::dvec2(p.x, p.y);
      };
      float low = 0.0f, high = 2.0f / shared::beamDeflection(fit, 1.0f);
      for (int i = 0; i < 40; ++i) {
        const float middle = 0.5f * (low + high);
        (at(middle, 1.0f).y < tip ? low : high) = middle;
      }
      double farthest = 0.0;
      for (std::size_t i = 0; i < truth.size(); ++i)
        farthest =
            std::max(farthest, glm::length(truth[i] - at(high, static_cast<float>(i) / 100.0f)));
      printf("taper %g, tip %g: %.4f\n", taper, tip, farthest);
      EXPECT_LT(farthest, tip < 0.2 ? 0.004 : tip < 0.4 ? 0.015 : 0.05);
    }
}

TEST(BentBeam, IsTheLinearBeamForSmallLoads) {
  for (const double taper : {0.2, 0.6, 1.0}) {
    const auto bent = bentBeam(taper, 1e-3, 400);
    const double scale = 1e-3 / beamDeflectionExact(taper, 1.0);
    for (std::size_t i = 0; i < bent.size(); ++i) {
      EXPECT_NEAR(bent[i].y, scale * beamDeflectionExact(taper, bent[i].x), 2e-6) << i;
    }
  }
  EXPECT_THROW(bentBeam(0.5, 0.9), Error);
}

}  // namespace
}  // namespace verdure
