// verdure sky and figures sky, as their user meets them.
#include <glm/gtc/constants.hpp>

#include "command_line.h"
#include "sky_checks.h"
#include "verdure/harmonics.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

Harmonics weightsOf(const Json& said) {
  Harmonics h;
  h.bands = said["bands"].get<int>();
  for (std::size_t i = 0; i < said["harmonics"].size(); ++i)
    for (int c = 0; c < 3; ++c)
      h.weights[i][c] = said["harmonics"][i][static_cast<std::size_t>(c)].get<float>();
  return h;
}

TEST_F(CommandLine, SkySaysWhatTheLibraryKnows) {
  const Json said = Json::parse(
      runWell({"sky", "--turbidity", "3.5", "--sun", "120,35", "--bands", "5", "--json"}));
  const Daylight light = preethamDaylight(3.5f, fromAngles(55.0, 120.0));
  const Harmonics truth = projectSky(*light.sky, 5), h = weightsOf(said);
  ASSERT_EQ(said["harmonics"].size(), 25u);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(h.weights[i].g, truth.weights[i].g, 1e-4f) << i;
  EXPECT_NEAR(said["sun"]["facing_illuminance_klx"].get<double>(),
              photometric(light.sun.illuminance()), 1e-2);
  EXPECT_NEAR(said["sky"]["level_illuminance_klx"].get<double>(), skyIlluminance(*light.sky), 0.05);
  // (5.5) touches the zonal weights alone.
  const Harmonics filtered = weightsOf(Json::parse(runWell(
      {"sky", "--turbidity", "3.5", "--sun", "120,35", "--bands", "5", "--filter", "--json"})));
  EXPECT_EQ(filtered.weights[0], h.weights[0]);
  EXPECT_EQ(filtered.weights[3], h.weights[3]);
  const double x = glm::pi<double>() / 5.0;
  EXPECT_NEAR(filtered.weights[2].r, h.weights[2].r * std::sin(x) / x, 1e-4);
}

TEST_F(CommandLine, SkyFindsTheSunByDateAndPlace) {
  const Json said = Json::parse(runWell(
      {"sky", "--date", "2003-10-17T12:30:30-07:00", "--place", "39.742476,-105.1786", "--json"}));
  EXPECT_NEAR(said["sun"]["elevation_deg"].get<double>(), 90.0 - 50.11162, 0.05);
  EXPECT_NEAR(said["sun"]["azimuth_deg"].get<double>(), 180.0 - 194.34024, 0.05);
}

TEST_F(CommandLine, SkyDraws) {
  runWell(
      {"sky", "--sun", "0,50", "--image", path("a.exr"), "--dome", "panorama", "--size", "128"});
  const HdrImage image = readHdrImage(path("a.exr"));
  ASSERT_EQ(image.width, 256);
  ASSERT_EQ(image.height, 128);
  const auto sky = preethamDaylight(3.0f, fromAngles(40.0, 0.0)).sky;
  // Column 0 is south and a little west; row 40 stands 56.95 degrees from the zenith.
  const glm::vec3 expected = sky->luminance(fromAngles(180.0 * 40.5 / 128, -180.0 * 0.5 / 128));
  EXPECT_NEAR(image.at(0, 40).g, expected.g, 1e-3f * expected.g);
  EXPECT_EQ(image.at(9, 100), glm::vec3(0.0f));
  // That panorama as a sky gives the same light again.
  const Json first = Json::parse(runWell({"sky", "--sun", "0,50", "--json"}));
  const Json again = Json::parse(runWell({"sky", "--model", path("a.exr"), "--json"}));
  const double klx = first["sky"]["level_illuminance_klx"].get<double>();
  EXPECT_NEAR(again["sky"]["level_illuminance_klx"].get<double>(), klx, 0.02 * klx);

  runWell({"sky", "--sun", "90,20", "--image", path("a.png"), "--size", "64"});
  const Image png = readImage(path("a.png"));
  ASSERT_EQ(png.width, 64);
  EXPECT_EQ(png.at(0, 0)[0], 0);                    // outside of the dome
  EXPECT_GT(png.at(12, 32)[0], png.at(52, 32)[0]);  // east is at left
  EXPECT_GT(png.at(32, 32)[2], png.at(32, 32)[0]);  // blue overhead
}

TEST_F(CommandLine, SkyOfTheCie) {
  const Json said = Json::parse(
      runWell({"sky", "--model", "cie:5", "--illuminance", "10", "--bands", "3", "--json"}));
  EXPECT_NEAR(said["sky"]["level_illuminance_klx"].get<double>(), 10.0, 0.01);
  EXPECT_NEAR(said["harmonics"][0][1].get<double>(), 10.0 / std::sqrt(glm::pi<double>()), 0.02);
}

TEST_F(CommandLine, SkyEmitsItsFit) {
  runWell({"sky", "--bands", "2", "--emit-header", path("sky.h")});
  const std::string header = textOf(path("sky.h"));
  EXPECT_NE(header.find("#define VERDURE_SKY_BANDS 2\n"), std::string::npos);
  EXPECT_NE(header.find("static void verdure_sky_weights("), std::string::npos);
}

TEST_F(CommandLine, SkyReports) {
  runWell({"sky", "--bands", "2", "--report", path("report")});
  const Json report = jsonOf(path("report/report.json"));
  ASSERT_EQ(report["errors"].size(), 2u);
  EXPECT_LT(report["errors"][1]["maximal"].get<double>(), 5e-4);
  const std::string page = textOf(path("report/index.html"));
  for (const char* name : {"figure53a.png", "figure53b.png", "figure53c.png", "figure54.svg",
                           "figure55a.png", "figure55b.png", "figure55c.svg"}) {
    EXPECT_TRUE(fs::exists(path("report") + std::string("/") + name)) << name;
    EXPECT_NE(page.find(name), std::string::npos) << name;
  }
}

TEST_F(CommandLine, SkyRefusesInOneLine) {
  HdrImage square(8, 8);
  writeExr(square, path("square.exr"));
  writeFile(path("broken.hdr"), std::string("#?RADIANCE\nno picture"));
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--turbidity", "11"}, "turbidity: 11 is outside of [2, 10]"},
      {{"--turbidity", "nan"}, "turbidity"},
      {{"--sun", "10,-3"}, "below the horizon"},
      {{"--sun", "10,91"}, "above the zenith"},
      {{"--sun", "10"}, "--sun"},
      {{"--bands", "8"}, "--bands: 8 is outside of [1, 7]"},
      {{"--bands", "0"}, "--bands"},
      {{"--sun", "1,2", "--date", "2026-06-21T12:00Z", "--place", "1,2"}, "beside --date"},
      {{"--date", "2026-06-21T12:00Z"}, "stands alone"},
      {{"--place", "1,2"}, "stands alone"},
      {{"--date", "yesterday", "--place", "1,2"}, "'yesterday'"},
      {{"--date", "2026-06-21T12:00Z", "--place", "91,2"}, "not on Earth"},
      {{"--date", "2026-06-21T00:00Z", "--place", "48,16"}, "it rises at 2026-06-2"},
      {{"--date", "2026-12-21T12:00Z", "--place", "80,16"}, "does not rise"},
      {{"--model", "cie:16"}, "no type 16"},
      {{"--model", "cie:x"}, "names no CIE sky"},
      {{"--model", "hosek"}, "is no model"},
      {{"--model", path("none.hdr")}, "none.hdr"},
      {{"--model", path("broken.hdr")}, "broken.hdr"},
      {{"--model", path("square.exr")}, "no panorama"},
      {{"--model", "cie:1", "--emit-header", path("x.h")}, "only preetham is fitted"},
      {{"--model", "cie:1", "--illuminance", "-1"}, "klx"},
      {{"--image", path("x.jpg")}, "x.jpg"},
      {{"--dome", "cube"}, "--dome"},
      {{"--size", "3"}, "--size"},
      {{"--emit-header", path("no/x.h")}, "x.h"},
  };
  for (const auto& [options, says] : cases) {
    Words words = {"sky"};
    words.insert(words.end(), options.begin(), options.end());
    SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
    expectRefused(words, {says});
  }
}

}  // namespace
}  // namespace verdure::test
