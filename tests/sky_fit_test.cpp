// The harmonics of the sky as polynomials of the sun's angle and of turbidity.
#include "verdure/sky_fit.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cstdlib>

#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "scratch.h"
#include "sky_checks.h"
#include "verdure/error.h"

namespace verdure {
namespace {

const SkyFit& preethamFit() {
  static const SkyFit fit(preethamModel());
  return fit;
}

/// (5.3), the worst of the channels, in kcd/m^2.
double sumOfErrors(const Harmonics& a, const Harmonics& b) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count()); ++i)
    sum += glm::abs(glm::dvec3(a.weights[i]) - glm::dvec3(b.weights[i]));
  return std::max({sum.r, sum.g, sum.b});
}

TEST(SkyFit, KeepsItsErrorBound) {
  const SkyFitErrors errors = measureSkyFit(preethamFit(), preethamModel(), 90, 4);
  EXPECT_LT(errors.maximal[6], 5e-4);
  EXPECT_LT(errors.mean[6], 2.5e-4);
  for (std::size_t n = 1; n < 7; ++n) {
    EXPECT_GE(errors.maximal[n], errors.maximal[n - 1]);
    EXPECT_LE(errors.mean[n], errors.maximal[n]);
  }
  EXPECT_GT(errors.maximal[6], 1e-5);  // it is a fit
  // The darkest sky of the range: the sun on the horizon in haze.
  const Harmonics dark = projectSky(*preethamDaylight(6.0f, fromAngles(90.0, 0.0)).sky, 1);
  EXPECT_NEAR(errors.least_weight,
              std::min({dark.weights[0].r, dark.weights[0].g, dark.weights[0].b}), 1e-4);
}

// Where the fit was never sampled, and turned to any side: plain projection is the truth.
TEST(SkyFit, IsTheProjectionAnywhere) {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const float turbidity = random.uniform(2.5f, 6.0f);
    const glm::vec3 sun =
        fromAngles(double{random.uniform(0.0f, 90.0f)}, double{random.uniform(0.0f, 360.0f)});
    const Harmonics truth = projectSky(*preethamDaylight(turbidity, sun).sky, 7);
    EXPECT_LT(sumOfErrors(preethamFit().at(sun, turbidity), truth), 1.5e-3) << i;
  }
}

// The model's own colours against those that a picture shows.
TEST(SkyFit, IsNearTheClampedSkyWhereTheGamutEnds) {
  const glm::vec3 sun = fromAngles(90.0, 0.0);
  const Harmonics shown = projectSky(*preethamDaylight(2.5f, sun).sky, 7);
  const double error = sumOfErrors(preethamFit().at(sun, 2.5f), shown);
  EXPECT_GT(error, 1e-3);
  EXPECT_LT(error, 4e-3 * 1.825);
}

TEST(SkyFit, DimsInTwilightAsTheModel) {
  const glm::vec3 sun = fromAngles(97.0, 200.0);
  const Harmonics truth = projectSky(*preethamDaylight(3.0f, sun).sky, 7);
  EXPECT_LT(sumOfErrors(preethamFit().at(sun, 3.0f), truth), 1e-3 * double{truth.weights[0].r});
  for (const glm::vec3 way : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0)})
    for (const glm::vec3& w : preethamFit().at(way, 3.0f).weights)
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(w[c]));
}

TEST(SkyFit, OfFewBandsIsThatOfMany) {
  SkyFitOptions options;
  options.bands = 4;
  const SkyFit four(preethamModel(), options);
  const glm::vec3 sun = fromAngles(64.0, 33.0);
  Harmonics seven = preethamFit().at(sun, 4.4f);
  seven.bands = 4;
  EXPECT_LT(sumOfErrors(four.at(sun, 4.4f), seven), 1e-4);
  // The paper: 131 kB and 28 kB.
  EXPECT_LE(preethamFit().coefficients().size_bytes(), 131000u / 3);
  EXPECT_LE(four.coefficients().size_bytes(), 28000u / 1.9);
}

TEST(SkyFit, FitsAnyModel) {
  // Luminance that is itself such a polynomial: exact.
  const SkyModel model = [](float zenith, float) {
    return uniformSky(glm::vec3(1.0f + zenith * zenith, 2.0f, std::cos(zenith)));
  };
  SkyFitOptions options;
  options.bands = 3;
  const SkyFit fit(model, options);
  const SkyFitErrors errors = measureSkyFit(fit, model, 20, 5);
  EXPECT_LT(errors.maximal[2], 1e-4);
}

TEST(SkyFit, DoesNotDependOnThreads) {
  SkyFitOptions options;
  options.bands = 2;
  options.sun_degree = 4;
  options.turbidity_degree = 2;
  const SkyFit all(preethamModel(), options);
  setThreadCount(1);
  const SkyFit one(preethamModel(), options);
  setThreadCount(0);
  EXPECT_TRUE(
      std::equal(all.coefficients().begin(), all.coefficients().end(), one.coefficients().begin()));
}

// The header, compiled as C and run.
TEST(SkyFitHeader, IsTheFit) {
  SkyFitOptions options;
  options.bands = 4;
  options.sun_degree = 6;
  options.turbidity_degree = 3;
  const SkyFit fit(preethamModel(), options);
  const auto folder = scratchFolder("header");
  writeFile(folder / "sky.h", skyFitHeader(fit));
  writeFile(folder / "main.c", std::string(R"(
#include <stdio.h>
#include "sky.h"
int main(void) {
  float w[VERDURE_SKY_BANDS * VERDURE_SKY_BANDS][3];
  int filter, i;
  for (filter = 0; filter < 2; ++filter) {
    verdure_sky_weights(0.9f, 2.2f, 3.3f, filter, w);
    for (i = 0; i < VERDURE_SKY_BANDS * VERDURE_SKY_BANDS; ++i)
      printf("%.9g %.9g %.9g\n", (double)w[i][0], (double)w[i][1], (double)w[i][2]);
  }
  return 0;
}
)"));
  const std::string compile = fmt::format(
      "{} -std=c99 -pedantic -Wall -Wextra -Wconversion -Werror -o {}/main {}/main.c -lm && "
      "{}/main "
      "> {}/out",
      VERDURE_C_COMPILER, folder.string(), folder.string(), folder.string(), folder.string());
  ASSERT_EQ(std::system(compile.c_str()), 0);
  std::ifstream out(folder / "out");
  const Harmonics plain = fit.at(
      {std::sin(0.9f) * std::sin(2.2f), std::cos(0.9f), std::sin(0.9f) * std::cos(2.2f)}, 3.3f);
  for (const Harmonics& h : {plain, withoutRinging(plain)})
    for (std::size_t i = 0; i < 16; ++i)
      for (int c = 0; c < 3; ++c) {
        float got = NAN;
        out >> got;
        EXPECT_NEAR(got, h.weights[i][c], 2e-5f * h.weights[0][c]) << i;
      }
}

TEST(SkyFit, RefusesWhatIsOutOfRange) {
  const auto fitWith = [](auto change) {
    SkyFitOptions options;
    change(options);
    return SkyFit(preethamModel(), options);
  };
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.bands = 8; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.bands = 0; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.sun_degree = 0; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.turbidity_degree = 32; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.turbidity_min = 1.5f; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.turbidity_max = 2.0f; }), Error);
  EXPECT_THROW(fitWith([](SkyFitOptions& o) { o.turbidity_max = NAN; }), Error);
  EXPECT_THROW(preethamFit().at({0, 1, 0}, 6.01f), Error);
  EXPECT_THROW(preethamFit().at({0, 1, 0}, NAN), Error);
}

}  // namespace
}  // namespace verdure
