// reference and compare as their user meets them.
#include "command_line.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

class CommandLineReference : public CommandLine {
 protected:
  std::string file(const std::string& name, int width, int height, int level) const {
    Image image(width, height);
    std::fill(image.rgba.begin(), image.rgba.end(), static_cast<std::uint8_t>(level));
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    writePng(image, path(name));
    return path(name);
  }
  std::string hdrFile(const std::string& name, float level) const {
    HdrImage image(16, 12);
    std::fill(image.rgb.begin(), image.rgb.end(), glm::vec3(level));
    writeExr(image, path(name));
    return path(name);
  }
};

TEST_F(CommandLineReference, ComparesTwoImages) {
  const std::string a = file("a.png", 16, 12, 100), b = file("b.png", 16, 12, 110);
  const Json json = Json::parse(runWell({"compare", a, b, "--json", "--heatmap", path("h.png")}));
  EXPECT_EQ(json["width"], 16);
  EXPECT_NEAR(json["psnr"].get<double>(), 20.0 * std::log10(255.0 / 10.0), 1e-6);
  EXPECT_GT(json["flip"], 0.0);
  EXPECT_LT(json["ssim"], 1.0);
  EXPECT_EQ(readImage(path("h.png")).height, 12);
  const Json same = Json::parse(runWell({"compare", a, a, "--json", "--metric", "psnr,flip"}));
  EXPECT_EQ(same["psnr"], "inf");
  EXPECT_EQ(same["flip"], 0.0);
  EXPECT_FALSE(same.contains("ssim"));
}

TEST_F(CommandLineReference, ComparesHdrImages) {
  const std::string a = hdrFile("a.exr", 4.0f), b = hdrFile("b.exr", 3.0f);
  const Json json = Json::parse(runWell({"compare", a, b, "--json", "--peak", "10"}));
  EXPECT_NEAR(json["psnr"].get<double>(), 20.0, 1e-6);
  EXPECT_GE(json["exposures"]["count"], 2);
}

TEST_F(CommandLineReference, TellsByItsExitCodeWhatIsWorse) {
  const std::string a = file("a.png", 16, 12, 100), b = file("b.png", 16, 12, 110);  // 28.1 dB
  EXPECT_EQ(run({"compare", a, b, "--metric", "psnr", "--threshold", "28"}).code, 0);
  EXPECT_EQ(run({"compare", a, b, "--metric", "psnr", "--threshold", "29"}).code, 1);
  EXPECT_EQ(run({"compare", a, b, "--metric", "flip", "--threshold", "0"}).code, 1);
  EXPECT_EQ(run({"compare", a, a, "--metric", "flip", "--threshold", "0"}).code, 0);
}

TEST_F(CommandLineReference, RefusesWhatCannotBeCompared) {
  const std::string a = file("a.png", 16, 12, 100), small = file("b.png", 16, 11, 100);
  const std::string hdr = hdrFile("c.exr", 1.0f);
  expectRefused({"compare", a, small}, {"different sizes, 16x12 and 16x11"});
  expectRefused({"compare", a, hdr}, {"one image is HDR"});
  expectRefused({"compare", a, path("none.png")}, {"no such file"});
  expectRefused({"compare", a, a, "--metric", "mse"}, {"'mse' is unknown"});
  expectRefused({"compare", a, a, "--heatmap", path("h.gif")}, {"use .png"});
}

TEST_F(CommandLineReference, TracesAPlant) {
  const std::string tree = smallTree();
  const Words common = {"reference", tree, "--size", "32x24", "--samples", "4", "--json", "-o"};
  const auto traced = [&](const std::string& name, const Words& more) {
    Words command = common;
    command.push_back(path(name));
    command.insert(command.end(), more.begin(), more.end());
    return Json::parse(runWell(command));
  };
  const Json json = traced("a.exr", {});
  EXPECT_EQ(json["width"], 32);
  EXPECT_EQ(json["samples"], 4);
  EXPECT_GT(json["noise"], 0.0);
  traced("b.exr", {"--threads", "1"});
  EXPECT_EQ(readHdrImage(path("a.exr")).rgb, readHdrImage(path("b.exr")).rgb);
  traced("c.exr", {"--sun", "200,10"});
  EXPECT_NE(readHdrImage(path("a.exr")).rgb, readHdrImage(path("c.exr")).rgb);
  traced("d.exr", {"--bounces", "1", "--seed", "2", "--noise", "0.5", "--seconds", "60"});
  traced("a.png", {"--exposure", "14"});
  EXPECT_EQ(readImage(path("a.png")).width, 32);
  EXPECT_EQ(run({"reference", tree, "-o", path("a.jpg")}).code, 2);
  EXPECT_EQ(run({"reference", tree, "-o", path("e.exr"), "--samples", "0"}).code, 2);
}

}  // namespace
}  // namespace verdure::test
