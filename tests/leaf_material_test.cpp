// Leaves with maps of both sides, through glTF files.
#include <algorithm>
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

}  // namespace
}  // namespace verdure
