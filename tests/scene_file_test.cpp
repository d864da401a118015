// Scene files: what they hold, what is refused, and what they load.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <set>

#include "app/json_text.h"
#include "app/loaded_scene.h"
#include "app/scene_settings.h"
#include "base/progress.h"
#include "base/random.h"
#include "gltf_builder.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDocs = VERDURE_TEST_DATA "/../../docs/";

std::string textOf(const fs::path& path) {
  const auto bytes = readFile(path);
  return {bytes.begin(), bytes.end()};
}

PlantSettings plantOf(const std::string& name, const fs::path& file) {
  PlantSettings plant;
  plant.name = name;
  plant.file = file.string();
  return plant;
}

/// A scene in which no value is its default.
SceneSettings unusualScene(const fs::path& folder) {
  SceneSettings s;
  s.width = 123;
  s.height = 77;
  PlantSettings file = plantOf("ash", folder / "plants/ash.glb");
  file.load = {{"leaf*"}, {"bark", "twig"}};
  file.bake.emplace();
  BakeParameters& bake = *file.bake;
  bake.field = "metaball";
  bake.options.rho = 0.31f;
  bake.options.tau = 1.7f;
  bake.options.fraction = 0.6f;
  bake.norm = "2.5";
  bake.options.grid = 99;
  bake.options.d_min = 3.3f;
  bake.options.k_min = 0.15f;
  bake.options.exponent = 1.4f;
  bake.normals = "surface-vertex";
  bake.options.blend = 0.9f;
  bake.options.seed = 4000000000u;
  bake.fit = true;
  bake.max_memory_mib = 512.5;
  MotionSettings& motion = file.motion.emplace();
  motion.flexibility = 1.7f;
  motion.level_flexibility = {1.1f, 0.0f, 0.3f, 2.2f};
  motion.damping_ratio = {0.25f, 0.35f, 0.45f, 0.55f};
  motion.branches = {{7, 0.0f}, {2, 3.3f}};
  PlantSettings grown = plantOf("elm", {});
  grown.grow.species = "black-oak";
  grown.grow.seed = 77;
  grown.grow.leaf_form = LeafForm::kCard;
  grown.grow.set = {{"Levels", "2"}, {"1CurveV", "40"}};
  grown.grow.texture_size = 128;
  grown.grow.leaf_age = 0.9f;
  s.plants = {file, grown};
  s.placements = {{1, {1.1f, 0.3f, -2.7f}, 2.0f, 0.7f, 0x12ab9f, 4000000001u}};
  s.bake_together = true;
  s.layouts = {{(folder / "layout.glb").string(), {1, 0}, true, 9.5f}};
  ScatterSettings scatter;
  scatter.kinds = {{1, 2.5f, 0.4f, {0.3f, 1.7f}}};
  scatter.seed = 18000000000000000001ull;
  scatter.center_m = {3.3f, -4.4f};
  scatter.size_m = {31.0f, 17.1f};
  scatter.per_ha = 123.4f;
  scatter.density_map = (folder / "maps/density.png").string();
  scatter.clear_m = 2.1f;
  scatter.most_slope_deg = 33.3f;
  scatter.height = {-1.5f, 99.9f};
  scatter.hue_spread = 0.33f;
  scatter.brightness_spread = 0.44f;
  s.scatters = {scatter};
  s.detail = 1.9f;
  s.ground.shown = false;
  s.ground.grass = {{"lawn", 0.4f, (folder / "cover.png").string()},
                    {(folder / "own grass").string(), 0.3f, {}}};
  s.ground.grass_seed = 9;
  s.ground.grass_slices = 12;
  s.ground.terrain = (folder / "heights.png").string();
  s.ground.terrain_size_m = {44.0f, 55.5f};
  s.ground.terrain_height_m = {-3.0f, 6.5f};
  s.ground.terrain_seed = 8;
  s.daylight.sky = (folder / "sky.exr").string();
  s.daylight.date = "2026-06-21T12:30+02:00";
  s.daylight.place = Place{52.5, -13.4};
  s.daylight.turbidity = 4.4;
  s.exposure = {11.5f, 0.18, 3.2f, 0.25};
  s.wind = {7.7f, 111.0f, 0.8f, -3.25};
  s.camera = {glm::vec3(1.5f, 2.5f, 3.5f), {0.1f, 0.2f, 0.3f}, {12.0f, 34.0f}, 48.5};
  s.look.light = "depth-maps";
  s.look.terms = std::vector<std::string>{"ambient", "gloss"};
  s.look.shadows = ShadowSource::kDepthPaper;
  s.look.sky_bands = 3;
  s.look.visibility_exponent = 1.3f;
  s.look.background = glm::vec3(0.1f, 0.7f, 0.9f);
  s.look.shadow_map = 333;
  s.look.cascades = 3;
  s.look.style = Style::kToon;
  s.look.style_normals = StyleNormals::kRaw;
  return s;
}

/// Every value of both.
void expectSame(const SceneSettings& a, const SceneSettings& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.plants.size(), b.plants.size());
  for (std::size_t i = 0; i < a.plants.size(); ++i) {
    const PlantSettings &p = a.plants[i], &q = b.plants[i];
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.file, q.file);
    EXPECT_EQ(p.grow.species, q.grow.species);
    EXPECT_EQ(p.grow.seed, q.grow.seed);
    EXPECT_EQ(p.grow.leaf_form, q.grow.leaf_form);
    EXPECT_EQ(p.grow.set, q.grow.set);
    EXPECT_EQ(p.grow.texture_size, q.grow.texture_size);
    EXPECT_EQ(p.grow.leaf_age, q.grow.leaf_age);
    EXPECT_EQ(p.load.foliage, q.load.foliage);
    EXPECT_EQ(p.load.wood, q.load.wood);
    ASSERT_EQ(p.motion.has_value(), q.motion.has_value());
    if (p.motion) {
      EXPECT_EQ(p.motion->flexibility, q.motion->flexibility);
      EXPECT_EQ(p.motion->level_flexibility, q.motion->level_flexibility);
      EXPECT_EQ(p.motion->damping_ratio, q.motion->damping_ratio);
      ASSERT_EQ(p.motion->branches.size(), q.motion->branches.size());
      for (std::size_t n = 0; n < p.motion->branches.size(); ++n) {
        EXPECT_EQ(p.motion->branches[n].branch, q.motion->branches[n].branch);
        EXPECT_EQ(p.motion->branches[n].flexibility, q.motion->branches[n].flexibility);
      }
    }
    ASSERT_EQ(p.bake.has_value(), q.bake.has_value());
    if (!p.bake) continue;
    const DensityOptions &o = p.bake->options, &r = q.bake->options;
    EXPECT_EQ(p.bake->field, q.bake->field);
    EXPECT_EQ(o.rho, r.rho);
    EXPECT_EQ(o.tau, r.tau);
    EXPECT_EQ(o.fraction, r.fraction);
    EXPECT_EQ(p.bake->norm, q.bake->norm);
    EXPECT_EQ(o.grid, r.grid);
    EXPECT_EQ(o.d_min, r.d_min);
    EXPECT_EQ(o.k_min, r.k_min);
    EXPECT_EQ(o.exponent, r.exponent);
    EXPECT_EQ(p.bake->normals, q.bake->normals);
    EXPECT_EQ(o.blend, r.blend);
    EXPECT_EQ(o.seed, r.seed);
    EXPECT_EQ(p.bake->fit, q.bake->fit);
    EXPECT_EQ(p.bake->max_memory_mib, q.bake->max_memory_mib);
  }
  ASSERT_EQ(a.placements.size(), b.placements.size());
  for (std::size_t i = 0; i < a.placements.size(); ++i)
    EXPECT_EQ(std::memcmp(&a.placements[i], &b.placements[i], sizeof(Placement)), 0) << i;
  EXPECT_EQ(a.bake_together, b.bake_together);
  ASSERT_EQ(a.layouts.size(), b.layouts.size());
  for (std::size_t i = 0; i < a.layouts.size(); ++i) {
    EXPECT_EQ(a.layouts[i].file, b.layouts[i].file);
    EXPECT_EQ(a.layouts[i].plants, b.layouts[i].plants);
    EXPECT_EQ(a.layouts[i].heights_of_file, b.layouts[i].heights_of_file);
    EXPECT_EQ(a.layouts[i].scale, b.layouts[i].scale);
  }
  ASSERT_EQ(a.scatters.size(), b.scatters.size());
  for (std::size_t i = 0; i < a.scatters.size(); ++i) {
    const ScatterSettings &p = a.scatters[i], &q = b.scatters[i];
    ASSERT_EQ(p.kinds.size(), q.kinds.size());
    for (std::size_t k = 0; k < p.kinds.size(); ++k) {
      EXPECT_EQ(p.kinds[k].plant, q.kinds[k].plant);
      EXPECT_EQ(p.kinds[k].share, q.kinds[k].share);
      EXPECT_EQ(p.kinds[k].radius_m, q.kinds[k].radius_m);
      EXPECT_EQ(p.kinds[k].scale, q.kinds[k].scale);
    }
    EXPECT_EQ(p.seed, q.seed);
    EXPECT_EQ(p.center_m, q.center_m);
    EXPECT_EQ(p.size_m, q.size_m);
    EXPECT_EQ(p.per_ha, q.per_ha);
    EXPECT_EQ(p.density_map, q.density_map);
    EXPECT_EQ(p.clear_m, q.clear_m);
    EXPECT_EQ(p.most_slope_deg, q.most_slope_deg);
    EXPECT_EQ(p.height, q.height);
    EXPECT_EQ(p.hue_spread, q.hue_spread);
    EXPECT_EQ(p.brightness_spread, q.brightness_spread);
  }
  EXPECT_EQ(a.detail, b.detail);
  EXPECT_EQ(a.ground.shown, b.ground.shown);
  ASSERT_EQ(a.ground.grass.size(), b.ground.grass.size());
  for (std::size_t i = 0; i < a.ground.grass.size(); ++i) {
    EXPECT_EQ(a.ground.grass[i].grass, b.ground.grass[i].grass);
    EXPECT_EQ(a.ground.grass[i].density, b.ground.grass[i].density);
    EXPECT_EQ(a.ground.grass[i].cover, b.ground.grass[i].cover);
  }
  EXPECT_EQ(a.ground.grass_seed, b.ground.grass_seed);
  EXPECT_EQ(a.ground.grass_slices, b.ground.grass_slices);
  EXPECT_EQ(a.ground.terrain, b.ground.terrain);
  EXPECT_EQ(a.ground.terrain_size_m, b.ground.terrain_size_m);
  EXPECT_EQ(a.ground.terrain_height_m, b.ground.terrain_height_m);
  EXPECT_EQ(a.ground.terrain_seed, b.ground.terrain_seed);
  EXPECT_EQ(a.daylight.sky, b.daylight.sky);
  EXPECT_EQ(a.daylight.sun_deg, b.daylight.sun_deg);
  EXPECT_EQ(a.daylight.date, b.daylight.date);
  ASSERT_EQ(a.daylight.place.has_value(), b.daylight.place.has_value());
  if (a.daylight.place) {
    EXPECT_EQ(a.daylight.place->latitude_deg, b.daylight.place->latitude_deg);
    EXPECT_EQ(a.daylight.place->longitude_deg, b.daylight.place->longitude_deg);
  }
  EXPECT_EQ(a.daylight.turbidity, b.daylight.turbidity);
  EXPECT_EQ(a.exposure.ev, b.exposure.ev);
  EXPECT_EQ(a.exposure.key, b.exposure.key);
  EXPECT_EQ(a.exposure.white, b.exposure.white);
  EXPECT_EQ(a.exposure.bloom, b.exposure.bloom);
  EXPECT_EQ(a.wind.speed, b.wind.speed);
  EXPECT_EQ(a.wind.from_deg, b.wind.from_deg);
  EXPECT_EQ(a.wind.gusts, b.wind.gusts);
  EXPECT_EQ(a.wind.seconds, b.wind.seconds);
  EXPECT_EQ(a.camera.eye, b.camera.eye);
  EXPECT_EQ(a.camera.target, b.camera.target);
  EXPECT_EQ(a.camera.from_deg, b.camera.from_deg);
  EXPECT_EQ(a.camera.fov_deg, b.camera.fov_deg);
  EXPECT_EQ(a.look.light, b.look.light);
  EXPECT_EQ(a.look.terms, b.look.terms);
  EXPECT_EQ(a.look.shadows, b.look.shadows);
  EXPECT_EQ(a.look.sky_bands, b.look.sky_bands);
  EXPECT_EQ(a.look.visibility_exponent, b.look.visibility_exponent);
  EXPECT_EQ(a.look.background, b.look.background);
  EXPECT_EQ(a.look.shadow_map, b.look.shadow_map);
  EXPECT_EQ(a.look.cascades, b.look.cascades);
  EXPECT_EQ(a.look.style, b.look.style);
  EXPECT_EQ(a.look.style_normals, b.look.style_normals);
}

TEST(SceneFile, EveryValueSurvives) {
  const fs::path folder = scratchFolder("scene_round");
  SceneSettings scene = unusualScene(folder);
  writeScene(scene, folder / "a.json");
  expectSame(scene, readScene(folder / "a.json"));
  // The other way to say where the sun is.
  scene.daylight.date.clear();
  scene.daylight.place.reset();
  scene.daylight.sun_deg = {201.7f, 12.3f};
  scene.daylight.sky = "cie:12";
  scene.ground.terrain = "hills";
  writeScene(scene, folder / "b.json");
  expectSame(scene, readScene(folder / "b.json"));
  expectSame(SceneSettings{}, [&] {
    writeScene({}, folder / "c.json");
    return readScene(folder / "c.json");
  }());
  // And writing it again gives the same file.
  writeScene(readScene(folder / "b.json"), folder / "d.json");
  EXPECT_EQ(textOf(folder / "b.json"), textOf(folder / "d.json"));
}

TEST(SceneFile, PlacesSurviveToTheBit) {
  const fs::path folder = scratchFolder("scene_bits");
  SceneSettings scene;
  scene.plants = {plantOf("ash", folder / "ash.glb")};
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    Placement place;
    const float far = std::exp2(random.uniform(-20.0f, 20.0f));
    place.position = {random.vary(far), random.vary(far), random.vary(far)};
    place.angle = random.vary(7.0f);
    place.scale = random.uniform(0.01f, 4.0f);
    place.tint = random.next() & 0xffffffu;
    place.phase = random.next();
    scene.placements.push_back(place);
  }
  writeScene(scene, folder / "scene.json");
  expectSame(scene, readScene(folder / "scene.json"));
}

TEST(SceneFile, PathsAreRelativeToTheFile) {
  const fs::path folder = scratchFolder("scene_paths");
  fs::create_directories(folder / "scenes/deep");
  SceneSettings scene = unusualScene(folder);
  writeScene(scene, folder / "scenes/deep/a.json");
  const std::string text = textOf(folder / "scenes/deep/a.json");
  EXPECT_NE(text.find("\"../../plants/ash.glb\""), std::string::npos) << text;
  EXPECT_EQ(text.find(folder.string()), std::string::npos) << text;
  EXPECT_NE(text.find("\"lawn\""), std::string::npos);  // no path
  // The folder as a whole may move.
  fs::rename(folder / "scenes", folder / "moved");
  EXPECT_EQ(readScene(folder / "moved/deep/a.json").plants[0].file,
            (folder / "plants/ash.glb").string());
}

TEST(SceneFile, NamesArePutInWhereTheyAreMissing) {
  const fs::path folder = scratchFolder("scene_names");
  SceneSettings scene;
  for (int i = 0; i < 3; ++i) scene.plants.push_back(plantOf({}, folder / "ash.glb"));
  scene.placements = {{.plant = 2}};
  writeScene(scene, folder / "a.json");
  const SceneSettings read = readScene(folder / "a.json");
  EXPECT_EQ(read.plants[0].name, "ash");
  EXPECT_EQ(read.plants[2].name, "ash-3");
  EXPECT_EQ(read.placements[0].plant, 2u);
}

/// Paths of all keys, without numbers of elements.
void collectKeys(const nlohmann::ordered_json& json, const std::string& path,
                 std::set<std::string>& keys) {
  if (json.is_array())
    for (const auto& part : json) collectKeys(part, path + "[]", keys);
  if (json.is_object())
    for (const auto& [key, value] : json.items()) {
      keys.insert(path + "." + key);
      if (path + "." + key != ".plants[].grow.set") collectKeys(value, path + "." + key, keys);
    }
}

void collectSchemaKeys(const nlohmann::ordered_json& schema, const std::string& path,
                       std::set<std::string>& keys) {
  if (schema.contains("items")) collectSchemaKeys(schema["items"], path + "[]", keys);
  if (schema.contains("properties")) {
    EXPECT_EQ(schema["additionalProperties"], false) << path;
    for (const auto& [key, value] : schema["properties"].items()) {
      keys.insert(path + "." + key);
      collectSchemaKeys(value, path + "." + key, keys);
    }
  }
}

/// The schema of what a written value is, by the path to it.
const nlohmann::ordered_json* schemaOf(const nlohmann::ordered_json& schema,
                                       const std::string& key) {
  return schema.contains("properties") && schema["properties"].contains(key)
             ? &schema["properties"][key]
             : nullptr;
}

/// Defaults that the schema tells are those of a scene that says nothing.
void expectDefaults(const nlohmann::ordered_json& json, const nlohmann::ordered_json& schema,
                    const std::string& path) {
  for (const auto& [key, value] : json.items()) {
    const auto* const part = schemaOf(schema, key);
    ASSERT_NE(part, nullptr) << path << key;
    if (value.is_object()) {
      expectDefaults(value, *part, path + key + ".");
    } else if (part->contains("default")) {
      EXPECT_EQ((*part)["default"], value) << path << key;
    }
  }
}

TEST(SceneFile, TheSchemaAndTheDocumentKnowTheSameKeys) {
  const fs::path folder = scratchFolder("scene_schema");
  SceneSettings scene = unusualScene(folder);
  writeScene(scene, folder / "a.json");
  scene.daylight.date.clear();
  scene.daylight.place.reset();
  scene.daylight.sun_deg = glm::vec2(1.0f);
  writeScene(scene, folder / "b.json");
  std::set<std::string> written, in_schema;
  for (const char* name : {"a.json", "b.json"})
    collectKeys(nlohmann::ordered_json::parse(textOf(folder / name)), "", written);
  const auto schema =
      nlohmann::ordered_json::parse(textOf(std::string(kDocs) + "scene.schema.json"));
  collectSchemaKeys(schema, "", in_schema);
  EXPECT_EQ(written, in_schema);
  const std::string document = textOf(std::string(kDocs) + "scene.md");
  for (const std::string& key : written) {
    const std::string name = key.substr(key.rfind('.') + 1);
    EXPECT_TRUE(document.find("`" + name + "`") != std::string::npos ||
                document.find("." + name + "`") != std::string::npos)
        << key << " is not explained";
  }
  writeScene({}, folder / "plain.json");
  expectDefaults(nlohmann::ordered_json::parse(textOf(folder / "plain.json")), schema, "");
}

TEST(SceneFile, TheDocumentsExampleIsRead) {
  const std::string document = textOf(std::string(kDocs) + "scene.md");
  const std::size_t begin = document.find("```json\n") + 8;
  const std::string example = document.substr(begin, document.find("```", begin) - begin);
  const fs::path file = scratchFolder("scene_example") / "scene.json";
  writeFile(file, example);
  const SceneSettings scene = readScene(file);
  EXPECT_EQ(scene.plants.size(), 3u);
  EXPECT_EQ(scene.plants[2].grow.leaf_form, LeafForm::kCard);
  EXPECT_EQ(scene.placements[1].plant, 2u);
  EXPECT_EQ(scene.placements[1].tint, 0xfff0d8u);
  EXPECT_EQ(scene.scatters[0].kinds[1].plant, 0u);
  // The document's own line of an error.
  std::string wrong = example;
  wrong.replace(wrong.find("\"most_slope_deg\": 30"), 20, "\"most_slope_deg\": 120");
  writeFile(file, wrong);
  try {
    readScene(file);
    FAIL();
  } catch (const Error& e) {
    const std::string said = e.what();
    EXPECT_NE(document.find(said.substr(said.find("scene.json"))), std::string::npos) << said;
  }
}

/// The message of a scene file; `body`: its lines from the fourth on, without the last brace.
std::string errorOf(
    const std::string& body,
    const std::string& head = "{\n\"format\": \"verdure-scene\",\n\"version\": 1,\n") {
  static const fs::path file = scratchFolder("scene_errors") / "scene.json";
  writeFile(file, head + body + "\n}\n");
  try {
    readScene(file);
  } catch (const Error& e) {
    std::string said = e.what();
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    const std::size_t at = said.find("scene.json:");
    EXPECT_NE(at, std::string::npos) << said;
    return at == std::string::npos ? said : said.substr(at);
  }
  return "";
}

TEST(SceneFile, SaysLineAndKeyOfWhatIsWrong) {
  EXPECT_EQ(errorOf("\"detail\": 1"), "");
  const auto starts = [](const std::string& body, const std::string& message) {
    const std::string said = errorOf(body);
    EXPECT_EQ(said.substr(0, message.size()), message) << body;
  };
  starts("\"detial\": 1", "scene.json:4: key 'detial' is unknown; use format, version, width");
  starts("\n\n\"detail\": 0", "scene.json:6: key 'detail' is 0; choose above 0 to 100");
  starts("\"detail\": \"high\"", "scene.json:4: key 'detail' is no number");
  starts("\"width\": 1.5", "scene.json:4: key 'width' is no whole number");
  starts("\"daylight\": {\n\"sun_deg\": [1]}",
         "scene.json:5: key 'daylight.sun_deg' is no list of 2 numbers");
  starts("\"daylight\": {\n\"sun_deg\": [1, -30]}",
         "scene.json:5: key 'daylight.sun_deg' has the elevation -30");
  starts("\"daylight\": {\n\"date\": \"2026-06-21T12:30Z\"}",
         "scene.json:5: key 'daylight.date' needs the other");
  starts("\"daylight\": {\n\"place_deg\": [95, 0],\n\"date\": \"2026-06-21T12:30Z\"}",
         "scene.json:5: key 'daylight.place_deg' has the latitude 95");
  starts("\"daylight\": {\"date\": \"noon\", \"place_deg\": [1, 1]}",
         "scene.json:4: key 'daylight.date' is no time");
  starts("\"daylight\": {\"sky\": \"cie:16\"}", "scene.json:4: key 'daylight.sky' is 'cie:16'");
  starts("\"daylight\": {\"sky\": \"green\"}", "scene.json:4: key 'daylight.sky' is no sky");
  starts("\"daylight\": 5", "scene.json:4: key 'daylight' is no object");
  starts("\"look\": {\"light\": \"candle\"}", "scene.json:4: key 'look.light' is no light");
  starts("\"look\": {\"terms\": [\"glow\"]}", "scene.json:4: key 'look.terms' is wrong");
  starts("\"look\": {\"style\": \"oil\"}",
         "scene.json:4: key 'look.style' is 'oil'; choose photo, normals, edges");
  starts("\"plants\": [\n{\"file\": \"a.glb\"},\n{\"name\": \"b\"}]",
         "scene.json:6: key 'plants[1]' has neither a file nor grow");
  starts("\"plants\": [\n{\"file\": \"a.glb\"},\n{\"file\": \"b/a.glb\"}]",
         "scene.json:6: key 'plants[1].name' is 'a'");
  starts("\"plants\": [{\"grow\": {\n\"species\": \"triffid\"}}]",
         "scene.json:5: key 'plants[0].grow.species' names 'triffid'");
  starts(
      "\"plants\": [{\"file\": \"a.glb\", \"bake\": {\n\"field\": \"optical-depth\",\n\"rho_m\": "
      "2}}]",
      "scene.json:4: key 'plants[0].bake' is no bake: rho_m: belongs to the metaball field");
  starts("\"placements\": [{}]", "scene.json:4: key 'placements[0].plant' names a plant");
  const std::string oak = "\"plants\": [{\"file\": \"oak.glb\"}],\n";
  starts(oak + "\"placements\": [\n{},\n{\"plant\": \"oka\"}]",
         "scene.json:7: key 'placements[1].plant' names 'oka'; the plants are oak");
  starts(oak + "\"placements\": [\n{\"tint\": \"red\"}]",
         "scene.json:6: key 'placements[0].tint' is 'red'");
  starts(oak + "\"placements\": [\n{\"scale\": -1}]",
         "scene.json:6: key 'placements[0].scale' is -1; choose above 0 to 10000");
  starts(oak + "\"placements\": [\n{\"position_m\":\n[1, 2, null]}]",
         "scene.json:6: key 'placements[0].position_m' is no number");
  starts(oak + "\"scatters\": [{\"plants\": [{\"radius_m\": 0}]}]",
         "scene.json:5: key 'scatters[0]' has no per_ha");
  starts(oak + "\"layouts\": [{\"file\": \"a.glb\"}]",
         "scene.json:5: key 'layouts[0].plants' names no plant");
  starts("\"ground\": {\"grass\": [{}]}", "scene.json:4: key 'ground.grass[0]' names no grass");
  starts("\"camera\": {\"eye_m\": [0, 0, 0]}",
         "scene.json:4: key 'camera.target_m' is the eye's own place");
  starts("\"wind\": {\"speed_m_s\": 1e300}", "scene.json:4: key 'wind.speed_m_s' is 1e+300");
  starts("\"wind\": {\n\"seconds\": 1e999 }", "scene.json:5: holds a number that is too large");
  // What is no JSON.
  starts("\"detail\": 1,,", "scene.json:4: syntax error while parsing object key");
  starts("\"detail\": 1,\n\"width\" 5",
         "scene.json:5: syntax error while parsing object separator");
  starts("\"wind\": {\n\"gusts\": 0.1,\n\"gusts\": 0.2}",
         "scene.json:6: key 'wind.gusts' is there twice");
}

TEST(SceneFile, RefusesOtherFilesAndNewerVersions) {
  const auto head = [](const std::string& format, const std::string& version) {
    return errorOf("\"detail\": 1",
                   "{\n\"format\": " + format + ",\n\"version\": " + version + ",\n");
  };
  EXPECT_EQ(head("\"verdure-scene\"", "1"), "");
  EXPECT_EQ(head("\"verdure-scene\"", "2"),
            "scene.json:3: key 'version' is 2, and this program knows scenes up to 1; use a newer "
            "verdure");
  EXPECT_NE(head("\"verdure-scene\"", "\"1\"").find("key 'version' is no version"),
            std::string::npos);
  const fs::path folder = scratchFolder("scene_other");
  const auto said = [&](const std::string& text) -> std::string {
    writeFile(folder / "scene.json", text);
    try {
      readScene(folder / "scene.json");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(said("[]").find("no JSON object"), std::string::npos);
  EXPECT_NE(said("{}").find("is no scene"), std::string::npos);
  EXPECT_NE(said("").find("scene.json:1: "), std::string::npos);
  EXPECT_NE(said("{\"format\": \"verdure-grass\"}").find("is no scene"), std::string::npos);
  EXPECT_NE(said("\xff\xfe{}").find("scene.json:1: "), std::string::npos);
  // Truncated anywhere, it is refused and never crashes.
  writeScene(unusualScene(folder), folder / "whole.json");
  const std::string whole = textOf(folder / "whole.json");
  for (std::size_t size = 0; size + 2 < whole.size(); size += 37)
    EXPECT_NE(said(whole.substr(0, size)), "") << size;
}

TEST(SceneFile, DamagedFilesAreReadOrRefused) {
  const fs::path folder = scratchFolder("scene_damage");
  writeScene(unusualScene(folder), folder / "whole.json");
  const std::string whole = textOf(folder / "whole.json");
  const std::string pieces[] = {
      "0",  "-1",   "1e999", "\"\"", "null", "[]", "{}",
      "[1", "true", "\n",    "\"x",  "}",    ",",  "18446744073709551616"};
  Random random(11);
  std::size_t refused = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = whole;
    const auto at = random.below(static_cast<std::uint32_t>(text.size()));
    if (i % 3 == 0)
      text[at] = static_cast<char>(random.below(256));
    else
      text.replace(at, i % 3 == 1 ? 0 : random.below(9), pieces[random.below(std::size(pieces))]);
    writeFile(folder / "scene.json", text);
    try {
      readScene(folder / "scene.json");
    } catch (const Error& e) {
      ++refused;
      EXPECT_NE(std::string(e.what()).find("scene.json"), std::string::npos) << e.what();
    }
  }
  EXPECT_GT(refused, 700u);
}

TEST(SceneFile, IsWrittenWholeOrNotAtAll) {
  const fs::path folder = scratchFolder("scene_atomic");
  SceneSettings scene = unusualScene(folder);
  writeScene(scene, folder / "a.json");
  const std::string before = textOf(folder / "a.json");
  scene.plants[0].name = "no\xff utf8";
  EXPECT_THROW(writeScene(scene, folder / "a.json"), Error);
  EXPECT_EQ(textOf(folder / "a.json"), before);
  EXPECT_THROW(writeScene(scene, folder / "none/a.json"), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

/// A scene of boxes, which needs no bake.
SceneSettings boxScene(const fs::path& folder) {
  writeFile(folder / "box.glb", BoxFile().glb());
  SceneSettings scene;
  scene.look.light = "standard";
  scene.look.shadows = ShadowSource::kShadowMap;
  scene.plants = {plantOf("box", folder / "box.glb")};
  return scene;
}

TEST(LoadedScene, WithoutPlacesAPlantStandsAsItsFileHasIt) {
  const LoadedScene loaded(boxScene(scratchFolder("loaded_alone")));
  const Scene scene = loaded.scene();
  ASSERT_EQ(scene.items.size(), 1u);
  EXPECT_EQ(scene.forest, nullptr);
  EXPECT_EQ(scene.items[0].world_from_plant, std::vector{glm::mat4(1.0f)});
  EXPECT_EQ(scene.ground_height, -1.0f);  // a box around the origin stands on its lowest face
  EXPECT_EQ(loaded.lightName(), "standard");
  EXPECT_TRUE(loaded.notes().empty());
}

TEST(LoadedScene, PlantsThatStandOnceAreDrawnWhole) {
  SceneSettings settings = boxScene(scratchFolder("loaded_once"));
  settings.plants.push_back(settings.plants[0]);
  settings.plants[1].name = "other";
  settings.placements = {{.plant = 0, .position = {4, 0, 0}},
                         {.plant = 1, .position = {7, 2, 0}, .scale = 2.0f},
                         {.plant = 1, .position = {9, 0, 0}}};
  const LoadedScene loaded(settings);
  const Scene scene = loaded.scene();
  ASSERT_EQ(scene.items.size(), 1u);
  EXPECT_EQ(scene.ground_height, 0.0f);
  // Its foot, 1 m below its origin, stands on the ground.
  EXPECT_EQ(glm::vec3(scene.items[0].world_from_plant[0][3]), glm::vec3(4, 1, 0));
  ASSERT_NE(scene.forest, nullptr);
  ASSERT_EQ(scene.forest->places.size(), 2u);
  EXPECT_EQ(scene.forest->places[0].position, glm::vec3(7, 4, 0));
  EXPECT_EQ(scene.forest->kinds[1].plant, &loaded.plants()[1].plant);
  EXPECT_EQ(scene.forest->kinds[1].levels, nullptr);  // too few to be worth it
  // A camera that shows all shows them, too.
  const Camera camera = loaded.view().camera;
  EXPECT_GT(glm::distance(camera.eye, camera.target), 8.0f);
  // The path tracer gets them at all their places.
  LoadSceneOptions traced;
  traced.for_reference = true;
  const LoadedScene reference(settings, traced);
  const Scene shown = reference.scene();
  EXPECT_EQ(shown.forest, nullptr);
  ASSERT_EQ(shown.items.size(), 2u);
  EXPECT_EQ(shown.items[1].world_from_plant.size(), 2u);
}

TEST(LoadedScene, NeighboursThatAreBakedTogetherDarkenEachOther) {
  SceneSettings settings;
  settings.look.light = "expressive";
  settings.plants = {plantOf("shrub", {})};
  settings.plants[0].grow.leaf_form = LeafForm::kCard;
  settings.plants[0].grow.texture_size = 32;
  settings.plants[0].grow.set = {{"Levels", "2"}, {"Leaves", "6"}};
  settings.plants[0].bake.emplace();
  settings.plants[0].bake->options.grid = 24;
  settings.plants[0].bake->options.rho = 1.5f;
  settings.bake_together = true;
  const auto meanAmbients = [&settings](float apart) {
    settings.placements = {{.plant = 0}, {.plant = 0, .position = {apart, 0, 0}, .angle = 2.0f}};
    const LoadedScene loaded(settings);
    const Scene scene = loaded.scene();
    EXPECT_EQ(scene.items.size(), 2u);
    std::vector<double> means;
    for (const SceneItem& item : scene.items) {
      double sum = 0.0, count = 0.0;
      if (item.light == nullptr) continue;
      for (const MeshLight& mesh : item.light->meshes)
        for (const float k : mesh.ambient) {
          sum += double{k};
          ++count;
        }
      means.push_back(sum / count);
    }
    return means;
  };
  const std::vector<double> far = meanAmbients(100.0f), near = meanAmbients(0.6f);
  ASSERT_EQ(far.size(), 2u);
  ASSERT_EQ(near.size(), 2u);
  EXPECT_NEAR(far[0], far[1], 1e-4);  // alone, a turn changes nothing
  for (const std::size_t i : {0u, 1u}) EXPECT_LT(near[i], far[i] - 0.02) << i;
}

TEST(LoadedScene, AMarkerStandsForAMissingPlant) {
  const fs::path folder = scratchFolder("loaded_missing");
  SceneSettings settings = boxScene(folder);
  settings.plants.push_back(plantOf("gone", folder / "gone.glb"));
  writeFile(folder / "cut.glb", std::string("glTF"));
  settings.plants.push_back(plantOf("cut", folder / "cut.glb"));
  settings.look.light = "best";
  settings.plants.erase(settings.plants.begin());  // boxes have no foliage to bake
  settings.placements = {{.plant = 0}, {.plant = 1, .position = {3, 0, 0}}};
  const LoadedScene loaded(settings);
  ASSERT_EQ(loaded.notes().size(), 2u);
  EXPECT_NE(loaded.notes()[0].find("plant 'gone' is missing, a marker stands for it"),
            std::string::npos)
      << loaded.notes()[0];
  EXPECT_NE(loaded.notes()[1].find("cut.glb"), std::string::npos);
  ASSERT_EQ(loaded.scene().items.size(), 2u);
  const Plant& marker = *loaded.scene().items[0].plant;
  EXPECT_TRUE(loaded.plants()[0].missing);
  const Bounds box = bounds(marker);
  EXPECT_EQ(box.min.y, 0.0f);
  EXPECT_GT(box.max.y, 1.5f);
  for (const Mesh& mesh : marker.meshes)  // outwards
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec3 middle(0.0f, mesh.name == "sign" ? 1.8f : 0.5f, 0.0f);
      EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i] - middle), 0.0f) << mesh.name << i;
    }
  LoadSceneOptions strict;
  strict.missing_is_error = true;
  EXPECT_THROW(LoadedScene(settings, strict), Error);
}

TEST(LoadedScene, AHundredThousandPlacesTakeLittleTime) {
  const fs::path folder = scratchFolder("loaded_many");
  SceneSettings scene = boxScene(folder);
  Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    Placement place;
    place.position = {random.vary(400.0f), 0.0f, random.vary(400.0f)};
    place.angle = random.vary(3.0f);
    place.tint = random.next() & 0xffffffu;
    place.phase = random.next();
    scene.placements.push_back(place);
  }
  Timer timer;
  writeScene(scene, folder / "many.json");
  const double written = timer.lap();
  const SceneSettings read = readScene(folder / "many.json");
  const double was_read = timer.lap();
  const LoadedScene loaded(read);
  const double was_loaded = timer.lap();
  EXPECT_EQ(loaded.forest().places.size(), 100'000u);
  const Camera camera = loaded.view().camera;
  EXPECT_GT(glm::distance(camera.eye, camera.target), 400.0f);
  std::printf("written in %.2f s, read in %.2f s, loaded in %.2f s, camera in %.2f s\n", written,
              was_read, was_loaded, timer.lap());
  EXPECT_LT(written + was_read + was_loaded, 60.0);  // sanitizers, busy machines
}

TEST(LoadedScene, ScattersAndLaysOutOnATerrain) {
  const fs::path folder = scratchFolder("loaded_places");
  SceneSettings settings = boxScene(folder);
  settings.ground.terrain = "hills";
  settings.ground.terrain_size_m = {80.0f, 80.0f};
  settings.placements = {{.plant = 0, .position = {20, 0, 10}}};
  BoxFile layout;
  layout.node({{"mesh", 0},
               {"extensions",
                {{"EXT_mesh_gpu_instancing",
                  {{"attributes",
                    {{"TRANSLATION",
                      layout.floats(std::vector<glm::vec3>{{-20, 7, -20}, {-24, 7, -20}})}}}}}}}});
  layout.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  writeFile(folder / "layout.glb", layout.glb());
  settings.layouts = {{(folder / "layout.glb").string(), {0}, true},
                      {(folder / "layout.glb").string(), {0}, false, 1.5f}};
  ScatterSettings scatter;
  scatter.kinds = {{.plant = 0, .radius_m = 2.0f, .scale = {1.0f, 1.0f}}};
  scatter.size_m = {60.0f, 60.0f};
  scatter.clear_m = 6.0f;
  settings.scatters = {scatter};
  settings.camera.eye = glm::vec3(-10, 3, 10);
  LoadSceneOptions options;
  const LoadedScene loaded(settings, options);
  const Scene scene = loaded.scene();
  ASSERT_NE(scene.terrain, nullptr);
  ASSERT_NE(scene.forest, nullptr);
  const auto& places = scene.forest->places;
  ASSERT_GT(places.size(), 80u);
  EXPECT_NEAR(scene.terrain->heightAt({0, 0}), 0.0f, 1e-6f);
  const auto ground = [&](const Placement& place) {
    return scene.terrain->heightAt({place.position.x, place.position.z});
  };
  EXPECT_EQ(places[1].position.y, 8.0f);  // the file's own height, and its foot below its origin
  for (const std::size_t i : {std::size_t{0}, std::size_t{3}, std::size_t{4}, places.size() - 1})
    EXPECT_NEAR(places[i].position.y, ground(places[i]) + places[i].scale, 1e-5f) << i;
  for (std::size_t i = 5; i < places.size(); ++i)
    for (const glm::vec3& taken :
         {glm::vec3(20, 0, 10), glm::vec3(-20, 0, -20), *settings.camera.eye})
      EXPECT_GE(glm::distance(glm::vec2(places[i].position.x, places[i].position.z),
                              glm::vec2(taken.x, taken.z)),
                7.9999f);
}

}  // namespace
}  // namespace verdure::app
