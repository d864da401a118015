// What is a leaf and what is wood: names alone, and evidence together.
#include <gtest/gtest.h>

#include "base/random.h"
#include "plant/classify.h"

namespace verdure {
namespace {

TEST(NameScore, KnowsTheWordsOfAssetPacks) {
  for (const char* name : {"leaf",         "Leaves_01",     "OakLeaves", "M_Foliage",
                           "eichenblatt",  "Blätter",       "BLÄTTER",   "Laub",
                           "feuilles.001", "Hojas",         "foglia",    "folhas",
                           "葉",           "叶子",          "Листья",    "ЛИСТВА",
                           "needle_atlas", "cherryBlossom", "petals",    "palm_frond",
                           "twig card",    "Tannennadeln",  "mapleleaf", "leafs2",
                           "flower-head",  "Blüten",        "Löv",       "잎"})
    EXPECT_GT(nameScore(name), 0.0) << name;
  for (const char* name :
       {"bark",        "Trunk_LOD0", "oakBark", "wood",   "branch-01", "main_stem", "Stamm",
        "Eichenrinde", "Ast",        "écorce",  "ÉCORCE", "tronc",     "corteza",   "Tronco",
        "樹皮",        "树干",       "Кора",    "СТВОЛ",  "Branches",  "treetrunk", "Birkenstamm",
        "corteccia",   "Äste",       "casca",   "pień"})
    EXPECT_LT(nameScore(name), 0.0) << name;
  // Words within words say nothing.
  for (const char* name : {"last", "plaster", "mast", "system", "embark", "Material.001", "default",
                           "tree", "oak", "Mesh_12", "", "ramp", "catalog", "belief", "Laubbaum"})
    EXPECT_EQ(nameScore(name), 0.0) << name;
  EXPECT_GT(nameScore("branches_leaves"), 0.0);
  EXPECT_LT(nameScore("branches_leaves"), 1.0);
}

TEST(MatchesPattern, WholeNamesAndStars) {
  EXPECT_TRUE(matchesPattern("Oak Leaf", "oak leaf"));
  EXPECT_FALSE(matchesPattern("Oak Leaf", "oak"));
  EXPECT_TRUE(matchesPattern("Oak Leaf", "oak*"));
  EXPECT_TRUE(matchesPattern("Oak Leaf 01", "*leaf*"));
  EXPECT_TRUE(matchesPattern("ЛИСТ", "лист"));
  EXPECT_TRUE(matchesPattern("abab", "*ab"));
  EXPECT_TRUE(matchesPattern("", "*"));
  EXPECT_FALSE(matchesPattern("", "?"));
}

/// `count` flat quads, or tubes of eight sides.
Mesh pieces(bool flat, int count) {
  Random random(5);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at(random.vary(3), random.vary(3), random.vary(3));
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    if (flat) {
      const glm::vec3 u(random.vary(0.1f), random.vary(0.1f), 0.05f);
      const glm::vec3 v(random.vary(0.1f), 0.05f, random.vary(0.1f));
      for (const glm::vec3& p : {at, at + u, at + u + v, at + v}) mesh.positions.push_back(p);
      for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(base + k);
      continue;
    }
    const std::uint32_t sides = 8, rings = 6;
    for (std::uint32_t r = 0; r < rings; ++r)
      for (std::uint32_t s = 0; s < sides; ++s) {
        const float a = 6.2831853f * static_cast<float>(s) / static_cast<float>(sides);
        mesh.positions.push_back(
            at + glm::vec3(0.05f * std::cos(a), 0.4f * static_cast<float>(r), 0.05f * std::sin(a)));
      }
    for (std::uint32_t r = 0; r + 1 < rings; ++r)
      for (std::uint32_t s = 0; s < sides; ++s) {
        const std::uint32_t a = base + r * sides + s, b = base + r * sides + (s + 1) % sides;
        for (const std::uint32_t k : {a, a + sides, b, b, a + sides, b + sides})
          mesh.indices.push_back(k);
      }
  }
  return mesh;
}

PartKind classified(Mesh mesh, const Material& material, const PartNames& names,
                    const Texture* texture = nullptr) {
  Plant plant;
  plant.meshes.push_back(std::move(mesh));
  plant.materials.push_back(material);
  if (texture != nullptr) {
    plant.textures.push_back(*texture);
    plant.materials[0].base_color_texture = 0;
  }
  classifyParts(plant, {names}, {}, "test");
  EXPECT_EQ(plant.notes.size(), 1u);
  return plant.meshes[0].kind;
}

TEST(Classify, WithoutTellingNamesByShapeAndTexture) {
  Material plain;
  plain.name = "Material.003";
  EXPECT_EQ(classified(pieces(true, 400), plain, {}), PartKind::kFoliage);
  EXPECT_EQ(classified(pieces(false, 40), plain, {}), PartKind::kWood);
  EXPECT_EQ(classified(pieces(false, 1), plain, {}), PartKind::kWood);
  // Marked as cut-out, but the texture is opaque: exporters do that to bark too.
  Texture texture;
  texture.image = Image(16, 16);
  std::fill(texture.image.rgba.begin(), texture.image.rgba.end(), std::uint8_t{255});
  Material masked = plain;
  masked.alpha_mode = AlphaMode::kMask;
  masked.double_sided = true;
  EXPECT_EQ(classified(pieces(false, 5), masked, {}, &texture), PartKind::kWood);
  for (std::size_t i = 3; i < texture.image.rgba.size(); i += 8) texture.image.rgba[i] = 0;
  EXPECT_EQ(classified(pieces(true, 12), masked, {}, &texture), PartKind::kFoliage);
  // A card named after its branch is foliage all the same.
  masked.name = "branch-01";
  EXPECT_EQ(classified(pieces(true, 12), masked, {}, &texture), PartKind::kFoliage);
}

TEST(Classify, TheMaterialsNameCountsMostAndRecordsWin) {
  Material bark;
  bark.name = "bark";
  EXPECT_EQ(
      classified(pieces(false, 30), bark, {.mesh = "tree_leaves", .node = "", .recorded = {}}),
      PartKind::kWood);
  EXPECT_EQ(
      classified(pieces(false, 30), bark, {.mesh = "", .node = "", .recorded = PartKind::kFoliage}),
      PartKind::kFoliage);
}

}  // namespace
}  // namespace verdure
