// Transfer vectors against closed forms, and their files.
#include "verdure/transfer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/gtc/packing.hpp>

#include "base/files.h"
#include "base/parallel.h"
#include "ray_plants.h"
#include "scratch.h"
#include "shared/leaf.h"
#include "shared/sky.h"
#include "test_plants.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"
#include "verdure/plant_io.h"

namespace verdure {
namespace {

using namespace test;

const float kBand0 = std::sqrt(4.0f * glm::pi<float>());  ///< weight of an even light of 1

glm::vec3 coefficient(const std::vector<std::uint16_t>& vectors, int bands, std::size_t vertex,
                      int i) {
  const std::size_t at =
      (vertex * static_cast<std::size_t>(bands * bands) + static_cast<std::size_t>(i)) * 3;
  return {glm::unpackHalf1x16(vectors[at]), glm::unpackHalf1x16(vectors[at + 1]),
          glm::unpackHalf1x16(vectors[at + 2])};
}

/// The harmonics of max(cos, 0) / pi around a direction: Ramamoorthi, Hanrahan 2001, (8) over pi.
std::vector<float> cosineLobe(const glm::vec3& axis, int bands) {
  std::vector<float> values(static_cast<std::size_t>(bands * bands));
  harmonicsAt(axis, bands, values.data());
  const float factors[] = {1.0f, 2.0f / 3.0f, 0.25f, 0.0f, -1.0f / 24.0f, 0.0f, 1.0f / 64.0f};
  for (int l = 0; l < bands; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i)
      values[static_cast<std::size_t>(i)] *= factors[l];
  return values;
}

void expectLobe(const std::vector<std::uint16_t>& vectors, int bands, std::size_t vertex,
                const glm::vec3& axis, const glm::vec3& scale, float tolerance) {
  const std::vector<float> lobe = cosineLobe(axis, bands);
  for (int i = 0; i < bands * bands; ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(coefficient(vectors, bands, vertex, i)[c],
                  scale[c] * lobe[static_cast<std::size_t>(i)], tolerance)
          << i << ", " << c;
}

TransferOptions options(int rays, int bands = 5, int bounces = 3) {
  TransferOptions o;
  o.rays.rays = rays;
  o.rays.bounces = bounces;
  o.bands = bands;
  o.bounce_bands = std::min(bands, 3);
  o.ground_size = 8;
  return o;
}

TEST(Transfer, ALoneLeafHasCosineLobesOnBothSides) {
  const glm::vec3 n = glm::normalize(glm::vec3(0.4f, 0.7f, -0.5f));
  const Plant plant = probe({0, 1, 0}, n);
  for (const int bands : {2, 5, 7}) {
    const PlantTransfer t = bakeTransfer(plant, options(2048, bands));
    EXPECT_EQ(t.bands, bands);
    ASSERT_EQ(t.meshes.size(), 1u);
    ASSERT_EQ(t.meshes[0].front.size(), 3u * static_cast<std::size_t>(bands * bands) * 3u);
    expectLobe(t.meshes[0].front, bands, 0, n, glm::vec3(1.0f), 1.5e-3f);
    expectLobe(t.meshes[0].back, bands, 0, -n, glm::vec3(1.0f), 1.5e-3f);
    for (const std::uint16_t h : t.meshes[0].front_bounced) EXPECT_EQ(h, 0);
    EXPECT_EQ(t.ground.size, 0);
  }
}

TEST(Transfer, UnderATranslucentSheetTheLobeOfItsUpperSideShinesThrough) {
  Plant plant = probe({0, 0, 0}, {0, 1, 0});
  addSheet(plant, 4000.0f, 0.5f);
  plant.meshes[1].kind = PartKind::kFoliage;
  const glm::vec3 color(0.3f, 0.6f, 0.2f);
  plant.materials[1].base_color = glm::vec4(color, 1.0f);
  plant.materials[0].base_color = {0, 0, 0, 1};
  addSheet(plant, 4000.0f, -0.5f);  // black, below
  plant.meshes.back().material = 0;
  const PlantTransfer t = bakeTransfer(plant, options(4096, 4, 1));
  expectLobe(t.meshes[0].front, 4, 0, {0, 1, 0}, shared::leafTransmittance(color), 4e-3f);
  expectLobe(t.meshes[0].front_bounced, 3, 0, {0, 1, 0}, shared::leafTransmittance(color), 4e-3f);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(coefficient(t.meshes[0].back, 4, 0, i).g, 0.0f);
}

TEST(Transfer, TheGroundReflectsItsLobeAndReceivesIts) {
  const Plant plant = probe({0, 6, 0}, {0, -1, 0});
  TransferOptions o = options(4096);
  o.rays.ground_height = 0.5f;
  const PlantTransfer t = bakeTransfer(plant, o);
  expectLobe(t.meshes[0].front, 5, 0, {0, 1, 0}, shared::groundMeanColor(), 2e-3f);
  expectLobe(t.meshes[0].back, 5, 0, {0, 1, 0}, glm::vec3(1.0f), 2e-3f);
  ASSERT_EQ(t.ground.size, 8);
  EXPECT_EQ(t.ground.height, 0.5f);
  EXPECT_LE(t.ground.corner.x, -5.5f);
  EXPECT_NEAR(t.ground.corner.x + 7.0f * t.ground.step, -t.ground.corner.x, 0.01f);
  for (const std::size_t point : {0, 7, 36, 63})
    expectLobe(t.ground.vectors.front, 5, point, {0, 1, 0}, glm::vec3(1.0f), 2e-3f);
}

TEST(Transfer, UnderARoofTheGroundIsDark) {
  Plant plant = probe({0, 0.1f, 0}, {0, 1, 0});
  addSheet(plant, 8.0f, 0.4f);
  TransferOptions o = options(4096, 3, 0);
  o.ground_size = 9;
  o.rays.ground_height = 0.0f;
  const PlantTransfer t = bakeTransfer(plant, o);
  EXPECT_LT(coefficient(t.ground.vectors.front, 3, 4 * 9 + 4, 0).g * kBand0, 0.02f);  // the middle
  // The grid reaches the plant's height beyond its edge: there the roof fills the share of the
  // cosine hemisphere that a long rectangle's form factor gives, well below a half.
  const float corner = coefficient(t.ground.vectors.front, 3, 0, 0).g * kBand0;
  EXPECT_GT(corner, 0.7f);
  EXPECT_LT(corner, 1.0f);
}

TEST(Transfer, AnEvenSkyGivesAmbientOcclusion) {
  const Plant plant = ballTree(150, 0.5f, true);
  TransferOptions o = options(512, 3, 4);
  o.rays.ground_height = 0.0f;
  const PlantTransfer t = bakeTransfer(plant, o);
  const std::vector<VertexId> all = allVertices(plant);
  const std::vector<glm::vec3> ambient = traceAmbient(plant, all, o.rays);
  o.rays.bounces = 0;
  const std::vector<glm::vec3> direct = traceAmbient(plant, all, o.rays);
  glm::dvec3 error(0.0), bias(0.0), bounced(0.0);
  double direct_bias = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TransferVectors& v = t.meshes[all[i].mesh];
    const glm::vec3 lit = kBand0 * coefficient(v.front, 3, all[i].vertex, 0);
    const glm::vec3 part = kBand0 * coefficient(v.front_bounced, 3, all[i].vertex, 0);
    const glm::dvec3 difference(lit - ambient[i]);
    error += difference * difference;
    bias += difference;
    bounced += glm::dvec3(part);
    direct_bias += static_cast<double>(lit.g - part.g - direct[i].g);
  }
  const auto n = static_cast<double>(all.size());
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(std::sqrt(error[c] / n), 0.03);
    EXPECT_LT(std::abs(bias[c] / n), 2e-3);
  }
  EXPECT_GT(bounced.g / n, 0.02);  // there is something to compare
  EXPECT_GT(bounced.g, bounced.b);
  EXPECT_LT(std::abs(direct_bias / n), 2e-3);
}

bool same(const TransferVectors& a, const TransferVectors& b) {
  return a.front == b.front && a.back == b.back && a.front_bounced == b.front_bounced &&
         a.back_bounced == b.back_bounced;
}

TEST(Transfer, ThreadsChangeNothing) {
  const Plant plant = ballTree(60, 0.5f);
  TransferOptions o = options(64);
  o.rays.ground_height = 0.0f;
  setThreadCount(1);
  const PlantTransfer one = bakeTransfer(plant, o);
  setThreadCount(2);
  const PlantTransfer two = bakeTransfer(plant, o);
  setThreadCount(0);
  for (std::size_t m = 0; m < one.meshes.size(); ++m)
    EXPECT_TRUE(same(one.meshes[m], two.meshes[m]));
  EXPECT_TRUE(same(one.ground.vectors, two.ground.vectors));
}

TEST(Transfer, SaysWhatIsWrongAndStopsWhenAsked) {
  const Plant plant = ballTree(300);
  EXPECT_THROW(bakeTransfer(plant, options(16, 1)), Error);
  EXPECT_THROW(bakeTransfer(plant, options(16, 8)), Error);
  TransferOptions o = options(16);
  o.bounce_bands = 4;
  EXPECT_THROW(bakeTransfer(plant, o), Error);
  o = options(16);
  o.rays.max_memory_bytes = 1000;
  EXPECT_THROW(bakeTransfer(plant, o), Error);
  o = options(16);
  int told = 0;
  o.rays.progress = [&told](double) { return ++told < 3; };
  EXPECT_THROW(bakeTransfer(plant, o), Error);
  EXPECT_EQ(told, 3);
}

std::string loadError(const std::filesystem::path& file, const Plant& plant) {
  try {
    loadTransfer(file, plant);
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "";
}

TEST(TransferFile, ComesBackAsItWas) {
  const auto folder = scratchFolder("transfer");
  const Plant plant = ballTree(40, 0.5f);
  TransferOptions o = options(32, 4);
  o.rays.ground_height = -0.25f;
  const PlantTransfer t = bakeTransfer(plant, o);
  const auto file = folder / "tree.glb";
  EXPECT_FALSE(loadTransfer(file, plant));
  saveTransfer(t, plant, file);
  EXPECT_TRUE(std::filesystem::exists(folder / "tree.transfer"));
  const std::optional<PlantTransfer> read = loadTransfer(file, plant);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->bands, 4);
  EXPECT_EQ(read->bounce_bands, 3);
  ASSERT_EQ(read->meshes.size(), t.meshes.size());
  for (std::size_t m = 0; m < t.meshes.size(); ++m) EXPECT_TRUE(same(read->meshes[m], t.meshes[m]));
  EXPECT_TRUE(same(read->ground.vectors, t.ground.vectors));
  EXPECT_EQ(read->ground.size, t.ground.size);
  EXPECT_EQ(read->ground.corner, t.ground.corner);
  EXPECT_EQ(read->ground.step, t.ground.step);
  EXPECT_EQ(read->ground.height, -0.25f);
}

TEST(TransferFile, BelongsToThePlantThatWasSaved) {
  const auto folder = scratchFolder("transfer_saved");
  const Plant plant = ballTree(30, 0.5f);
  const auto file = folder / "tree.glb";
  savePlant(plant, nullptr, file);
  const Plant loaded = loadPlant(file);
  saveTransfer(bakeTransfer(loaded, options(8, 2)), loaded, file);
  EXPECT_TRUE(loadTransfer(file, loadPlant(file)));
}

TEST(TransferFile, DamageIsOneClearLine) {
  const auto folder = scratchFolder("transfer_damage");
  const auto file = folder / "tree.glb";
  const Plant plant = ballTree(30, 0.5f);
  TransferOptions o = options(8, 2);
  o.rays.ground_height = 0.0f;
  saveTransfer(bakeTransfer(plant, o), plant, file);
  const std::vector<std::uint8_t> good = readFile(transferPath(file));
  const auto with = [&](std::vector<std::uint8_t> bytes) {
    writeFile(transferPath(file), bytes);
    return loadError(file, plant);
  };
  EXPECT_EQ(with(good), "");
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{47}, std::size_t{60},
                                 good.size() / 2, good.size() - 1})
    EXPECT_NE(with({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  auto bytes = good;
  bytes.push_back(0);
  EXPECT_NE(with(bytes).find("longer"), std::string::npos);
  // Every byte of the header matters, but for the reserved ones and the ground's place.
  for (std::size_t at = 0; at < 28; ++at) {
    bytes = good;
    bytes[at] ^= 0x40;
    EXPECT_NE(with(bytes), "") << at;
  }
  bytes = good;
  bytes[8] = 2;
  EXPECT_NE(with(bytes).find("version 2"), std::string::npos);
  bytes = good;
  bytes[bytes.size() - 1] = 0x7e;  // NaN
  EXPECT_NE(with(bytes).find("finite"), std::string::npos);
  with(good);
  EXPECT_NE(loadError(file, ballTree(31, 0.5f)).find("another plant"), std::string::npos);
  Plant moved = plant;
  for (glm::vec3& p : moved.meshes[0].positions) p.x += 0.1f;
  EXPECT_NE(loadError(file, moved).find("another plant"), std::string::npos);
}

TEST(Transfer, ForeignPlants) {
  const char* folder = std::getenv("VERDURE_PLANT_DIR");
  if (folder == nullptr) GTEST_SKIP() << "VERDURE_PLANT_DIR is not set";
  const auto scratch = scratchFolder("foreign_transfer");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf") continue;
    SCOPED_TRACE(entry.path());
    const Plant plant = loadPlant(entry.path());
    if (vertexCount(plant) > 30000) continue;
    TransferOptions o = options(16, 2, 2);
    o.rays.ground_height = bounds(plant).min.y;
    const PlantTransfer t = bakeTransfer(plant, o);
    for (const TransferVectors& mesh : t.meshes)
      for (std::size_t v = 0; v < mesh.front.size() / 12; ++v) {
        const glm::vec3 lit = kBand0 * coefficient(mesh.front, 2, v, 0);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(lit, glm::vec3(0.0f))));
        ASSERT_TRUE(glm::all(glm::lessThan(lit, glm::vec3(2.0f))));
      }
    // What is saved with a bake's light still fits.
    CrownLight light;
    for (const Mesh& mesh : plant.meshes)
      light.meshes.push_back({mesh.normals, std::vector<float>(mesh.normals.size(), 0.5f)});
    const auto file = scratch / "plant.glb";
    savePlant(plant, &light, file);
    saveTransfer(t, plant, file);
    EXPECT_EQ(loadError(file, loadPlant(file)), "");
  }
}

}  // namespace
}  // namespace verdure
