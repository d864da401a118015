// Models of the sky and the sun.
#include "verdure/sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shared/sky_formula.h"
#include "sky/preetham.h"
#include "sky_checks.h"
#include "verdure/error.h"

namespace verdure {
namespace {

using nlohmann::json;

constexpr double kPi = glm::pi<double>();

TEST(PreethamSky, HasTheReferenceColours) {
  ASSERT_EQ(skyReference()["radiance"].size(), 96u);
  for (const json& row : skyReference()["radiance"]) {
    for (const double turn : {0.0, 77.0, 290.0}) {
      const shared::SkyFormula formula =
          preethamFormula(row[0].get<float>(), fromAngles(row[1].get<double>(), turn));
      const glm::vec3 direction = fromAngles(row[2].get<double>(), turn + row[3].get<double>());
      const glm::vec3 color = shared::skyColorUnclamped(direction, formula);
      for (int i = 0; i < 3; ++i) {
        const double expected = row[4 + static_cast<std::size_t>(i)].get<double>();
        EXPECT_NEAR(color[i], expected, 1e-4 * std::abs(expected)) << row.dump();
      }
      const glm::vec3 luminance = shared::skyLuminance(direction, formula);
      EXPECT_EQ(luminance, glm::max(color, glm::vec3(0.0f)));
    }
  }
}

TEST(PreethamSky, IsFiniteAndNeverNegative) {
  for (float turbidity = 2.0f; turbidity <= 10.0f; turbidity += 1.0f)
    for (double sun = 0.0; sun <= 180.0; sun += 7.5) {
      const Daylight light = preethamDaylight(turbidity, fromAngles(sun, 40.0));
      for (double zenith = 0.0; zenith <= 180.0; zenith += 5.0)
        for (double azimuth = 0.0; azimuth < 360.0; azimuth += 20.0) {
          const glm::vec3 direction = fromAngles(zenith, azimuth);
          const glm::vec3 color = light.sky->luminance(direction);
          for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(std::isfinite(color[i]));
            ASSERT_GE(color[i], 0.0f);
            ASSERT_LT(color[i], 1000.0f);
          }
          if (direction.y < 0.0f) {
            ASSERT_EQ(color, glm::vec3(0.0f));
          }
        }
    }
}

TEST(PreethamSky, DoesNotJumpAsTheSunSets) {
  for (const float turbidity : {2.0f, 4.0f, 10.0f}) {
    double above = skyIlluminance(*preethamDaylight(turbidity, fromAngles(89.99, 0.0)).sky);
    const double below = skyIlluminance(*preethamDaylight(turbidity, fromAngles(90.01, 0.0)).sky);
    EXPECT_NEAR(below, above, 0.03 * above);
    for (double depth = 0.5; depth < 60.0; depth += 0.5) {
      const double now =
          skyIlluminance(*preethamDaylight(turbidity, fromAngles(90.0 + depth, 0.0)).sky);
      EXPECT_LT(now, above);
      EXPECT_GT(now, 0.6 * above);
      above = now;
    }
  }
  EXPECT_LT(skyIlluminance(*preethamDaylight(3.0f, {0, -1, 0}).sky), 1e-20);
}

TEST(PreethamSky, RefusesWhatIsNoSky) {
  for (const float turbidity : {1.9f, 10.1f, -1.0f, NAN, INFINITY})
    EXPECT_THROW(preethamDaylight(turbidity, {0, 1, 0}), Error) << turbidity;
  for (const float y : {0.0f, NAN, INFINITY})
    EXPECT_THROW(preethamDaylight(3.0f, {0, y, 0}), Error) << y;
  EXPECT_EQ(preethamDaylight(3.0f, {0, 5, 0}).sun.direction, glm::vec3(0, 1, 0));
}

// Gueymard and others: a clear sea-level noon has 95 to 110 klx facing the sun; outside of the air
// 133 klx (ASTM E490).
TEST(SunLight, HasTheMagnitudeOfDaylight) {
  const double noon = photometric(preethamDaylight(2.5f, {0, 1, 0}).sun.illuminance());
  EXPECT_GT(noon, 90.0);
  EXPECT_LT(noon, 110.0);
  double above = noon;
  for (double zenith = 5.0; zenith <= 90.0; zenith += 5.0) {
    const Sun sun = preethamDaylight(2.5f, fromAngles(zenith, 120.0)).sun;
    const double now = photometric(sun.illuminance());
    EXPECT_LT(now, above) << zenith;
    above = now;
    // The lower the redder.
    EXPECT_GT(sun.luminance.r, sun.luminance.g);
    EXPECT_GE(sun.luminance.g, sun.luminance.b);
  }
  EXPECT_LT(above, 5.0);
  EXPECT_GT(above, 0.0);
  EXPECT_LT(photometric(preethamDaylight(6.0f, {0, 1, 0}).sun.illuminance()), 0.9 * noon);
}

TEST(SunLight, SetsAsADisk) {
  const double radius_deg = glm::degrees(double{Sun::kAngularRadius});
  const auto at = [](double elevation_deg) {
    return photometric(
        sunLuminance(3.0f, static_cast<float>(glm::radians(elevation_deg)), Sun::kAngularRadius));
  };
  EXPECT_NEAR(at(-0.5 * radius_deg) / at(0.0), 2.0 * (1.0 / 3.0 - std::sqrt(3.0) / (4.0 * kPi)),
              1e-4);
  EXPECT_EQ(at(-1.001 * radius_deg), 0.0);
  EXPECT_EQ(at(-90.0), 0.0);
}

TEST(SunLight, FacingSurfaceGetsTheDisksSolidAngle) {
  Sun sun;
  sun.luminance = glm::vec3(1000.0f, 2000.0f, 3000.0f);
  // Integral of cos over the disk, by rings.
  double sum = 0.0;
  constexpr int kRings = 1000;
  for (int i = 0; i < kRings; ++i) {
    const double t = double{sun.angular_radius} * (i + 0.5) / kRings;
    sum += std::cos(t) * std::sin(t) * 2.0 * kPi * double{sun.angular_radius} / kRings;
  }
  EXPECT_NEAR(sun.illuminance().g, 2000.0 * sum, 1e-6);
}

TEST(UniformSky, IsUniform) {
  const auto sky = uniformSky({1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(sky->luminance({0, 1, 0}), glm::vec3(1, 2, 3));
  EXPECT_EQ(sky->luminance({0, -1, 0}), glm::vec3(4, 5, 6));
  EXPECT_NEAR(skyIlluminance(*uniformSky(glm::vec3(2.0f))), 2.0 * kPi, 1e-3);
  EXPECT_EQ(sky->formula(), nullptr);
}

}  // namespace
}  // namespace verdure
