// render and figures as their user meets them.
#include <fstream>

#include "command_line.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

class CommandLineRender : public CommandLine {
 protected:
  /// A small picture of `plant`.
  Image picture(const std::string& plant, const Words& options, Json* report = nullptr) const {
    Words command = {"render", plant,          "-o",  path("out.png"), "--size",
                     "96x72",  "--shadow-map", "256", "--json"};
    command.insert(command.end(), options.begin(), options.end());
    const std::string said = runWell(command);
    if (said.empty()) return {};
    const Json json = Json::parse(said);
    EXPECT_EQ(json["width"], 96);
    EXPECT_EQ(json["height"], 72);
    if (report != nullptr) *report = json;
    return readImage(path("out.png"));
  }
};

/// Mean of all bytes of one channel.
double mean(const Image& image, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = channel; i < image.rgba.size(); i += 4) sum += image.rgba[i];
  return sum * 4.0 / static_cast<double>(image.rgba.size());
}

double difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

TEST_F(CommandLineRender, BothLights) {
  const std::string tree = smallTree("tree.glb", 3);
  Json expressive_report, standard_report, baked_report;
  const Image expressive =
      picture(tree, {"--light", "expressive", "--grid", "40"}, &expressive_report);
  const Image standard = picture(tree, {"--light", "standard"}, &standard_report);
  const double of_lights = difference(expressive, standard);
  EXPECT_GT(of_lights, 0.1);
  EXPECT_GT(expressive_report["bake_seconds"], 0.0);
  EXPECT_EQ(standard_report["bake_seconds"], 0.0);  // a light of leaf normals needs none
  // What a file brought along is used: the same picture, but for the rounding of the file.
  runWell({"bake", tree, "-o", path("baked.glb"), "--grid", "40"});
  const Image baked = picture(path("baked.glb"), {"--light", "expressive"}, &baked_report);
  EXPECT_EQ(baked_report["bake_seconds"], 0.0);
  EXPECT_LT(difference(expressive, baked), 0.1 * of_lights);
  const std::string said =
      runWell({"render", tree, "-o", path("out.png"), "--size", "32x32", "--light", "expressive"});
  EXPECT_NE(said.find("out.png: 32x32, expressive light, on "), std::string::npos) << said;
}

TEST_F(CommandLineRender, TheBestLightUsesWhatTheFileHas) {
  const std::string tree = smallTree("tree.glb", 3);
  Json baked_report, traced_report, transfer_report;
  const Image baked = picture(tree, {}, &baked_report);
  EXPECT_EQ(baked_report["light"], "best (baked)");
  EXPECT_GT(baked_report["bake_seconds"], 0.0);
  runWell({"bake", tree, "-o", path("traced.glb"), "--transfer", "3", "--rays", "16"});
  const Image best = picture(path("traced.glb"), {}, &traced_report);
  EXPECT_EQ(traced_report["light"], "best (transfer vectors)");
  const Image transfer = picture(path("traced.glb"), {"--light", "transfer"}, &transfer_report);
  EXPECT_EQ(transfer_report["light"], "transfer");
  // The shadows make a difference, and so do the leaves' own maps.
  const Image plain_shadows = picture(path("traced.glb"), {"--shadows", "map"});
  EXPECT_GT(difference(plain_shadows, best), 0.0);
  EXPECT_GT(difference(plain_shadows, transfer), 0.0);
  EXPECT_GT(difference(baked, best), difference(plain_shadows, best));
}

TEST_F(CommandLineRender, WithoutLeafMapsTheBestLightDiffersByItsShadowsAlone) {
  const std::string tree = smallTree("tree.gltf", 3);
  Json file = Json::parse(std::ifstream(tree));
  std::size_t stripped = 0;
  for (Json& material : file["materials"])
    if (material.contains("extras")) stripped += material["extras"].erase("verdure");
  EXPECT_EQ(stripped, 1u);
  std::ofstream(tree) << file;
  runWell({"bake", tree, "-o", path("traced.gltf"), "--transfer", "3", "--rays", "16"});
  const Image transfer = picture(path("traced.gltf"), {"--light", "transfer"});
  EXPECT_EQ(difference(transfer, picture(path("traced.gltf"), {"--shadows", "map"})), 0.0);
  EXPECT_GT(difference(transfer, picture(path("traced.gltf"), {})), 0.0);
}

TEST_F(CommandLineRender, ShadowsFromEachSource) {
  const std::string tree = smallTree("tree.glb", 3);
  std::vector<Image> pictures;
  for (const char* source : {"map", "paper", "layers", "ordered"})
    pictures.push_back(picture(tree, {"--light", "depth-maps", "--shadows", source}));
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(difference(pictures[i], pictures[k]), 0.0);
  EXPECT_EQ(difference(pictures[2], picture(tree, {"--light", "depth-maps"})), 0.0);
}

TEST_F(CommandLineRender, OptionsOfTheView) {
  const std::string tree = smallTree();
  const Image plain = picture(tree, {});
  EXPECT_EQ(difference(plain, picture(tree, {"--camera", "auto", "--sun", "85,42"})), 0.0);
  EXPECT_EQ(difference(plain, picture(tree, {"--camera", "35,4"})), 0.0);  // what auto stands for
  EXPECT_GT(difference(plain, picture(tree, {"--camera", "-60,30"})), 1.0);
  EXPECT_GT(difference(plain, picture(tree, {"--sun", "-50,20"})), 0.1);
  EXPECT_GT(difference(plain, picture(tree, {"--fov", "60", "--camera", "9,4,9,0,6,0"})), 1.0);
  EXPECT_GT(difference(plain, picture(tree, {"--terms", "ambient"})), 1.0);
  EXPECT_EQ(
      difference(plain,
                 picture(tree, {"--terms",
                                "ambient,diffuse,specular,shadow,textures,transmission,gloss"})),
      0.0);
  EXPECT_GT(difference(plain, picture(tree, {"--turbidity", "8"})), 1.0);
  EXPECT_GT(difference(plain, picture(tree, {"--sky", "cie:1"})), 1.0);
  HdrImage panorama(16, 8);
  for (glm::vec3& p : panorama.rgb) p = {1.0f, 2.0f, 3.0f};
  writeExr(panorama, path("sky.exr"));
  EXPECT_GT(difference(plain, picture(tree, {"--sky", path("sky.exr")})), 1.0);
  EXPECT_GT(difference(plain, picture(tree, {"--date", "2026-06-21T16:00Z", "--place", "51,0"})),
            0.1);
  EXPECT_GT(difference(plain, picture(tree, {"--key", "0.36"})), 5.0);
  EXPECT_GT(difference(plain, picture(tree, {"--exposure", "12"})), 5.0);
  EXPECT_GT(difference(plain, picture(tree, {"--white", "1"})), 0.5);
  EXPECT_EQ(difference(plain, picture(tree, {"--white", "auto"})), 0.0);
  EXPECT_GT(difference(plain, picture(tree, {"--bloom", "0.5"})), 0.5);
  EXPECT_GT(difference(plain, picture(tree, {"--terms",
                                             "ambient,diffuse,specular,shadow,textures,"
                                             "transmission"})),
            0.01);
  // Without any ground the background alone is seen away from the plant.
  const Image red = picture(tree, {"--no-ground", "--background", "1,0,0"});
  for (const int x : {0, 95})
    for (const int y : {0, 71}) {
      EXPECT_EQ(red.at(x, y)[0], 255);
      EXPECT_EQ(red.at(x, y)[1], 0);
      EXPECT_EQ(red.at(x, y)[2], 0);
    }
  EXPECT_GT(mean(red, 0), 150.0);
  // Looking away from the plant there is nothing but the background.
  const Image empty =
      picture(tree, {"--no-ground", "--background", "0,0,1", "--camera", "0,2,50,0,2,100"});
  EXPECT_EQ(mean(empty, 0), 0.0);
  EXPECT_EQ(mean(empty, 2), 255.0);
}

TEST_F(CommandLineRender, WritesLightAsOpenExr) {
  const std::string tree = smallTree();
  const auto average = [&](const Words& options) {
    Words command = {"render", tree,      "-o",      path("out.exr"), "--size",
                     "96x72",  "--sun",   "85,42",   "--shadow-map",  "256",
                     "--json", "--light", "standard"};
    command.insert(command.end(), options.begin(), options.end());
    const Json report = Json::parse(runWell(command));
    const HdrImage image = readHdrImage(path("out.exr"));
    EXPECT_EQ(image.width, 96);
    EXPECT_EQ(image.height, 72);
    double sum = 0.0;
    for (const glm::vec3& p : image.rgb)
      sum += std::log(double{0.2126f * p.r + 0.7152f * p.g + 0.0722f * p.b} + 1e-9);
    return std::pair(std::exp(sum / (96.0 * 72.0)), report["average_kcd_m2"].get<double>());
  };
  const auto [day, said] = average({});
  EXPECT_NEAR(day, said, 0.01 * day);
  EXPECT_GT(day, 0.5);  // kcd/m^2: a sunny day
  EXPECT_LT(day, 20.0);
  // The file knows no exposure.
  EXPECT_NEAR(average({"--exposure", "5", "--key", "0.5", "--bloom", "1"}).first, day, 1e-6 * day);
}

TEST_F(CommandLineRender, StandsOnZeroWhereAStrandHangsBelow) {
  // Leaves from 0 to 4 m, and one 0.5 m below: seen from the height of -0.25 m, the camera is below
  // the ground at 0, and above one at the lowest leaf.
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 40; ++i)
    corners.emplace_back(0.2f * static_cast<float>(i % 3), 0.1f * static_cast<float>(i), 0);
  const Words view = {"--camera", "0,-0.25,30,0,-0.25,60", "--background", "1,0,0", "--light",
                      "standard"};
  writeFile(path("standing.glb"), LeafFile(corners).glb());
  const Image standing = picture(path("standing.glb"), view);
  corners.emplace_back(0.0f, -0.5f, 0.0f);
  writeFile(path("hanging.glb"), LeafFile(corners).glb());
  EXPECT_EQ(difference(standing, picture(path("hanging.glb"), view)), 0.0);
  // Modelled around 0, it stands on its lowest leaf.
  corners.emplace_back(0.0f, -3.0f, 0.0f);
  writeFile(path("around.glb"), LeafFile(corners).glb());
  EXPECT_GT(difference(standing, picture(path("around.glb"), view)), 5.0);
}

TEST_F(CommandLineRender, LeavesAreLookedAtWhereTheFileHasNoVisibility) {
  const std::string tree = smallTree("tree.glb", 3);
  const Words light = {"--light", "depth-maps", "--no-ground", "--background",
                       "0,0,0",   "--exposure", "14"};
  const auto with = [&light](const Words& more) {
    Words all = light;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  Json plain_report, kept_report, dense_report;
  const Image plain = picture(tree, light, &plain_report);
  EXPECT_GT(plain_report["bake_seconds"], 0.0);
  runWell({"bake", tree, "-o", path("kept.glb"), "--ambient", "leaf-visibility"});
  const Image kept = picture(path("kept.glb"), light, &kept_report);
  EXPECT_EQ(kept_report["bake_seconds"], 0.0);
  const double of_exponents =
      difference(plain, picture(tree, with({"--visibility-exponent", "3"})));
  EXPECT_GT(of_exponents, 0.1);
  EXPECT_LT(difference(plain, kept), 0.1 * of_exponents);
  // A file with another bake has no visibility.
  runWell({"bake", tree, "-o", path("dense.glb")});
  EXPECT_LT(difference(plain, picture(path("dense.glb"), light, &dense_report)),
            0.1 * of_exponents);
  EXPECT_GT(dense_report["bake_seconds"], 0.0);
}

TEST_F(CommandLineRender, Refuses) {
  const std::string tree = smallTree();
  const auto refused = [&](const Words& options, const Words& said) {
    Words command = {"render", tree, "-o", path("out.png")};
    command.insert(command.end(), options.begin(), options.end());
    expectRefused(command, said);
  };
  refused({"--shadows", "soft"}, {"--shadows", "'soft'", "ordered"});
  refused({"--style", "oil"}, {"--style: 'oil' is unknown; use photo, edges, toon, watercolour"});
  refused({"--style-normals", "bent"}, {"--style-normals: 'bent' is unknown; use raw, realigned"});
  refused({"--light", "candle"}, {"\"candle\"", "standard, expressive"});
  for (const char* terms : {"glow", "ambient,glow"})
    refused({"--terms", terms}, {"--terms: 'glow'"});
  refused({"--terms", "ambient,,shadow"}, {"--terms: ''"});
  for (const char* size :
       {"0x100", "10x", "x10", "-5x5", "10x10x10", "10", "9999999999x2", "1.5x2"})
    refused({"--size", size}, {"--size: '", size, "write 960x720"});
  refused({"--size", "99999999x2"}, {"width is 99999999", "choose another size"});
  refused({"--shadow-map", "0"}, {"--shadow-map"});
  refused({"--shadow-map", "99999999"}, {"99999999", "choose another size"});
  refused({"--cascades", "5"}, {"--cascades: '5'", "auto or 1 to 4"});
  refused({"--cascades", "0"}, {"--cascades: '0'"});
  refused({"--sun", "abc"}, {"--sun: 'abc' is no list of numbers; separate them by commas"});
  refused({"--sun", "1"}, {"--sun: '1' has 1 numbers; write 2"});
  refused({"--sun", "1,nan"}, {"--sun: "});
  refused({"--sun", "10,-30"}, {"--sun: at an elevation of -30 degrees it is night"});
  refused({"--sun", "10,130"}, {"--sun: the elevation 130"});
  refused({"--turbidity", "50"}, {"turbidity"});
  refused({"--wind", "500"}, {"--wind: 500 m/s", "choose 0 to 60"});
  refused({"--wind", "nan"}, {"--wind: "});
  refused({"--gusts", "2"}, {"--gusts: 2"});
  refused({"--time", "inf"}, {"--time: "});
  refused({"--frames", "20:10"}, {"--frames: 10 is before 20; write 10:20"});
  refused({"--frames", "3"}, {"--frames: '3'", "FIRST:LAST"});
  refused({"--frames", "0:3", "--fps", "0"}, {"--fps: 0"});
  refused({"--frames", "0:3", "--motion-vectors", path("v.exr")}, {"--motion-vectors: "});
  refused({"--turbidity", "nan"}, {"turbidity"});
  refused({"--sky", "green"}, {"--sky: 'green' is unknown"});
  refused({"--bands", "9"}, {"--bands: 9 is out of range"});
  for (const char* exponent : {"0", "-1", "nan", "inf"})
    refused({"--visibility-exponent", exponent}, {"--visibility-exponent: must be a number above"});
  refused({"--exposure", "bright"}, {"--exposure: 'bright' is no number"});
  refused({"--exposure", "99"}, {"--exposure: 99 is out of range"});
  refused({"--key", "0"}, {"--key: 0 is out of range"});
  refused({"--white", "-1"}, {"--white: -1 is out of range"});
  refused({"--white", "bright"}, {"--white: 'bright' is no number"});
  refused({"--bloom", "2"}, {"--bloom: 2 is out of range"});
  refused({"--light", "transfer"}, {"no transfer vectors", "bake --transfer"});
  refused({"--sky", "cie:16"}, {"--sky: 'cie:16' is no CIE standard sky"});
  refused({"--sky", "none.exr"}, {"none.exr"});
  refused({"--date", "2026-06-21T12:30Z"}, {"--date: ", "--place"});
  refused({"--date", "2026-06-21T00:30Z", "--place", "51,0"}, {"sun"});  // at night
  refused({"--date", "yesterday", "--place", "51,0"}, {"yesterday"});
  refused({"--date", "2026-06-21T12:30Z", "--place", "51,0", "--sun", "1,2"}, {"--sun: "});
  refused({"--camera", "1,2,3"}, {"--camera: needs 2 or 6 numbers"});
  refused({"--camera", "1,2,3,1,2,3"}, {"same point"});
  refused({"--fov", "0"}, {"--fov: "});
  refused({"--fov", "nan"}, {"--fov: "});
  refused({"--background", "1,0"}, {"--background: "});
  refused({"--background", "2,0,0"}, {"--background: 2 is out of range"});
  refused({"--rho", "0"}, {"rho must be above 0"});
  refused({"--normals", "none"}, {"--normals: 'none' is unknown"});
  refused({"--wood", "*"}, {"no foliage"});
  refused({"--device", "Voodoo 2"}, {"no Vulkan device \"Voodoo 2\""});
  refused({"--nonsense"}, {"--nonsense"});
  expectRefused({"render", tree, "-o", path("out.jpg")}, {"out.jpg: ", "use .png"});
  expectRefused({"render", tree, "-o", path("no/out.png")}, {"no/out.png: cannot be written"});
  expectRefused({"render", path("none.glb"), "-o", path("out.png")}, {"none.glb: no such file"});
  writeFile(path("picture.png"), encodePng(Image(4, 4)));
  expectRefused({"render", path("picture.png"), "-o", path("out.png")}, {"picture.png: "});
  expectRefused({"figures", "luft", "--size", "0x5", "-o", path("figures")}, {"--size"});
  expectRefused({"figures", "luft", "--species", "triffid", "-o", path("figures")}, {"triffid"});
  expectRefused({"figures", "luft", "-o", tree}, {"the folder cannot be made", "-o"});
  expectRefused({"render", tree, "-o", path("out.exr"), "--style", "toon"},
                {"out.exr: a drawn style has no light to write; use .png"});
  expectRefused({"figures", "npr", "--size", "0x5", "-o", path("figures")}, {"--size"});
  expectRefused({"figures", "npr", "--species", "triffid", "-o", path("figures")}, {"triffid"});
  expectRefused({"figures", "sky", "--size", "0x5", "-o", path("figures")}, {"--size"});
  expectRefused({"figures", "sky", "--species", "triffid", "-o", path("figures")}, {"triffid"});
  expectRefused({"figures", "gumbau", "--size", "0x5", "-o", path("figures")}, {"--size"});
  expectRefused({"figures", "gumbau", "--species", "triffid", "-o", path("figures")}, {"triffid"});
}

TEST_F(CommandLineRender, DrawnStyles) {
  const std::string tree = smallTree("tree.glb", 3);
  Json raw_report, scaled_report;
  const Image photo = picture(tree, {});
  std::vector<Image> pictures{photo};
  for (const char* style : {"edges", "toon", "watercolor", "normals"})
    pictures.push_back(picture(tree, {"--style", style}, &scaled_report));
  EXPECT_GT(scaled_report["bake_seconds"], 0.0);
  // Raw normals need no bake.
  pictures.push_back(picture(tree, {"--style", "edges", "--style-normals", "raw"}, &raw_report));
  EXPECT_EQ(raw_report["bake_seconds"], 0.0);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(difference(pictures[i], pictures[k]), 0.2);
  // A film.
  runWell({"render", tree, "-o", path("clip.png"), "--size", "96x72", "--shadow-map", "256",
           "--style", "watercolour", "--frames", "0:1", "--wind", "18"});
  EXPECT_GT(difference(readImage(path("clip-0000.png")), readImage(path("clip-0001.png"))), 0.05);
}

TEST_F(CommandLineRender, FiguresOfDrawnStyles) {
  runWell({"figures", "npr", "--species", "scots-pine", "--size", "64x64", "-o", path("npr")});
  const std::string page = textOf(path("npr/index.html"));
  for (const char* name : {"figure7-normals-a", "figure7-edges-c", "toon-b", "watercolour-c",
                           "figure8-hedge-edges", "figure8-group-watercolour"}) {
    EXPECT_NE(page.find("'" + std::string(name) + ".png'"), std::string::npos) << name;
    EXPECT_EQ(readImage(path("npr/" + std::string(name) + ".png")).width, 64);
  }
  EXPECT_GT(difference(readImage(path("npr/figure7-edges-a.png")),
                       readImage(path("npr/figure7-edges-c.png"))),
            1.0);
}

TEST_F(CommandLineRender, MovesInWind) {
  const std::string tree = smallTree("tree.glb", 3);
  const Words plain = {"--light", "standard"};
  const auto with = [&](const Words& more) {
    Words all = plain;
    all.insert(all.end(), more.begin(), more.end());
    return picture(tree, all);
  };
  const Image rest = picture(tree, plain);
  EXPECT_EQ(with({"--time", "3", "--wind", "0"}).rgba, rest.rgba);
  const Image gale = with({"--time", "3", "--wind", "18"});
  EXPECT_GT(difference(gale, rest), 0.3);
  EXPECT_EQ(with({"--time", "3", "--wind", "18"}).rgba, gale.rgba);
  // Numbered as the frames are, and exposed as the first: frame 12 of 4 a second is the picture at
  // 3 s, as long as they share its exposure.
  runWell({"render", tree, "-o", path("clip.png"), "--size", "96x72", "--shadow-map", "256",
           "--light", "standard", "--frames", "12:13", "--fps", "4", "--wind", "18"});
  EXPECT_EQ(readImage(path("clip-0012.png")).rgba, gale.rgba);
  EXPECT_GT(difference(readImage(path("clip-0013.png")), gale), 0.1);
  EXPECT_FALSE(std::filesystem::exists(path("clip.png")));
  EXPECT_FALSE(std::filesystem::exists(path("clip-0014.png")));
  runWell({"render", tree, "-o", path("one.png"), "--size", "96x72", "--light", "standard",
           "--time", "3", "--wind", "18", "--motion-vectors", path("way.exr")});
  const HdrImage way = readExrMap(path("way.exr"));
  float farthest = 0.0f;
  for (const glm::vec3& w : way.rgb) farthest = std::max(farthest, glm::length(w));
  EXPECT_GT(farthest, 0.2f);
  EXPECT_LT(farthest, 20.0f);
}

TEST_F(CommandLineRender, MakesFilms) {
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) GTEST_SKIP() << "without ffmpeg";
  const std::string tree = smallTree("tree.glb", 3);
  for (const char* name : {"clip.mp4", "clip.gif"}) {
    // Odd sizes, too.
    runWell({"render", tree, "-o", path(name), "--size", "65x49", "--shadow-map", "64", "--light",
             "standard", "--frames", "0:2", "--fps", "10"});
    EXPECT_GT(std::filesystem::file_size(path(name)), 500u) << name;
  }
  // Nothing but these and the tree is left.
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path(""))) {
    (void)entry;
    ++files;
  }
  EXPECT_EQ(files, 3u);
}

TEST_F(CommandLineRender, ReportOfMotion) {
  const std::string tree = smallTree("tree.glb", 3);
  const Json report = Json::parse(
      runWell({"report", "motion", tree, "-o", path("motion"), "--size", "48x60", "--json"}));
  for (const Json& beam : report["beams"]) {
    EXPECT_NEAR(beam["length"], 1.0, 0.01);
    EXPECT_LT(beam["farthest"], 0.05);
  }
  for (const Json& row : report["spectra"]) {
    if (row["texture"] == "separable")
      EXPECT_LT(row["l1_error"], 0.1);
    else
      EXPECT_GT(row["l1_error"], 0.2);
  }
  EXPECT_GE(report["levels"].size(), 2u);
  const std::string page = textOf(path("motion/index.html"));
  for (const char* name : {"figure4-8.svg", "figure4-10.svg", "figure4-14-2.svg", "tree-16-4.png"})
    EXPECT_NE(page.find(name), std::string::npos) << name;
  EXPECT_GT(
      difference(readImage(path("motion/tree-16-0.png")), readImage(path("motion/tree-16-4.png"))),
      0.05);
}

TEST_F(CommandLineRender, FiguresOfTheSky) {
  runWell({"figures", "sky", "--species", "scots-pine", "--size", "96x72", "-o", path("sky")});
  const std::string page = textOf(path("sky/index.html"));
  std::vector<Image> pictures;
  for (const std::string name :
       {"figure56-morning-2.5", "figure56-midday-2.5", "figure56-sunset-2.5", "figure56-midday-6",
        "figure57-midday", "figure57-sunset", "figure57-sun-ahead"}) {
    EXPECT_NE(page.find("'" + name + ".png'"), std::string::npos) << name;
    pictures.push_back(readImage(path("sky/" + name + ".png")));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_GT(difference(pictures[i], pictures.back()), 1.0) << name << ", " << i;
  }
  EXPECT_NE(page.find("figure53a.png"), std::string::npos);
}

TEST_F(CommandLineRender, FiguresOfLightDepthMaps) {
  runWell(
      {"figures", "gumbau", "--species", "scots-pine", "--size", "64x48", "-o", path("gumbau")});
  const std::string page = textOf(path("gumbau/index.html"));
  std::map<std::string, Image> pictures;
  const std::string opening = "<img src='";
  for (std::size_t at = page.find(opening); at != std::string::npos; at = page.find(opening, at)) {
    at += opening.size();
    const std::string name = page.substr(at, page.find('\'', at) - at);
    EXPECT_TRUE(pictures.try_emplace(name, readImage(path("gumbau/" + name))).second) << name;
    EXPECT_EQ(pictures.at(name).width, 64) << name;
    EXPECT_EQ(pictures.at(name).height, 48) << name;
  }
  EXPECT_EQ(listing().size(), pictures.size() + 2);  // the folder and its page
  const auto shown = [&pictures](const std::string& name) -> const Image& {
    EXPECT_TRUE(pictures.contains(name + ".png")) << name;
    return pictures[name + ".png"];
  };
  for (const auto& [a, b] :
       {std::pair{"figure1a", "figure1b"}, std::pair{"figure3a", "figure3b"},
        std::pair{"figure3c", "figure3d"}, std::pair{"figure4a", "figure4b"},
        std::pair{"figure4-map", "figure4-paper"}, std::pair{"figure4-paper", "figure4-layers"},
        std::pair{"figure4-layers", "figure4-ordered"},
        std::pair{"figure5-walk-standard", "figure5-walk"},
        std::pair{"figure5-above-standard", "figure5-above"}})
    EXPECT_GT(difference(shown(a), shown(b)), 0.2) << a << ", " << b;
  // Surroundings without as much green and blue leave less of them, and red as it is.
  const Image &white = shown("figure2-white"), &red = shown("figure2-reddish"),
              &yellow = shown("figure2-yellow");
  EXPECT_LT(mean(red, 1), mean(yellow, 1));
  EXPECT_LT(mean(yellow, 1), mean(white, 1));
  EXPECT_LT(mean(yellow, 2), mean(red, 2));
  EXPECT_LT(mean(red, 2), mean(white, 2));
  // Leaves darken with the exponent.
  EXPECT_LT(mean(shown("figure2-n2"), 1), mean(shown("figure2-n1"), 1));
  EXPECT_LT(mean(shown("figure2-n1"), 1), mean(shown("figure2-n0.5"), 1));
  EXPECT_EQ(difference(shown("figure2-n1"), white), 0.0);
  // Light through leaves makes the shadow on the ground brighter.
  EXPECT_GT(mean(shown("figure4b"), 1), mean(shown("figure4a"), 1));
}

TEST_F(CommandLineRender, SaysWhatToInstallWithoutVulkan) {
  const std::string tree = smallTree();
  const Words nothing = {"VK_ICD_FILENAMES=/nonexistent", "VK_DRIVER_FILES=/nonexistent"};
  expectRefused({"render", tree, "-o", path("out.png")},
                {"Vulkan", "install", "mesa-vulkan-drivers"}, nothing);
  expectRefused({"figures", "luft", "-o", path("figures")}, {"Vulkan", "install"}, nothing);
  expectRefused({"figures", "sky", "-o", path("figures")}, {"Vulkan", "install"}, nothing);
  EXPECT_EQ(run({"bake", tree, "-o", path("out.glb")}, nothing).code, 0);  // needs no device
}

TEST_F(CommandLineRender, ForeignPlants) {
  const char* folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  int plants = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().string());
    ++plants;
    const Json found = Json::parse(runWell({"inspect", entry.path(), "--json"}));
    EXPECT_GT(found["leaves"], 0);
    if (found["vertices"] > 50000) continue;  // read, but not baked: that is one way for all
    runWell({"bake", entry.path(), "-o", path("baked.glb"), "--grid", "48"});
    Json report;
    picture(path("baked.glb"), {}, &report);
    EXPECT_EQ(report["bake_seconds"], 0.0);
  }
  EXPECT_GT(plants, 0);
}

}  // namespace
}  // namespace verdure::test
