#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files.h"
#include "grass_sets.h"
#include "scratch.h"
#include "verdure/error.h"
#include "verdure/grass.h"
#include "verdure/image.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

TEST(GrassFiles, FilesKeepAllWithinTheirRounding) {
  const GrassSet set = smallSet();
  const fs::path folder = scratchFolder("grass_round_trip") / "new";
  saveGrass(set, folder);
  const GrassSet read = loadGrass(folder);
  EXPECT_EQ(read.name, set.name);
  EXPECT_EQ(read.height_m, set.height_m);
  EXPECT_EQ(read.spacing_m, set.spacing_m);
  EXPECT_EQ(read.tile_m, set.tile_m);
  ASSERT_EQ(read.slices.size(), set.slices.size());
  const auto compare = [](const GrassMap& a, const GrassMap& b, const char* what) {
    ASSERT_EQ(a.width, b.width) << what;
    ASSERT_EQ(a.height, b.height) << what;
    double color = 0, data = 0;
    for (std::size_t i = 0; i < a.texelCount(); ++i) {
      color = std::max(color, largest(glm::dvec4(a.color[i] - b.color[i])));
      data = std::max(data, largest(glm::dvec4(a.data[i] - b.data[i])));
    }
    // A step of sRGB at white is 0.0088; alpha and data have steps of 1 / 255 and 2 / 255.
    EXPECT_LT(color, 0.0044 + 0.002 + 1e-4) << what;
    EXPECT_LT(data, 0.004 + 0.002 + 1e-4) << what;
  };
  for (std::size_t k = 0; k < set.slices.size(); ++k)
    compare(read.slices[k], set.slices[k], "slice");
  compare(read.opaque, set.opaque, "opaque");
  compare(read.ground, set.ground, "ground");
  compare(read.middle, set.middle, "middle");

  // The species grows the same set again.
  GrassGrowOptions options;
  options.seed = 3;
  options.texels_per_m = 160;
  options.kinds = 3;
  EXPECT_EQ(growGrass(read.species, options).slices[1].color, set.slices[1].color);
  EXPECT_EQ(loadGrass(folder / "grass.json").name, set.name);
}

/// A folder with one tile of two upright blades, and the JSON for it.
Json userGrass(const fs::path& folder) {
  Image strip(16, 8);
  for (int y = 0; y < 8; ++y)
    for (const int x : {3, 11}) {
      std::uint8_t* texel = strip.at(x, y);
      texel[0] = 60, texel[1] = 120, texel[2] = 40, texel[3] = 255;
    }
  writePng(strip, folder / "strip.png");
  Image wide(32, 8);
  writePng(wide, folder / "wide.png");
  Image opaque(16, 8);
  std::fill(opaque.rgba.begin(), opaque.rgba.end(), std::uint8_t{255});
  writePng(opaque, folder / "opaque.png");
  Image odd(18, 8);
  writePng(odd, folder / "odd.png");
  return {{"format", "verdure-grass"},
          {"version", 1},
          {"height_m", 0.1},
          {"spacing_m", Json::array({0.04, 0.05})},
          {"tile_m", 0.2},
          {"tiles", 1},
          {"slices", Json::array({{{"color", "strip.png"}}})}};
}

void writeGrass(const fs::path& folder, const Json& json) {
  writeFile(folder / "grass.json", json.dump());
}

TEST(GrassFiles, PicturesOfOneTileAreEnough) {
  const fs::path folder = scratchFolder("grass_user");
  writeGrass(folder, userGrass(folder));
  const GrassSet set = loadGrass(folder);
  EXPECT_EQ(set.spacing_m, glm::vec2(0.04f, 0.05f));
  ASSERT_EQ(set.slices.size(), 1u);
  const GrassMap& slice = set.slices[0];
  EXPECT_EQ(slice.width, 64);
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(slice.color[static_cast<std::size_t>(x)].a, x % 8 == 3 ? 1.0f : 0.0f);
    if (x % 8 != 3) continue;
    const glm::vec4& data = slice.data[static_cast<std::size_t>(x)];
    EXPECT_EQ(glm::vec3(data), glm::vec3(0.0f, 0.0f, 0.6f));
    EXPECT_GE(data.w, 0.0f);
    EXPECT_LT(data.w, 1.0f);
  }
  EXPECT_EQ(set.opaque.width, 64);
  // Only blades are seen: what fills the gaps is as green.
  EXPECT_NEAR(set.opaque.color[0].g, slice.color[3].g, 1e-5f);
  EXPECT_EQ(set.ground.width, 4);
  EXPECT_TRUE(set.middle.empty());
  EXPECT_TRUE(set.species.plants.empty());
  // It can be written, and read as four tiles.
  saveGrass(set, folder / "again");
  EXPECT_EQ(loadGrass(folder / "again").slices[0].width, 64);
}

TEST(GrassFiles, BadFilesAreRefusedInOneLine) {
  const fs::path folder = scratchFolder("grass_bad");
  const Json good = userGrass(folder);
  const auto refuses = [&](const std::string& word, const std::function<void(Json&)>& spoil) {
    Json json = good;
    spoil(json);
    writeGrass(folder, json);
    try {
      loadGrass(folder);
      ADD_FAILURE() << "accepted: " << json.dump();
    } catch (const Error& e) {
      const std::string line = e.what();
      EXPECT_NE(line.find(word), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_NE(line.find("; "), std::string::npos) << line << ": no advice";
    }
  };
  writeGrass(folder, good);
  EXPECT_NO_THROW(loadGrass(folder));
  refuses("others are", [](Json& j) { j["slices"].push_back({{"color", "wide.png"}}); });
  refuses("opaque everywhere", [](Json& j) { j["slices"][0]["color"] = "opaque.png"; });
  refuses("missing.png", [](Json& j) { j["slices"][0]["color"] = "missing.png"; });
  refuses("its colours are", [](Json& j) { j["slices"][0]["data"] = "wide.png"; });
  refuses("cannot share", [](Json& j) {
    j["tiles"] = 4;
    j["slices"][0]["color"] = "odd.png";
  });
  refuses("no color", [](Json& j) { j["slices"][0] = Json::object(); });
  refuses("color is no text", [](Json& j) { j["slices"][0]["color"] = 3; });
  refuses("no slices", [](Json& j) { j["slices"] = Json::array(); });
  refuses("has no slices", [](Json& j) { j.erase("slices"); });
  refuses("slices is no list", [](Json& j) { j["slices"] = "strip.png"; });
  refuses("height_m is 0", [](Json& j) { j["height_m"] = 0; });
  refuses("height_m is -1", [](Json& j) { j["height_m"] = -1; });
  refuses("height_m is no number", [](Json& j) { j["height_m"] = "high"; });
  refuses("height_m is no number", [](Json& j) { j["height_m"] = 1e300; });
  refuses("height_m is no number", [](Json& j) { j["height_m"] = nullptr; });
  refuses("no height_m", [](Json& j) { j.erase("height_m"); });
  refuses("spacing_m is 0", [](Json& j) { j["spacing_m"] = 0; });
  refuses("spacing_m is -0.1", [](Json& j) { j["spacing_m"] = Json::array({0.1, -0.1}); });
  refuses("pair of numbers", [](Json& j) { j["spacing_m"] = Json::array({0.1}); });
  refuses("no spacing_m", [](Json& j) { j.erase("spacing_m"); });
  refuses("tile_m is 0", [](Json& j) { j["tile_m"] = 0; });
  refuses("tiles is 2", [](Json& j) { j["tiles"] = 2; });
  refuses("unknown member 'hieght_m'", [](Json& j) { j["hieght_m"] = 1; });
  refuses("version", [](Json& j) { j["version"] = 2; });
  refuses("format", [](Json& j) { j["format"] = "verdure-leaf"; });
  refuses("not opaque", [](Json& j) { j["opaque"] = {{"color", "strip.png"}}; });
  refuses("cannot share", [](Json& j) {
    j["tiles"] = 4;
    j["ground"] = {{"color", "odd.png"}};
  });
  refuses("not square", [](Json& j) { j["ground"] = {{"color", "opaque.png"}}; });
  refuses("species", [](Json& j) { j["species"] = 3; });
  refuses("no plants", [](Json& j) { j["species"] = Json::object(); });

  writeFile(folder / "grass.json", std::string("{\"format\": "));
  EXPECT_THROW(loadGrass(folder), Error);
  writeFile(folder / "grass.json", std::string("[]"));
  EXPECT_THROW(loadGrass(folder), Error);
  EXPECT_THROW(loadGrass(folder / "nowhere"), Error);
}

}  // namespace
}  // namespace verdure
