// Models of the sky and the sun.
#include "verdure/sky.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shared/sky_formula.h"
#include "sky/preetham.h"
#include "sky_checks.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"

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

// Luminance over the zenith's, by the standard's own formula.
double cieRatio(double a, double b, double c, double d, double e, const glm::vec3& view,
                const glm::vec3& sun) {
  const auto gradation = [&](double up) { return 1.0 + a * std::exp(b / up); };
  const auto indicatrix = [&](double angle) {
    return 1.0 + c * (std::exp(d * angle) - std::exp(d * kPi / 2.0)) +
           e * std::cos(angle) * std::cos(angle);
  };
  return gradation(double{view.y}) * indicatrix(std::acos(double{glm::dot(view, sun)})) /
         (gradation(1.0) * indicatrix(std::acos(double{sun.y})));
}

TEST(CieSky, HasTheStandardsDistributions) {
  const glm::vec3 sun = fromAngles(50.0, 20.0);
  const struct {
    int type;
    double a, b, c, d, e;
  } rows[] = {{1, 4.0, -0.7, 0, -1, 0},
              {5, 0, -1, 0, -1, 0},
              {8, 0, -1, 10, -3, 0.45},
              {12, -1, -0.32, 10, -3, 0.45},
              {15, -1, -0.15, 24, -2.8, 0.15}};
  for (const auto& r : rows) {
    const auto sky = cieSky(r.type, sun);
    const glm::vec3 zenith = sky->luminance({0, 1, 0});
    EXPECT_NEAR(zenith.r, zenith.g, 2e-3 * zenith.g);  // white
    EXPECT_NEAR(zenith.b, zenith.g, 2e-3 * zenith.g);
    for (const glm::vec3 view : {fromAngles(20, 300), fromAngles(70, 15), fromAngles(88, 190)})
      EXPECT_NEAR(photometric(sky->luminance(view)) / photometric(zenith),
                  cieRatio(r.a, r.b, r.c, r.d, r.e, view, sun), 2e-4)
          << r.type;
    ASSERT_NE(sky->formula(), nullptr);
  }
  // Moon and Spencer's overcast sky, which type 1 replaced, is near: 1 to 3 from horizon to zenith.
  const auto overcast = cieSky(1, sun);
  EXPECT_NEAR(overcast->luminance({0, 1, 0}).g / overcast->luminance({0, 0, 1}).g, 3.0, 0.03);
}

TEST(CieSky, GivesTheIlluminance) {
  for (int type = 1; type <= 15; ++type) {
    const glm::vec3 sun = fromAngles(40.0, 100.0);
    EXPECT_NEAR(skyIlluminance(*cieSky(type, sun, 12.5f)), 12.5, 0.03) << type;
    const double usual = double{cieIlluminance(type, glm::radians(50.0f))};
    EXPECT_NEAR(skyIlluminance(*cieSky(type, sun)), usual, 3e-3 * usual);
  }
  EXPECT_NEAR(cieSky(5, {0, 1, 0}, 10.0f)->luminance(fromAngles(60, 0)).g, 10.0 / kPi, 3e-3);
  for (const int type : {0, 16, -3}) EXPECT_THROW(cieSky(type, {0, 1, 0}), Error);
  for (const float klx : {-1.0f, NAN, INFINITY}) EXPECT_THROW(cieSky(3, {0, 1, 0}, klx), Error);
  EXPECT_THROW(cieSky(3, {0, 0, 0}), Error);
}

/// A panorama of a sky.
HdrImage panorama(const Sky& sky, int height) {
  HdrImage image(2 * height, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x)
      // North in the middle, east at right: azimuths from the south towards the east fall.
      image.at(x, y) =
          sky.luminance(fromAngles(180.0 * (y + 0.5) / height, 360.0 - 180.0 * (x + 0.5) / height));
  return image;
}

TEST(ImageSky, IsThePicture) {
  const auto model = preethamDaylight(3.0f, fromAngles(50.0, 30.0)).sky;
  const auto sky = imageSky(panorama(*model, 256));
  for (const glm::vec3 d : {fromAngles(20, 5), fromAngles(60, 100), fromAngles(75, 250)})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(sky->luminance(d)[c], model->luminance(d)[c], 2e-3 * model->luminance(d)[c]);
  EXPECT_NEAR(skyIlluminance(*sky), skyIlluminance(*model), 5e-3 * skyIlluminance(*model));
  const auto turned = imageSky(panorama(*model, 256), glm::radians(40.0f), 2.0f);
  EXPECT_NEAR(turned->luminance(fromAngles(60, 140)).g,
              2.0f * sky->luminance(fromAngles(60, 100)).g, 1e-3f);
  EXPECT_EQ(sky->luminance(fromAngles(95, 0)), glm::vec3(0.0f));
  // Across the seam (south) there is no jump.
  EXPECT_NEAR(sky->luminance(fromAngles(60, 0.01)).g, sky->luminance(fromAngles(60, -0.01)).g,
              1e-2f);
}

TEST(ImageSky, ShowsEachPixelToTheProjection) {
  // One bright pixel of a fine picture: its solid angle times its luminance.
  HdrImage image(1024, 512);
  image.at(100, 150) = glm::vec3(1e6f);
  const double zenith = kPi * 150.5 / 512;
  const double light = 1e6 * (2.0 * kPi / 1024) * (kPi / 512) * std::sin(zenith);
  EXPECT_NEAR(levelIlluminance(projectSky(*imageSky(image), 2)).g, light * std::cos(zenith),
              0.03 * light);
}

TEST(ImageSky, RefusesBadPictures) {
  EXPECT_THROW(imageSky(HdrImage()), Error);
  EXPECT_THROW(imageSky(HdrImage(64, 64)), Error);
  EXPECT_THROW(imageSky(HdrImage(64, 32), NAN), Error);
  EXPECT_THROW(imageSky(HdrImage(64, 32), 0.0f, -1.0f), Error);
  HdrImage image(64, 32);
  image.at(5, 3).g = NAN;
  try {
    imageSky(image);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(),
                 "sky image: the pixel at 5, 3 is not finite; mend it, or save the picture again");
  }
}

}  // namespace
}  // namespace verdure
