// Spherical harmonics: their convention, closed forms and projections of skies.
#include "verdure/harmonics.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "shared/sh.h"
#include "sky/harmonic_basis.h"
#include "sky/quadrature.h"
#include "sky_checks.h"
#include "verdure/error.h"

namespace verdure {
namespace {

constexpr double kPi = glm::pi<double>();

std::array<float, 49> valuesAt(const glm::vec3& direction) {
  std::array<float, 49> values{};
  harmonicsAt(direction, 7, values.data());
  return values;
}

TEST(GaussLegendre, IntegratesPolynomials) {
  for (const int count : {1, 2, 7, 64, 500}) {
    const auto nodes = gaussLegendre(count);
    for (const int degree : {0, 1, 2 * count - 1}) {
      double sum = 0.0;
      for (const QuadratureNode& n : nodes) sum += n.weight * std::pow(n.x, degree);
      EXPECT_NEAR(sum * (degree + 1), 1.0, 1e-12) << count << ' ' << degree;
    }
  }
}

TEST(Harmonics, HaveTheStatedConvention) {
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, 0.5f, -0.8f));  // world
  const glm::vec3 s = shared::shFromWorld(d);
  EXPECT_EQ(s, glm::vec3(d.z, d.x, d.y));
  EXPECT_EQ(shared::worldFromSh(s), d);
  const auto y = valuesAt(d);
  const double first = std::sqrt(3.0 / (4.0 * kPi));
  EXPECT_NEAR(y[0], 0.5 / std::sqrt(kPi), 1e-6);
  EXPECT_NEAR(y[1], first * d.x, 1e-6);
  EXPECT_NEAR(y[2], first * d.y, 1e-6);
  EXPECT_NEAR(y[3], first * d.z, 1e-6);
  EXPECT_NEAR(y[4], 0.5 * std::sqrt(15.0 / kPi) * s.x * s.y, 1e-6);
  EXPECT_NEAR(y[6], 0.25 * std::sqrt(5.0 / kPi) * (3.0 * s.z * s.z - 1.0), 1e-6);
  EXPECT_NEAR(y[8], 0.25 * std::sqrt(15.0 / kPi) * (s.x * s.x - s.y * s.y), 1e-6);
  // Written out in books for l = 3 and 4.
  EXPECT_NEAR(y[9], 0.25 * std::sqrt(35.0 / (2.0 * kPi)) * s.y * (3.0 * s.x * s.x - s.y * s.y),
              1e-6);
  EXPECT_NEAR(y[16], 0.75 * std::sqrt(35.0 / kPi) * s.x * s.y * (s.x * s.x - s.y * s.y), 1e-6);
}

// Gauss-Legendre of 16 nodes times 32 azimuths integrates products of degree 12 exactly.
TEST(Harmonics, AreOrthonormal) {
  const auto nodes = gaussLegendre(16);
  std::array<std::array<double, 49>, 49> gram{};
  for (const QuadratureNode& n : nodes)
    for (int j = 0; j < 32; ++j) {
      const double up = 2.0 * n.x - 1.0, across = std::sqrt(1.0 - up * up);
      const double a = 2.0 * kPi * j / 32;
      std::array<double, 49> y{};
      harmonicsOf(across * std::cos(a), across * std::sin(a), up, 7, y.data());
      for (std::size_t p = 0; p < 49; ++p)
        for (std::size_t q = 0; q < 49; ++q)
          gram[p][q] += y[p] * y[q] * 2.0 * n.weight * 2.0 * kPi / 32;
    }
  for (std::size_t p = 0; p < 49; ++p)
    for (std::size_t q = 0; q < 49; ++q) EXPECT_NEAR(gram[p][q], p == q ? 1.0 : 0.0, 1e-12);
}

// The addition theorem: over each band the products sum to a Legendre polynomial of the angle.
TEST(Harmonics, AddUpByBands) {
  const glm::vec3 a = fromAngles(33.0, 70.0), b = fromAngles(118.0, -20.0);
  const auto ya = valuesAt(a), yb = valuesAt(b);
  const double t = double{glm::dot(a, b)};
  for (std::size_t l = 0; l < 7; ++l) {
    double sum = 0.0;
    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) sum += double{ya[i]} * double{yb[i]};
    EXPECT_NEAR(sum,
                (2.0 * static_cast<double>(l) + 1.0) / (4.0 * kPi) *
                    std::legendre(static_cast<unsigned>(l), t),
                2e-6);
  }
}

TEST(ProjectSky, HasTheReferenceWeights) {
  ASSERT_EQ(skyReference()["harmonics"].size(), 3u);
  for (const auto& row : skyReference()["harmonics"]) {
    const Daylight light = preethamDaylight(row["turbidity"].get<float>(),
                                            fromAngles(row["sun_zenith_deg"].get<double>(), 0.0));
    const Harmonics h = projectSky(*light.sky, row["bands"].get<int>());
    for (std::size_t i = 0; i < row["rgb"].size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double expected = row["rgb"][i][static_cast<std::size_t>(c)].get<double>();
        // The reference's own quadrature is good to 1.2e-4 of some of the small weights.
        const double mean = row["rgb"][0][static_cast<std::size_t>(c)].get<double>();
        EXPECT_NEAR(h.weights[i][c], expected, 5e-5 * mean) << "weight " << i << ", channel " << c;
      }
  }
}

TEST(ProjectSky, AgreesWithBruteForce) {
  const Daylight light = preethamDaylight(3.5f, fromAngles(50.0, 130.0));
  const Harmonics h = projectSky(*light.sky, 7);
  for (const std::size_t i : {0u, 1u, 3u, 6u, 11u, 24u, 30u, 42u, 48u}) {
    const auto sum = sphereIntegral<glm::dvec3>(400, [&](const glm::dvec3& d) {
      return glm::dvec3(light.sky->luminance(glm::vec3(d))) * double{valuesAt(glm::vec3(d))[i]};
    });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(h.weights[i][c], sum[c], 4e-3) << i;
  }
}

TEST(ProjectSky, OfAUniformSkyIsTheClosedForm) {
  const Harmonics all = projectSky(*uniformSky(glm::vec3(2.0f), glm::vec3(2.0f)), 7);
  EXPECT_NEAR(all.weights[0].g, 2.0 * std::sqrt(4.0 * kPi), 1e-5);
  for (std::size_t i = 1; i < 49; ++i) EXPECT_NEAR(all.weights[i].g, 0.0, 1e-6);
  // Upper and lower half together.
  const Harmonics above = projectSky(*uniformSky(glm::vec3(2.0f)), 7);
  const Harmonics below = groundHarmonics(glm::vec3(2.0f), 7);
  for (std::size_t i = 0; i < 49; ++i)
    EXPECT_NEAR(above.weights[i].r + below.weights[i].r, all.weights[i].r, 2e-6) << i;
}

TEST(ProjectSky, RefusesBands) {
  const auto sky = uniformSky(glm::vec3(1.0f));
  for (const int bands : {0, -1, 8}) EXPECT_THROW(projectSky(*sky, bands), Error);
  EXPECT_EQ(projectSky(*sky, 1).count(), 1);
}

TEST(ProjectSky, DoesNotDependOnThreads) {
  const Daylight light = preethamDaylight(3.0f, fromAngles(40.0, 10.0));
  const Harmonics all = projectSky(*light.sky, 7);
  setThreadCount(1);
  const Harmonics one = projectSky(*light.sky, 7);
  setThreadCount(0);
  EXPECT_EQ(all.weights, one.weights);
}

TEST(DiskHarmonics, AreThoseOfTheDisk) {
  // A wide disk, summed over the sphere.
  const glm::vec3 center = fromAngles(55.0, 200.0);
  const float radius = 0.4f;
  const Harmonics h = diskHarmonics(center, radius, {1, 2, 3}, 7);
  for (std::size_t i = 0; i < 49; ++i) {
    const auto sum = sphereIntegral<double>(500, [&](const glm::dvec3& d) {
      if (glm::dot(d, glm::dvec3(center)) < std::cos(double{radius})) return 0.0;
      return double{valuesAt(glm::vec3(d))[i]};
    });
    EXPECT_NEAR(h.weights[i].g, 2.0 * sum, 2e-3) << i;
  }
  // The sun: as good as a point.
  Sun sun;
  sun.direction = center;
  sun.luminance = glm::vec3(1e6f);
  const Harmonics point = diskHarmonics(center, sun.angular_radius, sun.luminance, 7);
  const auto y = valuesAt(center);
  for (std::size_t i = 0; i < 49; ++i)
    EXPECT_NEAR(point.weights[i].r, sun.illuminance().r * y[i], 2e-4 * sun.illuminance().r);
}

TEST(Turned, IsTheProjectionOfTheTurnedSky) {
  for (const double turn : {30.0, 155.0, -100.0}) {
    const Harmonics still = projectSky(*preethamDaylight(3.0f, fromAngles(60.0, 15.0)).sky, 7);
    const Harmonics moved =
        projectSky(*preethamDaylight(3.0f, fromAngles(60.0, 15.0 + turn)).sky, 7);
    const Harmonics h = turned(still, static_cast<float>(glm::radians(turn)));
    const glm::vec3 view = fromAngles(35.0, 80.0);
    const glm::vec3 back = fromAngles(35.0, 80.0 - turn);
    EXPECT_NEAR(valueAt(h, view).g, valueAt(still, back).g, 2e-5 * valueAt(still, back).g);
    for (std::size_t i = 0; i < 49; ++i)
      EXPECT_NEAR(h.weights[i].b, moved.weights[i].b, 2e-4 * moved.weights[0].b) << i;
  }
}

TEST(WithoutRinging, FiltersZonalWeightsOnly) {
  const Harmonics h = projectSky(*preethamDaylight(4.0f, fromAngles(70.0, 40.0)).sky, 6);
  const Harmonics f = withoutRinging(h);
  for (std::size_t l = 0; l < 6; ++l)
    for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) {
      const double x = kPi * static_cast<double>(l) / 6.0;
      const double factor = i == l * l + l && l > 0 ? std::sin(x) / x : 1.0;
      EXPECT_NEAR(f.weights[i].r, h.weights[i].r * factor, 1e-6 * std::abs(h.weights[0].r));
    }
  // A step at the horizon: the filtered harmonics neither overshoot nor swing back below.
  const auto range = [](const Harmonics& g) {
    glm::vec2 least_most(1e9f, -1e9f);
    for (double zenith = 0.0; zenith <= 180.0; zenith += 1.0) {
      const float v = valueAt(g, fromAngles(zenith, 0.0)).g;
      least_most = {std::min(least_most.x, v), std::max(least_most.y, v)};
    }
    return least_most;
  };
  const Harmonics step = projectSky(*uniformSky(glm::vec3(1.0f)), 7);
  EXPECT_LT(range(step).x, -0.08f);
  EXPECT_GT(range(step).y, 1.08f);
  EXPECT_GT(range(withoutRinging(step)).x, -0.04f);
  EXPECT_LT(range(withoutRinging(step)).y, 1.04f);
}

// A surface that faces n under a light from everywhere, by brute force.
TEST(IrradianceHarmonics, AreThoseOfTheCosine) {
  const glm::vec3 luminance(1.5f);
  const auto furnace = projectSky(*uniformSky(luminance, luminance), 7);
  EXPECT_NEAR(valueAt(irradianceHarmonics(furnace), fromAngles(77.0, 12.0)).r, 1.5 * kPi, 1e-5);
  const Daylight light = preethamDaylight(3.0f, fromAngles(45.0, 60.0));
  const Harmonics h = projectSky(*light.sky, 7);
  const Harmonics e = irradianceHarmonics(h);
  for (const glm::vec3 n : {fromAngles(0.0, 0.0), fromAngles(60.0, 60.0), fromAngles(100.0, 0.0)}) {
    const auto truth = sphereIntegral<glm::dvec3>(200, [&](const glm::dvec3& d) {
      return glm::dvec3(light.sky->luminance(glm::vec3(d))) *
             std::max(glm::dot(d, glm::dvec3(n)), 0.0);
    });
    const glm::vec3 got = valueAt(e, n);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], truth[c], 0.01 * truth[c]);
    // The shaders' nine weights.
    glm::vec4 weights[9];
    for (std::size_t i = 0; i < 9; ++i) weights[i] = glm::vec4(e.weights[i], 0.0f);
    const glm::vec3 shader = shared::shIrradiance(n, weights);
    Harmonics three = e;
    three.bands = 3;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shader[c], valueAt(three, n)[c], 1e-4f);
  }
  // The cosine lobe's own weights, integrated: projected on the zenith's harmonics.
  for (int l = 0; l < 7; ++l) {
    double sum = 0.0;
    for (const QuadratureNode& q : gaussLegendre(32))
      sum += q.weight * 2.0 * kPi * q.x * std::legendre(static_cast<unsigned>(l), q.x);
    Harmonics one;
    one.bands = 7;
    const auto i = static_cast<std::size_t>(l * l + l);
    one.weights[i] = glm::vec3(1.0f);
    EXPECT_NEAR(irradianceHarmonics(one).weights[i].r, sum, 1e-6) << l;
  }
}

TEST(LevelIlluminance, IsTheIntegral) {
  for (const double zenith : {10.0, 60.0, 88.0}) {
    const Daylight light = preethamDaylight(4.0f, fromAngles(zenith, 20.0));
    const double truth = skyIlluminance(*light.sky);
    EXPECT_NEAR(photometric(levelIlluminance(projectSky(*light.sky, 2))), truth, 2e-3 * truth);
  }
  const Harmonics sun = diskHarmonics(fromAngles(60.0, 0.0), 0.01f, glm::vec3(1e4f), 3);
  EXPECT_NEAR(levelIlluminance(sun).r, 0.5 * 1e4 * kPi * std::pow(std::sin(0.01), 2.0), 1e-4);
}

}  // namespace
}  // namespace verdure
