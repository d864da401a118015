// The program as its user meets it: commands that work, and input that does not.
#include <sys/stat.h>

#include <array>
#include <chrono>
#include <limits>
#include <regex>
#include <thread>

#include "command_line.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

const fs::path kSource = fs::path(VERDURE_TEST_DATA) / ".." / "..";

TEST_F(CommandLine, HelpNamesEveryOptionAndDefault) {
  const std::string all = runWell({"--help-all"});
  const std::string guide = textOf(kSource / "docs" / "command-line.md");
  const std::string source = textOf(kSource / "src" / "app" / "main.cpp") +
                             textOf(kSource / "src" / "app" / "option_groups.cpp");
  const std::regex declared("\"(?:-[a-z],)?(--[a-z0-9-]+)\"");
  std::size_t options = 0;
  for (auto at = std::sregex_iterator(source.begin(), source.end(), declared);
       at != std::sregex_iterator(); ++at, ++options) {
    const std::regex whole(at->str(1) + "[^a-z0-9-]");
    EXPECT_TRUE(std::regex_search(all, whole)) << at->str(1) << " is not in --help-all";
    EXPECT_TRUE(std::regex_search(guide, whole)) << at->str(1) << " is not in the guide";
  }
  EXPECT_GT(options, 40u);
  for (const Words& command :
       {Words{"--help"}, Words{"grow", "--help"}, Words{"inspect", "--help"},
        Words{"bake", "--help"}, Words{"render", "--help"}, Words{"figures", "--help"},
        Words{"figures", "luft", "--help"}, Words{"figures", "gumbau", "--help"}})
    EXPECT_NE(runWell(command).find("Usage: "), std::string::npos) << command[0];
  const std::string bake = runWell({"bake", "-h"});
  for (const char* text : {"--grid INT=128", "--k-min FLOAT=0.2", "--field TEXT",
                           "--max-memory FLOAT=4096", "default: from the crown"})
    EXPECT_NE(bake.find(text), std::string::npos) << text << " is not in:\n" << bake;
  EXPECT_TRUE(std::regex_match(runWell({"--version"}), std::regex("verdure [0-9]+\\.[0-9.]+\n")));
}

TEST_F(CommandLine, GrowInspectBakeInspect) {
  const std::string said =
      runWell({"grow", "--species", "quaking-aspen", "-o", path("a.glb"), "--leaves", "card",
               "--texture-size", "64", "--set", "Levels=2", "--set", "Leaves=10"});
  EXPECT_NE(said.find("a.glb: quaking-aspen, "), std::string::npos) << said;
  const Json grown = Json::parse(runWell({"inspect", path("a.glb"), "--json"}));
  EXPECT_GT(grown["leaves"], 50);
  EXPECT_EQ(grown["problems"].size(), 0u);
  const auto count = [&](const char* kind, const char* key) {
    std::size_t sum = 0;
    for (const Json& part : grown["parts"])
      if (part["kind"] == kind) sum += part[key].get<std::size_t>();
    return sum;
  };
  // A card is one quad.
  EXPECT_EQ(count("foliage", "triangles"), 2 * grown["leaves"].get<std::size_t>());
  EXPECT_EQ(count("foliage", "vertices") + count("wood", "vertices"), grown["vertices"]);

  const Json printed = Json::parse(
      runWell({"bake", path("a.glb"), "-o", path("b.glb"), "--report", path("r.json"), "--color1",
               "--grid", "40", "--fraction", "0.5", "--k-min", "0.3", "--json"}));
  const Json report = jsonOf(path("r.json"));
  EXPECT_EQ(printed, report);
  EXPECT_EQ(report["leaves"], grown["leaves"]);
  EXPECT_EQ(report["leaves_without_area"], 0);
  EXPECT_NEAR(report["generators"].get<double>(), 0.5 * grown["leaves"].get<double>(), 1.0);
  EXPECT_NEAR(report["k_min"].get<double>(), 0.3, 1e-6);
  EXPECT_EQ(report["vertices"]["all"], grown["vertices"]);
  EXPECT_EQ(report["vertices"]["foliage"], count("foliage", "vertices"));
  EXPECT_LE(report["vertices"]["open"].get<int>() + report["vertices"]["core"].get<int>(),
            report["vertices"]["all"].get<int>());
  EXPECT_GE(report["vertices"]["mean_ambient"].get<double>(), 0.3);
  EXPECT_LT(report["vertices"]["mean_ambient"].get<double>(), 1.0);
  EXPECT_GT(report["field"]["largest_sum_at_leaves"], report["tau"]);
  EXPECT_TRUE(report["surface"]["watertight"]);
  // A closed triangle mesh of genus 0 has F = 2V - 4; every handle adds two pairs, every further
  // component takes two away, so F is even and at least that for one component.
  const int faces = report["surface"]["triangles"], corners = report["surface"]["vertices"];
  EXPECT_EQ(faces % 2, 0);
  EXPECT_GE(faces, 2 * corners - 4 * report["surface"]["components"].get<int>());
  for (const Json& points : report["grid"]["points"]) EXPECT_GT(points, 3);

  const Json baked = Json::parse(runWell({"inspect", path("b.glb"), "--json"}));
  std::set<std::string> attributes;
  for (const Json& name : baked["attributes"]) attributes.insert(name);
  EXPECT_TRUE(attributes.count("_AO") == 1 && attributes.count("COLOR_1") == 1) << baked;
  EXPECT_EQ(baked["parts"], grown["parts"]);
  EXPECT_EQ(baked["bounds"], grown["bounds"]);
  EXPECT_NE(runWell({"inspect", path("b.glb")}).find("_AO"), std::string::npos);
}

TEST_F(CommandLine, WhereRaysGiveAllNoFieldIsBaked) {
  const std::string tree = smallTree();
  Words command = {"bake",      tree,   "-o",     path("b.glb"), "--ambient", "ray-traced",
                   "--normals", "keep", "--rays", "8",           "--json"};
  const Json report = Json::parse(runWell(command));
  EXPECT_EQ(report["kind"], "none");
  EXPECT_GT(report["rays"]["mean_ambient"].get<double>(), 0.1);
  EXPECT_LT(report["rays"]["mean_ambient"].get<double>(), 1.0);
  const Json baked = Json::parse(runWell({"inspect", path("b.glb"), "--json"}));
  EXPECT_NE(baked["attributes"].dump().find("_AO"), std::string::npos);
  command.resize(6);  // crown normals come from the field
  command.insert(command.end(), {"--rays", "8", "--json"});
  EXPECT_EQ(Json::parse(runWell(command))["kind"], "optical-depth");
}

TEST_F(CommandLine, ListsSpeciesAndParameters) {
  const Json species = Json::parse(runWell({"grow", "--list", "--json"}));
  const std::string list = runWell({"grow", "--list"});
  ASSERT_GT(species.size(), 3u);
  for (const Json& s : species) {
    EXPECT_NE(list.find(s["name"]), std::string::npos);
    EXPECT_NE(runWell({"grow", "--parameters", "--species", s["name"]}).find("Levels"),
              std::string::npos);
  }
}

TEST_F(CommandLine, ThreadsDoNotChangeAByte) {
  const std::string tree = smallTree();
  runWell({"--threads", "1", "bake", tree, "-o", path("one.glb")});
  runWell({"bake", tree, "-o", path("two.glb"), "--threads", "2"});
  EXPECT_TRUE(readFile(path("one.glb")) == readFile(path("two.glb")));
}

TEST_F(CommandLine, OptionsThatRepeatTakeOneValueEach) {
  const std::string tree = smallTree();
  EXPECT_NE(runWell({"inspect", "--wood", "bark", "--wood", "twig", "--foliage", "leaf", tree})
                .find("leaves"),
            std::string::npos);
}

/// The example of docs/population.md.
Json layoutOfTheGuide() {
  const std::string guide = textOf(kSource / "docs" / "population.md");
  const std::size_t begin = guide.find("```json\n") + 8, end = guide.find("```", begin);
  return Json::parse(guide.substr(begin, end - begin));
}

TEST_F(CommandLine, PopulationOfTheGuide) {
  const Json layout = layoutOfTheGuide();
  const std::string tree = smallTree("oak.glb");
  fs::create_directories(dir_ / "layout");
  for (const Json& file : layout["plants"]) smallTree("layout/" + file.get<std::string>());
  writeFile(dir_ / "layout" / "grove.json", layout.dump());
  const Words command = {
      "bake",   tree, "-o",       path("grove.glb"), "--population", path("layout/grove.json"),
      "--grid", "32", "--report", path("r.json")};
  const std::string said = runWell(command);
  EXPECT_NE(said.find("no longer be instanced"), std::string::npos) << said;
  EXPECT_NE(said.find(path("grove-000.glb")), std::string::npos) << said;
  const std::size_t count = layout["placements"].size();
  ASSERT_GE(count, 2u);
  const Json report = jsonOf(path("r.json"));
  ASSERT_EQ(report.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string file = "grove-00" + std::to_string(i) + ".glb";
    EXPECT_EQ(report[i]["file"], file);
    const Json plant = Json::parse(runWell({"inspect", path(file), "--json"}));
    EXPECT_EQ(plant["vertices"], report[i]["vertices"]["all"]);
    EXPECT_NE(plant["attributes"].dump().find("_AO"), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(path("grove.glb")));
  // The same plant alone is lighter than among neighbours.
  runWell({"bake", tree, "-o", path("alone.glb"), "--report", path("alone.json"), "--grid", "32"});
  EXPECT_LT(report[0]["vertices"]["mean_ambient"],
            jsonOf(path("alone.json"))["vertices"]["mean_ambient"]);
}

TEST_F(CommandLine, SurfaceFromAFile) {
  const std::string tree = smallTree();
  // A box around the tree, as OBJ and as GLB: every leaf gets one of six normals.
  const Json bounds = Json::parse(runWell({"inspect", tree, "--json"}))["bounds"];
  std::string obj;
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i) {
    glm::vec3 p;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const float low = bounds["min"][axis], high = bounds["max"][axis];
      p[a] = (i >> a & 1) != 0 ? high + 1.0f : low - 1.0f;
    }
    corners.push_back(p);
    obj +=
        "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
  }
  std::vector<std::uint32_t> faces;
  for (const std::array<std::uint32_t, 4>& q : {std::array{0u, 4u, 6u, 2u},
                                                {1u, 3u, 7u, 5u},
                                                {0u, 1u, 5u, 4u},
                                                {2u, 6u, 7u, 3u},
                                                {0u, 2u, 3u, 1u},
                                                {4u, 5u, 7u, 6u}})
    for (const int k : {0, 1, 2, 0, 2, 3}) faces.push_back(q[static_cast<std::size_t>(k)]);
  for (std::size_t i = 0; i < faces.size(); i += 3)
    obj += "f " + std::to_string(faces[i] + 1) + " " + std::to_string(faces[i + 1] + 1) + " " +
           std::to_string(faces[i + 2] + 1) + "\n";
  writeFile(path("box.obj"), obj);
  GltfBuilder box;
  box.mesh({{"attributes", {{"POSITION", box.floats(corners)}}}, {"indices", box.indices(faces)}});
  box.node({{"mesh", 0}});
  writeFile(path("box.glb"), box.glb());
  for (const char* surface : {"box.obj", "box.glb"}) {
    const Json report = Json::parse(
        runWell({"bake", tree, "-o", path("lit.glb"), "--surface", path(surface), "--json"}));
    EXPECT_EQ(report["surface"]["triangles"], 12) << surface;
    EXPECT_EQ(report["grid"]["points_evaluated"], 0) << surface;
  }
}

TEST_F(CommandLine, InspectFindsAndDrawsBranches) {
  const std::string tree = smallTree();
  const Json json =
      Json::parse(runWell({"inspect", tree, "--json", "--skeleton", path("tree.obj")}));
  std::size_t branches = 0, lines = 0, objects = 0;
  for (const Json& level : json["branches_by_level"]) {
    branches += level["branches"].get<std::size_t>();
    EXPECT_GT(level["length_m"], 0.0);
  }
  EXPECT_GT(branches, 1u);
  EXPECT_EQ(json["branches"], branches);
  EXPECT_EQ(json["levels"], json["branches_by_level"].size());
  std::istringstream obj(textOf(path("tree.obj")));
  std::size_t vertices = 0, used = 0;
  for (std::string line; std::getline(obj, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    vertices += kind == "v" ? 1 : 0;
    objects += kind == "o" ? 1 : 0;
    lines += kind == "l" ? 1 : 0;
    if (kind != "l") continue;
    for (std::size_t v = 0; words >> v; ++used) EXPECT_EQ(v, used + 1);
  }
  EXPECT_EQ(lines, branches);
  EXPECT_EQ(used, vertices);
  EXPECT_EQ(objects, json["branches_by_level"].size());
  EXPECT_NE(runWell({"inspect", tree, "--skeleton", path("tree.png")}).find("levels, known"),
            std::string::npos);
  const Image drawing = readImage(path("tree.png"));
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < drawing.rgba.size(); i += 4)
    drawn += drawing.rgba[i + 2] < 60 ? 1 : 0;
  EXPECT_GT(drawn, 1000u);
  expectRefused({"inspect", tree, "--skeleton", path("tree.svg")}, {"tree.svg", ".obj or .png"});
  EXPECT_FALSE(fs::exists(path("tree.svg")));
}

TEST_F(CommandLine, RefusesFilesThatAreNoPlants) {
  const auto good = readFile(smallTree());
  const std::string bad = path("bad.glb"), out = path("out.glb");
  const auto refused = [&](const std::vector<std::uint8_t>& bytes, const Words& said) {
    writeFile(bad, bytes);
    expectRefused({"bake", bad, "-o", out}, said);
  };
  expectRefused({"bake", path("none.glb"), "-o", out}, {"none.glb: no such file; check the path"});
  expectRefused({"inspect", path("none.glb")}, {"none.glb: no such file"});
  expectRefused({"inspect", dir_.string() + "/no\nfile.glb"}, {"no file.glb: no such file"});
  for (const std::size_t size : {std::size_t{0}, std::size_t{11}, std::size_t{20}, good.size() / 9,
                                 good.size() / 2, good.size() - 1})
    refused({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}, {"bad.glb: "});
  const std::string text = "I am a text\nof two lines\n";
  refused({text.begin(), text.end()}, {"bad.glb: is not a glTF file"});
  const std::vector<glm::vec3> two = {{0, 0, 0}, {1, 0, 0}};
  {
    LeafFile file(two);
    file.json["meshes"][0]["primitives"][0]["indices"] = file.indices({0, 1, 99});
    refused(file.glb(), {"bad.glb: ", "is 99, but there are 8 vertices", "export"});
  }
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    refused(LeafFile({{0, 0, 0}, {0, value, 0}}).glb(), {"bad.glb: ", "is not finite"});
  for (const std::uint64_t count : {std::uint64_t{4000000000}, ~std::uint64_t{0}}) {
    LeafFile file(two);
    file.json["accessors"][0]["count"] = count;
    refused(file.glb(), {"bad.glb: accessor 0"});
  }
  writeFile(bad, LeafFile({{0, 0, 0}}).glb());
  expectRefused({"bake", bad, "-o", out, "--field", "metaball"}, {"single leaf"});
  refused(LeafFile(two, 0.0f).glb(), {"2 leaves have zero area"});
  writeFile(path("picture.png"), encodePng(Image(4, 4)));
  expectRefused({"bake", path("picture.png"), "-o", out}, {"picture.png: ", "use .glb, .gltf"});
  ASSERT_EQ(mkfifo(path("pipe.glb").c_str(), 0600), 0);
  expectRefused({"inspect", path("pipe.glb")}, {"pipe.glb: is no regular file"});
}

TEST_F(CommandLine, RefusesParametersOfTheBake) {
  const std::string tree = smallTree(), out = path("out.glb");
  const auto refused = [&](const Words& options, const Words& said) {
    Words command = {"bake", tree, "-o", out};
    command.insert(command.end(), options.begin(), options.end());
    expectRefused(command, said);
  };
  refused({"--wood", "*"}, {"no foliage", "--foliage"});
  refused({"--foliage", "petal*"}, {"tree.glb: ", "'petal*'", "the file has bark, leaf"});
  for (const char* rho : {"0", "-1", "nan", "inf"})
    refused({"--rho", rho}, {"rho must be above 0", "leave --rho out"});
  refused({"--rho", "abc"}, {"--rho = abc", "see verdure bake --help"});
  refused({"--rho", ""}, {"is empty"});
  refused({"--grid", "0"}, {"grid", "128 is usual"});
  refused({"--grid", "1.5"}, {"--grid = 1.5"});
  refused({"--grid", "900", "--max-memory", "0.5"}, {"MiB", "--grid", "--max-memory"});
  refused({"--max-memory", "nan"}, {"--max-memory"});
  refused({"--norm", "0.5"}, {"--norm: ", "at least 1"});
  refused({"--norm", "abc"}, {"--norm: 'abc' is no number"});
  refused({"--normals", "abc"}, {"--normals: 'abc' is unknown; use optical-depth"});
  refused({"--field", "abc"}, {"--field: 'abc' is unknown"});
  refused({"--field", "optical-depth", "--rho", "1"}, {"--rho: belongs to the metaball field"});
  refused({"--field", "metaball", "--normals", "optical-depth"}, {"--normals optical-depth: "});
  refused({"--fraction", "0"}, {"fraction"});
  refused({"--k-min", "2"}, {"k_min"});
  refused({"--exponent", "nan"}, {"exponent"});
  refused({"--blend", "-1"}, {"blend"});
  refused({"--d-min", "0"}, {"d_min"});
  refused({"--tau", "-1"}, {"tau must not be negative"});
  for (const char* directions : {"0", "1", "4097", "-6"})
    refused({"--ambient", "leaf-visibility", "--directions", directions},
            {"--directions: ", directions, "not in range 2 to 4096", "see verdure bake --help"});
  for (const char* rays : {"0", "-1", "65537"})
    refused({"--ambient", "leaf-visibility", "--rays", rays},
            {"--rays: ", rays, "not in range 1 to 65536"});
  refused({"--ambient", "visible"}, {"--ambient: 'visible' is unknown"});
  // The message holds the maximum: just below it there is a surface, above it none.
  const Outcome high = run({"bake", tree, "-o", out, "--tau", "1e6"});
  EXPECT_EQ(high.code, 2);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(high.err, match, std::regex("largest kernel sum, ([0-9.]+):")))
      << high.err;
  const double most = std::stod(match[1]);
  refused({"--tau", std::to_string(1.01 * most)}, {"smaller --tau"});
  runWell({"bake", tree, "-o", out, "--tau", std::to_string(0.9 * most)});
}

TEST_F(CommandLine, RefusesOutputsThatCannotBeWritten) {
  const std::string tree = smallTree();
  expectRefused({"bake", tree, "-o", path("no/out.glb")},
                {"no/out.glb: cannot be written", "fold"});
  expectRefused({"bake", tree, "-o", "/proc/out.glb"}, {"/proc/out.glb: cannot be written"});
  fs::create_directories(path("folder.glb"));
  expectRefused({"bake", tree, "-o", path("folder.glb")}, {"is a folder; name a file"});
  expectRefused({"bake", tree, "-o", path("out.obj")}, {"out.obj: ", "use .glb or .gltf"});
  expectRefused({"bake", tree, "-o", path(std::string(300, 'a') + ".glb")}, {"cannot be written"});
  expectRefused({"grow", "-o", path("no/out.glb")}, {"no/out.glb: cannot be written"});
  expectRefused({"grow", "-o", path("out.obj")}, {"out.obj: ", "use .glb or .gltf"});
  const Words bake = {"bake", tree, "-o", path("out.glb")};
  const auto refused = [&](const std::string& report, const Words& said) {
    Words command = bake;
    command.insert(command.end(), {"--report", report});
    expectRefused(command, said);
  };
  refused(path("no/r.json"), {"no/r.json: cannot be written"});
  refused(path("out.glb"), {"--report", "another file"});
  refused("/dev/null", {"/dev/null: is no regular file"});
  // What stood there before a failure stands there after it.
  writeFile(path("out.glb"), "precious");
  expectRefused({"bake", tree, "-o", path("out.glb"), "--tau", "1e6"}, {"tau"});
  EXPECT_EQ(textOf(path("out.glb")), "precious");
  const pid_t child = start({"inspect", tree}, "/dev/full", logs_ / "err");
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2);
  EXPECT_EQ(textOf(logs_ / "err").rfind("verdure: standard output: ", 0), 0u);
}

TEST_F(CommandLine, RefusesWhatCannotGrow) {
  const std::string out = path("out.glb");
  const auto refused = [&](const Words& options, const Words& said) {
    Words command = {"grow", "-o", out};
    command.insert(command.end(), options.begin(), options.end());
    expectRefused(command, said);
  };
  refused({"--species", "triffid"}, {"triffid: there is no such species"});
  refused({"--set", "Foo=1"}, {"Foo: there is no such parameter"});
  refused({"--set", "Levels"}, {"--set: 'Levels' is no assignment; write Param=value"});
  refused({"--set", "=1"}, {"--set: '=1' is no assignment"});
  refused({"--set", "Levels=many"}, {"Levels: 'many' is not a number"});
  refused({"--set", "Levels=99"}, {"Levels: 99 is out of range; give a whole number from 1 to 4"});
  refused({"--set", "Levels=2", "Leaves=3"}, {"not expected: Leaves=3"});
  refused({"--leaves", "origami"}, {"--leaves: 'origami' is unknown; use mesh or card"});
  refused({"--texture-size", "7"}, {"texture_size: 7 is out of range"});
  refused({"--seed", "-1"}, {"--seed = -1"});
  expectRefused({"grow"}, {"-o FILE.glb"});
}

TEST_F(CommandLine, RefusesWordsItDoesNotKnow) {
  expectRefused({}, {"no command is named; use grow, leaf, grass, inspect, bake"});
  expectRefused({"prune"}, {"prune", "verdure --help"});
  expectRefused({"--frobnicate"}, {"--frobnicate"});
  expectRefused({"inspect", "a.glb", "--frobnicate"}, {"--frobnicate", "verdure inspect --help"});
  expectRefused({"inspect"}, {"file is required"});
  expectRefused({"bake", "a.glb"}, {"--output is required"});
  expectRefused({"figures"}, {"no paper is named; use luft, npr, gumbau, leaf, grass or sky"});
  expectRefused({"--threads", "-1", "inspect", "a.glb"}, {"--threads"});
}

TEST_F(CommandLine, RefusesLayouts) {
  const std::string tree = smallTree();
  const auto refused = [&](const std::string& layout, const Words& said, const Words& more = {}) {
    writeFile(path("layout.json"), layout);
    Words command = {"bake", tree, "-o", path("grove.glb"), "--population", path("layout.json")};
    command.insert(command.end(), more.begin(), more.end());
    SCOPED_TRACE(layout);
    expectRefused(command, said);
  };
  refused("trees, please", {"layout.json: is no population layout: it is not JSON", "docs/"});
  for (const char* text : {"[]", "{}", R"({"placements": 3})", R"({"placements": []})"})
    refused(text, {"layout.json: is no population layout: it needs a list \"placements\""});
  refused(R"({"placements": [{}], "trees": []})", {"it may hold \"plants\""});
  refused(R"({"placements": [{}], "plants": "a.glb"})", {"\"plants\" is no list of files"});
  refused(R"({"placements": [{}], "plants": [5]})", {"\"plants\" is no list of files"});
  refused(R"({"placements": [{}], "plants": ["gone.glb"]})", {"gone.glb: no such file"});
  refused(R"({"placements": [{}, 5]})", {"placement 1: is no object"});
  for (const char* index : {"1", "-1", "0.5", "99999999999", "4294967296", "\"oak\""})
    refused(R"({"placements": [{"plant": )" + std::string(index) + "}]}",
            {"placement 0: \"plant\" is ", index, "numbered 0 to 0"});
  refused(R"({"placements": [{"position": [1, 2]}]})", {"placement 0: \"position\""});
  refused(R"({"placements": [{"position": [1, 2, 1e300]}]})", {"placement 0: \"position\""});
  refused(R"({"placements": [{"scale": 0}]})", {"placement 0: \"scale\" is not above 0"});
  refused(R"({"placements": [{"angle": 30}]})", {"placement 0: \"angle\" is unknown", "angle_deg"});
  writeFile(path("tri.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refused(R"({"placements": [{}]})", {"--surface: cannot be used with --population"},
          {"--surface", path("tri.obj")});
  fs::create_directories(path("grove-001.glb"));
  refused(R"({"placements": [{}, {"position": [5, 0, 0]}]})", {"grove-001.glb: is a folder"});
}

TEST_F(CommandLine, RefusesSurfacesWithoutTriangles) {
  const std::string tree = smallTree();
  writeFile(path("points.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  GltfBuilder lines;
  lines.mesh({{"attributes", {{"POSITION", lines.floats({{0, 0, 0}, {1, 0, 0}})}}}, {"mode", 1}});
  lines.node({{"mesh", 0}});
  writeFile(path("lines.glb"), lines.glb());
  for (const char* surface : {"points.obj", "lines.glb", "gone.ply"})
    expectRefused({"bake", tree, "-o", path("out.glb"), "--surface", path(surface)}, {surface});
}

TEST_F(CommandLine, AKilledBakeLeavesNoPartOfAFile) {
  const std::string tree = path("tree.glb"), out = path("out.glb");
  runWell({"grow", "-o", tree, "--leaves", "card", "--set", "Leaves=6"});
  const auto begin = std::chrono::steady_clock::now();
  runWell({"bake", tree, "-o", out});
  const auto whole = std::chrono::steady_clock::now() - begin;
  const auto complete = readFile(out);
  fs::remove(out);
  int killed = 0, finished = 0;
  constexpr int kTimed = 14, kWatched = 6;  // killed after a time, or at the sight of a new name
  for (int round = 0; round < kTimed + kWatched; ++round) {
    // Half of the rounds replace a file.
    if (round % 2 == 0) fs::remove(out);
    if (round % 2 == 1) writeFile(out, "old");
    const pid_t child = start({"bake", tree, "-o", out}, logs_ / "out", logs_ / "err");
    ASSERT_GT(child, 0);
    if (round < kTimed) {
      std::this_thread::sleep_for(whole * round / (kTimed - 3));
    } else {
      const auto until = std::chrono::steady_clock::now() + 3 * whole;
      const auto names = std::distance(fs::directory_iterator(dir_), fs::directory_iterator());
      while (std::distance(fs::directory_iterator(dir_), fs::directory_iterator()) == names &&
             std::chrono::steady_clock::now() < until) {
      }
    }
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    (WIFSIGNALED(status) ? killed : finished) += 1;
    if (!fs::exists(out)) {
      EXPECT_EQ(round % 2, 0);
      continue;
    }
    const auto bytes = readFile(out);
    EXPECT_TRUE(bytes == complete || (round % 2 == 1 && bytes.size() == 3)) << bytes.size();
  }
  EXPECT_GT(killed, 0);
  // Nothing half-written under another name, where files can be written without any; a complete
  // one may wait to be renamed.
  const int nameless = open(dir_.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (nameless < 0) GTEST_SKIP() << "no nameless files on this file system";
  close(nameless);
  for (const auto& entry : fs::directory_iterator(dir_))
    if (entry.path() != tree && entry.path() != out) {
      EXPECT_EQ(entry.file_size(), complete.size()) << entry.path();
    }
}

TEST_F(CommandLine, LeafGrowWritesAFolderOfMaps) {
  const std::string folder = path("leaf");
  const Json said = Json::parse(runWell({"leaf", "grow", "--species", "hedge", "--seed", "3",
                                         "--size", "64", "--age", "0.8", "-o", folder, "--json"}));
  EXPECT_EQ(said["species"], "hedge");
  EXPECT_EQ(said["size"], 64);
  EXPECT_GT(said["area_mm2"], 300);
  EXPECT_LT(said["area_mm2"], 1500);
  const Json leaf = Json::parse(textOf(fs::path(folder) / "leaf.json"));
  EXPECT_EQ(leaf["name"], "hedge");
  EXPECT_NEAR(leaf["mm_per_texel"].get<double>(), said["mm_per_texel"].get<double>(), 1e-6);
  const Image albedo = readImage(fs::path(folder) / "front_albedo.png");
  EXPECT_EQ(albedo.width, 64);
  EXPECT_EQ(albedo.height, 64);
  const std::string list = runWell({"leaf", "grow", "--list"});
  for (const char* name : {"silver-birch", "black-oak", "scots-pine"})
    EXPECT_NE(list.find(name), std::string::npos) << name;
  expectRefused({"leaf", "grow"}, {"no folder is named", "-o"});
  expectRefused({"leaf", "grow", "--species", "beech", "-o", folder}, {"beech", "silver-birch"});
  expectRefused({"leaf", "grow", "--size", "8", "-o", folder}, {"8 texels", "16 to 8192"});
  expectRefused({"leaf", "grow", "--age", "nan", "-o", folder}, {"leaf age", "0 (spring)"});
}

}  // namespace
}  // namespace verdure::test
