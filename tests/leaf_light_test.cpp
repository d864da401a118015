// Ambient light from how much of a leaf's faces is seen, (3) of Gumbau et al. 2008: from the file
// to the picture, against closed forms.
#include <glm/gtc/matrix_transform.hpp>

#include "gltf_builder.h"
#include "render_fixture.h"
#include "shared/leaf.h"
#include "shared/leaf_visibility.h"
#include "verdure/leaf_visibility.h"
#include "verdure/plant_io.h"

namespace verdure::test {
namespace {

namespace fs = std::filesystem;

// Levels that the vertices hold exactly.
const glm::vec2 kSeen(190.0f / 254.0f, 40.0f / 254.0f);
const glm::vec3 kGreen(0.1f, 0.3f, 0.05f);

/// A light with the same visibility on all leaves.
CrownLight seenLight(const Plant& plant, const glm::vec2& seen, float ambient = 0.6f) {
  CrownLight light = uniformLight(plant, {0, 0, 1}, ambient);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m)
    if (plant.meshes[m].kind == PartKind::kFoliage)
      light.meshes[m].visibility.assign(plant.meshes[m].positions.size(), seen);
  return light;
}

/// The ambient term alone, by leaf visibility, on leaf normals.
View ambientView(float exponent = 1.0f, bool transmission = false) {
  View view = quadView();
  view.terms = {.normal = NormalSource::kLeaf, .ambient_source = AmbientSource::kLeafVisibility};
  view.terms.diffuse = view.terms.specular = view.terms.shadow = false;
  view.terms.transmission = transmission;
  view.visibility_exponent = exponent;
  return view;
}

/// (3), with the light of the surroundings on the face that is seen and on the other.
glm::vec3 expectedAmbient(const glm::vec3& color, const glm::vec3& near, const glm::vec3& beyond,
                          const glm::vec2& seen, float exponent, bool transmission) {
  glm::vec3 sum = color * near * std::pow(seen.x, exponent);
  if (transmission) sum += shared::leafTransmittance(color) * beyond * std::pow(seen.y, exponent);
  return sum;
}

/// Luminance that changes linearly from -Z to +Z, below the horizon too.
class LinearSky final : public Sky {
 public:
  LinearSky(const glm::vec3& back, const glm::vec3& front) : back_(back), front_(front) {}
  glm::vec3 luminance(const glm::vec3& d) const override {
    return glm::mix(back_, front_, 0.5f + 0.5f * d.z);
  }
  /// Irradiance / pi: the cosine lobe passes the mean and two thirds of the slope.
  glm::vec3 lightOn(const glm::vec3& normal) const {
    return glm::mix(back_, front_, 0.5f + normal.z / 3.0f);
  }

 private:
  glm::vec3 back_, front_;
};

TEST(VisibilityCode, KeepsEveryPairOfLevelsThroughAVertexAttribute) {
  std::vector<bool> used(65536, false);
  for (int front = 0; front <= 254; ++front)
    for (int back = 0; back <= 254; ++back) {
      const glm::vec2 seen = glm::vec2(front, back) / 254.0f;
      const int code = packNormal({0, 0, 1}, 1.0f, seen)[3];
      ASSERT_GT(code, -32768);  // the same as -32767 to the GPU
      ASSERT_FALSE(used[static_cast<std::size_t>(code + 32768)]);
      used[static_cast<std::size_t>(code + 32768)] = true;
      const float attribute = static_cast<float>(code) / 32767.0f;
      ASSERT_EQ(shared::unpackVisibility(attribute * 32767.0f), seen);
    }
  const auto rounded = [](glm::vec2 v) {
    return shared::unpackVisibility(static_cast<float>(shared::packVisibility(v)));
  };
  EXPECT_EQ(rounded({1.0f, 0.5f}), glm::vec2(1.0f, 0.5f));
  EXPECT_EQ(rounded({-3.0f, 7.0f}), glm::vec2(0.0f, 1.0f));
  for (float v = 0.0f; v <= 1.0f; v += 0.00137f)
    EXPECT_NEAR(rounded({v, 1.0f - v}).x, v, 0.5f / 254.0f + 1e-6f);
}

TEST(VisibilityShares, TakeThePowerOfTheFaceThatIsSeen) {
  EXPECT_EQ(shared::visibilityShares({0.25f, 1.0f}, true, 0.5f), glm::vec2(0.5f, 1.0f));
  EXPECT_EQ(shared::visibilityShares({0.25f, 1.0f}, false, 2.0f), glm::vec2(1.0f, 0.0625f));
  for (const float exponent : {1e-3f, 1.0f, 100.0f})
    EXPECT_EQ(shared::visibilityShares({0.0f, 1.0f}, true, exponent), glm::vec2(0.0f, 1.0f));
}

class LeafLight : public RenderTest {};

TEST_F(LeafLight, IsExactInAFurnace) {
  const Plant quad = whiteQuad(glm::vec4(kGreen, 1.0f));
  const CrownLight light = seenLight(quad, kSeen);
  setItem(quad, &light);
  const glm::vec3 sky(0.5f, 0.25f, 0.125f);
  for (const float exponent : {0.4f, 1.0f, 2.5f})
    for (const bool transmission : {false, true})
      for (const NormalSource normal : {NormalSource::kLeaf, NormalSource::kCrown})
        for (const bool behind : {false, true}) {
          View view = ambientView(exponent, transmission);
          view.terms.normal = normal;
          setFurnace(view, sky);
          view.camera.eye.z = behind ? -5.0f : 5.0f;
          const glm::vec2 seen = behind ? glm::vec2(kSeen.y, kSeen.x) : kSeen;
          expectPixel(renderer().render(view).hdr, 32, 24,
                      expectedAmbient(kGreen, sky, sky, seen, exponent, transmission));
        }
}

TEST_F(LeafLight, EachFaceHasTheColourOfItsSurroundings) {
  const Plant quad = whiteQuad(glm::vec4(kGreen, 1.0f));
  const CrownLight light = seenLight(quad, kSeen);
  const auto sky =
      std::make_shared<LinearSky>(glm::vec3(0.1f, 0.3f, 1.0f), glm::vec3(1.0f, 0.2f, 0.1f));
  for (const bool mirrored : {false, true}) {
    Scene scene = itemScene(quad, &light);
    // The front of the mirrored one is still the side of +Z, but winds the other way.
    if (mirrored) scene.items[0].world_from_plant = {glm::scale(glm::mat4(1), {-1, 1, 1})};
    renderer().setScene(scene);
    for (const bool transmission : {false, true})
      for (const bool behind : {false, true}) {
        View view = ambientView(1.5f, transmission);
        view.daylight = {sky, {}};
        view.camera.eye.z = behind ? -5.0f : 5.0f;
        const glm::vec3 front = sky->lightOn({0, 0, 1}), back = sky->lightOn({0, 0, -1});
        expectPixel(
            renderer().render(view).hdr, 32, 24,
            expectedAmbient(kGreen, behind ? back : front, behind ? front : back,
                            behind ? glm::vec2(kSeen.y, kSeen.x) : kSeen, 1.5f, transmission),
            2e-3f);
      }
  }
}

TEST_F(LeafLight, MirroredThroughItsPlaneALeafShowsItsOtherFace) {
  const Plant quad = whiteQuad();
  const CrownLight light = seenLight(quad, kSeen);
  Scene scene = itemScene(quad, &light);
  scene.items[0].world_from_plant = {glm::scale(glm::mat4(1), {1, 1, -1})};
  renderer().setScene(scene);
  View view = ambientView();
  setFurnace(view, glm::vec3(1.0f));
  expectCenter(view, glm::vec3(kSeen.y));
  view.camera.eye.z = -5.0f;
  expectCenter(view, glm::vec3(kSeen.x));
}

TEST_F(LeafLight, WhatHasNoneTakesItsBakedCoefficient) {
  Plant plant = whiteQuad();
  Mesh wood;
  addQuad(wood, {-1.0f, -1, 1}, {2, 0, 0}, {0, 2, 0});  // hides the left half
  plant.meshes.push_back(wood);
  CrownLight light = seenLight(plant, kSeen, 0.7f);
  ASSERT_TRUE(light.meshes[1].visibility.empty());
  View view = ambientView(2.0f);
  setFurnace(view, glm::vec3(1.0f));
  for (const bool has : {true, false}) {
    if (!has) light.meshes[0].visibility.clear();
    setItem(plant, &light);
    const HdrImage image = renderer().render(view).hdr;
    expectPixel(image, 20, 24, glm::vec3(0.7f));
    expectPixel(image, 44, 24, glm::vec3(has ? kSeen.x * kSeen.x : 0.7f));
  }
  // Other lights do not look at it.
  light = seenLight(plant, kSeen, 0.7f);
  setItem(plant, &light);
  view.terms.ambient_source = AmbientSource::kBaked;
  expectPixel(renderer().render(view).hdr, 44, 24, glm::vec3(0.7f));
}

TEST_F(LeafLight, OfOpenLeavesIsThatOfTheSky) {
  const Plant tree = ballTree(60);
  CrownLight light = seenLight(tree, glm::vec2(1.0f), 1.0f);
  setItem(tree, &light);
  View view = smallView(96, 96);
  view.camera = {{0, 3, 9}, {0, 2.8f, 0}, 0.6f};
  view.terms = presetTerms("transfer");
  for (const float exponent : {0.5f, 3.0f}) {
    view.visibility_exponent = exponent;
    view.terms.ambient_source = AmbientSource::kSky;
    const HdrImage sky = renderer().render(view).hdr;
    view.terms.ambient_source = AmbientSource::kLeafVisibility;
    const HdrImage seen = renderer().render(view).hdr;
    // Drivers interpolate over slivers to half a percent; the exponent makes it three times as
    // much.
    EXPECT_EQ(countDifferent(sky, seen, 2e-2f), 0);
  }
  light = seenLight(tree, glm::vec2(0.3f), 1.0f);
  setItem(tree, &light);
  const HdrImage dark = renderer().render(view).hdr;
  view.terms.ambient_source = AmbientSource::kSky;
  EXPECT_GT(countDifferent(dark, renderer().render(view).hdr, 2e-2f), 300);
}

TEST_F(LeafLight, GlossMirrorsTheShareThatTheFaceSees) {
  const Plant quad = whiteQuad(glm::vec4(0, 0, 0, 1));
  const CrownLight light = seenLight(quad, kSeen);
  setItem(quad, &light);
  View view = ambientView(2.0f);
  setFurnace(view, {1.0f, 2.0f, 3.0f});
  view.terms.gloss = true;
  const float mirrored =
      shared::glossReflected(shared::glossWidth(true), 0.04f, -pixelRay(view, 32, 24).z);
  expectPixel(renderer().render(view).hdr, 32, 24,
              glm::vec3(1.0f, 2.0f, 3.0f) * mirrored * kSeen.x * kSeen.x, 2e-3f);
}

TEST_F(LeafLight, RefusesBadInput) {
  const Plant quad = whiteQuad();
  CrownLight light = seenLight(quad, kSeen);
  setItem(quad, &light);
  View view = ambientView();
  for (const float bad : {0.0f, -1.0f, NAN, INFINITY}) {
    view.visibility_exponent = bad;
    EXPECT_THROW(renderer().render(view), Error) << bad;
  }
  light.meshes[0].visibility.pop_back();
  EXPECT_THROW(setItem(quad, &light), Error);
}

TEST(VisibilityOfFiles, ComesBackAsItWent) {
  const fs::path dir = scratchFolder("visibility_round_trip");
  BoxFile file;
  writeFile(dir / "in.glb", file.glb());
  Plant plant = loadPlant(dir / "in.glb");
  EXPECT_TRUE(plant.meshes[0].visibility.empty());
  CrownLight light;
  light.meshes.push_back({plant.meshes[0].normals, {}});
  for (std::size_t v = 0; v < plant.meshes[0].positions.size(); ++v) {
    const float x = static_cast<float>(v) / 23.0f;
    light.meshes[0].ambient.push_back(0.5f);
    light.meshes[0].visibility.emplace_back(x, 1.0f - x * x);
  }
  for (const bool has_source : {true, false}) {
    if (!has_source) plant.source = nullptr;
    savePlant(plant, &light, dir / "out.glb");
    const Plant back = loadPlant(dir / "out.glb");
    EXPECT_TRUE(back.meshes[0].visibility == light.meshes[0].visibility);
    EXPECT_TRUE(back.meshes[0].ambient == light.meshes[0].ambient);
  }
}

TEST(VisibilityOfFiles, MayBeNormalisedIntegers) {
  const fs::path dir = scratchFolder("visibility_integers");
  const auto loaded = [&](BoxFile& file, int accessor) {
    file.primitive()["attributes"]["_VISIBILITY"] = accessor;
    writeFile(dir / "in.glb", file.glb());
    return loadPlant(dir / "in.glb").meshes[0].visibility;
  };
  BoxFile bytes, words, floats;
  std::vector<std::uint8_t> u8;
  std::vector<std::uint16_t> u16;
  std::vector<glm::vec2> f32(24, glm::vec2(0.5f));
  for (int v = 0; v < 24; ++v) {
    for (const int value : {v, 255 - v, 0, 0}) u8.push_back(static_cast<std::uint8_t>(value));
    for (const int value : {v * 2000, 65535 - v}) u16.push_back(static_cast<std::uint16_t>(value));
  }
  f32[3] = {NAN, 7.0f};
  f32[4] = {-2.0f, INFINITY};
  const auto of_bytes = loaded(bytes, bytes.accessor(bytes.view(u8, 4), 5121, 24, "VEC2", true));
  const auto of_words = loaded(words, words.accessor(words.view(u16), 5123, 24, "VEC2", true));
  ASSERT_EQ(of_bytes.size(), 24u);
  ASSERT_EQ(of_words.size(), 24u);
  for (int v = 0; v < 24; ++v) {
    const auto i = static_cast<std::size_t>(v);
    EXPECT_NEAR(of_bytes[i].x, static_cast<float>(v) / 255.0f, 1e-6f);
    EXPECT_NEAR(of_bytes[i].y, static_cast<float>(255 - v) / 255.0f, 1e-6f);
    EXPECT_NEAR(of_words[i].x, static_cast<float>(v * 2000) / 65535.0f, 1e-6f);
    EXPECT_NEAR(of_words[i].y, static_cast<float>(65535 - v) / 65535.0f, 1e-6f);
  }
  const auto of_floats = loaded(floats, floats.floats(f32));
  EXPECT_EQ(of_floats[0], glm::vec2(0.5f));
  EXPECT_EQ(of_floats[3], glm::vec2(1.0f));
  EXPECT_EQ(of_floats[4], glm::vec2(0.0f, 1.0f));
  // Of another length or kind.
  BoxFile shorter, scalar;
  f32.pop_back();
  EXPECT_THROW(loaded(shorter, shorter.floats(f32)), Error);
  EXPECT_THROW(loaded(scalar, scalar.accessor(scalar.view(std::vector<float>(24, 1.0f)), 5126, 24,
                                              "SCALAR")),
               Error);
}

TEST(VisibilityOfFiles, IsThatOfEachLeaf) {
  // From the bake through a file to the vertices of the GPU.
  const fs::path dir = scratchFolder("visibility_of_leaves");
  Plant tree = ballTree(80);
  findLeaves(tree);
  CrownLight light = ballTreeLight(tree);
  LeafVisibilityOptions looks;
  looks.directions = 16;
  looks.rays = 32;
  const auto seen = leafVisibility(tree, looks);
  setLeafVisibility(tree, seen, light);
  savePlant(tree, &light, dir / "tree.glb");
  const Plant back = loadPlant(dir / "tree.glb");
  ASSERT_EQ(back.meshes.size(), 2u);
  EXPECT_TRUE(back.meshes[0].visibility.empty());
  EXPECT_TRUE(back.meshes[1].visibility == light.meshes[1].visibility);
  const PackedScene packed = packScene(itemScene(tree, &light));
  for (const auto* stream : {&packed.leaf_normals, &packed.crown_normals})
    for (std::size_t l = 0; l < seen.size(); ++l) {
      const std::size_t v = tree.meshes[0].positions.size() + 4 * l;
      const glm::vec2 on_gpu = shared::unpackVisibility(static_cast<float>((*stream)[v][3]));
      for (int side = 0; side < 2; ++side)
        EXPECT_NEAR(on_gpu[side], seen[l][side], 0.5f / 254.0f + 1e-6f);
    }
}

}  // namespace
}  // namespace verdure::test
