// Light depth maps: Gumbau, Chover, Rebollo, Remolar 2008.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "render_fixture.h"
#include "shared/foliage_shadow.h"
#include "shared/leaf.h"

namespace verdure {
namespace {

using namespace test;

constexpr std::array kDepthSources{ShadowSource::kDepthPaper, ShadowSource::kDepthLayers,
                                   ShadowSource::kDepthOrdered};
const glm::vec3 kGreen(0.15f, 0.35f, 0.10f);

/// A filtered texel where `covered` of the filter sees leaves between two depths.
shared::LeafLayers layersOf(float near, float far, float depth, float covered = 1.0f) {
  return shared::leafLayers(glm::vec4(1.0f - near, far, 1.0f, depth) * covered);
}

TEST(FoliageShadow, ALeafAloneIsLit) {
  const shared::LeafLayers layers = layersOf(0.3f, 0.3f, 1.7f);
  EXPECT_FLOAT_EQ(shared::paperShadow(layers, 0.3f, 1.7f), 1.0f);
  EXPECT_FLOAT_EQ(shared::spreadDepth(layers, 0.3f), 0.0f);
  EXPECT_FLOAT_EQ(shared::orderedDepth(layers, 0.3f, 0.0f, 1.7f, true), 0.0f);
  // What lies behind it sees all of it.
  EXPECT_FLOAT_EQ(shared::spreadDepth(layers, 0.9f), 1.7f);
  EXPECT_FLOAT_EQ(shared::orderedDepth(layers, 0.9f, 1.0f, 1.7f, false), 1.7f);
}

TEST(FoliageShadow, FiltersByWhatIsCovered) {
  // Half covered: the same means over the covered half, whatever is added from empty texels.
  for (const float covered : {0.1f, 0.5f, 1.0f}) {
    const shared::LeafLayers layers = layersOf(0.2f, 0.8f, 3.0f, covered);
    EXPECT_NEAR(layers.near, 0.2f, 1e-6f);
    EXPECT_NEAR(layers.far, 0.8f, 1e-6f);
    EXPECT_NEAR(shared::spreadDepth(layers, 0.5f), 1.5f, 1e-5f);
    const glm::vec3 through = shared::throughLayers(layers, 1.5f, {1.0f, 0.5f, 2.0f}, 1.0f);
    EXPECT_NEAR(through.x, 1.0f - covered + covered * std::exp(-1.5f), 1e-6f);
    EXPECT_NEAR(through.y, 1.0f - covered + covered * std::exp(-0.75f), 1e-6f);
    EXPECT_NEAR(through.z, 1.0f - covered + covered * std::exp(-3.0f), 1e-6f);
  }
  const shared::LeafLayers empty = shared::leafLayers(glm::vec4(0.0f));
  EXPECT_EQ(shared::throughLayers(empty, shared::spreadDepth(empty, 0.5f), glm::vec3(1.0f), 1.0f),
            glm::vec3(1.0f));
  EXPECT_EQ(shared::paperShadow(empty, 0.5f, 2.0f), 1.0f);
}

TEST(FoliageShadow, OrderedLayersAreExactWhenEvenlySpaced) {
  // n leaves of depth 2 evenly spaced: the first sees 0, the last n - 1 of them.
  for (int n = 2; n < 9; ++n) {
    const shared::LeafLayers layers = layersOf(0.1f, 0.9f, 2.0f * static_cast<float>(n));
    EXPECT_FLOAT_EQ(shared::orderedDepth(layers, 0.1f, 0.0f, 2.0f, true), 0.0f);
    EXPECT_NEAR(shared::orderedDepth(layers, 0.9f, 1.0f, 2.0f, true),
                2.0f * static_cast<float>(n - 1), 1e-4f);
    EXPECT_NEAR(shared::orderedDepth(layers, 1.0f, 1.0f, 2.0f, false), 2.0f * static_cast<float>(n),
                1e-4f);
    float before = 0.0f;
    for (int i = 0; i <= 20; ++i) {  // never lighter further in
      const float now =
          shared::orderedDepth(layers, 0.1f + 0.04f * static_cast<float>(i), 1.0f, 2.0f, true);
      EXPECT_GE(now, before);
      before = now;
    }
  }
}

TEST(FoliageShadow, PaperDarkensInwardsAndWithTheNumberOfLayers) {
  float before = 2.0f;
  for (const float z : {0.1f, 0.3f, 0.6f, 0.9f}) {
    const float s = shared::paperShadow(layersOf(0.1f, 0.9f, 8.0f), z, 2.0f);
    EXPECT_LT(s, before);
    before = s;
  }
  EXPECT_FLOAT_EQ(before, 0.0f);
  before = 2.0f;
  for (const float count : {1.0f, 2.0f, 4.0f, 9.0f}) {
    const float s = shared::paperShadow(layersOf(0.1f, 0.9f, 2.0f * count), 0.3f, 2.0f);
    EXPECT_LT(s, before);
    before = s;
  }
}

TEST(FoliageShadow, TheTintIsThatOfTheLeaf) {
  const glm::vec3 tint = shared::leafTint(shared::leafTransmittance(kGreen)),
                  through = shared::leafTransmittance(kGreen);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(std::exp(-shared::leafOpticalDepth(shared::leafTransmittance(kGreen)) * tint[c]),
                through[c], 1e-5f);
  EXPECT_NEAR(std::exp(-shared::leafOpticalDepth(shared::leafTransmittance(kGreen))),
              shared::luminanceOf(through), 1e-6f);
  // Black lets nothing through and white cannot (it reflects all): finite all the same.
  for (const glm::vec3& color : {glm::vec3(0.0f), glm::vec3(1.0f)}) {
    EXPECT_NEAR(shared::leafOpticalDepth(shared::leafTransmittance(color)), 6.0f, 1e-4f);
    for (int c = 0; c < 3; ++c)
      EXPECT_TRUE(std::isfinite(shared::leafTint(shared::leafTransmittance(color))[c]));
  }
}

TEST(FoliageShadow, ScatteringFollowsTheThickness) {
  EXPECT_FLOAT_EQ(shared::scatteredLight(0.0f, 0.0f), 2.0f);
  EXPECT_NEAR(shared::scatteredLight(1.0f, 0.5f), 1.0f + std::exp(-1.5f), 1e-6f);
  for (const float s : {0.01f, 0.5f, 2.0f, 6.0f}) {
    double sum = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i)
      sum += shared::scatteredLight(s, s * (static_cast<float>(i) + 0.5f) / kSteps) / kSteps;
    EXPECT_NEAR(shared::meanScatteredLight(s), sum, 1e-4) << s;
  }
}

class LightDepth : public RenderTest {};

/// The sun at the zenith over stacks of cards, each 2 m wide, from the first height on; dark sky.
View zenithView(ShadowSource source) {
  View view = smallView(64, 48);
  view.terms = presetTerms("standard");
  view.terms.ambient = view.terms.textures = view.terms.specular = false;
  view.terms.shadow_source = source;
  view.daylight.sky = nullptr;
  setSun(view, {0, 1, 0}, {0.9f, 0.8f, 0.6f});
  view.background = glm::vec3(0.0f);
  return view;
}

Plant stackOfCards(const std::vector<float>& heights, const glm::vec3& color) {
  Plant plant = whiteQuad(glm::vec4(color, 1.0f));
  plant.meshes[0] = {};
  plant.meshes[0].kind = PartKind::kFoliage;
  for (const float height : heights)
    addQuad(plant.meshes[0], {0, height, 1.0f}, {2.0f, 0, 0}, {0, 0, -2.0f});
  return plant;
}

TEST_F(LightDepth, TheGroundSeesEveryLayer) {
  for (const ShadowSource source : kDepthSources)
    for (const int layers : {0, 1, 2, 3, 5}) {
      std::vector<float> heights;
      for (int i = 0; i < layers; ++i) heights.push_back(1.0f + 0.4f * static_cast<float>(i));
      const Plant stack = stackOfCards(heights, kGreen);
      Scene scene;
      scene.items = {{&stack, nullptr}};
      renderer().setScene(scene);
      View view = zenithView(source);
      view.camera = {{0, 0.9f, 0.001f}, {0, 0, 0}, 0.3f};  // below the lowest card
      glm::vec3 through(1.0f);
      for (int i = 0; i < layers; ++i) through *= shared::leafTransmittance(kGreen);
      if (source == ShadowSource::kDepthOrdered && layers > 0) through *= shared::shareBelowCrown();
      // Half floats: 11 bits of an optical depth of up to 10.
      expectPixel(renderer().render(view).hdr, 32, 24, 0.18f * sunLight(view) * through, 0.01f);
    }
}

TEST_F(LightDepth, LeavesSeeTheLayersInFront) {
  const glm::vec3 k_t = shared::leafTransmittance(kGreen);
  const float depth = shared::leafOpticalDepth(shared::leafTransmittance(kGreen));
  for (const ShadowSource source : kDepthSources)
    for (const int layers : {1, 2, 4}) {
      std::vector<float> heights;
      for (int i = 0; i < layers; ++i) heights.push_back(1.0f + 0.4f * static_cast<float>(i));
      const Plant stack = stackOfCards(heights, kGreen);
      setItem(stack, nullptr);
      View view = zenithView(source);
      view.terms.transmission = true;
      view.shadow_map_size = 1024;
      const auto power = [&k_t](int n) { return glm::pow(k_t, glm::vec3(static_cast<float>(n))); };
      // The first leaf, from above. By the paper the others take light from it.
      view.camera = {{0, 6.0f, 0.001f}, {0, 1, 0}, 0.1f};
      const float first =
          source == ShadowSource::kDepthPaper
              ? std::exp(-depth) + (1.0f - std::exp(-depth)) / static_cast<float>(layers)
              : 1.0f;
      expectPixel(renderer().render(view).hdr, 32, 24, sunLight(view) * kGreen * first, 0.01f);
      // The last one, from below, by the light that it lets through.
      view.camera = {{0, -4.0f, 0.001f}, {0, 1, 0}, 0.1f};
      glm::vec3 last(1.0f);
      if (layers > 1)
        last = source == ShadowSource::kDepthPaper    ? glm::vec3(0.0f)
               : source == ShadowSource::kDepthLayers ? power(layers)
                                                      : power(layers - 1);
      // The point is moved off its leaf by a texel or two: a hundredth of the way through.
      const HdrImage image = renderer().render(view).hdr;
      for (int c = 0; c < 3; ++c) {
        const float lit = sunLight(view)[c] * k_t[c];
        EXPECT_NEAR(image.at(32, 24)[c], lit * last[c], 0.02f * lit * (0.2f + last[c]))
            << static_cast<int>(source) << ", " << layers << " layers, channel " << c;
      }
    }
}

TEST_F(LightDepth, WoodInsideSeesTheLayersInFrontOfItAndHidesLeaves) {
  // Cards above and below a slab of wood.
  Plant plant = stackOfCards({3.0f, 2.8f, 1.0f}, kGreen);
  Mesh slab;
  slab.kind = PartKind::kWood;
  slab.material = 1;
  addQuad(slab, {0, 2.0f, 1.0f}, {2.0f, 0, 0}, {0, 0, -2.0f});
  plant.meshes.push_back(slab);
  plant.materials.push_back({});
  setItem(plant, nullptr);
  const glm::vec3 k_t = shared::leafTransmittance(kGreen);
  for (const ShadowSource source : kDepthSources) {
    View view = zenithView(source);
    // Between the upper cards and the slab; the leaf behind the slab does not count.
    view.camera = {{0, 2.7f, 0.001f}, {0, 2, 0}, 0.1f};
    const float share = source == ShadowSource::kDepthOrdered ? shared::shareBelowCrown() : 1.0f;
    expectPixel(renderer().render(view).hdr, 32, 24, sunLight(view) * k_t * k_t * share, 0.01f);
    // The leaf under the slab is in its shadow, seen from either side.
    view.terms.transmission = true;
    for (const float eye : {1.9f, -2.0f}) {
      view.camera = {{0, eye, 0.001f}, {0, 1, 0}, 0.1f};
      expectPixel(renderer().render(view).hdr, 32, 24, glm::vec3(0.0f));
    }
  }
}

TEST_F(LightDepth, HolesInLeavesLetAllLightThrough) {
  Plant card = leafCard();  // its tip is cut away, its middle is not
  Scene scene;
  scene.items = {
      {&card, nullptr, {glm::mat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 1, 0, 1})}}};
  renderer().setScene(scene);
  View view = zenithView(ShadowSource::kDepthLayers);
  view.shadow_map_size = 512;
  view.width = view.height = 64;
  view.camera = {{0, 0.9f, 0.001f}, {0, 0, 0}, 2.0f * std::atan(0.5f / 0.9f)};
  const HdrImage depth = renderer().render(view).hdr;
  view.terms.shadow_source = ShadowSource::kShadowMap;
  const HdrImage map = renderer().render(view).hdr;
  // White leaves let nothing through: both maps are lit and dark in the same places but for the
  // width of the half-shadow.
  int lit = 0, dark = 0, wrong = 0;
  for (int y = 4; y < 60; ++y)
    for (int x = 4; x < 60; ++x) {
      const float open = 0.18f * sunLight(view).g;
      if (map.at(x, y).g > 0.999f * open && depth.at(x, y).g > 0.8f * open) ++lit;
      if (map.at(x, y).g < 0.001f * open && depth.at(x, y).g < 0.2f * open) ++dark;
      wrong += std::abs(map.at(x, y).g - depth.at(x, y).g) > 0.5f * open ? 1 : 0;
    }
  EXPECT_GT(lit, 300);
  EXPECT_GT(dark, 300);
  EXPECT_LT(wrong, 10);
}

TEST_F(LightDepth, HalfShadowsAreAsWideAsTheSunsDiskMakesThem) {
  // The half-plane x < 0 at a height of 1 m and 2 m, of leaves or of wood: at x on the ground the
  // share of the disk, of radius r = height tan(radius) there, that is not behind it.
  for (const float height : {1.0f, 2.0f})
    for (const PartKind kind : {PartKind::kFoliage, PartKind::kWood}) {
      Plant card = whiteQuad(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
      card.meshes[0] = {};
      card.meshes[0].kind = kind;
      addQuad(card.meshes[0], {-1.0f, height, 1.0f}, {2.0f, 0, 0}, {0, 0, -2.0f});
      Scene scene;
      scene.items = {{&card, nullptr}};
      scene.items[0].seen = false;
      renderer().setScene(scene);
      View view = zenithView(ShadowSource::kDepthLayers);
      view.daylight.sun.angular_radius = 0.03f;
      setSun(view, {0, 1, 0}, glm::vec3(1.0f));
      view.shadow_map_size = 512;
      view.width = 200;
      view.height = 50;
      constexpr float kHalf = 0.16f;  // of the ground seen, m
      view.camera = {{0, 4.0f, 0.001f}, {0, 0, 0}, 2.0f * std::atan(kHalf / 4.0f / 4.0f)};
      const double r = height * std::tan(0.03);
      double off[2];  // by the plain map, by depth maps
      for (const int soft : {0, 1}) {
        view.terms.shadow_source =
            soft == 1 ? ShadowSource::kDepthLayers : ShadowSource::kShadowMap;
        const HdrImage image = renderer().render(view).hdr;
        double squares = 0.0;
        for (int x = 0; x < 200; ++x) {
          double mean = 0.0;
          for (int y = 0; y < 50; ++y) mean += double{image.at(x, y).g} / 0.18 / 50.0;
          const double u = std::clamp(kHalf * (x + 0.5 - 100.0) / 100.0 / r, -1.0, 1.0);
          const double open = 0.5 + (std::asin(u) + u * std::sqrt(1.0 - u * u)) / glm::pi<double>();
          squares += (mean - open) * (mean - open) / 200.0;
        }
        off[soft] = std::sqrt(squares);
      }
      EXPECT_LT(off[1], 0.5 * off[0]) << height << " m, wood " << (kind == PartKind::kWood);
    }
}

TEST_F(LightDepth, ScatteringIsTheSameForATexelWhereverItIsSeenFrom) {
  Plant quad = whiteQuad();
  quad.textures = {{"leaf", Image(16, 16), false, false}};
  std::fill(quad.textures[0].image.rgba.begin(), quad.textures[0].image.rgba.end(), 255);
  quad.materials[0].base_color = glm::vec4(kGreen, 1.0f);
  quad.materials[0].base_color_texture = 0;
  quad.materials[0].optical_thickness = 0.8f;
  setItem(quad, nullptr);
  View view = zenithView(ShadowSource::kDepthLayers);
  view.terms.textures = view.terms.scattering = true;
  view.terms.shadow = false;
  setSun(view, {0, 0, 1}, glm::vec3(1.0f));
  const float least = shared::scatteredLight(0.8f, 0.8f), most = shared::scatteredLight(0.8f, 0.0f);
  std::vector<float> seen[2];
  for (const int k : {0, 1}) {
    view.width = view.height = k == 0 ? 256 : 160;
    view.camera = {{k == 0 ? 0.0f : 0.4f, 0, k == 0 ? 5.0f : 7.0f}, {0, 0, 0}, 0.45f};
    const HdrImage image = renderer().render(view).hdr;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {  // the texels' middles
        const glm::ivec2 at = pixelOf(view, {-1.0f + (static_cast<float>(x) + 0.5f) / 8.0f,
                                             1.0f - (static_cast<float>(y) + 0.5f) / 8.0f, 0.0f});
        seen[k].push_back(image.at(at.x, at.y).g / kGreen.g);
        EXPECT_GT(seen[k].back(), least - 2e-3f);
        EXPECT_LT(seen[k].back(), most + 2e-3f);
      }
  }
  double mean = 0.0;
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(seen[0][i], seen[1][i], 2e-3f) << i;
    mean += seen[0][i] / 256.0;
  }
  EXPECT_NEAR(mean, shared::meanScatteredLight(0.8f), 0.02);
  EXPECT_GT(*std::max_element(seen[0].begin(), seen[0].end()), most - 0.03f);  // not all alike
  EXPECT_LT(*std::min_element(seen[0].begin(), seen[0].end()), least + 0.03f);
  // From afar, the mean.
  view.width = view.height = 64;
  view.camera = {{0, 0, 60.0f}, {0, 0, 0}, 0.2f};
  expectPixel(renderer().render(view).hdr, 32, 32, kGreen * shared::meanScatteredLight(0.8f),
              2e-3f);
}

TEST_F(LightDepth, ThicknessComesFromTheMap) {
  Plant quad = whiteQuad(glm::vec4(kGreen, 1.0f));
  Image map(4, 4);
  for (std::size_t i = 0; i < map.rgba.size(); ++i) map.rgba[i] = i % 4 == 1 ? 102 : 7;  // green
  quad.textures = {{"thickness", map, false, false}};
  quad.materials[0].optical_thickness = 2.0f;
  quad.materials[0].thickness_texture = 0;
  setItem(quad, nullptr);
  View view = zenithView(ShadowSource::kDepthLayers);
  view.terms.scattering = true;
  view.terms.shadow = false;
  setSun(view, {0, 0, 1}, glm::vec3(1.0f));
  view.camera = {{0, 0, 5.0f}, {0, 0, 0}, 0.3f};
  expectCenter(view, kGreen * shared::meanScatteredLight(2.0f * 102.0f / 255.0f));
  // Without a thickness, that of the colour.
  quad.materials[0].optical_thickness = 0.0f;
  setItem(quad, nullptr);
  expectCenter(view, kGreen * shared::meanScatteredLight(
                                  shared::leafOpticalDepth(shared::leafTransmittance(kGreen))));
}

}  // namespace
}  // namespace verdure
