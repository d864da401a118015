// Import of every way in which glTF can say the same plant.
#include <assimp/scene.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "gltf_builder.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

/// Writes the file and loads it.
Plant load(const GltfBuilder& file, const LoadOptions& options = {}) {
  static const fs::path dir = scratchFolder("plant_import");
  writeFile(dir / "plant.glb", file.glb());
  return loadPlant(dir / "plant.glb", options);
}

double signedVolume(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]),
        c(mesh.positions[mesh.indices[t + 2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

void expectNear(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_LT(glm::length(a[i] - b[i]), tolerance) << "vertex " << i;
}

bool hasNote(const Plant& plant, const std::string& text) {
  for (const std::string& note : plant.notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}

TEST(GltfImport, ReadsAPlainMeshBitByBit) {
  const BoxFile file;
  const Plant plant = load(file);
  ASSERT_EQ(plant.meshes.size(), 1u);
  EXPECT_EQ(plant.meshes[0].name, "box");
  EXPECT_EQ(plant.meshes[0].positions, file.box.positions);
  EXPECT_EQ(plant.meshes[0].normals, file.box.normals);
  EXPECT_EQ(plant.meshes[0].uvs, file.box.uvs);
  EXPECT_EQ(plant.meshes[0].indices, file.box.indices);
  EXPECT_EQ(plant.origin, glm::dvec3(0.0));
}

TEST(GltfImport, ComposesTheNodeHierarchy) {
  BoxFile file;
  const glm::dquat q = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  file.json["nodes"] = Json::array();
  file.json["scenes"][0]["nodes"] = Json::array();
  file.node({{"mesh", 0}, {"scale", {2, 3, 4}}}, false);
  file.node({{"children", {0}}, {"rotation", {q.x, q.y, q.z, q.w}}, {"translation", {1, 2, 3}}},
            false);
  glm::dmat4 outer = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 5, 0));
  outer[0][0] = 0.5;
  std::vector<double> matrix(&outer[0][0], &outer[0][0] + 16);
  file.node({{"children", {1}}, {"matrix", matrix}});
  const glm::dmat4 world = outer * glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3)) *
                           glm::mat4_cast(q) * glm::scale(glm::dmat4(1.0), glm::dvec3(2, 3, 4));
  std::vector<glm::vec3> expected;
  for (const glm::vec3& p : file.box.positions)
    expected.emplace_back(world * glm::dvec4(glm::dvec3(p), 1.0));
  const Plant plant = load(file);
  expectNear(plant.meshes[0].positions, expected, 1e-5f);
  // Normals stay perpendicular to their faces under non-uniform scale.
  const Mesh& mesh = plant.meshes[0];
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[t]];
    const glm::vec3 n = glm::normalize(glm::cross(mesh.positions[mesh.indices[t + 1]] - a,
                                                  mesh.positions[mesh.indices[t + 2]] - a));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(glm::dot(n, mesh.normals[mesh.indices[t + static_cast<std::size_t>(c)]]), 1.0f,
                  1e-5f);
  }
}

TEST(GltfImport, MirroredNodesStayOutsideOut) {
  for (const glm::vec3 scale :
       {glm::vec3(-1, 1, 1), glm::vec3(2, -3, 1), glm::vec3(-1, -1, -1), glm::vec3(-1, -1, 1)}) {
    const BoxFile file(Json{{"scale", {scale.x, scale.y, scale.z}}});
    const Plant plant = load(file);
    EXPECT_NEAR(signedVolume(plant.meshes[0]), 8.0 * std::abs(double(scale.x * scale.y * scale.z)),
                1e-4);
    for (std::size_t i = 0; i < plant.meshes[0].positions.size(); ++i)
      EXPECT_GT(glm::dot(plant.meshes[0].positions[i], plant.meshes[0].normals[i]), 0.5f);
  }
}

TEST(GltfImport, KeepsPrecisionFarFromTheOrigin) {
  const glm::dvec3 at(448262.25, 512.5, -5411932.75);
  const BoxFile file(Json{{"translation", {at.x, at.y, at.z}}, {"scale", {0.001, 0.001, 0.001}}});
  const Plant plant = load(file);
  EXPECT_EQ(plant.origin, glm::round(plant.origin));
  for (std::size_t i = 0; i < file.box.positions.size(); ++i) {
    const glm::dvec3 world = plant.origin + glm::dvec3(plant.meshes[0].positions[i]);
    EXPECT_LT(glm::length(world - (at + 0.001 * glm::dvec3(file.box.positions[i]))), 1e-6);
  }
  EXPECT_FALSE(inspectPlant(plant).problems.empty());
  // A plant of ordinary size beside the origin keeps the origin.
  EXPECT_EQ(load(BoxFile(Json{{"translation", {10, 0, 0}}})).origin, glm::dvec3(0.0));
}

TEST(GltfImport, ReadsQuantizedAttributes) {
  BoxFile file(Json{{"scale", {2, 2, 2}}});
  std::vector<std::int16_t> positions;
  std::vector<std::int8_t> normals;
  std::vector<std::uint16_t> uvs;
  for (std::size_t i = 0; i < file.box.positions.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      positions.push_back(static_cast<std::int16_t>(file.box.positions[i][c] * 16384));
      normals.push_back(static_cast<std::int8_t>(file.box.normals[i][c] * 127));
    }
    positions.push_back(0);
    normals.push_back(0);
    for (int c = 0; c < 2; ++c)
      uvs.push_back(static_cast<std::uint16_t>(file.box.uvs[i][c] * 65535));
  }
  const std::size_t n = file.box.positions.size();
  Json& attributes = file.primitive()["attributes"];
  attributes["POSITION"] = file.accessor(file.view(positions, 8), 5122, n, "VEC3", true);
  attributes["NORMAL"] = file.accessor(file.view(normals, 4), 5120, n, "VEC3", true);
  attributes["TEXCOORD_0"] = file.accessor(file.view(uvs), 5123, n, "VEC2", true);
  file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  Plant plant = load(file);
  std::vector<glm::vec3> expected;
  for (const glm::vec3& p : file.box.positions)
    expected.push_back(2.0f * p * (16384.0f / 32767.0f));
  expectNear(plant.meshes[0].positions, expected, 1e-6f);
  expectNear(plant.meshes[0].normals, file.box.normals, 1e-6f);
  EXPECT_EQ(plant.meshes[0].uvs, file.box.uvs);
  // Not normalised: the integers themselves.
  file.json["accessors"][attributes["POSITION"].get<std::size_t>()]["normalized"] = false;
  plant = load(file);
  for (glm::vec3& p : expected) p *= 32767.0f;
  expectNear(plant.meshes[0].positions, expected, 1e-2f);
}

TEST(GltfImport, ReadsInterleavedAndSparseAccessors) {
  BoxFile file;
  const std::size_t n = file.box.positions.size();
  std::vector<glm::vec3> mixed;
  for (std::size_t i = 0; i < n; ++i) {
    mixed.push_back(file.box.normals[i]);
    mixed.push_back(file.box.positions[i]);
  }
  const int view = file.view(mixed, 24);
  Json& attributes = file.primitive()["attributes"];
  attributes["NORMAL"] = file.accessor(view, 5126, n, "VEC3");
  attributes["POSITION"] = file.accessor(view, 5126, n, "VEC3", false, 12);
  EXPECT_EQ(load(file).meshes[0].positions, file.box.positions);
  EXPECT_EQ(load(file).meshes[0].normals, file.box.normals);

  // Sparse over the interleaved base: vertices 3 and 7 move.
  const std::vector<std::uint8_t> where = {3, 7};
  const std::vector<glm::vec3> moved = {{9, 8, 7}, {6, 5, 4}};
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", file.view(where)}, {"componentType", 5121}}},
                       {"values", {{"bufferView", file.view(moved)}}}};
  file.json["accessors"][attributes["POSITION"].get<std::size_t>()]["sparse"] = sparse;
  auto expected = file.box.positions;
  expected[3] = moved[0];
  expected[7] = moved[1];
  EXPECT_EQ(load(file).meshes[0].positions, expected);
  // Sparse over nothing: zeros.
  file.json["accessors"][attributes["POSITION"].get<std::size_t>()].erase("bufferView");
  file.json["accessors"][attributes["POSITION"].get<std::size_t>()].erase("byteOffset");
  std::fill(expected.begin(), expected.end(), glm::vec3(0.0f));
  expected[3] = moved[0];
  expected[7] = moved[1];
  EXPECT_EQ(load(file).meshes[0].positions, expected);
}

TEST(GltfImport, ReadsEveryIndexTypeAndPrimitiveMode) {
  BoxFile file;
  const std::vector<std::uint8_t> small(file.box.indices.begin(), file.box.indices.end());
  const std::vector<std::uint16_t> medium(file.box.indices.begin(), file.box.indices.end());
  file.primitive()["indices"] = file.accessor(file.view(small), 5121, small.size(), "SCALAR");
  EXPECT_EQ(load(file).meshes[0].indices, file.box.indices);
  file.primitive()["indices"] = file.accessor(file.view(medium), 5123, medium.size(), "SCALAR");
  EXPECT_EQ(load(file).meshes[0].indices, file.box.indices);
  // Strip: a band of four triangles, every one facing +Z.
  file.primitive()["mode"] = 5;
  file.primitive().erase("indices");
  std::vector<glm::vec3> band;
  for (int i = 0; i < 3; ++i) {
    band.emplace_back(i, 1, 0);
    band.emplace_back(i, 0, 0);
  }
  file.primitive()["attributes"] = {{"POSITION", file.floats(band)}};
  Plant plant = load(file);
  EXPECT_EQ(plant.meshes[0].triangleCount(), 4u);
  for (const glm::vec3& n : plant.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  // Fan: a square around its first corner.
  file.primitive()["mode"] = 6;
  file.primitive()["attributes"] = {{"POSITION", file.floats(std::vector<glm::vec3>{
                                                     {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})}};
  plant = load(file);
  EXPECT_EQ(plant.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(hasNote(plant, "had no normals"));
  // Lines beside triangles are left out.
  file.json["meshes"][0]["primitives"].push_back(file.primitive());
  file.json["meshes"][0]["primitives"][1]["mode"] = 1;
  plant = load(file);
  EXPECT_EQ(plant.meshes.size(), 1u);
  EXPECT_TRUE(hasNote(plant, "has no triangles"));
}

TEST(GltfImport, MendsNormals) {
  BoxFile file;
  auto normals = file.box.normals;
  normals[0] = glm::vec3(0.0f);
  normals[5] = glm::vec3(NAN);
  normals[6] *= 7.0f;
  file.primitive()["attributes"]["NORMAL"] = file.floats(normals);
  Plant plant = load(file);
  expectNear(plant.meshes[0].normals, file.box.normals, 1e-6f);
  EXPECT_TRUE(hasNote(plant, "2 normals without direction"));
  // None at all and unindexed: flat.
  file.primitive()["attributes"].erase("NORMAL");
  file.primitive().erase("indices");
  std::vector<glm::vec3> soup, flat;
  for (const std::uint32_t i : file.box.indices) {
    soup.push_back(file.box.positions[i]);
    flat.push_back(file.box.normals[i]);
  }
  file.primitive()["attributes"] = {{"POSITION", file.floats(soup)}};
  plant = load(file);
  expectNear(plant.meshes[0].normals, flat, 1e-6f);
  EXPECT_TRUE(plant.meshes[0].uvs.empty());
}

TEST(GltfImport, BakesTheTextureTransform) {
  BoxFile file;
  const Image pixel(1, 1);
  const auto png = encodePng(pixel);
  file.json["images"] = Json::array({{{"bufferView", file.view(png)}, {"mimeType", "image/png"}}});
  file.json["textures"] = Json::array({{{"source", 0}}});
  const Json transform = {{"offset", {0.25, -0.5}}, {"scale", {2, 3}}, {"rotation", 0.5}};
  file.json["materials"] =
      Json::array({{{"name", "m"},
                    {"pbrMetallicRoughness",
                     {{"baseColorTexture",
                       {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}}});
  file.primitive()["material"] = 0;
  Plant plant = load(file);
  EXPECT_EQ(plant.textures.size(), 1u);
  for (std::size_t i = 0; i < file.box.uvs.size(); ++i) {
    // Counter-clockwise on the screen, where V points down.
    const glm::dvec2 s = glm::dvec2(file.box.uvs[i]) * glm::dvec2(2, 3);
    const glm::dvec2 r(std::cos(0.5) * s.x + std::sin(0.5) * s.y,
                       -std::sin(0.5) * s.x + std::cos(0.5) * s.y);
    EXPECT_LT(glm::length(glm::dvec2(plant.meshes[0].uvs[i]) - (r + glm::dvec2(0.25, -0.5))), 1e-6);
  }
  // The extension's texCoord wins.
  std::vector<glm::vec2> other(file.box.uvs.size(), glm::vec2(0.125f, 0.375f));
  file.primitive()["attributes"]["TEXCOORD_1"] = file.floats(other);
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform", {{"texCoord", 1}}}};
  EXPECT_EQ(load(file).meshes[0].uvs, other);
}

TEST(GltfImport, ReadsMaterialsAndLeavesUnknownImagesOut) {
  BoxFile file;
  const std::vector<std::uint8_t> webp = {'R', 'I', 'F', 'F', 0, 0, 0, 0};
  file.json["images"] =
      Json::array({{{"bufferView", file.view(webp)}, {"mimeType", "image/webp"}}});
  file.json["textures"] =
      Json::array({{{"source", 0}}, {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}});
  file.json["materials"] = Json::array(
      {{{"name", "a"},
        {"alphaMode", "MASK"},
        {"alphaCutoff", 0.25},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"baseColorTexture", {{"index", 0}}}}}},
       {{"name", "b"},
        {"alphaMode", "BLEND"},
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}}});
  file.primitive()["material"] = 0;
  const Plant plant = load(file);
  const Material& a = plant.materials[0];
  EXPECT_EQ(a.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(a.alpha_cutoff, 0.25f);
  EXPECT_TRUE(a.double_sided);
  EXPECT_EQ(a.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(a.base_color_texture, -1);
  EXPECT_EQ(plant.materials[1].alpha_mode, AlphaMode::kBlend);
  EXPECT_TRUE(hasNote(plant, "texture left out"));
  EXPECT_TRUE(hasNote(plant, "EXT_texture_webp"));
}

TEST(GltfImport, ReadsHowThickLeavesAre) {
  BoxFile file;
  file.json["materials"] = Json::array();
  const auto add = [&file](const Json& volume) {
    file.json["materials"].push_back({{"extensions", {{"KHR_materials_volume", volume}}}});
  };
  add({{"thicknessFactor", 0.0003}, {"attenuationDistance", 0.0002}});
  add({{"thicknessFactor", 0.0003}});  // clear
  add({{"attenuationDistance", 0.0002}});
  add({{"thicknessFactor", 1e9}, {"attenuationDistance", 1e-9}});
  const Plant plant = load(file);
  EXPECT_FLOAT_EQ(plant.materials[0].optical_thickness, 1.5f);
  EXPECT_EQ(plant.materials[0].thickness_texture, -1);
  EXPECT_EQ(plant.materials[1].optical_thickness, 0.0f);
  EXPECT_EQ(plant.materials[2].optical_thickness, 0.0f);
  EXPECT_EQ(plant.materials[3].optical_thickness, 100.0f);
}

TEST(GltfImport, UsesTheDefaultSceneAlone) {
  BoxFile file;
  file.node({{"mesh", 0}, {"translation", {5, 0, 0}}}, false);
  file.json["scenes"].push_back({{"nodes", {1}}});
  EXPECT_EQ(bounds(load(file)).max.x, 1.0f);
  file.json["scene"] = 1;
  EXPECT_EQ(bounds(load(file)).max.x, 6.0f);
  // A mesh that two nodes show is two parts.
  file.json["scenes"][1]["nodes"] = {0, 1};
  EXPECT_EQ(load(file).meshes.size(), 2u);
}

TEST(GltfImport, DropsVerticesThatNoTriangleUses) {
  BoxFile file;
  // Two primitives share the arrays: three faces each.
  const std::vector<std::uint32_t> first(file.box.indices.begin(), file.box.indices.begin() + 18);
  const std::vector<std::uint32_t> second(file.box.indices.begin() + 18, file.box.indices.end());
  Json other = file.primitive();
  file.primitive()["indices"] = file.indices(first);
  other["indices"] = file.indices(second);
  file.json["meshes"][0]["primitives"].push_back(other);
  const Plant plant = load(file);
  ASSERT_EQ(plant.meshes.size(), 2u);
  EXPECT_EQ(plant.meshes[1].positions,
            std::vector<glm::vec3>(file.box.positions.begin() + 12, file.box.positions.end()));
  EXPECT_EQ(plant.meshes[1].indices, first);
}

TEST(GltfImport, ExpandsInstances) {
  BoxFile file(Json{{"translation", {0, 1, 0}}});
  const float half = std::sqrt(0.5f);
  const Json attributes = {
      {"TRANSLATION", file.floats(std::vector<glm::vec3>{{3, 0, 0}, {0, 0, 9}})},
      {"ROTATION", file.floats(std::vector<glm::vec4>{{0, 0, 0, 1}, {0, half, 0, half}})},
      {"SCALE", file.floats(std::vector<glm::vec3>{{1, 1, 1}, {2, 1, -1}})}};
  file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  const Plant plant = load(file);
  ASSERT_EQ(plant.meshes.size(), 1u);
  const std::size_t n = file.box.positions.size();
  ASSERT_EQ(plant.meshes[0].positions.size(), 2 * n);
  std::vector<glm::vec3> expected;
  for (const glm::vec3& p : file.box.positions) expected.push_back(p + glm::vec3(3, 1, 0));
  for (const glm::vec3& p : file.box.positions) {
    const glm::vec3 s = p * glm::vec3(2, 1, -1);
    expected.push_back(glm::vec3(s.z, s.y, -s.x) + glm::vec3(0, 1, 9));  // 90 degrees about Y
  }
  expectNear(plant.meshes[0].positions, expected, 1e-5f);
  EXPECT_NEAR(signedVolume(plant.meshes[0]), 8.0 + 16.0, 1e-3);
}

TEST(GltfImport, ShowsSkinsInTheRestPose) {
  BoxFile file(
      Json{{"skin", 0}, {"translation", {77, 77, 77}}});  // a skinned mesh ignores its node
  file.node({{"translation", {0, 2, 0}}});
  file.node({{"translation", {1, 0, 0}}, {"scale", {2, 2, 2}}});
  const std::size_t n = file.box.positions.size();
  std::vector<std::uint8_t> joints;
  std::vector<glm::vec4> weights;
  for (std::size_t i = 0; i < n; ++i) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    const float w = static_cast<float>(i) / static_cast<float>(n);
    weights.emplace_back(2.0f * (1.0f - w), 2.0f * w, 0, 0);  // not normalised on purpose
  }
  file.primitive()["attributes"]["JOINTS_0"] = file.accessor(file.view(joints), 5121, n, "VEC4");
  file.primitive()["attributes"]["WEIGHTS_0"] = file.floats(weights);
  std::vector<glm::mat4> bind(2, glm::mat4(1.0f));
  bind[0][3] = glm::vec4(0, -2, 0, 1);
  const int matrices = file.accessor(file.view(bind), 5126, 2, "MAT4");
  file.json["skins"] = Json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}});
  const Plant plant = load(file);
  std::vector<glm::vec3> expected;
  for (std::size_t i = 0; i < n; ++i) {
    const glm::vec3 p = file.box.positions[i];
    const float w = static_cast<float>(i) / static_cast<float>(n);
    expected.push_back((1.0f - w) * p + w * (2.0f * p + glm::vec3(1, 0, 0)));
  }
  expectNear(plant.meshes[0].positions, expected, 1e-5f);
  expectNear(plant.meshes[0].normals, file.box.normals, 1e-5f);
}

TEST(GltfImport, DecodesMeshopt) {
  BoxFile file;
  const std::size_t n = file.box.positions.size();
  std::vector<std::uint8_t> vertices(meshopt_encodeVertexBufferBound(n, 12));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(),
                                             file.box.positions.data(), n, 12));
  const auto& indices = file.box.indices;
  std::vector<std::uint8_t> triangles(meshopt_encodeIndexBufferBound(indices.size(), n));
  triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(),
                                             indices.size()));
  const int vertex_view = file.view(vertices), index_view = file.view(triangles);
  const auto compress = [&](int packed, const char* mode, std::size_t stride, std::size_t count,
                            std::size_t offset) {
    const Json at = file.json["bufferViews"][static_cast<std::size_t>(packed)];
    file.json["bufferViews"].push_back({{"buffer", 1},
                                        {"byteOffset", offset},
                                        {"byteLength", stride * count},
                                        {"extensions",
                                         {{"EXT_meshopt_compression",
                                           {{"buffer", 0},
                                            {"byteOffset", at["byteOffset"]},
                                            {"byteLength", at["byteLength"]},
                                            {"byteStride", stride},
                                            {"count", count},
                                            {"mode", mode}}}}}});
    return static_cast<int>(file.json["bufferViews"].size()) - 1;
  };
  const int v = compress(vertex_view, "ATTRIBUTES", 12, n, 0);
  const int i = compress(index_view, "TRIANGLES", 4, indices.size(), 12 * n);
  file.primitive()["attributes"]["POSITION"] = file.accessor(v, 5126, n, "VEC3");
  file.primitive()["indices"] = file.accessor(i, 5125, indices.size(), "SCALAR");
  file.json["buffers"] =
      Json::array({{{"byteLength", file.bin.size()}},
                   {{"byteLength", 12 * n + 4 * indices.size()},
                    {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"EXT_meshopt_compression"};
  const Plant plant = load(file);
  EXPECT_EQ(plant.meshes[0].positions, file.box.positions);
  EXPECT_NEAR(signedVolume(plant.meshes[0]), 8.0, 1e-6);
  // Saved, it is an ordinary file.
  const fs::path out = scratchFolder("meshopt") / "out.glb";
  savePlant(plant, nullptr, out);
  EXPECT_FALSE(glbJson(out).contains("extensionsRequired"));
  EXPECT_EQ(glbJson(out).dump().find("meshopt"), std::string::npos);
  EXPECT_EQ(loadPlant(out).meshes[0].positions, plant.meshes[0].positions);
  // One that claims more than its bytes can hold is refused before anything is allocated.
  file.json["bufferViews"][static_cast<std::size_t>(v)]["extensions"]["EXT_meshopt_compression"]
           ["count"] = 4000000000u;
  EXPECT_THROW(load(file), Error);
}

TEST(GltfImport, DecodesDraco) {
  BoxFile file;
  draco::TriangleSoupMeshBuilder builder;
  const auto& box = file.box;
  builder.Start(static_cast<int>(box.indices.size() / 3));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t f = 0; f < box.indices.size() / 3; ++f)
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), &box.positions[box.indices[3 * f]],
                                      &box.positions[box.indices[3 * f + 1]],
                                      &box.positions[box.indices[3 * f + 2]]);
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer packed;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
  const std::vector<char> bytes(packed.data(), packed.data() + packed.size());
  const int view = file.view(bytes);
  const int positions = file.accessor(-1, 5126, 8, "VEC3");
  const int indices = file.accessor(-1, 5123, box.indices.size(), "SCALAR");
  file.primitive() = {{"attributes", {{"POSITION", positions}}},
                      {"indices", indices},
                      {"extensions",
                       {{"KHR_draco_mesh_compression",
                         {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}};
  file.json["extensionsRequired"] = file.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  const Plant plant = load(file);
  EXPECT_EQ(plant.meshes[0].positions.size(), 8u);
  EXPECT_NEAR(signedVolume(plant.meshes[0]), 8.0, 1e-6);
  EXPECT_EQ(bounds(plant).max, glm::vec3(1.0f));
  // Truncated data is an error, not a crash.
  file.json["bufferViews"][static_cast<std::size_t>(view)]["byteLength"] = bytes.size() / 2;
  EXPECT_THROW(load(file), Error);
}

TEST(OtherFormats, LoadObjWithItsMaterialsAndMask) {
  const fs::path dir = scratchFolder("obj");
  Image leaf(8, 8), mask(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const std::uint8_t on = x < 4 ? 255 : 0;
      std::memcpy(leaf.at(x, y), "\x20\x90\x20\xff", 4);
      const std::uint8_t texel[4] = {on, on, on, 255};
      std::memcpy(mask.at(x, y), texel, 4);
    }
  writePng(leaf, dir / "leaf.png");
  writePng(mask, dir / "mask.png");
  writeFile(dir / "tree.mtl",
            "newmtl Bark\nKd 0.4 0.3 0.2\nnewmtl Leaf\nKd 1 1 1\nmap_Kd C:\\art\\leaf.png\nmap_d "
            "mask.png\n");
  std::string obj =
      "mtllib tree.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
      "1\nvn 0 0 1\n";
  obj += "o tree\nusemtl Bark\nf 1/1/1 2/2/1 5/3/1\nusemtl Leaf\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";
  writeFile(dir / "tree.obj", obj);
  const Plant plant = loadPlant(dir / "tree.obj");
  ASSERT_EQ(plant.meshes.size(), 2u);
  const Mesh& cards = plant.meshes[1];
  EXPECT_EQ(cards.kind, PartKind::kFoliage);
  EXPECT_EQ(plant.meshes[0].kind, PartKind::kWood);
  const Material& material = plant.materials[cards.material];
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  ASSERT_GE(material.base_color_texture, 0);
  EXPECT_EQ(plant.textures[static_cast<std::size_t>(material.base_color_texture)].image.at(7, 0)[3],
            0);
  EXPECT_EQ(plant.textures[static_cast<std::size_t>(material.base_color_texture)].image.at(0, 0)[3],
            255);
  // OBJ counts V from below, glTF from above: the corner (0, 0, 0) is the image's lower left.
  for (std::size_t i = 0; i < cards.positions.size(); ++i)
    EXPECT_EQ(cards.uvs[i], glm::vec2(cards.positions[i].x, 1.0f - cards.positions[i].y));
  // It goes out as glTF and comes back the same.
  savePlant(plant, nullptr, dir / "tree.glb");
  const Plant back = loadPlant(dir / "tree.glb");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.meshes[i].positions, plant.meshes[i].positions);
    EXPECT_EQ(back.meshes[i].kind, plant.meshes[i].kind);
  }
}

TEST(OtherFormats, LoadFbxInItsUnitAndAxes) {
  const fs::path dir = scratchFolder("fbx");
  writeFile(dir / "t.obj", "o leaf\nv 0 0 0\nv 100 0 0\nv 0 20 300\nf 1 2 3\n");
  Assimp::Importer importer;
  Assimp::Exporter exporter;
  const aiScene* scene = importer.ReadFile((dir / "t.obj").string(), 0);
  ASSERT_EQ(exporter.Export(scene, "fbxa", (dir / "y_up.fbx").string()), aiReturn_SUCCESS);
  // Centimetres, Y up.
  glm::vec3 size = bounds(loadPlant(dir / "y_up.fbx")).size();
  EXPECT_LT(glm::length(size - glm::vec3(1.0f, 0.2f, 3.0f)), 1e-5f);
  // The same numbers with Z up, front along -Y, in metres.
  const auto bytes = readFile(dir / "y_up.fbx");
  std::string text(bytes.begin(), bytes.end());
  const auto set = [&text](const std::string& key, const std::string& value) {
    const auto at = text.find("\"" + key + "\"");
    ASSERT_NE(at, std::string::npos) << key;
    const auto end = text.find('\n', at);
    text.replace(text.rfind(',', end) + 1, end - text.rfind(',', end) - 1, " " + value);
  };
  set("UpAxis", "2");
  set("FrontAxis", "1");
  set("FrontAxisSign", "-1");
  set("UnitScaleFactor", "100");
  writeFile(dir / "z_up.fbx", text);
  const Bounds box = bounds(loadPlant(dir / "z_up.fbx"));
  EXPECT_LT(glm::length(box.min - glm::vec3(0, 0, -20)), 1e-3f);
  EXPECT_LT(glm::length(box.max - glm::vec3(100, 300, 0)), 1e-3f);
}

TEST(OtherFormats, LoadPlyAndDae) {
  const fs::path dir = scratchFolder("ply");
  writeFile(dir / "t.ply",
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
            "float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  const Plant ply = loadPlant(dir / "t.ply");
  EXPECT_EQ(triangleCount(ply), 2u);
  for (const glm::vec3& n : ply.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));

  // Z up and centimetres: a 200 cm tall triangle becomes 2 m along Y.
  writeFile(
      dir / "t.dae",
      "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
      "version=\"1.4.1\">"
      "<asset><unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset>"
      "<library_geometries><geometry id=\"g\" name=\"leaf\"><mesh><source id=\"p\"><float_array "
      "id=\"a\" count=\"9\">"
      "0 0 0 100 0 0 0 0 200</float_array><technique_common><accessor source=\"#a\" count=\"3\" "
      "stride=\"3\">"
      "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
      "type=\"float\"/></accessor></technique_common></source>"
      "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
      "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
      "2</p></triangles></mesh></geometry></library_geometries>"
      "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\" "
      "name=\"leaf\"><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
      "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>");
  const Bounds box = bounds(loadPlant(dir / "t.dae"));
  EXPECT_NEAR(box.size().y, 2.0f, 1e-5f);
  EXPECT_NEAR(box.size().x, 1.0f, 1e-5f);

  writeFile(dir / "bad.ply", "ply\nthis is not one\n");
  EXPECT_THROW(loadPlant(dir / "bad.ply"), Error);
  writeFile(dir / "bad.fbx", "nothing");
  EXPECT_THROW(loadPlant(dir / "bad.fbx"), Error);
}

}  // namespace
}  // namespace verdure
