#include "command_line.h"

namespace verdure::test {
namespace {

class CommandLineExport : public CommandLine {};

TEST_F(CommandLineExport, WritesEveryTargetOfTheList) {
  const std::string tree = smallTree();
  const Json list = Json::parse(runWell({"export", "--list", "--json"}));
  ASSERT_GE(list.size(), 10u);
  for (const Json& target : list) {
    const std::string name = target["name"];
    fs::create_directories(dir_ / "out");
    const Json report =
        Json::parse(runWell({"export", tree, "-o", path("out/oak.glb"), "--wind", name, "--json"}));
    EXPECT_FALSE(report["attributes"].empty());
    EXPECT_GT(report["branches"], 10);
    std::size_t found = 0;
    for (const Json& file : report["files"]) {
      EXPECT_EQ(fs::file_size(file["path"].get<std::string>()), file["bytes"]);
      ++found;
    }
    EXPECT_EQ(static_cast<std::size_t>(
                  std::distance(fs::directory_iterator(dir_ / "out"), fs::directory_iterator())),
              found);
    EXPECT_EQ(found, name == "pivot-painter2" ? 4u : 2u) << name;
    fs::remove_all(dir_ / "out");
  }
}

TEST_F(CommandLineExport, WritesAClip) {
  const Json clip =
      Json::parse(runWell({"export", smallTree(), "-o", path("clip.glb"), "--skin", "--seconds",
                           "1.5", "--fps", "20", "--joints", "40", "--json"}))["clip"];
  EXPECT_EQ(clip["frames"], 30);
  EXPECT_LE(clip["joints"], 40);
  EXPECT_LT(clip["error_wood_rms_m"], clip["motion_rms_m"]);
  // The same again, and with other threads.
  const auto bytes = readFile(path("clip.glb"));
  runWell({"--threads", "1", "export", path("tree.glb"), "-o", path("clip.glb"), "--skin",
           "--seconds", "1.5", "--fps", "20", "--joints", "40"});
  EXPECT_EQ(readFile(path("clip.glb")), bytes);
}

TEST_F(CommandLineExport, SaysThatAPlantSwaysAsAWhole) {
  writeFile(path("leaf.glb"), LeafFile({{0, 1, 0}, {0.3f, 1.2f, 0}}).glb());
  const std::string out = runWell({"export", path("leaf.glb"), "-o", path("out.glb")});
  EXPECT_NE(out.find("one upright branch"), std::string::npos) << out;
}

TEST_F(CommandLineExport, RefusesBadOptions) {
  writeFile(path("leaf.glb"), LeafFile({{0, 1, 0}}).glb());
  const std::string leaf = path("leaf.glb"), out = path("out.glb");
  expectRefused({"export"}, {"no plant"});
  expectRefused({"export", leaf}, {"no output"});
  expectRefused({"export", path("none.glb"), "-o", out}, {"none.glb"});
  expectRefused({"export", leaf, "-o", path("out.fbx")}, {"out.fbx", ".glb"});
  expectRefused({"export", leaf, "-o", out, "--wind", "unreal"},
                {"'unreal'", "pivot-painter2", "vertex-colour:sbox"});
  expectRefused({"export", leaf, "-o", out, "--wind", "attributes", "--skin"}, {"--wind"});
  expectRefused({"export", leaf, "-o", out, "--fps", "30"}, {"--fps", "--skin"});
  for (const Words& bad : {Words{"--seconds", "0.1"},
                           {"--seconds", "61"},
                           {"--seconds", "nan"},
                           {"--fps", "4"},
                           {"--fps", "121"},
                           {"--joints", "7"},
                           {"--joints", "5000"},
                           {"--wind-speed", "-1"},
                           {"--wind-speed", "61"},
                           {"--gusts", "2"},
                           {"--wind-from", "1000"}})
    expectRefused({"export", leaf, "-o", out, "--skin", bad[0], bad[1]}, {bad[0]});
}

}  // namespace
}  // namespace verdure::test
