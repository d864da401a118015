// Files that are wrong: one clear line each, never a crash.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/random.h"
#include "gltf_builder.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

/// The message that loading these bytes ends with.
std::string messageOf(const std::vector<std::uint8_t>& bytes, const std::string& name = "bad.glb") {
  static const fs::path dir = scratchFolder("bad_plants");
  writeFile(dir / name, bytes);
  try {
    loadPlant(dir / name);
  } catch (const Error& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find(name + ": "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "loaded";
}

/// A box file after `damage`.
std::string messageAfter(const std::function<void(BoxFile&)>& damage) {
  BoxFile file;
  damage(file);
  return messageOf(file.glb());
}

#define EXPECT_SAYS(message, text)                         \
  do {                                                     \
    const std::string said = (message);                    \
    EXPECT_NE(said.find(text), std::string::npos) << said; \
  } while (false)

TEST(BadPlants, MissingCutOffOrForeign) {
  try {
    loadPlant("/nowhere/oak.glb");
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "/nowhere/oak.glb: no such file; check the path");
  }
  EXPECT_SAYS(messageOf({}), "is not a glTF file");
  EXPECT_SAYS(messageOf({'h', 'e', 'l', 'l', 'o'}), "is not a glTF file");
  EXPECT_SAYS(messageOf({'{', '}'}, "empty.gltf"), "no asset version");
  EXPECT_SAYS(messageOf({1, 2}, "tree.blend"), "use .glb, .gltf");
  const auto good = BoxFile().glb();
  EXPECT_EQ(messageOf(good), "loaded");
  for (std::size_t size = 0; size < good.size(); size += 13)
    EXPECT_NE(messageOf({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}),
              "loaded");
  EXPECT_SAYS(messageOf({good.begin(), good.begin() + 400}), "the file is cut off: 400 of");
  auto old = good;
  old[4] = 1;
  EXPECT_SAYS(messageOf(old), "is glTF 1, not glTF 2");
}

TEST(BadPlants, NamesTheAccessorMeshOrNode) {
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["accessors"][0]["count"] = 25; }),
              "accessor 0 of 25 elements ends beyond its buffer view 0 of 288 bytes");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["accessors"][0]["count"] = 4000000000u; }),
              "ends beyond its buffer view");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["accessors"][0]["count"] = std::numeric_limits<std::uint64_t>::max();
              }),
              "accessor 0");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["accessors"][0]["count"] = 4000000000u;
                f.json["accessors"][0].erase("bufferView");
              }),
              "accessor 0 claims 4000000000 elements without data");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["accessors"][0]["componentType"] = 9; }),
              "has no known type");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["accessors"][0]["count"] = -3; }),
              "'count' is not a whole number");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["accessors"][0]["type"] = "VEC2"; }),
              "has 2 components instead of 3");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["bufferViews"][0]["byteLength"] = 1u << 30; }),
              "buffer view 0 (offset 0, length 1073741824) ends beyond buffer 0");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["bufferViews"][0]["byteStride"] = 4; }),
              "byteStride 4 does not suit");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.primitive()["attributes"].erase("POSITION"); }),
              "mesh 0 'box' primitive 0 has no POSITION");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.primitive()["attributes"]["POSITION"] = 77; }),
              "mesh 0 'box' primitive 0: 'POSITION' is 77, but the file has 4 accessors");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.primitive()["material"] = 3; }),
              "'material' is 3, but the file has 0 materials");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                auto indices = f.box.indices;
                indices[7] = 24;
                f.primitive()["indices"] = f.indices(indices);
              }),
              "mesh 0 'box' primitive 0: index 7 of accessor 4 is 24, but there are 24 vertices");
  for (const float bad : {NAN, INFINITY})
    EXPECT_SAYS(messageAfter([bad](BoxFile& f) {
                  auto positions = f.box.positions;
                  positions[5].y = bad;
                  f.primitive()["attributes"]["POSITION"] = f.floats(positions);
                }),
                "accessor 4: position 5 is not finite");
}

TEST(BadPlants, ScenesAndNodes) {
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["scenes"][0]["nodes"] = Json::array(); }),
              "its scene shows no mesh");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["scenes"][0]["nodes"] = {9}; }),
              "'nodes' names node 9, but the file has 1 nodes");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["nodes"].push_back({{"children", {2}}});
                f.json["nodes"].push_back({{"children", {1}}});
              }),
              "its nodes form a cycle");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["nodes"][0]["children"] = {0}; }), "cycle");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["nodes"].push_back({{"children", {0}}});
                f.json["nodes"].push_back({{"children", {0}}});
              }),
              "node 0 has two parents");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["nodes"][0]["scale"] = {1, 2};
              }),
              "node 0: 'scale' is not 3 numbers");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["nodes"][0]["scale"] = {1, 1e300, 1};
              }),
              "beyond all bounds");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.json["meshes"] = 5; }), "'meshes' is not a list");
  EXPECT_SAYS(messageAfter([](BoxFile& f) { f.primitive()["mode"] = 0; }), "has no triangles");
}

TEST(BadPlants, RequiredExtensionsByName) {
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["extensionsRequired"] = {"KHR_texture_transform", "VENDOR_secret_mesh"};
              }),
              "requires the extension VENDOR_secret_mesh, which verdure cannot read");
}

TEST(BadPlants, BuffersThatAreNotThere) {
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["buffers"] = Json::array({{{"byteLength", 10}, {"uri", "gone.bin"}}});
              }),
              "buffer 0: there is no file");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["buffers"] = Json::array({{{"byteLength", 1u << 20}}});
              }),
              "instead of 1048576");
  EXPECT_SAYS(messageAfter([](BoxFile& f) {
                f.json["buffers"] = Json::array({{{"byteLength", 3}, {"uri", "data:x;base64,@@"}}});
              }),
              "not base64");
  EXPECT_SAYS(
      messageAfter([](BoxFile& f) {
        f.json["buffers"] = Json::array({{{"byteLength", 3}, {"uri", "https://x.y/z.bin"}}});
      }),
      "is on the network");
}

TEST(BadPlants, DeepJson) {
  const std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"x\":" + std::string(100000, '[') +
                           std::string(100000, ']') + "}";
  EXPECT_SAYS(messageOf({deep.begin(), deep.end()}, "deep.gltf"), "nested deeper");
}

TEST(BadPlants, NamesThatMatchNothing) {
  const fs::path dir = scratchFolder("bad_names");
  BoxFile file;
  file.json["materials"] = Json::array({{{"name", "Oak Bark"}}});
  file.primitive()["material"] = 0;
  writeFile(dir / "box.glb", file.glb());
  try {
    loadPlant(dir / "box.glb", {.foliage = {"leaf*"}, .wood = {}});
    FAIL();
  } catch (const Error& e) {
    EXPECT_SAYS(e.what(), "no material, mesh or node is named 'leaf*'; the file has Oak Bark, box");
  }
  EXPECT_EQ(loadPlant(dir / "box.glb", {.foliage = {"OAK*"}, .wood = {}}).meshes[0].kind,
            PartKind::kFoliage);
  EXPECT_EQ(loadPlant(dir / "box.glb", {.foliage = {}, .wood = {"BOX"}}).meshes[0].kind,
            PartKind::kWood);
  EXPECT_THROW(loadPlant(dir / "box.glb", {.foliage = {"box"}, .wood = {"*bark"}}), Error);
}

/// A file with most features, so that damage finds something to break.
std::vector<std::uint8_t> richFile() {
  BoxFile file(Json{{"translation", {1, 2, 3}}, {"name", "node"}});
  const Image image(4, 4);
  const auto png = encodePng(image);
  file.json["images"] = Json::array({{{"bufferView", file.view(png)}, {"mimeType", "image/png"}}});
  file.json["samplers"] = Json::array({{{"wrapS", 33071}}});
  file.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
  file.json["materials"] = Json::array(
      {{{"name", "leaf"},
        {"alphaMode", "MASK"},
        {"pbrMetallicRoughness",
         {{"baseColorTexture",
           {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}}}}});
  file.primitive()["material"] = 0;
  const std::vector<std::uint8_t> where = {3};
  file.json["accessors"][1]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", file.view(where)}, {"componentType", 5121}}},
      {"values", {{"bufferView", file.view(std::vector<glm::vec3>{{0, 1, 0}})}}}};
  file.node(
      {{"mesh", 0},
       {"extensions",
        {{"EXT_mesh_gpu_instancing",
          {{"attributes",
            {{"TRANSLATION", file.floats(std::vector<glm::vec3>{{3, 0, 0}, {0, 0, 9}})}}}}}}}});
  file.node({{"mesh", 0}, {"skin", 0}});
  std::vector<std::uint8_t> joints(file.box.positions.size() * 4, 0);
  file.primitive()["attributes"]["JOINTS_0"] =
      file.accessor(file.view(joints), 5121, file.box.positions.size(), "VEC4");
  file.primitive()["attributes"]["WEIGHTS_0"] =
      file.floats(std::vector<glm::vec4>(file.box.positions.size(), glm::vec4(1, 0, 0, 0)));
  file.json["skins"] = Json::array({{{"joints", {0}}}});
  return file.glb();
}

TEST(BadPlants, SurviveFlippedBytes) {
  const fs::path dir = scratchFolder("fuzz");
  const auto good = richFile();
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, good.data() + 12, 4);
  Random random(2024);
  int loaded = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    auto bytes = good;
    const std::uint32_t flips = 1 + random.below(3);
    for (std::uint32_t k = 0; k < flips; ++k) {
      // Mostly within the JSON, and there mostly digits: other damage only breaks its syntax.
      const bool in_json = random.below(4) != 0;
      const std::size_t at = in_json ? 20 + random.below(json_length)
                                     : random.below(static_cast<std::uint32_t>(bytes.size()));
      const bool digit = bytes[at] >= '0' && bytes[at] <= '9';
      bytes[at] = static_cast<std::uint8_t>(in_json && digit ? '0' + random.below(10)
                                            : in_json && random.below(3) != 0 ? bytes[at]
                                                                              : random.below(256));
    }
    if (random.below(20) == 0) bytes.resize(random.below(static_cast<std::uint32_t>(bytes.size())));
    writeFile(dir / "fuzz.glb", bytes);
    try {
      const Plant plant = loadPlant(dir / "fuzz.glb");
      inspectPlant(plant);
      CrownLight light;
      for (const Mesh& mesh : plant.meshes)
        light.meshes.push_back({std::vector<glm::vec3>(mesh.positions.size(), {0, 0, 1}),
                                std::vector<float>(mesh.positions.size(), 0.5f)});
      savePlant(plant, &light, dir / "out.glb", {.color1 = true});
      loadPlant(dir / "out.glb");
      ++loaded;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(loaded, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace verdure
