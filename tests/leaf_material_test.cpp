// Leaves with maps of both sides, through glTF files.
#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gltf_builder.h"
#include "verdure/error.h"
#include "verdure/leaf_grow.h"
#include "verdure/leaf_plant.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

namespace fs = std::filesystem;

Plant birchLeaf() {
  LeafGrowOptions options;
  options.size = 64;
  const LeafSet set = growLeaf(options);
  return leafPlant(set, bakeLeafTranslucency(set));
}

/// The JSON of a .gltf file, changed and written again.
template <typename Change>
void changeJson(const fs::path& path, Change change) {
  Json json;
  std::ifstream(path) >> json;
  change(json);
  std::ofstream(path) << json;
}

TEST(LeafMaterial, ComesBackFromAFileAsItWas) {
  const Plant plant = birchLeaf();
  const fs::path path = scratchFolder("leaf_material") / "leaf.glb";
  savePlant(plant, nullptr, path);
  const Plant back = loadPlant(path);
  ASSERT_EQ(back.materials.size(), 1u);
  ASSERT_TRUE(back.materials[0].leaf.has_value());
  const LeafTextures &a = *plant.materials[0].leaf, &b = *back.materials[0].leaf;
  EXPECT_EQ(a.front_scale, b.front_scale);
  EXPECT_EQ(a.front_offset, b.front_offset);
  EXPECT_EQ(a.back_scale, b.back_scale);
  EXPECT_EQ(a.back_offset, b.back_offset);
  EXPECT_EQ(a.front_roughness, b.front_roughness);
  EXPECT_EQ(a.back_roughness, b.back_roughness);
  EXPECT_EQ(a.refractive_index, b.refractive_index);
  for (const auto texture :
       {&LeafTextures::back_color, &LeafTextures::back_normal, &LeafTextures::front_translucency,
        &LeafTextures::back_translucency, &LeafTextures::front_light, &LeafTextures::back_light}) {
    ASSERT_GE(b.*texture, 0);
    EXPECT_EQ(plant.textures[static_cast<std::size_t>(a.*texture)].image.rgba,
              back.textures[static_cast<std::size_t>(b.*texture)].image.rgba);
  }
}

TEST(LeafMaterial, OtherProgramsFindTheLightThroughIt) {
  const fs::path path = scratchFolder("leaf_extensions") / "leaf.gltf";
  savePlant(birchLeaf(), nullptr, path);
  Json json;
  std::ifstream(path) >> json;
  const Json& material = json["materials"][0];
  const Json& through = material["extensions"]["KHR_materials_diffuse_transmission"];
  // A leaf of a birch lets a tenth to half of the light through.
  EXPECT_GT(through["diffuseTransmissionFactor"].get<double>(), 0.1);
  EXPECT_LT(through["diffuseTransmissionFactor"].get<double>(), 0.5);
  EXPECT_EQ(through["diffuseTransmissionColorTexture"]["index"],
            material["extras"]["verdure"]["leaf"]["frontTranslucencyTexture"]["index"]);
  EXPECT_NEAR(material["extensions"]["KHR_materials_ior"]["ior"].get<double>(), 1.45, 0.3);
  for (const char* name : {"KHR_materials_diffuse_transmission", "KHR_materials_ior"}) {
    const Json& used = json["extensionsUsed"];
    EXPECT_EQ(std::count(used.begin(), used.end(), name), 1) << name;
  }
}

TEST(LeafMaterial, PassesTheKhronosValidator) {
  const fs::path path = scratchFolder("leaf_valid") / "leaf.glb";
  savePlant(birchLeaf(), nullptr, path);
  const int code = runValidator({path.string()});
  if (code > 1) GTEST_SKIP() << "no validator";
  EXPECT_EQ(code, 0);
}

TEST(LeafMaterial, WithoutOneMapAllAreLeftOut) {
  const fs::path path = scratchFolder("leaf_lacking") / "leaf.gltf";
  savePlant(birchLeaf(), nullptr, path);
  changeJson(path, [](Json& json) {
    Json& map = json["materials"][0]["extras"]["verdure"]["leaf"]["backNormalTexture"];
    map["texCoord"] = 1;  // its own UVs
  });
  const Plant plant = loadPlant(path);
  EXPECT_FALSE(plant.materials[0].leaf.has_value());
  EXPECT_TRUE(std::any_of(plant.notes.begin(), plant.notes.end(), [](const std::string& note) {
    return note.find("a map of its leaves") != std::string::npos;
  }));
}

TEST(LeafMaterial, DamagedExtrasSayWhatIsWrong) {
  const auto refused = [](auto change, const std::string& words) {
    const fs::path path = scratchFolder("leaf_damaged") / "leaf.gltf";
    savePlant(birchLeaf(), nullptr, path);
    changeJson(path,
               [&](Json& json) { change(json["materials"][0]["extras"]["verdure"]["leaf"]); });
    try {
      loadPlant(path);
      ADD_FAILURE() << "was taken: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refused([](Json& leaf) { leaf.erase("frontLightTexture"); }, "has no frontLightTexture");
  refused([](Json& leaf) { leaf["frontLightTexture"]["scale"] = "much"; },
          "'scale' is not a number");
  refused([](Json& leaf) { leaf["frontRoughness"] = 7; }, "frontRoughness is out of range");
  refused([](Json& leaf) { leaf["backColorTexture"]["index"] = 99; }, "99");
}

/// A foreign file: a box whose material has KHR_materials_diffuse_transmission and images of 2 x 2.
struct TranslucentFile : BoxFile {
  TranslucentFile() {
    json["extensionsUsed"] = {"KHR_materials_diffuse_transmission"};
    json["materials"] = Json::array({{{"name", "leaf"}, {"doubleSided", true}}});
    primitive()["material"] = 0;
    through() = {{"diffuseTransmissionFactor", 0.625},
                 {"diffuseTransmissionColorFactor", {0.5, 0.75, 0.25}},
                 {"diffuseTransmissionTexture", {{"index", addImage({0, 0, 0, 128})}}},
                 {"diffuseTransmissionColorTexture", {{"index", addImage({200, 220, 90, 255})}}}};
  }
  Json& through() {
    return json["materials"][0]["extensions"]["KHR_materials_diffuse_transmission"];
  }
  std::size_t addImage(const std::array<std::uint8_t, 4>& texel) {
    Image image(2, 2);
    for (int i = 0; i < 4; ++i) std::copy(texel.begin(), texel.end(), image.at(i % 2, i / 2));
    json["images"].push_back({{"bufferView", view(encodePng(image))}, {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return json["textures"].size() - 1;
  }
  fs::path write(const char* folder) const {
    const fs::path path = scratchFolder(folder) / "leaf.glb";
    writeFile(path, glb());
    return path;
  }
};

void expectTheSameLight(const Plant& plant) {
  ASSERT_TRUE(plant.materials[0].transmission.has_value());
  EXPECT_FALSE(plant.materials[0].leaf.has_value());
  const DiffuseTransmission& stated = *plant.materials[0].transmission;
  EXPECT_EQ(stated.factor, 0.625f);
  EXPECT_EQ(stated.color, glm::vec3(0.5f, 0.75f, 0.25f));
  const auto texel = [&plant](int texture) {
    return plant.textures.at(static_cast<std::size_t>(texture)).image.at(1, 1);
  };
  EXPECT_EQ(texel(stated.factor_texture)[3], 128);
  EXPECT_EQ(texel(stated.color_texture)[1], 220);
}

TEST(StatedTransmission, IsReadAndWrittenWithoutLoss) {
  const TranslucentFile file;
  Plant plant = loadPlant(file.write("stated"));
  expectTheSameLight(plant);
  // As a change to its own file,
  const fs::path again = scratchFolder("stated_again") / "leaf.glb";
  savePlant(plant, nullptr, again);
  EXPECT_EQ(glbJson(again)["materials"], file.json["materials"]);
  expectTheSameLight(loadPlant(again));
  // and as a new one.
  plant.source = nullptr;
  savePlant(plant, nullptr, again);
  expectTheSameLight(loadPlant(again));
  const Json used = glbJson(again)["extensionsUsed"];
  EXPECT_EQ(used, Json::array({"KHR_materials_diffuse_transmission"}));
  EXPECT_NE(runValidator({again.string()}), 1);
}

TEST(StatedTransmission, MapsOfBothSidesGoBeforeIt) {
  const fs::path path = scratchFolder("stated_own") / "leaf.gltf";
  savePlant(birchLeaf(), nullptr, path);
  EXPECT_FALSE(loadPlant(path).materials[0].transmission.has_value());
  // Without them it is what is known.
  changeJson(path, [](Json& json) { json["materials"][0].erase("extras"); });
  const Plant foreign = loadPlant(path);
  EXPECT_FALSE(foreign.materials[0].leaf.has_value());
  EXPECT_TRUE(foreign.materials[0].transmission.has_value());
}

TEST(StatedTransmission, WithATextureThatCannotBeReadItIsGuessed) {
  TranslucentFile file;
  file.through()["diffuseTransmissionTexture"]["texCoord"] = 1;
  TranslucentFile broken;
  broken.json["images"][1].erase("bufferView");
  broken.json["images"][1]["uri"] = "data:image/png;base64,AAAA";
  for (const TranslucentFile& bad : {file, broken}) {
    const Plant plant = loadPlant(bad.write("stated_lost"));
    EXPECT_FALSE(plant.materials[0].transmission.has_value());
    EXPECT_TRUE(std::any_of(plant.notes.begin(), plant.notes.end(), [](const std::string& note) {
      return note.find("guessed from its colour") != std::string::npos;
    }));
  }
}

TEST(StatedTransmission, NumbersOutOfRangeAreRefused) {
  const auto refused = [](const char* key, const Json& value, const std::string& words) {
    TranslucentFile file;
    file.through()[key] = value;
    try {
      loadPlant(file.write("stated_bad"));
      ADD_FAILURE() << "was taken: " << value;
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(key), std::string::npos) << text;
      EXPECT_NE(text.find(words), std::string::npos) << text;
      EXPECT_NE(text.find("'leaf'"), std::string::npos) << text;
    }
  };
  refused("diffuseTransmissionFactor", 1.01, "1.01 is outside of [0, 1]");
  refused("diffuseTransmissionFactor", -0.1, "-0.1 is outside of [0, 1]");
  refused("diffuseTransmissionFactor", "NaN", "not a number");
  refused("diffuseTransmissionColorFactor", {0.5, 2.0, 0.5}, "2 is outside of [0, 1]");
  refused("diffuseTransmissionColorFactor", {0.5, 0.5}, "not 3 numbers");
}

/// A foreign file with the extensions of gloss.
struct GlossyFile : BoxFile {
  GlossyFile() {
    json["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_specular"};
    json["materials"] = Json::array({{{"name", "leaf"}}});
    primitive()["material"] = 0;
    extensions() = {{"KHR_materials_ior", {{"ior", 1.375}}},
                    {"KHR_materials_specular",
                     {{"specularFactor", 0.25}, {"specularColorFactor", {1.0, 1.5, 0.5}}}}};
  }
  Json& extensions() { return json["materials"][0]["extensions"]; }
  Plant load() const {
    const fs::path path = scratchFolder("glossy") / "leaf.glb";
    writeFile(path, glb());
    return loadPlant(path);
  }
};

TEST(StatedGloss, IsReadAndWrittenWithoutLoss) {
  const GlossyFile file;
  Plant plant = file.load();
  const ClearSurface expected{1.375f, 0.25f, {1.0f, 1.5f, 0.5f}};
  EXPECT_EQ(plant.materials[0].surface, expected);
  const fs::path again = scratchFolder("glossy_again") / "leaf.glb";
  savePlant(plant, nullptr, again);
  EXPECT_EQ(glbJson(again)["materials"], file.json["materials"]);
  plant.source = nullptr;
  savePlant(plant, nullptr, again);
  EXPECT_EQ(loadPlant(again).materials[0].surface, expected);
  EXPECT_EQ(glbJson(again)["materials"][0]["extensions"], file.json["materials"][0]["extensions"]);
  EXPECT_NE(runValidator({again.string()}), 1);
  GlossyFile textured;
  textured.extensions()["KHR_materials_specular"]["specularTexture"] = {{"index", 0}};
  EXPECT_NE(textured.load().notes.at(0).find("specularTexture is left out"), std::string::npos);
  // Where nothing is said nothing is written.
  plant.materials[0].surface = {};
  savePlant(plant, nullptr, again);
  EXPECT_FALSE(glbJson(again)["materials"][0].contains("extensions"));
  EXPECT_FALSE(glbJson(again).contains("extensionsUsed"));
}

TEST(StatedGloss, NumbersOutOfRangeAreRefused) {
  const auto refused = [](const char* extension, const char* key, const Json& value) {
    GlossyFile file;
    file.extensions()[extension][key] = value;
    try {
      file.load();
      ADD_FAILURE() << "was taken: " << value;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
  };
  refused("KHR_materials_ior", "ior", 0.5);
  refused("KHR_materials_ior", "ior", -1.5);
  refused("KHR_materials_specular", "specularFactor", 1.5);
  refused("KHR_materials_specular", "specularFactor", -0.5);
  refused("KHR_materials_specular", "specularColorFactor", {0.5, -1.0, 0.5});
  GlossyFile mirror;
  mirror.extensions()["KHR_materials_ior"]["ior"] = 0;
  EXPECT_GT(mirror.load().materials[0].surface.refractive_index, 1e6f);
}

}  // namespace
}  // namespace verdure
