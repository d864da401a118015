// Light through leaves whose files state it, by core glTF or by maps of both sides: in pictures, in
// light depth maps, in rays and in what they bake.
#include "even_leaf.h"
#include "render_fixture.h"
#include "scene/leaf_surface.h"
#include "shared/foliage_shadow.h"
#include "shared/leaf.h"
#include "shared/leaf_basis.h"
#include "verdure/occlusion.h"
#include "verdure/reference.h"

namespace verdure::test {
namespace {

/// Drivers decode bytes of sRGB to within 0.7 %.
constexpr float kOfBytes = 1e-2f;

const glm::vec3 kColor(0.5f, 0.4f, 0.2f);

/// The quad with a factor of 0.75 times 0.502 and a colour of (0.9, 1, 0.5) times that of a
/// texture.
Plant statedQuad(bool textured) {
  Plant plant = whiteQuad(glm::vec4(kColor, 1.0f));
  DiffuseTransmission& stated = plant.materials[0].transmission.emplace();
  stated.factor = 0.75f;
  stated.color = {0.9f, 1.0f, 0.5f};
  if (!textured) return plant;
  Image share(4, 2), tint(1, 1);
  for (std::size_t i = 0; i < share.rgba.size(); i += 4) share.rgba[i + 3] = 128;
  const std::uint8_t texel[] = {230, 188, 137, 255};
  std::copy_n(texel, 4, tint.rgba.begin());
  plant.textures = {{"share", share}, {"tint", tint}};
  stated.factor_texture = 0;
  stated.color_texture = 1;
  return plant;
}

/// What it should do with light, from the definition of KHR_materials_diffuse_transmission.
LeafDiffuse statedLight(bool textured) {
  const float factor = textured ? 0.75f * 128.0f / 255.0f : 0.75f;
  glm::vec3 color(0.9f, 1.0f, 0.5f);
  if (textured)
    color *=
        glm::vec3(shared::linearFromSrgb(230.0f / 255.0f), shared::linearFromSrgb(188.0f / 255.0f),
                  shared::linearFromSrgb(137.0f / 255.0f));
  return {kColor * (1.0f - factor), color * factor};
}

View quadFrom(bool front) {
  View view = quadView();
  view.camera.eye = {0, 0, front ? 5.0f : -5.0f};
  view.terms = presetTerms("habel");
  view.terms.shadow = view.terms.ambient = view.terms.specular = false;
  return view;
}

class LeafThrough : public RenderTest {};

TEST_F(LeafThrough, TheSunBehindShinesWithTheStatedShareAndColour) {
  const glm::vec3 l = glm::normalize(glm::vec3(0.3f, 0.2f, 0.9f));
  for (const bool textured : {false, true}) {
    const Plant plant = statedQuad(textured);
    const LeafDiffuse light = statedLight(textured);
    setItem(plant, nullptr);
    for (const bool from_front : {true, false}) {
      View view = quadFrom(from_front);
      setSun(view, l, {0.9f, 0.8f, 0.6f});
      const glm::vec3 expected =
          sunLight(view) * l.z * (from_front ? light.reflectance : light.transmittance);
      expectPixel(renderer().render(view).hdr, 32, 24, expected, kOfBytes);
      // The path tracer.
      ReferenceOptions options;
      options.width = options.height = 8;
      options.samples = 16;
      options.camera = view.camera;
      options.gloss = false;
      Daylight sun = view.daylight;
      sun.sky = nullptr;
      const Scene scene = itemScene(plant, nullptr);
      expectPixel(renderReference(scene, sun, options).image, 4, 4, expected, 0.01f);
    }
  }
}

TEST_F(LeafThrough, TheSkyBehindShinesWithTheStatedShareAndColour) {
  const glm::vec3 sky(0.5f, 0.25f, 0.125f);
  for (const bool textured : {false, true}) {
    const Plant plant = statedQuad(textured);
    const LeafDiffuse light = statedLight(textured);
    setItem(plant, nullptr);
    for (const AmbientSource source : {AmbientSource::kConstant, AmbientSource::kSky}) {
      View view = quadFrom(true);
      view.terms.ambient = true;
      view.terms.diffuse = false;
      view.terms.ambient_source = source;
      setFurnace(view, sky);
      expectPixel(renderer().render(view).hdr, 32, 24,
                  sky * (light.reflectance + light.transmittance), kOfBytes);
    }
  }
}

TEST_F(LeafThrough, GlossIsAsStrongAsStated) {
  const glm::vec3 color(0.2f, 0.3f, 0.1f), sky(0.5f, 0.25f, 0.125f);
  for (const ClearSurface& surface :
       {ClearSurface{}, ClearSurface{1.33f, 1.0f, glm::vec3(1.0f)},
        ClearSurface{1.5f, 0.5f, glm::vec3(1.0f)}, ClearSurface{1.5f, 0.0f, glm::vec3(1.0f)},
        ClearSurface{1.6f, 0.8f, glm::vec3(0.7f)}}) {
    Plant plant = whiteQuad(glm::vec4(color, 1.0f));
    plant.materials[0].surface = surface;
    setItem(plant, nullptr);
    const float ior = surface.refractive_index;
    const float facing =
        (ior - 1.0f) * (ior - 1.0f) / ((ior + 1.0f) * (ior + 1.0f)) * surface.color.x;
    View view = quadView();
    view.terms = presetTerms("transfer");
    view.terms.shadow = view.terms.transmission = false;
    const glm::vec3 l = glm::normalize(glm::vec3(0.3f, 0.2f, 0.9f));
    setSun(view, l, {0.9f, 0.8f, 0.6f});
    setFurnace(view, sky);
    const glm::vec3 n(0, 0, 1), v = -pixelRay(view, 32, 24);
    const float mirrored =
        surface.strength * shared::glossReflected(shared::glossWidth(true), facing, v.z);
    const float highlight = surface.strength * facing / (4.0f * 0.41f * 0.41f) *
                            shared::specularFactor(n, l, v, shared::highlightExponent(true));
    const glm::vec3 expected = (1.0f - mirrored) * color * (sky + sunLight(view) * l.z) +
                               mirrored * sky + sunLight(view) * highlight;
    expectPixel(renderer().render(view).hdr, 32, 24, expected, 2e-3f);
    // In an even world gloss alone loses nothing that the path tracer keeps.
    ReferenceOptions options;
    options.width = options.height = 8;
    options.samples = 256;
    options.camera = view.camera;
    Daylight even = view.daylight;
    even.sun.luminance = glm::vec3(0.0f);
    plant.meshes[0].kind = PartKind::kWood;
    const Scene scene = itemScene(plant, nullptr);
    const HdrImage traced = renderReference(scene, even, options).image;
    glm::vec3 mean(0.0f);
    for (const glm::vec3& texel : traced.rgb) mean += texel / 64.0f;
    const float dull =
        surface.strength * shared::glossReflected(shared::glossWidth(false), facing, v.z);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean[c], sky[c] * (dull + (1.0f - dull) * color[c]), 0.02f * sky[c]);
  }
}

/// The mean of what arrives on the ground below a leaf under the sun at the zenith, over what does
/// without it.
glm::vec3 arrivingBelow(Renderer& renderer, const Plant& leaf, bool turned, bool mirrored = false) {
  Scene scene;
  // The leaf lies 1 m above the ground, its front up or, turned, down.
  const float up = turned ? -1.0f : 1.0f, side = mirrored ? -1.0f : 1.0f;
  scene.items = {
      {&leaf, nullptr, {glm::mat4({side, 0, 0, 0}, {0, 0, -up, 0}, {0, up, 0, 0}, {0, 1, 0, 1})}}};
  renderer.setScene(scene);
  View view = smallView(32, 32);
  view.terms = presetTerms("standard");
  view.terms.ambient = view.terms.specular = false;
  view.terms.shadow_source = ShadowSource::kDepthLayers;
  view.daylight.sky = nullptr;
  view.background = glm::vec3(0.0f);
  setSun(view, {0, 1, 0}, {0.9f, 0.8f, 0.6f});
  view.camera = {{0, 0.9f, 0.001f}, {0, 0, 0}, 0.3f};
  const HdrImage below = renderer.render(view).hdr;
  view.terms.shadow = false;
  const HdrImage open = renderer.render(view).hdr;
  glm::dvec3 sum(0.0), all(0.0);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      sum += glm::dvec3(below.at(x, y));
      all += glm::dvec3(open.at(x, y));
    }
  return glm::vec3(sum / all);
}

TEST_F(LeafThrough, LightDepthMapsHoldTheStatedShare) {
  for (const bool textured : {false, true}) {
    const glm::vec3 expected = statedLight(textured).transmittance;
    const glm::vec3 found = arrivingBelow(renderer(), statedQuad(textured), false);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.015f * expected[c]);
  }
}

TEST_F(LeafThrough, LightDepthMapsHoldWhatTheMapsLetThrough) {
  // The two sides let different light through, in different colours.
  const glm::vec3 front_h(0.35f, 0.1f, 0.25f), back_h(0.05f, 0.3f, 0.1f);
  const Plant plant = evenLeaf(front_h, back_h);
  const LeafTextures& leaf = *plant.materials[0].leaf;
  const LeafSurface surface(plant, plant.materials[0], true);
  for (const bool turned : {false, true})
    for (const bool mirrored : {false, true}) {
      // The light of the zenith leaves the lower side.
      const glm::vec3 h =
          held(plant, turned ? leaf.front_light : leaf.back_light, false) - glm::vec3(0.2f);
      const glm::vec3 k_t =
          held(plant, turned ? leaf.front_translucency : leaf.back_translucency, true);
      const glm::vec3 through = k_t * shared::leafEvenDirection(h).z;
      const LeafDiffuse traced = surface.at({0.4f, 0.6f}, kColor, turned);
      const glm::vec3 found = arrivingBelow(renderer(), plant, turned, mirrored);
      SCOPED_TRACE(turned);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(traced.transmittance[c], through[c], 1e-5f);
      // In the luminance it is exact but for halves; the tint is the mean of both sides.
      const float all = shared::luminanceOf(through);
      EXPECT_NEAR(shared::luminanceOf(found), all, 0.06f * all);
    }
}

TEST(LeafThroughRays, LightBelowASheetIsWhatItStates) {
  // A sheet in an even world of light: what it reflects and lets through.
  Plant plant = statedQuad(true);
  Mesh probe = plant.meshes[0];
  for (glm::vec3& p : probe.positions) p = p * 1e-4f + glm::vec3(0, 0, 0.001f);
  for (glm::vec3& p : plant.meshes[0].positions) p *= 1000.0f;
  for (glm::vec3& n : probe.normals) n = {0, 0, -1};
  probe.material = 1;
  plant.materials.emplace_back();
  plant.meshes.push_back(probe);
  RayOptions options;
  options.rays = 1024;
  options.bounces = 1;
  const VertexId vertex{1, 0};
  const glm::vec3 lit = traceAmbient(plant, std::span(&vertex, 1), options)[0];
  const LeafDiffuse light = statedLight(true);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(lit[c], light.reflectance[c] + light.transmittance[c], 0.01f);
}

/// A black floor with hardly an end just below y = -1: one half of all that a leaf sees is free.
void addBlackFloor(Plant& plant) {
  Mesh floor;
  floor.kind = PartKind::kWood;
  floor.material = static_cast<std::uint32_t>(plant.materials.size());
  addQuad(floor, {0, -1.02f, 200.0f}, {400.0f, 0, 0}, {0, 0, -400.0f});
  plant.meshes.push_back(floor);
  plant.materials.emplace_back().base_color = {0, 0, 0, 1};
}

TEST_F(LeafThrough, TheSkyThroughALeafIsTimesItsOpenness) {
  Plant plant = evenLeaf(glm::vec3(0.35f, 0.1f, 0.25f), glm::vec3(0.05f, 0.3f, 0.2f));
  addBlackFloor(plant);
  RayOptions options;
  options.rays = 4096;
  const CrownLight traced = bakeAmbient(plant, options);
  for (const float k : traced.meshes[0].ambient) ASSERT_NEAR(k, 0.5f, 0.01f);
  const LeafTextures& leaf = *plant.materials[0].leaf;
  const glm::vec3 sky(0.5f, 0.25f, 0.125f);
  for (const CrownLight* light : {static_cast<const CrownLight*>(nullptr), &traced}) {
    setItem(plant, light);
    for (const bool from_front : {true, false}) {
      View view = quadFrom(from_front);
      view.terms.ambient = true;
      view.terms.diffuse = false;
      setFurnace(view, sky);
      const glm::vec3 albedo =
          held(plant, from_front ? plant.materials[0].base_color_texture : leaf.back_color, true);
      const glm::vec3 k_t =
          held(plant, from_front ? leaf.front_translucency : leaf.back_translucency, true);
      const glm::vec3 h =
          held(plant, from_front ? leaf.front_light : leaf.back_light, false) - glm::vec3(0.2f);
      const float open = light != nullptr ? 0.5f : 1.0f;
      expectPixel(renderer().render(view).hdr, 32, 24,
                  sky * open * (albedo + k_t * shared::leafEvenDirection(h).z), 0.02f);
    }
  }
}

TEST(LeafThroughRays, BetweenTwoLeavesItIsNotDark) {
  // A probe between two leaves without end, which turn either side to it: light comes through
  // either and is thrown to and fro between them.
  const glm::vec3 front_h(0.35f, 0.1f, 0.25f), back_h(0.05f, 0.3f, 0.1f);
  const Plant leaf = evenLeaf(front_h, back_h);
  for (const bool fronts_in : {true, false}) {
    Plant plant = leaf;
    const Mesh sheet = plant.meshes[0];
    plant.meshes.clear();
    for (const float z : {-0.5f, 0.5f}) {
      Mesh& out = plant.meshes.emplace_back(sheet);
      const float turn = (z < 0.0f) == fronts_in ? 1.0f : -1.0f;  // about the vertical
      for (glm::vec3& p : out.positions) p = glm::vec3(2000.0f * turn * p.x, 2000.0f * p.y, z);
      for (glm::vec3& n : out.normals) n = {0, 0, turn};
    }
    Mesh probe;
    probe.kind = PartKind::kFoliage;
    addQuad(probe, {0, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0});
    plant.meshes.push_back(probe);
    plant.leaves.clear();
    const LeafSurface surface(plant, plant.materials[0], true);
    const glm::vec3 base = held(plant, plant.materials[0].base_color_texture, true);
    const LeafDiffuse inner = surface.at({0.5f, 0.5f}, base, fronts_in);
    const LeafTextures& maps = *plant.materials[0].leaf;
    const glm::vec3 albedo =
        held(plant, fronts_in ? plant.materials[0].base_color_texture : maps.back_color, true);
    const glm::vec3 h =
        held(plant, fronts_in ? maps.front_light : maps.back_light, false) - glm::vec3(0.2f);
    const glm::vec3 through =
        held(plant, fronts_in ? maps.front_translucency : maps.back_translucency, true) *
        shared::leafEvenDirection(h).z;
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(inner.reflectance[c], albedo[c], 1e-5f);
      EXPECT_NEAR(inner.transmittance[c], through[c], 1e-5f);
    }
    for (const int bounces : {0, 1, 4}) {
      RayOptions options;
      options.rays = 1024;
      options.bounces = bounces;
      const VertexId vertex{2, 0};
      const glm::vec3 lit = traceAmbient(plant, std::span(&vertex, 1), options)[0];
      glm::vec3 expected(0.0f), passed = through;
      for (int i = 0; i < bounces; ++i, passed *= albedo) expected += passed;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(lit[c], expected[c], 0.02f * expected[c] + 1e-4f);
    }
  }
}

TEST(LeafSurfaces, MeansAreOverWhatTheCutLeaves) {
  Plant plant = statedQuad(true);
  plant.materials[0].base_color_texture = 2;
  plant.materials[0].alpha_mode = AlphaMode::kMask;
  Image base(4, 2);
  for (std::size_t i = 0; i < base.rgba.size(); ++i) base.rgba[i] = i % 16 < 8 ? 255 : 0;
  // Only the left half is there; the right half lets all through.
  Image& share = plant.textures[0].image;
  for (std::size_t i = 0; i < share.rgba.size(); i += 4) share.rgba[i + 3] = i % 16 < 8 ? 51 : 255;
  for (Texture& texture : plant.textures) texture.clamp_u = texture.clamp_v = true;
  plant.textures.push_back({"base", base, true, true});
  const glm::vec3 tint = statedLight(true).transmittance / (0.75f * 128.0f / 255.0f);
  const glm::vec3 mean =
      LeafSurface(plant, plant.materials[0], true).meanTransmittance(glm::vec3(0.5f));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 0.15f * tint[c], 1e-5f);
}

}  // namespace
}  // namespace verdure::test
