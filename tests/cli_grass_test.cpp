// Grass and terrain as their user meets them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "command_line.h"
#include "verdure/grass.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

/// Lighter above; every other column is cut out, unless `opaque`.
Image strip(int width, bool opaque) {
  Image image(width, 8);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint8_t green[] = {90, static_cast<std::uint8_t>(220 - 20 * y), 40,
                                    static_cast<std::uint8_t>(opaque || x % 2 == 0 ? 255 : 0)};
      std::memcpy(image.at(x, y), green, 4);
    }
  return image;
}

Image evenPicture(int width, int height, std::uint8_t grey) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = i % 4 == 3 ? 255 : grey;
  return image;
}

double difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

class CommandLineGrass : public CommandLine {
 protected:
  /// A folder of grass that is a strip of 16 x 8 texels.
  std::string ownGrass(const Json& changes = Json::object()) const {
    const fs::path folder = dir_ / "own";
    fs::create_directories(folder);
    writePng(strip(16, false), folder / "strip.png");
    writePng(strip(24, false), folder / "wide.png");
    writePng(strip(16, true), folder / "opaque.png");
    Json json = {{"format", "verdure-grass"},
                 {"version", 1},
                 {"height_m", 0.2},
                 {"spacing_m", 0.05},
                 {"tile_m", 0.4},
                 {"tiles", 1},
                 {"slices", Json::array({{{"color", "strip.png"}}})}};
    json.update(changes);
    writeFile(folder / "grass.json", json.dump());
    return folder.string();
  }

  /// A small picture of the ground around x = z = 0.
  Image picture(const Words& options, int pixels = 24) const {
    Words command = {"render",
                     "-o",
                     path("out.png"),
                     "--size",
                     fmt::format("{0}x{0}", pixels),
                     "--camera",
                     "0,0.8,1.6,0,0.2,0",
                     "--shadow-map",
                     "16"};
    command.insert(command.end(), options.begin(), options.end());
    runWell(command);
    return readImage(path("out.png"));
  }

  void refused(const Words& options, const Words& said) const {
    Words command = {"render", "-o", path("out.png"), "--size", "16x16"};
    command.insert(command.end(), options.begin(), options.end());
    expectRefused(command, said);
  }
};

TEST_F(CommandLineGrass, GrowsADataSet) {
  const std::string folder = path("clover");
  const Json said =
      Json::parse(runWell({"grass", "grow", "--species", "clover", "--seed", "7", "--kinds", "2",
                           "--texels-per-m", "64", "-o", folder, "--json"}));
  EXPECT_EQ(said["species"], "clover");
  const GrassSet set = loadGrass(folder);
  EXPECT_EQ(set.name, "clover");
  ASSERT_EQ(set.slices.size(), 2u);
  EXPECT_EQ(said["slices"], 2);
  EXPECT_EQ(said["width"], set.slices[0].width);
  EXPECT_EQ(said["height"], set.slices[0].height);
  EXPECT_EQ(said["ground"], set.ground.width);
  EXPECT_NEAR(said["height_m"].get<double>(), double{set.height_m}, 1e-6);
  EXPECT_GT(said["mean_cover"], 0.05);
  EXPECT_FALSE(set.middle.empty());
  EXPECT_FALSE(set.species.plants.empty());
  // The same options grow the same grass, another seed does not.
  const auto sliceOf = [&](const std::string& name) {
    return readFile(dir_ / name /
                    jsonOf(dir_ / name / "grass.json")["slices"][0]["color"].get<std::string>());
  };
  for (const auto& [name, seed] : {std::pair("again", "7"), std::pair("other", "8")})
    runWell({"grass", "grow", "--species", "clover", "--seed", seed, "--kinds", "2",
             "--texels-per-m", "64", "-o", path(name), "--threads", "1"});
  EXPECT_EQ(sliceOf("clover"), sliceOf("again"));
  EXPECT_NE(sliceOf("clover"), sliceOf("other"));
  const std::string list = runWell({"grass", "grow", "--list"});
  for (const std::string& name : grassSpeciesNames())
    EXPECT_NE(list.find(name), std::string::npos) << name;
  expectRefused({"grass"}, {"grass: nothing is named; use grow"});
  expectRefused({"grass", "grow"}, {"no folder is named", "-o"});
  expectRefused({"grass", "grow", "--species", "moss", "-o", folder}, {"moss", "meadow"});
  expectRefused({"figures", "grass", "--species", "moss", "-o", path("figures")}, {"moss"});
  expectRefused({"grass", "grow", "--kinds", "0", "-o", folder}, {"kinds is 0", "1 to 64"});
  expectRefused({"grass", "grow", "--texels-per-m", "8", "-o", folder}, {"texels_per_m is 8"});
}

TEST_F(CommandLineGrass, DrawsALawnOnHills) {
  const Words hills = {"--terrain", "hills", "--terrain-size", "40x40"};
  Words lawn = hills;
  lawn.insert(lawn.end(), {"--grass", "lawn"});
  const Image bare = picture(hills, 48), grown = picture(lawn, 48);
  EXPECT_GT(difference(bare, grown), 3.0);
  // In front of the eye it is green.
  const std::uint8_t* const near = grown.at(24, 44);
  EXPECT_GT(near[1], near[0]);
  EXPECT_GT(near[1], near[2]);
}

TEST_F(CommandLineGrass, OptionsOfTheGround) {
  const std::string own = ownGrass();
  const Image plain = picture({"--grass", own});
  EXPECT_EQ(difference(plain, picture({"--grass", own + "/grass.json"})), 0.0);
  EXPECT_GT(difference(plain, picture({"--grass", own, "--grass-density", "0.3"})), 0.5);
  EXPECT_GT(difference(plain, picture({"--grass", own, "--grass", own})), 0.1);
  EXPECT_GT(difference(plain, picture({"--grass", own, "--wind", "12"})), 0.1);
  EXPECT_GT(difference(plain, picture({"--grass", own, "--grass-slices", "1"})), 0.1);
  writePng(evenPicture(2, 2, 0), path("nowhere.png"));
  writePng(evenPicture(2, 2, 255), path("everywhere.png"));
  const Image bare = picture({"--grass", own, "--grass-cover", path("nowhere.png")});
  EXPECT_GT(difference(plain, bare), 2.0);
  EXPECT_LT(difference(plain, picture({"--grass", own, "--grass-cover", path("everywhere.png")})),
            0.05);
  // A terrain goes through the ground below the camera: level, its height is of no matter.
  writePng(evenPicture(3, 3, 128), path("level.png"));
  const Words level = {"--grass", own, "--terrain", path("level.png")};
  EXPECT_LT(difference(plain, picture(level)), 2.0);
  // A plant stands in it.
  const std::string tree = smallTree();
  EXPECT_GT(difference(plain, picture({tree, "--grass", own})), 1.0);
}

TEST_F(CommandLineGrass, RefusesBadSets) {
  const auto bad = [&](const Json& changes, const Words& said) {
    refused({"--grass", ownGrass(changes)}, said);
  };
  refused({"--grass", "moss"}, {"--grass: 'moss' is neither a species nor a folder", "lawn"});
  fs::create_directories(dir_ / "empty");
  refused({"--grass", path("empty")}, {"grass.json"});
  const auto slices = [](const char* first, const char* second) {
    return Json{{"slices", Json::array({{{"color", first}}, {{"color", second}}})}};
  };
  bad(slices("strip.png", "wide.png"), {"slice 1: is 96 x 8 texels, others are 64 x 8"});
  bad(slices("strip.png", "opaque.png"), {"slice 1", "no alpha"});
  bad(slices("strip.png", "missing.png"), {"missing.png"});
  bad({{"spacing_m", 0}}, {"spacing_m is 0"});
  bad({{"hieght_m", 1}}, {"unknown member 'hieght_m'"});
}

TEST_F(CommandLineGrass, RefusesOptionsOfTheGround) {
  const std::string own = ownGrass();
  refused({}, {"no plant is named", "--grass or --terrain"});
  refused({"--grass", own, "--grass-density", "1.5"}, {"--grass-density: 1.5 is out of range"});
  refused({"--grass", own, "--grass-density", "nan"}, {"--grass-density: nan"});
  refused({"--grass", own, "--grass-slices", "0"}, {"--grass-slices: 0 is out of range"});
  writePng(evenPicture(2, 2, 255), path("cover.png"));
  refused({"--grass", own, "--grass-cover", path("cover.png"), "--grass-cover", path("cover.png")},
          {"--grass-cover: there are more maps than layers"});
  refused({"--grass", own, "--grass-cover", path("missing.png")}, {"missing.png"});
  writePng(evenPicture(1, 1, 255), path("dot.png"));
  refused({"--terrain", path("dot.png")}, {"dot.png", "1"});
  refused({"--terrain", "mountains"}, {"mountains"});
  refused({"--terrain", "hills", "--terrain-size", "0x10"}, {"--terrain-size: '0x10' has no area"});
  refused({"--terrain", "hills", "--terrain-height", "9,2"}, {"--terrain-height: 9 is above 2"});
}

}  // namespace
}  // namespace verdure::test
