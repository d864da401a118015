// Export: what a bake made lands in the file, and nothing else changes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "base/random.h"
#include "gltf_builder.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

Plant load(const GltfBuilder& file, const fs::path& dir) {
  writeFile(dir / "in.glb", file.glb());
  return loadPlant(dir / "in.glb");
}

/// A random light for every vertex.
CrownLight randomLight(const Plant& plant, std::uint64_t seed = 1) {
  Random random(seed);
  CrownLight light;
  for (const Mesh& mesh : plant.meshes) {
    MeshLight& out = light.meshes.emplace_back();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::vec3 v(random.vary(1.0f), random.vary(1.0f), random.vary(1.0f) + 1.5f);
      out.normals.push_back(glm::normalize(v));
      out.ambient.push_back(random.uniform(0.01f, 1.0f));
    }
  }
  return light;
}

/// All but normals is the same, bit by bit.
void expectSameMeshes(const Plant& a, const Plant& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    EXPECT_TRUE(a.meshes[m].positions == b.meshes[m].positions);
    EXPECT_TRUE(a.meshes[m].indices == b.meshes[m].indices);
    EXPECT_TRUE(a.meshes[m].uvs == b.meshes[m].uvs);
    EXPECT_EQ(a.meshes[m].kind, b.meshes[m].kind);
  }
}

void expectNormals(const Plant& plant, const CrownLight& light) {
  ASSERT_EQ(plant.meshes.size(), light.meshes.size());
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    ASSERT_EQ(plant.meshes[m].normals.size(), light.meshes[m].normals.size());
    for (std::size_t i = 0; i < plant.meshes[m].normals.size(); ++i)
      ASSERT_LT(glm::length(plant.meshes[m].normals[i] - light.meshes[m].normals[i]), 2e-6f);
  }
}

/// The float scalars of an accessor of a GLB file, read without verdure.
std::vector<float> scalars(const fs::path& path, const Json& index) {
  const auto bytes = readFile(path);
  const Json json = glbJson(path);
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, bytes.data() + 12, 4);
  const Json& accessor = json["accessors"][index.get<std::size_t>()];
  const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::vector<float> values(accessor["count"].get<std::size_t>());
  std::memcpy(values.data(), bytes.data() + 28 + json_length + view.value("byteOffset", 0u),
              values.size() * 4);
  return values;
}

TEST(Export, WritesTheLightAndNothingElse) {
  const fs::path dir = scratchFolder("export_plain");
  BoxFile file;
  Json& json = file.json;
  json["asset"]["extras"] = {{"id", 12345678901}, {"nothing", nullptr}};
  json["asset"]["minVersion"] = "2.0";
  json["unknown"] = {{"deep", {1, 2.5, "x"}}};
  json["extensionsUsed"] = {"VENDOR_thing"};
  json["extensions"]["VENDOR_thing"] = {{"big", -5000000000}};
  json["nodes"][0]["extras"] = Json::array({1, 2, 3});
  file.primitive()["extras"] = "kept";
  const Image pixel(2, 2);
  const auto png = encodePng(pixel);
  json["images"] = Json::array({{{"bufferView", file.view(png)}, {"mimeType", "image/png"}}});
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "out.glb");
  const Plant back = loadPlant(dir / "out.glb");
  expectSameMeshes(plant, back);
  expectNormals(back, light);
  for (const glm::vec3& n : back.meshes[0].normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f);

  Json out = glbJson(dir / "out.glb");
  EXPECT_EQ(scalars(dir / "out.glb", out["meshes"][0]["primitives"][0]["attributes"]["_AO"]),
            light.meshes[0].ambient);
  // Take out what was added; where bytes lie may change, what they are may not.
  Json expected = glbJson(dir / "in.glb");
  out["meshes"][0]["primitives"][0]["attributes"].erase("_AO");
  for (const char* key : {"buffers", "bufferViews", "accessors"}) {
    out.erase(key);
    expected.erase(key);
  }
  EXPECT_EQ(out, expected);

  // Without light: the same JSON apart from where the bytes lie, and saving again adds nothing.
  savePlant(plant, nullptr, dir / "same.glb");
  EXPECT_EQ(fs::file_size(dir / "same.glb"), fs::file_size(dir / "in.glb"));
  savePlant(back, &light, dir / "again.glb");
  EXPECT_EQ(fs::file_size(dir / "again.glb"), fs::file_size(dir / "out.glb"));
}

TEST(Export, LeavesUnchangedNormalsAlone) {
  const fs::path dir = scratchFolder("export_unchanged");
  const BoxFile file;
  const Plant plant = load(file, dir);
  CrownLight light = randomLight(plant);
  light.meshes[0].normals = plant.meshes[0].normals;
  savePlant(plant, &light, dir / "out.glb");
  EXPECT_EQ(glbJson(dir / "out.glb")["accessors"][1], glbJson(dir / "in.glb")["accessors"][1]);
  light.meshes[0].normals.clear();
  light.meshes[0].ambient.clear();
  savePlant(plant, &light, dir / "none.glb");
  EXPECT_EQ(glbJson(dir / "none.glb")["meshes"], glbJson(dir / "in.glb")["meshes"]);
}

TEST(Export, TakesNormalsBackThroughTheNode) {
  const fs::path dir = scratchFolder("export_node");
  const glm::quat q = glm::angleAxis(1.1f, glm::normalize(glm::vec3(3, 1, -2)));
  const BoxFile file(Json{
      {"rotation", {q.x, q.y, q.z, q.w}}, {"scale", {-0.5, 2, 3}}, {"translation", {1, 2, 3}}});
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "out.glb");
  const Plant back = loadPlant(dir / "out.glb");
  expectSameMeshes(plant, back);
  expectNormals(back, light);
}

TEST(Export, DuplicatesMeshesThatNodesShare) {
  const fs::path dir = scratchFolder("export_shared");
  BoxFile file;
  file.json["nodes"][0]["name"] = "left";
  file.node({{"mesh", 0}, {"name", "right"}, {"scale", {-1, 1, 1}}, {"translation", {5, 0, 0}}});
  file.node({{"mesh", 0}, {"name", "twin"}, {"translation", {0, 5, 0}}});
  const Plant plant = load(file, dir);
  CrownLight light = randomLight(plant);
  light.meshes[2] = light.meshes[0];
  savePlant(plant, &light, dir / "out.glb");
  const Json out = glbJson(dir / "out.glb");
  ASSERT_EQ(out["meshes"].size(), 2u);
  EXPECT_EQ(out["meshes"][1]["name"], "box (right)");
  EXPECT_EQ(out["nodes"][2]["mesh"], 0);  // the same light: still shared
  // Positions are not copied.
  EXPECT_EQ(out["meshes"][0]["primitives"][0]["attributes"]["POSITION"],
            out["meshes"][1]["primitives"][0]["attributes"]["POSITION"]);
  const Plant back = loadPlant(dir / "out.glb");
  expectNormals(back, light);
  for (std::size_t m = 0; m < 3; ++m)
    EXPECT_EQ(back.meshes[m].positions, plant.meshes[m].positions);
}

TEST(Export, WritesPrimitivesThatShareArrays) {
  const fs::path dir = scratchFolder("export_arrays");
  BoxFile file;
  const std::vector<std::uint32_t> first(file.box.indices.begin(), file.box.indices.begin() + 18);
  const std::vector<std::uint32_t> second(file.box.indices.begin() + 18, file.box.indices.end());
  Json other = file.primitive();
  file.primitive()["indices"] = file.indices(first);
  other["indices"] = file.indices(second);
  file.json["meshes"][0]["primitives"].push_back(other);
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "out.glb");
  const Plant back = loadPlant(dir / "out.glb");
  expectSameMeshes(plant, back);
  expectNormals(back, light);
  const Json out = glbJson(dir / "out.glb")["meshes"][0]["primitives"];
  EXPECT_EQ(out[0]["attributes"]["NORMAL"], out[1]["attributes"]["NORMAL"]);
  EXPECT_EQ(out[0]["attributes"]["_AO"], out[1]["attributes"]["_AO"]);
  // All faces in both: arrays of their own.
  file.json["meshes"][0]["primitives"][1] = file.json["meshes"][0]["primitives"][0];
  const Plant twice = load(file, dir);
  const CrownLight differing = randomLight(twice);
  savePlant(twice, &differing, dir / "twice.glb");
  expectNormals(loadPlant(dir / "twice.glb"), differing);
}

TEST(Export, ExpandsLitInstances) {
  const fs::path dir = scratchFolder("export_instances");
  BoxFile file;
  file.json["nodes"][0]["name"] = "tree";
  file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", file.floats(std::vector<glm::vec3>{{3, 0, 0}, {0, 0, 9}, {1, 5, 1}})}};
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, nullptr, dir / "same.glb");
  EXPECT_EQ(glbJson(dir / "same.glb")["nodes"], file.json["nodes"]);
  savePlant(plant, &light, dir / "out.glb");
  const Plant back = loadPlant(dir / "out.glb");
  ASSERT_EQ(back.meshes.size(), 3u);
  EXPECT_EQ(glbJson(dir / "out.glb").dump().find("EXT_mesh_gpu_instancing"), std::string::npos);
  const std::size_t n = file.box.positions.size();
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(back.meshes[k].positions[i], plant.meshes[0].positions[k * n + i]);
      EXPECT_LT(glm::length(back.meshes[k].normals[i] - light.meshes[0].normals[k * n + i]), 2e-6f);
    }
}

TEST(Export, TakesNormalsBackThroughTheSkin) {
  const fs::path dir = scratchFolder("export_skin");
  BoxFile file(Json{{"skin", 0}});
  const glm::quat q = glm::angleAxis(0.9f, glm::normalize(glm::vec3(1, 1, 0)));
  file.node({{"rotation", {q.x, q.y, q.z, q.w}}});
  file.node({{"scale", {2, 1, 3}}});
  const std::size_t n = file.box.positions.size();
  std::vector<std::uint8_t> joints;
  std::vector<glm::vec4> weights;
  for (std::size_t i = 0; i < n; ++i) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    const float w = static_cast<float>(i) / static_cast<float>(n);
    weights.emplace_back(1.0f - w, w, 0, 0);
  }
  file.primitive()["attributes"]["JOINTS_0"] = file.accessor(file.view(joints), 5121, n, "VEC4");
  file.primitive()["attributes"]["WEIGHTS_0"] = file.floats(weights);
  file.json["skins"] = Json::array({{{"joints", {1, 2}}}});
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "out.glb");
  const Plant back = loadPlant(dir / "out.glb");
  expectSameMeshes(plant, back);
  expectNormals(back, light);
}

TEST(Export, WritesColorsNextToAWhiteOne) {
  const fs::path dir = scratchFolder("export_color");
  const BoxFile file;
  const Plant plant = load(file, dir);
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "out.glb", {.color1 = true});
  const Json out = glbJson(dir / "out.glb");
  const Json& attributes = out["meshes"][0]["primitives"][0]["attributes"];
  ASSERT_TRUE(attributes.contains("COLOR_0") && attributes.contains("COLOR_1"));
  const Json& color = out["accessors"][attributes["COLOR_1"].get<std::size_t>()];
  EXPECT_EQ(color["componentType"], 5121);
  EXPECT_EQ(color["normalized"], true);
  const auto bytes = readFile(dir / "out.glb");
  std::uint32_t json_length = 0;
  std::memcpy(&json_length, bytes.data() + 12, 4);
  const Json& view = out["bufferViews"][color["bufferView"].get<std::size_t>()];
  const std::uint8_t* texel =
      bytes.data() + 28 + json_length + view["byteOffset"].get<std::size_t>();
  for (std::size_t i = 0; i < light.meshes[0].ambient.size(); ++i, texel += 4) {
    EXPECT_NEAR(static_cast<float>(texel[0]) / 255.0f, light.meshes[0].ambient[i],
                0.5f / 255.0f + 1e-6f);
    EXPECT_EQ(texel[3], 255);
  }
}

TEST(Export, KeepsExternalFilesTogether) {
  const fs::path dir = scratchFolder("export_external");
  fs::create_directories(dir / "in" / "tex");
  fs::create_directories(dir / "out");
  BoxFile file;
  Image image(3, 2);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(40 + i);
  writePng(image, dir / "in" / "tex" / "a leaf.png");
  file.json["images"] = Json::array({{{"uri", "tex/a%20leaf.png"}}});
  file.json["textures"] = Json::array({{{"source", 0}}});
  file.json["materials"] =
      Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  file.primitive()["material"] = 0;
  file.json["buffers"] = Json::array({{{"byteLength", file.bin.size()}, {"uri", "box.bin"}}});
  writeFile(dir / "in" / "box.bin", file.bin);
  writeFile(dir / "in" / "box.gltf", file.json.dump());
  const Plant plant = loadPlant(dir / "in" / "box.gltf");
  ASSERT_EQ(plant.textures.size(), 1u);
  EXPECT_EQ(plant.textures[0].image.rgba, image.rgba);
  const CrownLight light = randomLight(plant);
  const auto png = readFile(dir / "in" / "tex" / "a leaf.png");
  savePlant(plant, &light, dir / "out" / "lit.gltf");
  EXPECT_EQ(readFile(dir / "out" / "tex" / "a leaf.png"), png);
  EXPECT_TRUE(fs::exists(dir / "out" / "lit.bin"));
  savePlant(plant, &light, dir / "out" / "lit.glb");
  for (const char* name : {"lit.gltf", "lit.glb"}) {
    const Plant back = loadPlant(dir / "out" / name);
    expectSameMeshes(plant, back);
    expectNormals(back, light);
    ASSERT_EQ(back.textures.size(), 1u);
    EXPECT_EQ(back.textures[0].image.rgba, image.rgba);
  }
  // In the .glb, the image's very bytes.
  const auto glb = readFile(dir / "out" / "lit.glb");
  EXPECT_NE(std::search(glb.begin(), glb.end(), png.begin(), png.end()), glb.end());
  // Data URIs: "AAECAw==" is 0 1 2 3.
  GltfBuilder uri;
  uri.json["buffers"] =
      Json::array({{{"byteLength", 36},
                    {"uri",
                     "data:application/"
                     "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}});
  uri.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 36}});
  uri.mesh({{"attributes", {{"POSITION", uri.accessor(0, 5126, 3, "VEC3")}}}});
  uri.node({{"mesh", 0}});
  writeFile(dir / "uri.gltf", uri.json.dump());
  EXPECT_EQ(loadPlant(dir / "uri.gltf").meshes[0].positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

/// A trunk and a leaf as growth makes them.
Plant grownPlant() {
  Plant plant;
  plant.name = "sapling";
  plant.origin = {1000, 0, -2000};
  const BoxMesh box(glm::vec3(0.1f, 1.0f, 0.1f));
  for (const PartKind kind : {PartKind::kWood, PartKind::kFoliage}) {
    const bool wood = kind == PartKind::kWood;
    Mesh& mesh = plant.meshes.emplace_back();
    mesh.name = wood ? "trunk" : "leaves";
    mesh.kind = kind;
    mesh.material = wood ? 0 : 1;
    for (const glm::vec3& p : box.positions) mesh.positions.push_back(p + glm::vec3(0, 1, 0));
    mesh.normals = box.normals;
    mesh.uvs = box.uvs;
    mesh.indices = box.indices;
    Material& material = plant.materials.emplace_back();
    material.name = "surface";  // says nothing: the kind must come from the file
    material.base_color_texture = wood ? -1 : 0;
    material.normal_texture = wood ? -1 : 1;
    material.normal_scale = 0.5f;
    material.base_color = {0.5f, 0.25f, 0.125f, 1.0f};
    if (wood) continue;
    material.alpha_mode = AlphaMode::kMask;
    material.alpha_cutoff = 0.25f;
    material.double_sided = true;
  }
  for (const char* name : {"color", "normal"}) {
    Texture& texture = plant.textures.emplace_back();
    texture.name = name;
    texture.image = Image(4, 4);
    for (std::size_t i = 0; i < texture.image.rgba.size(); ++i)
      texture.image.rgba[i] = static_cast<std::uint8_t>(i * 3);
    texture.clamp_u = true;
  }
  return plant;
}

TEST(Export, WritesGrownPlantsAsNewFiles) {
  const fs::path dir = scratchFolder("export_grown");
  const Plant plant = grownPlant();
  CrownLight light = randomLight(plant);
  for (const char* name : {"grown.glb", "grown.gltf"}) {
    savePlant(plant, &light, dir / name, {.color1 = true});
    const Plant back = loadPlant(dir / name);
    EXPECT_EQ(back.origin, plant.origin);
    expectSameMeshes(plant, back);
    for (std::size_t m = 0; m < 2; ++m) {
      const Material &a = plant.materials[m], &b = back.materials[m];
      EXPECT_EQ(a.base_color, b.base_color);
      EXPECT_EQ(a.alpha_mode, b.alpha_mode);
      EXPECT_EQ(a.double_sided, b.double_sided);
      EXPECT_EQ(a.base_color_texture, b.base_color_texture);
      EXPECT_EQ(a.normal_texture, b.normal_texture);
      EXPECT_EQ(plant.textures[m].image.rgba, back.textures[m].image.rgba);
      EXPECT_TRUE(back.textures[m].clamp_u);
      EXPECT_FALSE(back.textures[m].clamp_v);
    }
    EXPECT_EQ(back.materials[1].alpha_cutoff, 0.25f);
    EXPECT_EQ(back.materials[1].normal_scale, 0.5f);
    expectNormals(back, light);
  }
  const Json json = glbJson(dir / "grown.glb");
  EXPECT_EQ(json["asset"]["generator"].get<std::string>().substr(0, 8), "verdure ");
}

TEST(Export, PassesTheKhronosValidator) {
  const fs::path dir = scratchFolder("export_valid");
  std::vector<std::string> pairs = {"--compare"};
  const auto add = [&](const std::string& name, const GltfBuilder& file) {
    writeFile(dir / (name + ".glb"), file.glb());
    const Plant plant = loadPlant(dir / (name + ".glb"));
    const CrownLight light = randomLight(plant);
    savePlant(plant, &light, dir / (name + "_lit.glb"), {.color1 = true});
    savePlant(plant, &light, dir / (name + "_lit.gltf"));
    savePlant(plant, nullptr, dir / (name + "_same.glb"));
    for (const char* suffix : {"_lit.glb", "_lit.gltf", "_same.glb"}) {
      pairs.push_back((dir / (name + ".glb")).string());
      pairs.push_back((dir / (name + suffix)).string());
    }
  };
  add("box", BoxFile());
  add("mirrored", BoxFile(Json{{"scale", {-1, 2, 3}}}));
  BoxFile shared;
  shared.node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  add("shared", shared);
  BoxFile instanced;
  instanced.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  instanced.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", instanced.floats(std::vector<glm::vec3>{{3, 0, 0}, {0, 0, 9}})}};
  add("instanced", instanced);
  const int compared = runValidator(pairs);
  if (compared > 1) GTEST_SKIP() << "needs node and `npm install` in tests/npm";
  EXPECT_EQ(compared, 0);

  // What verdure writes anew has no issue at all: compare it with a file that has none.
  const Plant plant = grownPlant();
  const CrownLight light = randomLight(plant);
  savePlant(plant, &light, dir / "grown.glb", {.color1 = true});
  savePlant(plant, nullptr, dir / "grown.gltf");
  const std::string clean = (dir / "box_same.glb").string();
  EXPECT_EQ(runValidator({"--compare", clean, (dir / "grown.glb").string(), clean,
                          (dir / "grown.gltf").string()}),
            0);
}

TEST(Export, RefusesLightOfAnotherPlant) {
  const fs::path dir = scratchFolder("export_refuse");
  const Plant plant = load(BoxFile(), dir);
  CrownLight light = randomLight(plant);
  light.meshes.emplace_back();
  EXPECT_THROW(savePlant(plant, &light, dir / "a.glb"), Error);
  light = randomLight(plant);
  light.meshes[0].ambient.pop_back();
  EXPECT_THROW(savePlant(plant, &light, dir / "a.glb"), Error);
  light = randomLight(plant);
  light.meshes[0].normals[3] *= 0.5f;
  EXPECT_THROW(savePlant(plant, &light, dir / "a.glb"), Error);
  light = randomLight(plant);
  light.meshes[0].ambient[3] = NAN;
  EXPECT_THROW(savePlant(plant, &light, dir / "a.glb"), Error);
  EXPECT_THROW(savePlant(plant, nullptr, dir / "a.obj"), Error);
  EXPECT_THROW(savePlant(plant, nullptr, dir / "no" / "a.glb"), Error);
  EXPECT_FALSE(fs::exists(dir / "a.glb"));
}

}  // namespace
}  // namespace verdure
