#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "command_line.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

/// A folder of maps with ambientCG's names: 16 x 8 texels.
void writeMaps(const fs::path& folder) {
  fs::create_directories(folder);
  Image color(16, 8), normal(16, 8), opacity(16, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      const std::uint8_t green[] = {60, 120, 40, 255}, up[] = {128, 128, 255, 255};
      std::memcpy(color.at(x, y), green, 4);
      std::memcpy(normal.at(x, y), up, 4);
      std::memset(opacity.at(x, y), x > 1 ? 255 : 0, 3);
      opacity.at(x, y)[3] = 255;
    }
  writePng(color, folder / "Oak_Color.png");
  writePng(normal, folder / "Oak_NormalGL.png");
  writePng(opacity, folder / "Oak_Opacity.png");
}

/// A leaf card of 10 cm whose material lets light through.
struct LeafMaterial : LeafFile {
  LeafMaterial() : LeafFile({glm::vec3(0)}) {
    Image color(20, 10), thickness(20, 10);
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 20; ++x) {
        const std::uint8_t rgba[] = {188, 188, 188, static_cast<std::uint8_t>(x < 5 ? 60 : 255)};
        std::memcpy(color.at(x, y), rgba, 4);
        const std::uint8_t green[] = {7, static_cast<std::uint8_t>(x < 10 ? 255 : 51), 9, 255};
        std::memcpy(thickness.at(x, y), green, 4);
      }
    json["images"] =
        Json::array({{{"bufferView", view(encodePng(color))}, {"mimeType", "image/png"}},
                     {{"bufferView", view(encodePng(thickness))}, {"mimeType", "image/png"}}});
    json["textures"] = Json::array({{{"source", 0}}, {{"source", 1}}});
    const Json through = {{"diffuseTransmissionFactor", 0.25},
                          {"diffuseTransmissionColorFactor", {0.4, 0.8, 0.2}}};
    const Json volume = {{"thicknessFactor", 0.0005}, {"thicknessTexture", {{"index", 1}}}};
    json["materials"] = Json::array(
        {{{"name", "leaf"},
          {"alphaMode", "MASK"},
          {"alphaCutoff", 0.2},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {1, 0.5, 0.5, 1}}, {"baseColorTexture", {{"index", 0}}}}},
          {"extensions",
           {{"KHR_materials_diffuse_transmission", through}, {"KHR_materials_volume", volume}}}}});
    const std::vector<glm::vec2> uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = floats(uvs);
  }
};

TEST_F(CommandLine, ImportsAndBakesMaps) {
  writeMaps(path("maps"));
  const std::string said = runWell({"leaf", "import", path("maps"), "-o", path("leaf"),
                                    "--mm-per-texel", "0.5", "--thickness-mm", "0.25"});
  EXPECT_NE(said.find("Oak: 16 x 8 texels of 0.5 mm"), std::string::npos) << said;
  EXPECT_NE(said.find("0.25 mm thick everywhere"), std::string::npos) << said;
  runWell({"leaf", "bake", path("leaf"), "--report", path("report.json")});
  const Json report = jsonOf(path("report.json"));
  EXPECT_EQ(report["leaf_texels"], 14 * 8);
  EXPECT_EQ(report["clamped_texels"], 0);
  EXPECT_EQ(report["method"], "gaussians");
  EXPECT_EQ(report["errors"].size(), 3u);
  EXPECT_NEAR(report["surface_reflection"].get<double>(), 0.472, 1e-3);
  // Exactly flat: (1 - albedo) T sqrt(2 pi) / 3 but for what leaves over the edges, within the
  // leaf; T(0.25 mm) = 0.32.
  const HdrImage front = readExrMap(path("leaf") + "/front_hl2.exr");
  const HdrImage back = readExrMap(path("leaf") + "/back_hl2.exr");
  EXPECT_EQ(front.width, 16);
  EXPECT_GT(back.at(8, 4).x, 0.2f);
  EXPECT_LT(back.at(8, 4).x, 0.32f * 0.8355f);
  // The back's albedo is lighter, so less of its light enters.
  EXPECT_LT(front.at(8, 4).x, back.at(8, 4).x);
  // The direct sum, elsewhere, with the leaf copied there.
  const Json direct = Json::parse(
      runWell({"leaf", "bake", path("leaf"), "-o", path("other"), "--method", "direct", "--json"}));
  EXPECT_EQ(direct["terms"], 0);
  const HdrImage sum = readExrMap(path("other") + "/back_hl2.exr");
  EXPECT_NEAR(sum.at(8, 4).x / back.at(8, 4).x, 1.0f, 2e-3f);
  EXPECT_TRUE(fs::exists(path("other") + "/front_relief.png"));
  // Less red than green is thrown back by this leaf, so more of it enters.
  runWell({"leaf", "bake", path("leaf"), "-o", path("red"), "--wavelength", "1,0,0"});
  EXPECT_GT(readExrMap(path("red") + "/back_hl2.exr").at(8, 4).x, back.at(8, 4).x);
  // A folder that has a leaf.json is read by it.
  EXPECT_NE(runWell({"leaf", "import", path("leaf"), "-o", path("third"), "--name", "Elm"})
                .find("Elm: 16 x 8"),
            std::string::npos);
}

TEST_F(CommandLine, ImportsALeafOfAMaterial) {
  writeFile(path("leaf.glb"), LeafMaterial().glb());
  const std::string said = runWell({"leaf", "import", path("leaf.glb"), "-o", path("leaf")});
  // 10 cm across 20 texels one way, 10 the other: the square root of 5 mm times 10 mm.
  EXPECT_NE(said.find("7.071 mm wide"), std::string::npos) << said;
  const Json json = jsonOf(path("leaf") + "/leaf.json");
  EXPECT_NEAR(json["mm_per_texel"].get<double>(), std::sqrt(50.0), 1e-3);
  EXPECT_NEAR(json["thickness_range_mm"][0].get<double>(), 0.1, 1e-5) << "a fifth of 0.5 mm";
  EXPECT_NEAR(json["thickness_range_mm"][1].get<double>(), 0.5, 1e-5);
  const Image albedo = readImage(path("leaf") + "/front_albedo.png");
  const Image through = readImage(path("leaf") + "/front_translucency.png");
  const Image opacity = readImage(path("leaf") + "/opacity.png");
  // sRGB 188 is linear 0.503: three quarters of it, halved in green; a quarter of the colour.
  const auto srgb = [](double l) { return 255 * (1.055 * std::pow(l, 1 / 2.4) - 0.055); };
  EXPECT_NEAR(albedo.at(12, 5)[0], srgb(0.75 * 0.503), 1.0);
  EXPECT_NEAR(albedo.at(12, 5)[1], srgb(0.75 * 0.503 * 0.5), 1.0);
  EXPECT_NEAR(through.at(12, 5)[1], srgb(0.25 * 0.8), 1.0);
  EXPECT_EQ(opacity.at(2, 5)[0], 255) << "alpha 60 is above the cutoff of 0.2";
  runWell({"leaf", "bake", path("leaf")});
}

TEST_F(CommandLine, RefusesWhatIsNoLeaf) {
  writeMaps(path("maps"));
  writeFile(path("leaf.glb"), LeafMaterial().glb());
  LeafMaterial plain;
  plain.json["materials"][0]["pbrMetallicRoughness"].erase("baseColorTexture");
  writeFile(path("plain.glb"), plain.glb());
  fs::create_directories(path("empty"));
  const Words import = {"leaf", "import"};
  const auto refused = [&](Words rest, const Words& said) {
    Words words = import;
    words.insert(words.end(), rest.begin(), rest.end());
    words.insert(words.end(), {"-o", path("out")});
    expectRefused(words, said);
  };
  refused({path("maps")}, {"maps", "--mm-per-texel"});
  refused({path("maps"), "--mm-per-texel", "0.1"}, {"how thick", "--thickness-mm"});
  refused({path("maps"), "--mm-per-texel", "0", "--thickness-mm", "1"}, {"--mm-per-texel is 0"});
  refused({path("maps"), "--mm-per-texel", "1", "--thickness-mm", "-1"}, {"--thickness-mm is -1"});
  refused({path("maps"), "--width-mm", "nan", "--thickness-mm", "1"}, {"--width-mm is nan"});
  refused({path("maps"), "--material", "leaf"}, {"--material", ".glb"});
  refused({path("empty")}, {"empty", "no albedo"});
  refused({path("nowhere")}, {"nowhere", "is no folder"});
  refused({path("leaf.glb"), "--material", "bark"}, {"named 'bark'"});
  refused({path("plain.glb")}, {"no material has a texture"});
  expectRefused({"leaf"}, {"leaf", "import or bake"});
  expectRefused({"leaf", "bake", path("maps")}, {"leaf.json: no such file"});
  runWell({"leaf", "import", path("maps"), "-o", path("leaf"), "--width-mm", "4", "--thickness-mm",
           "0.25"});
  expectRefused({"leaf", "bake", path("leaf"), "--method", "fft"}, {"'fft'", "gaussians"});
  expectRefused({"leaf", "bake", path("leaf"), "--directions", "3"}, {"--directions: is 3"});
  expectRefused({"leaf", "bake", path("leaf"), "--wavelength", "0,0,0"}, {"--wavelength", "0,1,0"});
  expectRefused({"leaf", "bake", path("leaf"), "--wavelength", "1,2"}, {"--wavelength"});
  expectRefused({"leaf", "bake", path("leaf"), "--surface-reflection", "1"},
                {"--surface-reflection: is 1"});
  expectRefused({"leaf", "bake", path("leaf"), "--report", path("nowhere/r.json")}, {"nowhere"});
  expectRefused({"leaf", "import", path("maps"), "--width-mm", "4", "--thickness-mm", "1", "-o",
                 path("leaf.glb")},
                {"leaf.glb", "folder"});
}

}  // namespace
}  // namespace verdure::test
