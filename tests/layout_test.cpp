// Places of plants that a glTF file's instances tell.
#include "verdure/layout.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf_builder.h"
#include "verdure/error.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

glm::vec4 rotation(float angle, const glm::vec3& axis) {
  const glm::quat q = glm::angleAxis(angle, axis);
  return {q.x, q.y, q.z, q.w};
}

/// Adds a node with instances of mesh 0.
void addInstances(GltfBuilder& file, const std::vector<glm::vec3>& positions,
                  const std::vector<glm::vec4>& rotations, const std::vector<glm::vec3>& scales,
                  Json members = Json::object()) {
  Json attributes = Json::object();
  if (!positions.empty()) attributes["TRANSLATION"] = file.floats(positions);
  if (!rotations.empty()) attributes["ROTATION"] = file.floats(rotations);
  if (!scales.empty()) attributes["SCALE"] = file.floats(scales);
  members["mesh"] = 0;
  members["extensions"] = {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
  file.node(members);
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
}

std::filesystem::path written(const GltfBuilder& file, const std::string& name) {
  const std::filesystem::path path = scratchFolder("layout_" + name) / "layout.glb";
  writeFile(path, file.glb());
  return path;
}

TEST(Layout, ReadsPlacesTurnsAndScales) {
  BoxFile file;  // with a node that has no instances
  const glm::vec3 up(0, 1, 0);
  addInstances(file, {{1, 2, 3}, {-4, 0, 5}}, {rotation(0.5f, up), rotation(-2.0f, up)},
               {glm::vec3(1.0f), glm::vec3(2.5f)});
  // The node's own place counts, too: here a turn of a quarter, moved and twice as large.
  addInstances(file, {{1, 0, 0}}, {}, {},
               {{"translation", {10, 0, 0}},
                {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                {"scale", {2, 2, 2}}});
  const Layout layout = loadLayout(written(file, "places"));
  EXPECT_EQ(layout.nodes, 2u);
  ASSERT_EQ(layout.places.size(), 3u);
  EXPECT_TRUE(layout.notes.empty());
  const auto expect = [&](std::size_t i, std::uint32_t plant, const glm::vec3& position,
                          float angle, float scale) {
    const Placement& place = layout.places[i];
    EXPECT_EQ(place.plant, plant) << i;
    EXPECT_LT(glm::distance(place.position, position), 1e-5f) << i;
    EXPECT_NEAR(place.angle, angle, 1e-5f) << i;
    EXPECT_NEAR(place.scale, scale, 1e-5f) << i;
  };
  expect(0, 0, {1, 2, 3}, 0.5f, 1.0f);
  expect(1, 0, {-4, 0, 5}, -2.0f, 2.5f);
  expect(2, 1, {10, 0, -2}, glm::half_pi<float>(), 2.0f);
  EXPECT_NE(layout.places[0].phase, layout.places[1].phase);
}

TEST(Layout, PartsOfAPlantAreOnePlace) {
  BoxFile file;
  for (int part = 0; part < 2; ++part) addInstances(file, {{1, 0, 0}, {2, 0, 0}}, {}, {});
  addInstances(file, {{1, 0, 0}, {3, 0, 0}}, {}, {});
  const Layout layout = loadLayout(written(file, "parts"));
  EXPECT_EQ(layout.nodes, 2u);
  EXPECT_EQ(layout.places.size(), 4u);
}

TEST(Layout, SaysWhatPlacesCannotHold) {
  BoxFile file;
  const glm::vec3 up(0, 1, 0);
  const glm::quat tilted = glm::angleAxis(0.3f, glm::vec3(1, 0, 0)) * glm::angleAxis(1.0f, up);
  addInstances(
      file, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
      {{tilted.x, tilted.y, tilted.z, tilted.w}, rotation(0, up), rotation(0, up), rotation(0, up)},
      {glm::vec3(1), glm::vec3(1, 8, 1), glm::vec3(-1, 1, 1), glm::vec3(0)});
  const Layout layout = loadLayout(written(file, "lost"));
  ASSERT_EQ(layout.places.size(), 3u);
  EXPECT_NEAR(layout.places[0].angle, 1.0f, 0.05f);
  EXPECT_NEAR(layout.places[1].scale, 2.0f, 1e-5f);
  ASSERT_EQ(layout.notes.size(), 4u);
  EXPECT_NE(layout.notes[0].find("1 instances are tilted"), std::string::npos);
  EXPECT_NE(layout.notes[1].find("1 instances are scaled unevenly"), std::string::npos);
  EXPECT_NE(layout.notes[2].find("1 instances are mirrored"), std::string::npos);
  EXPECT_NE(layout.notes[3].find("1 instances have no size"), std::string::npos);
}

TEST(Layout, ComesToTheOriginFromFarAway) {
  BoxFile file;
  addInstances(file, {{0, 0, 0}, {20, 0, 8}}, {}, {}, {{"translation", {500000, 120, -4000000}}});
  const Layout layout = loadLayout(written(file, "far"));
  ASSERT_EQ(layout.notes.size(), 1u);
  EXPECT_EQ(layout.places[0].position, glm::vec3(-10, 0, -4));
  EXPECT_EQ(layout.places[1].position, glm::vec3(10, 0, 4));
}

TEST(Layout, RefusesAFileWithoutInstances) {
  try {
    loadLayout(written(BoxFile(), "none"));
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("has no instances"), std::string::npos) << e.what();
  }
}

TEST(Layout, OfAForest) {
  const char* const folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "without VERDURE_PLANT_DIR";
  const std::filesystem::path path = std::filesystem::path(folder) / "forest200_gpu_instancing.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "without " << path;
  const Layout layout = loadLayout(path);
  EXPECT_EQ(layout.places.size(), 200u);
  EXPECT_EQ(layout.nodes, 2u);  // of four: wood and leaves of both its plants
  // Where the importer puts them.
  const Bounds box = bounds(loadPlant(path));
  for (const Placement& place : layout.places) {
    EXPECT_GE(place.position.x, box.min.x - 1.0f);
    EXPECT_LE(place.position.x, box.max.x + 1.0f);
    EXPECT_GE(place.position.z, box.min.z - 1.0f);
    EXPECT_LE(place.position.z, box.max.z + 1.0f);
    EXPECT_GT(place.scale, 0.0f);
  }
}

}  // namespace
}  // namespace verdure
