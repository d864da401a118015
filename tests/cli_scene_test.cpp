// Scene files as their user meets them.
#include <algorithm>
#include <cmath>

#include "command_line.h"
#include "verdure/image.h"

namespace verdure::test {
namespace {

class CommandLineScene : public CommandLine {
 protected:
  /// A scene file with these members beside what all have.
  std::string scene(const std::string& name, const Json& members) const {
    Json json = {{"format", "verdure-scene"}, {"version", 1}, {"width", 64}, {"height", 48}};
    json["look"] = {{"light", "standard"}, {"shadow_map", 128}};
    json.update(members);
    writeFile(path(name), json.dump(1));
    return path(name);
  }

  Image picture(const Words& arguments) const {
    Words command = {"render"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    command.insert(command.end(), {"-o", path("out.png")});
    runWell(command);
    return readImage(path("out.png"));
  }
};

double difference(const Image& a, const Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

TEST_F(CommandLineScene, SavesWhatItDrew) {
  const std::string tree = smallTree("tree.glb");
  fs::create_directories(dir_ / "scenes");
  const std::string saved = path("scenes/saved.json");
  const Words options = {"--size",       "32x24",  "--sun",   "-50,20", "--light", "expressive",
                         "--grid",       "30",     "--rho",   "0.5",    "--terms", "ambient,shadow",
                         "--background", "0,0,1",  "--wind",  "9",      "--time",  "2.5",
                         "--camera",     "-60,30", "--fov",   "40",     "--bloom", "0.3",
                         "--shadow-map", "64",     "--key",   "0.2",    "--bands", "4",
                         "--cascades",   "2",      "--style", "toon",   "--gusts", "0.2",
                         "--foliage",    "leaf"};
  Words command = {tree, "--save-scene", saved};
  command.insert(command.end(), options.begin(), options.end());
  const Image drawn = picture(command);
  EXPECT_EQ(jsonOf(saved)["plants"][0]["file"], "../tree.glb");
  EXPECT_EQ(picture({saved}).rgba, drawn.rgba);
  // What is given beside it changes it, and it alone.
  command[1] = "--json";
  command.erase(command.begin() + 2);
  const Words others = {"--sun", "120,50", "--camera", "10,20"};
  for (std::size_t i = 0; i + 1 < others.size(); i += 2)
    *(std::find(command.begin(), command.end(), others[i]) + 1) = others[i + 1];
  Words changed = {saved};
  changed.insert(changed.end(), others.begin(), others.end());
  const Image other = picture(changed);
  EXPECT_EQ(other.rgba, picture(command).rgba);
  EXPECT_GT(difference(other, drawn), 1.0);
}

TEST_F(CommandLineScene, OptionsStandAboveWhatTheFileSays) {
  const std::string tree = smallTree("tree.glb");
  const Json plants = Json::array({{{"file", "tree.glb"}}});
  const Words plain = {tree, "--size", "64x48", "--light", "standard", "--shadow-map", "128"};
  const auto with = [&](const Words& more) {
    Words all = plain;
    all.insert(all.end(), more.begin(), more.end());
    return picture(all);
  };
  const std::string dated =
      scene("dated.json", {{"plants", plants},
                           {"daylight", {{"date", "2026-06-21T16:00Z"}, {"place_deg", {51, 0}}}},
                           {"exposure", {{"ev", 13}, {"white", 3}}},
                           {"camera", {{"eye_m", {9, 4, 9}}, {"target_m", {0, 3, 0}}}}});
  const Words camera = {"--camera", "9,4,9,0,3,0"};
  EXPECT_EQ(picture({dated}).rgba,
            with({"--date", "2026-06-21T16:00Z", "--place", "51,0", "--exposure", "13", "--white",
                  "3", "--camera", "9,4,9,0,3,0"})
                .rgba);
  EXPECT_EQ(picture({dated, "--sun", "10,60", "--exposure", "auto", "--white", "auto"}).rgba,
            with({"--sun", "10,60", "--camera", "9,4,9,0,3,0"}).rgba);
  EXPECT_EQ(
      picture({dated, "--date", "2026-06-21T10:00Z", "--camera", "auto"}).rgba,
      with({"--date", "2026-06-21T10:00Z", "--place", "51,0", "--exposure", "13", "--white", "3"})
          .rgba);
}

TEST_F(CommandLineScene, DrawsScatteredPlants) {
  smallTree("tree.glb");
  Json members = {{"plants", Json::array({{{"file", "tree.glb"}}})},
                  {"placements", Json::array({{{"position_m", {0, 0, 0}}}})},
                  {"camera", {{"eye_m", {0, 4, 30}}, {"target_m", {0, 3, 0}}}}};
  const Image alone = picture({scene("alone.json", members)});
  members["scatters"] = Json::array(
      {{{"plants", Json::array({{{"radius_m", 3}}})}, {"size_m", {50, 30}}, {"clear_m", 2}}});
  const Image many = picture({scene("many.json", members)});
  EXPECT_GT(difference(alone, many), 2.0);
  EXPECT_EQ(many.rgba, picture({path("many.json"), "--threads", "1"}).rgba);
}

TEST_F(CommandLineScene, MarksMissingPlants) {
  smallTree("tree.glb");
  const Json members = {
      {"plants", Json::array({{{"file", "tree.glb"}}, {{"file", "gone.glb"}}})},
      {"placements",
       Json::array({{{"plant", "tree"}}, {{"plant", "gone"}, {"position_m", {4, 0, 1}}}})}};
  const std::string file = scene("scene.json", members);
  const Outcome outcome = run({"render", file, "-o", path("out.png"), "--json"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err.rfind("verdure: plant 'gone' is missing, a marker stands for it: ", 0), 0u)
      << outcome.err;
  EXPECT_NE(outcome.err.find("gone.glb: no such file"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_EQ(Json::parse(outcome.out)["notes"].size(), 1u);
  // Pink is seen.
  const Image image = readImage(path("out.png"));
  int pink = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    pink += image.rgba[i] > image.rgba[i + 1] + 40 && image.rgba[i + 2] > image.rgba[i + 1] + 20;
  EXPECT_GT(pink, 2);
}

TEST_F(CommandLineScene, IsTracedToo) {
  smallTree("tree.glb");
  const Json members = {
      {"plants", Json::array({{{"file", "tree.glb"}}})},
      {"placements", Json::array({{{"position_m", {0, 0, 0}}, {"turn_deg", 30}},
                                  {{"position_m", {5, 0, 0}}, {"tint", "#ff8080"}}})},
      {"ground", {{"terrain", "hills"}}},
      {"daylight", {{"sun_deg", {30, 30}}}}};
  const std::string file = scene("scene.json", members);
  const Json report = Json::parse(
      runWell({"reference", file, "-o", path("truth.png"), "--samples", "2", "--json"}));
  EXPECT_EQ(report["width"], 64);
  EXPECT_EQ(report["notes"].size(), 2u);  // no terrain, no tints
  const Image traced = readImage(path("truth.png"));
  runWell({"reference", file, "-o", path("dusk.png"), "--samples", "2", "--sun", "30,3"});
  EXPECT_GT(difference(traced, readImage(path("dusk.png"))), 1.0);
}

TEST_F(CommandLineScene, RefusesBrokenScenes) {
  smallTree("tree.glb");
  const auto refused = [&](const Json& members, const Words& said) {
    const std::string file = scene("bad.json", members);
    expectRefused({"render", file, "-o", path("out.png")}, said);
    expectRefused({"reference", file, "-o", path("out.png")}, said);
  };
  refused({{"wind", {{"gusts", 2}}}}, {"bad.json:", "key 'wind.gusts' is 2; choose 0 to 1"});
  refused({{"version", 7}}, {"bad.json:3: key 'version' is 7", "use a newer verdure"});
  refused({{"camra", 1}}, {"key 'camra' is unknown"});
  const Json plants = Json::array({{{"file", "tree.glb"}}});
  // A million square kilometres of daisies.
  refused(
      {{"plants", plants},
       {"scatters",
        Json::array({{{"plants", Json::array({{{"radius_m", 0.05}}})}, {"size_m", {1e6, 1e6}}}})}},
      {"places of plants", "make the area smaller"});
  refused({{"plants", plants},
           {"layouts", Json::array({{{"file", "tree.glb"}, {"plants", {"tree"}}}})}},
          {"tree.glb: has no instances"});
  writeFile(path("bad.json"), std::string("{\"format\": \"verdure-scene\",\n\"version\" 1}"));
  expectRefused({"render", path("bad.json"), "-o", path("out.png")}, {"bad.json:2: syntax error"});
  expectRefused({"render", path("none.json"), "-o", path("out.png")}, {"none.json: no such file"});
  expectRefused({"render", scene("empty.json", Json::object()), "-o", path("out.png")},
                {"no plant is named"});
  expectRefused({"render", path("tree.glb"), "-o", path("out.png"), "--save-scene", path("a.txt")},
                {"a.txt", "use .json"});
}

}  // namespace
}  // namespace verdure::test
