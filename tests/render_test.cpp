#include <gtest/gtest.h>

#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>

#include "base/files.h"
#include "render_fixture.h"
#include "scene/camera.h"
#include "shared/leaf.h"
#include "verdure/compare.h"

namespace verdure {
namespace {

using namespace test;

TEST(Terms, PresetsAreThePublishedCombinations) {
  EXPECT_EQ(presetTerms("standard").normal, NormalSource::kLeaf);
  EXPECT_EQ(presetTerms("standard").ambient_source, AmbientSource::kConstant);
  EXPECT_EQ(presetTerms("expressive").normal, NormalSource::kCrown);
  EXPECT_EQ(presetTerms("expressive").ambient_source, AmbientSource::kBaked);
  for (const std::string& name : presetNames()) EXPECT_NO_THROW(presetTerms(name));
  EXPECT_EQ(presetTerms("transfer").ambient_source, AmbientSource::kTransfer);
  EXPECT_TRUE(presetTerms("transfer").transmission);
  EXPECT_EQ(presetTerms("depth-maps").ambient_source, AmbientSource::kLeafVisibility);
  EXPECT_EQ(presetTerms("depth-maps").shadow_source, ShadowSource::kDepthLayers);
  EXPECT_TRUE(presetTerms("depth-maps").scattering);
  EXPECT_EQ(presetTerms("best").ambient_source, AmbientSource::kTransfer);
  EXPECT_EQ(presetTerms("best").shadow_source, ShadowSource::kDepthOrdered);
  EXPECT_THROW(presetTerms("impressive"), Error);
}

class Render : public RenderTest {};

TEST_F(Render, EveryTermIsSilentUnderValidation) {
  const Plant tree = ballTree(120, 0.5f, true);
  const CrownLight light = ballTreeLight(tree);
  Scene scene;
  scene.items = {{&tree, &light}, {&tree, nullptr, {glm::translate(glm::mat4(1), {4, 0, 0})}}};
  renderer().setScene(scene);
  View view = smallView(64, 48);
  view.camera = automaticCamera(scene, 0.3f, 0.1f, 4.0f / 3.0f);
  view.shadow_map_size = 128;
  for (const std::string& name : presetNames())
    for (int off = 0; off < 9; ++off) {
      view.terms = presetTerms(name);
      bool* const switches[] = {&view.terms.ambient, &view.terms.diffuse, &view.terms.specular,
                                &view.terms.shadow, &view.terms.textures};
      if (off < 5) *switches[off] = false;
      if (off == 5)
        for (bool* s : switches) *s = false;
      view.daylight = off == 7   ? Daylight{uniformSky(glm::vec3(2.0f)), {}}
                      : off == 8 ? Daylight{}
                                 : preethamDaylight(3.0f, directionOf(0.9f, 0.75f));
      view.hdr = off % 2 == 0;
      view.bloom = off == 3 ? 0.0f : 0.05f;
      view.exposure.ev = off == 4 ? std::optional(14.0f) : std::nullopt;
      renderer().render(view);
    }
  for (const ShadowSource source : {ShadowSource::kShadowMap, ShadowSource::kDepthPaper,
                                    ShadowSource::kDepthLayers, ShadowSource::kDepthOrdered})
    for (const int cascades : {1, 3}) {
      view.terms.shadow_source = source;
      view.shadow_cascades = cascades;
      renderer().render(view);
    }
  view.background = glm::vec3(0.2f);
  view.width = 33;  // other targets, other shadow map
  view.shadow_map_size = 64;
  renderer().render(view);
  renderer().setScene(Scene{});  // nothing but ground
  renderer().render(view);
}

TEST_F(Render, AmbientAloneIsExact) {
  const Plant quad = whiteQuad();
  const CrownLight light = uniformLight(quad, {0, 0, 1}, 0.6f);
  View view = quadView();
  view.terms.diffuse = view.terms.specular = view.terms.shadow = false;
  const glm::vec3 sky(0.5f, 0.25f, 0.125f);
  setFurnace(view, sky);
  setItem(quad, &light);
  expectCenter(view, sky * 0.6f);
  view.terms.ambient_source = AmbientSource::kConstant;
  expectCenter(view, sky);
  view.terms.ambient = false;
  expectCenter(view, glm::vec3(0.0f));
  // Least coefficient: the normal's length is 1/255, its direction stays.
  const CrownLight dark = uniformLight(quad, {0, 0, 1}, 1.0f / 255.0f);
  setItem(quad, &dark);
  view.terms.ambient = true;
  view.terms.ambient_source = AmbientSource::kBaked;
  expectPixel(renderer().render(view).hdr, 32, 24, sky / 255.0f, 6e-3f);  // 16 bits a component
  view.terms.ambient = false;
  view.terms.diffuse = true;
  turnSun(view, 0.0f, 0.5f);
  expectCenter(view, sunLight(view) * std::cos(0.5f));
}

TEST_F(Render, DiffuseFollowsTheCosine) {
  const Plant quad = whiteQuad();
  setItem(quad, nullptr);
  View view = quadView();
  view.terms.ambient = view.terms.specular = view.terms.shadow = false;
  view.terms.normal = NormalSource::kLeaf;
  for (const float elevation : {0.0f, 0.3f, 0.7f, 1.1f, 1.5f}) {
    turnSun(view, 0.0f, elevation);
    expectCenter(view, sunLight(view) * std::cos(elevation));
  }
  for (const float azimuth : {-1.2f, 0.4f, 2.0f}) {  // the last is behind the quad
    turnSun(view, azimuth, 0.2f);
    expectCenter(view, sunLight(view) * std::max(0.0f, std::cos(azimuth) * std::cos(0.2f)));
  }
}

TEST_F(Render, LeafNormalsAreTwoSidedAndCrownNormalsAreNot) {
  const Plant quad = whiteQuad();
  const CrownLight light = uniformLight(quad, {0, 0, 1}, 1.0f);
  View view = quadView();
  view.terms.ambient = view.terms.specular = view.terms.shadow = false;
  const glm::vec3 lit = sunLight(view) * std::cos(0.4f);
  for (const bool mirrored : {false, true}) {
    Scene scene = itemScene(quad, &light);
    if (mirrored) scene.items[0].world_from_plant = {glm::scale(glm::mat4(1), {-1, 1, 1})};
    renderer().setScene(scene);
    for (const bool behind : {false, true}) {
      view.camera.eye.z = behind ? -5.0f : 5.0f;
      for (const bool sun_behind : {false, true}) {
        turnSun(view, sun_behind ? glm::pi<float>() : 0.0f, 0.4f);
        view.terms.normal = NormalSource::kLeaf;
        expectCenter(view, sun_behind == behind ? lit : glm::vec3(0.0f));
        view.terms.normal = NormalSource::kCrown;
        expectCenter(view, sun_behind ? glm::vec3(0.0f) : lit);
      }
    }
  }
}

TEST_F(Render, LeavesShowTheLightOnTheirFarSide) {
  const glm::vec3 green(0.1f, 0.3f, 0.05f);
  const Plant quad = whiteQuad(glm::vec4(green, 1.0f));
  setItem(quad, nullptr);
  View view = quadView();
  view.terms = presetTerms("standard");
  view.terms.specular = false;
  view.terms.transmission = true;
  const glm::vec3 sky = view.daylight.sky->luminance({0, 1, 0});
  const glm::vec3 through = shared::leafTransmittance(green);
  for (const bool sun_behind : {false, true}) {
    turnSun(view, sun_behind ? glm::pi<float>() : 0.0f, 0.4f);
    expectCenter(view, sky * (green + through) +
                           sunLight(view) * std::cos(0.4f) * (sun_behind ? through : green));
  }
  // Wood lets nothing through.
  Plant wood = quad;
  wood.meshes[0].kind = PartKind::kWood;
  setItem(wood, nullptr);
  expectCenter(view, sky * green);
}

TEST_F(Render, PixelsEqualTheSharedFormula) {
  // All terms on: a tilted quad whose highlight moves over it.
  const Plant quad = whiteQuad({0.3f, 0.5f, 0.2f, 1.0f});
  const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.4f, 1.0f));
  const float k = 0.7f;
  const CrownLight light = uniformLight(quad, normal, k);
  setItem(quad, &light);
  View view = quadView();
  turnSun(view, 0.5f, 0.6f);
  const HdrImage image = renderer().render(view).hdr;
  for (const int x : {20, 32, 44})
    for (const int y : {18, 24, 30}) {
      // The quad lies in z = 0.
      const glm::vec3 ray = pixelRay(view, x, y);
      const glm::vec3 point = view.camera.eye - ray * (view.camera.eye.z / ray.z);
      expectPixel(image, x, y, expectedLeafColor(view, {0.3f, 0.5f, 0.2f}, k, normal, point));
    }
}

TEST_F(Render, ShadowLiesWhereTheSunRaySays) {
  const Plant card = horizontalCard(2.0f, 1.0f);
  Scene scene = itemScene(card, nullptr);
  scene.ground = true;
  renderer().setScene(scene);
  View view = smallView(160, 120);
  view.camera = {{0, 9, 8}, {0, 0.5f, 0}, 0.8f};
  view.terms.textures = false;
  view.shadow_map_size = 512;
  for (const float azimuth : {0.9f, 3.5f, 5.3f}) {
    const glm::vec3 to_sun = directionOf(azimuth, 0.9f);
    view.daylight = preethamDaylight(3.0f, to_sun);
    view.terms.shadow = true;
    const HdrImage with = renderer().render(view).hdr;
    view.terms.shadow = false;
    const HdrImage without = renderer().render(view).hdr;
    int inside = 0, outside = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const glm::vec3 ray = pixelRay(view, x, y);
        if (ray.y >= -0.1f) continue;
        const glm::vec3 at_card = view.camera.eye + ray * ((2.0f - view.camera.eye.y) / ray.y);
        if (std::max(std::abs(at_card.x), std::abs(at_card.z)) < 0.65f) continue;  // the card
        const glm::vec3 ground = view.camera.eye - ray * (view.camera.eye.y / ray.y);
        const glm::vec3 above = ground + to_sun * (2.0f / to_sun.y);
        const float reach = std::max(std::abs(above.x), std::abs(above.z));
        const float left = luminanceAt(with, x, y) / luminanceAt(without, x, y);
        if (reach < 0.4f) {
          EXPECT_LT(left, 0.4f) << x << " " << y;
          ++inside;
        } else if (reach > 0.6f) {
          EXPECT_EQ(left, 1.0f) << x << " " << y;
          ++outside;
        }
      }
    EXPECT_GT(inside, 30);
    EXPECT_GT(outside, 5000);
  }
}

TEST_F(Render, WhatIsNotSeenStillCastsItsShadow) {
  // Two cameras on one axis, above the card and below it, see the same ground.
  const Plant card = horizontalCard(2.0f, 1.0f);
  const Plant post = standingTube(0.05f, 0.0f, 0.5f);
  Scene scene = itemScene(card, nullptr);
  scene.items.push_back({&post, nullptr});
  scene.ground = true;
  View above = smallView(96, 96);
  above.terms.textures = false;
  above.terms.specular = false;
  above.camera = {{0.1f, 12, 0.1f}, {0, 0, 0}, 0.1f};
  setSun(above, 0.0f, 1.47f, {0.9f, 0.8f, 0.6f});
  setFurnace(above, glm::vec3(0.1f));
  View below = above;
  below.camera.eye = 0.15f * above.camera.eye;
  below.camera.vertical_fov = 2.0f * std::atan(std::tan(0.05f) / 0.15f);
  renderer().setScene(scene);
  const float card_light = luminanceAt(renderer().render(above).hdr, 48, 20);
  const HdrImage from_below = renderer().render(below).hdr;
  scene.items[0].seen = false;
  renderer().setScene(scene);
  const HdrImage through = renderer().render(above).hdr;
  EXPECT_EQ(countDifferent(renderer().render(below).hdr, from_below, 0.0f), 0);
  int shadowed = 0;
  for (const glm::ivec2 at : {glm::ivec2(20, 48), glm::ivec2(80, 40), glm::ivec2(40, 80)}) {
    expectPixel(through, at.x, at.y, from_below.at(at.x, at.y), 0.02f);
    shadowed += luminanceAt(through, at.x, at.y) < 0.3f * card_light ? 1 : 0;
  }
  EXPECT_EQ(shadowed, 3);
  // Without the card the same place is lit.
  scene.items.erase(scene.items.begin());
  renderer().setScene(scene);
  EXPECT_GT(luminanceAt(renderer().render(above).hdr, 20, 48), 3.0f * luminanceAt(through, 20, 48));
}

TEST_F(Render, SurfacesDoNotShadeThemselves) {
  // No acne: single sheets and the lit side of a convex body have no shadow at any sun angle.
  View view = quadView();
  view.terms.specular = false;
  view.shadow_map_size = 256;
  const Plant quad = whiteQuad();
  const Plant tube = standingTube(0.5f, -1.0f, 1.0f);
  for (const Plant* plant : {&quad, &tube}) {
    setItem(*plant, nullptr);
    for (const float azimuth : {-1.3f, -0.6f, 0.0f, 0.8f, 1.4f})
      for (const float elevation : {0.1f, 0.7f, 1.3f}) {
        turnSun(view, azimuth, elevation);
        view.terms.shadow = true;
        const HdrImage with = renderer().render(view).hdr;
        view.terms.shadow = false;
        EXPECT_EQ(countDifferent(with, renderer().render(view).hdr, 0.02f), 0)
            << "sun at " << azimuth << ", " << elevation;
      }
  }
}

TEST_F(Render, NoLightLeaksAtTheFootOfATrunk) {
  const Plant trunk = standingTube(0.2f, 0.0f, 3.0f);
  Scene scene = itemScene(trunk, nullptr);
  scene.ground = true;
  renderer().setScene(scene);
  View view = smallView(160, 120);
  view.terms.textures = false;
  view.shadow_map_size = 512;
  view.daylight = preethamDaylight(3.0f, directionOf(2.5f, 0.8f));
  view.camera = {{0.0f, 3.0f, 3.0f}, {0.0f, 0.3f, 0.0f}, 0.5f};
  const glm::vec3 away = -glm::normalize(directionOf(2.5f, 0.0f));
  const HdrImage with = renderer().render(view).hdr;
  view.terms.shadow = false;
  const HdrImage without = renderer().render(view).hdr;
  for (const float distance : {0.22f, 0.25f, 0.3f, 0.5f, 0.8f}) {
    const glm::ivec2 p = pixelOf(view, away * distance);
    EXPECT_LT(luminanceAt(with, p.x, p.y), 0.4f * luminanceAt(without, p.x, p.y)) << distance;
  }
}

TEST_F(Render, EdgesCastEvenHalfShadows) {
  // The shadow of a lone straight edge on the ground: from full light to none without a step back,
  // half at the edge itself.
  const Plant card = horizontalCard(1.0f, 4.0f);
  Scene scene = itemScene(card, nullptr);
  scene.ground = true;
  renderer().setScene(scene);
  View view = smallView(400, 100);
  view.terms = presetTerms("standard");
  view.terms.ambient = view.terms.textures = false;
  view.shadow_map_size = 128;
  setSun(view, {0, 1, 0}, glm::vec3(1.0f));
  view.daylight.sky = nullptr;
  // Straight down past the card at the edge x = 2, from below its height.
  view.camera = {{2.0f, 0.9f, 0.001f}, {2.0f, 0.0f, 0.0f}, 2.0f * std::atan(0.1f)};
  const HdrImage image = renderer().render(view).hdr;
  std::vector<double> profile(400, 0.0);  // mean along the edge
  for (int x = 0; x < 400; ++x)
    for (int y = 0; y < 100; ++y)
      profile[static_cast<std::size_t>(x)] += double{image.at(x, y).g} / 0.18 / 100.0;
  EXPECT_NEAR(profile.front(), 0.0, 1e-3);
  EXPECT_NEAR(profile.back(), 1.0, 2e-3);
  double lit = 0.0;
  for (std::size_t x = 1; x < 400; ++x) {
    EXPECT_GT(profile[x], profile[x - 1] - 0.02) << x;
    lit += profile[x];
  }
  // The edge lies in the middle; a texel of the map is 4.3 m / 128 = 0.033 m wide or 19 pixels.
  EXPECT_NEAR(lit / 400.0, 0.5, 0.02);
  double at_edge = 0.0;
  for (std::size_t x = 190; x < 210; ++x) at_edge += profile[x] / 20.0;
  EXPECT_NEAR(at_edge, 0.5, 0.06);
}

TEST_F(Render, AlphaCutCardsKeepTheirCoverageAtAnyDistance) {
  const Plant card = leafCard();
  const gpu::MipLevel top{128, 128, card.textures[0].image.rgba};
  const double truth = alphaCoverage(top, 0.5f, std::numeric_limits<float>::infinity());
  EXPECT_GT(truth, 0.3);
  EXPECT_LT(truth, 0.7);
  // A field of cards, so that many positions relative to the pixels are averaged.
  Scene scene = itemScene(card, nullptr);
  scene.items[0].world_from_plant.clear();
  for (int i = 0; i < 36; ++i)
    scene.items[0].world_from_plant.push_back(glm::translate(
        glm::mat4(1),
        {1.2f * (static_cast<float>(i % 6) - 2.5f), 1.2f * (static_cast<float>(i / 6) - 2.5f), 0}));
  renderer().setScene(scene);
  View view = smallView(240, 240);
  view.background = glm::vec3(0.0f);
  setFurnace(view, glm::vec3(1.0f));
  view.terms = {.diffuse = false, .specular = false, .shadow = false};
  for (const float card_pixels : {33.0f, 17.3f, 9.1f, 5.2f, 2.9f}) {
    const float distance = 20.0f;
    view.camera.eye = {0, 0, distance};
    view.camera.target = {0, 0, 0};
    view.camera.vertical_fov =
        2.0f * std::atan(0.5f * static_cast<float>(view.height) / card_pixels / distance);
    const HdrImage image = renderer().render(view).hdr;
    double covered = 0.0;
    for (const glm::vec3& pixel : image.rgb) covered += static_cast<double>(pixel.r);
    const double area = 36.0 * static_cast<double>(card_pixels) * static_cast<double>(card_pixels);
    EXPECT_NEAR(covered / area, truth, 0.1 * truth) << card_pixels << " pixels a card";
  }
}

TEST_F(Render, CutCardsBehindEachOtherCoverIndependently) {
  // A checkerboard far finer than a pixel lets half through; of four behind each other, one of 16.
  Plant card = leafCard();
  Image& image = card.textures[0].image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.at(x, y)[3] = static_cast<std::uint8_t>((x + y) % 2 * 255);
  Scene scene = itemScene(card, nullptr);
  scene.items[0].world_from_plant.clear();
  constexpr int kColumns = 16, kLayers = 4;
  for (int i = 0; i < kColumns * kColumns; ++i)
    for (int layer = 0; layer < kLayers; ++layer)
      scene.items[0].world_from_plant.push_back(glm::translate(
          glm::mat4(1),
          {static_cast<float>(i % kColumns) - 7.5f, static_cast<float>(i / kColumns) - 7.5f,
           0.001f * static_cast<float>(layer)}));
  renderer().setScene(scene);
  View view = smallView(128, 128);
  view.background = glm::vec3(0.0f);
  setFurnace(view, glm::vec3(1.0f));
  view.terms = {.diffuse = false, .specular = false, .shadow = false};
  view.camera.eye = {0, 0, 20};
  view.camera.target = {0, 0, 0};
  view.camera.vertical_fov = 2.0f * std::atan(0.5f * 15.0f / 20.0f);  // the cards fill the picture
  const HdrImage picture = renderer().render(view).hdr;
  double covered = 0.0;
  for (const glm::vec3& pixel : picture.rgb) covered += static_cast<double>(pixel.r);
  EXPECT_NEAR(covered / static_cast<double>(picture.rgb.size()), 15.0 / 16.0, 0.03);
}

TEST_F(Render, IsTheSameEachTimeAndFarFromTheOrigin) {
  Plant tree = ballTree(300, 0.4f);
  const CrownLight light = ballTreeLight(tree);
  Scene scene = itemScene(tree, &light);
  scene.ground = true;
  View view = smallView(160, 120);
  view.camera = automaticCamera(scene, 0.3f, 0.0f, 4.0f / 3.0f);
  renderer().setScene(scene);
  const Image first = renderer().render(view).image;
  EXPECT_EQ(renderer().render(view).image.rgba, first.rgba);
  EXPECT_EQ(Renderer().deviceName(), renderer().deviceName());

  tree.origin = {500e3, 12.0, -4.2e6};
  const Camera far_camera = automaticCamera(scene, 0.3f, 0.0f, 4.0f / 3.0f);
  EXPECT_EQ(far_camera.eye, view.camera.eye);
  renderer().setScene(scene);
  EXPECT_EQ(renderer().render(view).image.rgba, first.rgba);

  // A second plant stands relative to the first one's origin.
  Plant neighbour = ballTree(50, 0.4f);
  neighbour.origin = tree.origin + glm::dvec3(3.0, 0.0, 0.0);
  scene.items.push_back({&neighbour, nullptr});
  const PackedScene packed = packScene(scene);
  EXPECT_EQ(packed.instances[1].rows[0], glm::vec4(1, 0, 0, 3));
}

TEST_F(Render, MatchesTheReferencePictures) {
  const Plant tree = ballTree(1500, 0.25f, true);
  const CrownLight light = ballTreeLight(tree);
  Scene scene = itemScene(tree, &light);
  scene.ground = true;
  renderer().setScene(scene);
  View view = smallView(240, 180);
  view.camera = automaticCamera(scene, 0.2f, 0.0f, 4.0f / 3.0f);
  view.shadow_map_size = 1024;
  // Drivers round differently at edges; the references were drawn by lavapipe.
  const bool lavapipe = renderer().deviceName().find("llvmpipe") != std::string::npos;
  const double tolerance = lavapipe ? 0.005 : 0.05;
  for (const std::string& name : presetNames()) {
    view.terms = presetTerms(name);
    const Image image = renderer().render(view).image;
    const std::filesystem::path path =
        std::filesystem::path(VERDURE_TEST_DATA) / ("ball_tree_" + name + ".png");
    if (std::getenv("VERDURE_UPDATE_REFERENCES") != nullptr) writePng(image, path);
    EXPECT_LT(meanFlip(image, readImage(path)), tolerance) << name;
  }
}

TEST_F(Render, BadInputIsRefused) {
  const Plant quad = whiteQuad();
  setItem(quad, nullptr);
  View view = quadView();
  view.width = 0;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.height = 1 << 19;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.shadow_map_size = 0;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.sky_bands = 8;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.bloom = 1.5f;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.exposure.key = 0.0f;
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.exposure.white = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.daylight.sun.direction = {0, 2, 0};
  EXPECT_THROW(renderer().render(view), Error);
  view = quadView();
  view.camera.target = view.camera.eye;
  EXPECT_THROW(renderer().render(view), Error);

  Scene scene;
  scene.items.push_back({});
  EXPECT_THROW(renderer().setScene(scene), Error);
  Plant broken = whiteQuad();
  broken.meshes[0].indices[2] = 99;
  EXPECT_THROW(renderer().setScene(itemScene(broken, nullptr)), Error);
  const CrownLight other = ballTreeLight(ballTree(3));
  EXPECT_THROW(renderer().setScene(itemScene(quad, &other)), Error);
  renderer().render(quadView());  // still works
}

TEST(RenderDevice, MissingDriverSaysWhatToInstall) {
  const char* old = std::getenv("VK_ICD_FILENAMES");
  const std::string kept = old != nullptr ? old : "";
  setenv("VK_ICD_FILENAMES", "/nonexistent", 1);
  try {
    Renderer renderer;
    ADD_FAILURE() << renderer.deviceName();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("no Vulkan device"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("mesa-vulkan-drivers"), std::string::npos) << e.what();
  }
  if (old != nullptr)
    setenv("VK_ICD_FILENAMES", kept.c_str(), 1);
  else
    unsetenv("VK_ICD_FILENAMES");
}

}  // namespace
}  // namespace verdure
