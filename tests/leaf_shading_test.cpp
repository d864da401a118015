// Leaves lit by the maps of both their sides (Habel 2009, chapter 3): formulas against closed forms
// and quadrature, pictures against the formulas on the CPU.
#include <glm/gtc/matrix_transform.hpp>

#include "base/random.h"
#include "even_leaf.h"
#include "render_fixture.h"
#include "shared/cook_torrance.h"
#include "shared/leaf_basis.h"
#include "shared/normal_map.h"
#include "shared/sh.h"
#include "verdure/harmonics.h"
#include "verdure/leaf_grow.h"
#include "verdure/leaf_plant.h"

namespace verdure::test {
namespace {

glm::vec3 onSphere(float cosine, float azimuth) {
  const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

TEST(CookTorrance, FresnelHasItsClosedForms) {
  for (const float index : {1.2f, 1.45f, 1.7f}) {
    const float squarely = (index - 1.0f) / (index + 1.0f);
    EXPECT_NEAR(shared::fresnelReflected(index, 1.0f), squarely * squarely, 1e-6f);
    EXPECT_NEAR(shared::fresnelReflected(index, 0.0f), 1.0f, 1e-5f);
    // At Brewster's angle only light polarised across is reflected.
    const float refracted = 1.0f / std::sqrt(1.0f + index * index);  // cosine of the angle
    const float across = (1.0f - index * index) / (1.0f + index * index);
    EXPECT_NEAR(shared::fresnelReflected(index, refracted), 0.5f * across * across, 1e-5f);
  }
}

TEST(CookTorrance, FacetsAddUpToTheSurface) {
  for (const float roughness : {0.078f, 0.2f, 0.5f}) {
    double sum = 0.0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += double{shared::facetDensity(roughness, static_cast<float>(cosine))} * cosine * 2.0 *
             glm::pi<double>() / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 2e-3) << roughness;
  }
}

TEST(CookTorrance, LosesLightAndIsReciprocal) {
  const glm::vec3 n(0, 0, 1);
  for (const float roughness : {0.1f, 0.3f, 0.5f})
    for (const float out : {0.1f, 0.4f, 0.8f, 1.0f}) {
      const glm::vec3 v = onSphere(out, 0.3f);
      double sum = 0.0;
      constexpr int kSteps = 400;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const glm::vec3 l = onSphere((static_cast<float>(i) + 0.5f) / kSteps,
                                       6.2831853f * static_cast<float>(j) / kSteps);
          sum += double{shared::cookTorrance(n, l, v, roughness, 1.5f)} * 2.0 / kSteps / kSteps;
        }
      EXPECT_LT(sum, 1.0);
      // Smooth and looked at squarely it is the facets' own reflectance.
      if (out == 1.0f && roughness == 0.1f) {
        EXPECT_NEAR(sum, 0.04, 0.001);
      }
      const glm::vec3 l = onSphere(0.6f, 2.0f);
      EXPECT_NEAR(shared::cookTorrance(n, l, v, roughness, 1.4f) * v.z,
                  shared::cookTorrance(n, v, l, roughness, 1.4f) * l.z,
                  1e-4f * shared::cookTorrance(n, l, v, roughness, 1.4f) + 1e-7f);
    }
  EXPECT_EQ(shared::cookTorrance(n, {0, 0, -1}, n, 0.2f, 1.4f), 0.0f);
  EXPECT_EQ(shared::cookTorrance(n, {1, 0, 0}, {-1, 0, 0}, 0.2f, 1.4f), 0.0f);
}

TEST(LeafBumps, GetWhatTheirPlaneGets) {
  for (const float slope : {0.1f, 0.3f, 0.6f})
    for (const float elevation : {0.02f, 0.1f, 0.3f, 0.8f, 1.5f}) {
      const double up = std::sin(double{elevation}), along = std::cos(double{elevation});
      // Slopes along the light are normally distributed; a bump's surface is 1 / n.z of its
      // plane's.
      const double sigma = double{slope} / std::sqrt(2.0);
      double mean = 0.0;
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        const double x = -8.0 + 16.0 * (i + 0.5) / kSteps;
        mean += std::exp(-0.5 * x * x) * std::max(up - sigma * x * along, 0.0) * 16.0 / kSteps /
                std::sqrt(2.0 * M_PI);
      }
      const auto lit = double{shared::lightOnBumps(slope, static_cast<float>(up))};
      EXPECT_NEAR(lit * mean, up, 0.005 * up) << slope << " " << elevation;
    }
  EXPECT_EQ(shared::lightOnBumps(0.3f, -0.1f), 0.0f);
  EXPECT_EQ(shared::lightOnBumps(0.0f, 0.01f), 1.0f);
}

/// A sky of three bands, above 0 everywhere.
class SmoothSky final : public Sky {
 public:
  glm::vec3 luminance(const glm::vec3& d) const override {
    return glm::vec3(1.0f + 0.3f * d.x - 0.2f * d.z + 0.25f * d.y,
                     1.0f + 0.4f * d.x * d.y - 0.3f * d.y * d.z,
                     1.2f + 0.5f * (d.x * d.x - d.z * d.z));
  }
};

std::array<glm::vec4, 9> irradianceOf(const Sky& sky) {
  const Harmonics h = irradianceHarmonics(projectSky(sky, 3));
  std::array<glm::vec4, 9> weights;
  for (std::size_t i = 0; i < 9; ++i) weights[i] = glm::vec4(h.weights[i], 0.0f);
  return weights;
}

TEST(LeafSky, LightAlongAVectorIsItsIntegral) {
  const SmoothSky sky;
  auto weights = irradianceOf(sky);
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const glm::vec3 n = onSphere(random.vary(1.0f), random.vary(3.14f));
    // Not so far from the normal that the integral could be below 0.
    const glm::vec3 q = n + 0.5f * onSphere(random.vary(1.0f), random.vary(3.14f));
    glm::dvec3 sum(0.0);
    constexpr int kSteps = 300;
    for (int i = 0; i < 2 * kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const glm::vec3 w = onSphere(-1.0f + (static_cast<float>(i) + 0.5f) / kSteps,
                                     6.2831853f * static_cast<float>(j) / kSteps);
        if (glm::dot(w, n) > 0.0f)
          sum += glm::dvec3(sky.luminance(w)) * double{glm::dot(q, w)} * 2.0 * glm::pi<double>() /
                 double{kSteps} / double{kSteps};
      }
    const glm::vec3 found = shared::shIrradianceAlong(n, q, weights.data());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], sum[c], 0.01 * sum[c] + 0.01);
    const glm::vec3 along_n = shared::shIrradianceAlong(n, n, weights.data());
    const glm::vec3 irradiance = shared::shIrradiance(n, weights.data());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(along_n[c], irradiance[c], 1e-5f);
  }
}

/// Drivers decode bytes of sRGB to within 0.7 %.
constexpr float kOfBytes = 1e-2f;

View leafView(bool from_front) {
  View view = quadView();
  view.camera.eye = {0, 0, from_front ? 5.0f : -5.0f};
  view.terms = presetTerms("habel");
  view.terms.shadow = view.terms.ambient = false;
  return view;
}

class LeafShading : public RenderTest {};

TEST_F(LeafShading, BothSidesAreLitByTheirOwnMaps) {
  Random random(9);
  for (int trial = 0; trial < 6; ++trial) {
    const glm::vec3 front_h(random.uniform(-0.1f, 0.4f), random.uniform(0.0f, 0.4f), 0.25f);
    const glm::vec3 back_h(0.3f, random.uniform(0.0f, 0.3f), random.uniform(-0.1f, 0.5f));
    const Plant plant = evenLeaf(front_h, back_h);
    const LeafTextures& leaf = *plant.materials[0].leaf;
    const bool mirrored = trial % 3 == 2;
    Scene scene = itemScene(plant, nullptr);
    if (mirrored)
      scene.items[0].world_from_plant = {glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1))};
    renderer().setScene(scene);
    for (const bool from_front : {true, false})
      for (const LeafModel model : {LeafModel::kMaps, LeafModel::kDiffuse}) {
        View view = leafView(from_front);
        view.terms.leaf = model;
        const glm::vec3 l = onSphere(random.vary(1.0f), random.vary(3.14f));
        setSun(view, l, {0.9f, 0.8f, 0.6f});
        // In the frame of the seen side: the image's right and up, and out of it.
        const glm::vec3 seen(mirrored ? -l.x : l.x, l.y, from_front ? l.z : -l.z);
        const glm::vec3 h =
            held(plant, from_front ? leaf.front_light : leaf.back_light, false) - glm::vec3(0.2f);
        const glm::vec3 q =
            model == LeafModel::kMaps ? shared::leafDirection(h) : shared::leafEvenDirection(h);
        const glm::vec3 albedo =
            held(plant, from_front ? plant.materials[0].base_color_texture : leaf.back_color, true);
        const glm::vec3 k_t =
            held(plant, from_front ? leaf.front_translucency : leaf.back_translucency, true);
        const float through = std::max(glm::dot(q, glm::vec3(seen.x, seen.y, -seen.z)), 0.0f);
        const glm::vec3 expected =
            sunLight(view) * (albedo * std::max(seen.z, 0.0f) + k_t * through);
        SCOPED_TRACE(trial);
        expectPixel(renderer().render(view).hdr, 32, 24, expected, kOfBytes);
        if (model == LeafModel::kMaps && seen.z < 0.0f) {
          // (3.23) itself.
          const glm::vec3 printed = shared::leafTranslucence(sunLight(view), k_t, h, seen);
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(printed[c], expected[c], 1e-5f);
        }
      }
  }
}

TEST_F(LeafShading, TheSkyShinesThroughAlongTheSameVector) {
  const Plant plant = evenLeaf(glm::vec3(0.35f, 0.1f, 0.25f), glm::vec3(0.05f, 0.3f, 0.2f));
  const LeafTextures& leaf = *plant.materials[0].leaf;
  setItem(plant, nullptr);
  const auto sky = std::make_shared<SmoothSky>();
  auto weights = irradianceOf(*sky);
  for (const bool from_front : {true, false}) {
    View view = leafView(from_front);
    view.terms.ambient = true;
    view.terms.diffuse = view.terms.specular = false;
    view.terms.ambient_source = AmbientSource::kSky;
    view.daylight.sky = sky;
    const glm::vec3 h =
        held(plant, from_front ? leaf.front_light : leaf.back_light, false) - glm::vec3(0.2f);
    const glm::vec3 q = shared::leafDirection(h);
    const glm::vec3 n(0, 0, from_front ? 1 : -1);
    const glm::vec3 near = shared::shIrradiance(n, weights.data());
    const glm::vec3 along =
        shared::shIrradianceAlong(-n, glm::vec3(q.x, q.y, -n.z * q.z), weights.data());
    const glm::vec3 albedo =
        held(plant, from_front ? plant.materials[0].base_color_texture : leaf.back_color, true);
    const glm::vec3 k_t =
        held(plant, from_front ? leaf.front_translucency : leaf.back_translucency, true);
    expectPixel(renderer().render(view).hdr, 32, 24,
                (albedo * near + k_t * along) / glm::pi<float>(), kOfBytes);
  }
}

TEST_F(LeafShading, AFurnaceLosesWhatTheLeafTakes) {
  const glm::vec3 h(0.2f);
  const Plant plant = evenLeaf(h, h);
  const LeafTextures& leaf = *plant.materials[0].leaf;
  setItem(plant, nullptr);
  const glm::vec3 held_h = held(plant, leaf.front_light, false) - glm::vec3(0.2f);
  const float total = shared::leafEvenDirection(held_h).z;
  const glm::vec3 sky(0.5f, 0.25f, 0.125f);
  for (const AmbientSource source : {AmbientSource::kSky, AmbientSource::kConstant})
    for (const LeafModel model : {LeafModel::kMaps, LeafModel::kDiffuse}) {
      View view = leafView(true);
      view.terms.ambient = true;
      view.terms.diffuse = view.terms.specular = false;
      view.terms.ambient_source = source;
      view.terms.leaf = model;
      setFurnace(view, sky);
      const glm::vec3 share = held(plant, plant.materials[0].base_color_texture, true) +
                              held(plant, leaf.front_translucency, true) * total;
      expectPixel(renderer().render(view).hdr, 32, 24, sky * share, kOfBytes);
    }
}

TEST_F(LeafShading, GlossIsCookAndTorrances) {
  Plant plant = evenLeaf(glm::vec3(0.2f), glm::vec3(0.2f));
  plant.materials[0].leaf->front_roughness = 0.2f;
  setItem(plant, nullptr);
  const glm::vec3 albedo = held(plant, plant.materials[0].base_color_texture, true);
  for (const glm::vec2 at : {glm::vec2(0.95f, 0.4f), glm::vec2(0.6f, 2.0f)}) {
    View view = leafView(true);
    view.terms.transmission = false;
    setSun(view, onSphere(at.x, at.y), {0.9f, 0.8f, 0.6f});
    const glm::vec3 n(0, 0, 1), v = -pixelRay(view, 32, 24), l = view.daylight.sun.direction;
    const float gloss =
        shared::cookTorrance(n, l, v, 0.2f, plant.materials[0].leaf->refractive_index);
    expectPixel(renderer().render(view).hdr, 32, 24, sunLight(view) * (albedo * l.z + gloss),
                kOfBytes);
    // The back is diffuse.
    View back = leafView(false);
    back.terms.transmission = false;
    back.daylight.sun.direction = glm::vec3(l.x, l.y, -l.z);
    back.daylight.sun.luminance = view.daylight.sun.luminance;
    expectPixel(renderer().render(back).hdr, 32, 24,
                sunLight(back) * held(plant, plant.materials[0].leaf->back_color, true) * l.z,
                kOfBytes);
  }
}

TEST_F(LeafShading, MapsOfDifferentSizesAreRefused) {
  Plant plant = evenLeaf(glm::vec3(0.2f), glm::vec3(0.2f));
  plant.textures[static_cast<std::size_t>(plant.materials[0].leaf->back_normal)].image =
      Image(4, 4);
  try {
    setItem(plant, nullptr);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("different sizes"), std::string::npos) << error.what();
  }
}

TEST(LeafPlant, KeepsItsAreaHoweverItIsBent) {
  for (const glm::vec2& turns : {glm::vec2(0, 0), glm::vec2(35, 0), glm::vec2(0, 120)}) {
    LeafPlantOptions options;
    options.fold_deg = turns.x;
    options.bend_deg = turns.y;
    const Plant plant = leafPlant(evenSet(), evenLight(glm::vec3(0.2f), glm::vec3(0.2f)), options);
    ASSERT_EQ(plant.leaves.size(), 1u);
    EXPECT_NEAR(plant.leaves[0].area, 4.0f, 4e-3f);
    const Mesh& mesh = plant.meshes[0];
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = mesh.positions[mesh.indices[i]];
      const glm::vec3 face = glm::cross(mesh.positions[mesh.indices[i + 1]] - a,
                                        mesh.positions[mesh.indices[i + 2]] - a);
      EXPECT_GT(glm::dot(glm::normalize(face), mesh.normals[mesh.indices[i]]), 0.7f);
    }
  }
  LeafPlantOptions bad;
  bad.fold_deg = 95.0f;
  EXPECT_THROW(leafPlant(evenSet(), evenLight({}, {}), bad), Error);
  LeafTranslucency other = evenLight({}, {});
  other.front.pop_back();
  EXPECT_THROW(leafPlant(evenSet(), other), Error);
}

TEST(LeafAtlas, HoldsEachLeafInItsPlace) {
  std::vector<LeafSet> leaves(3, evenSet());
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < leaves[k].texelCount(); ++i) {
      leaves[k].front.albedo[i] = glm::vec3(0.1f * static_cast<float>(k + 1));
      leaves[k].back.relief_mm[i] = static_cast<float>(i);
    }
  const LeafSet atlas = tileLeaves(leaves, 2);
  checkLeafSet(atlas, "atlas");
  ASSERT_EQ(atlas.width, 16);
  ASSERT_EQ(atlas.height, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const auto i = static_cast<std::size_t>(16 * y + x);
      const int k = x / 8 + 2 * (y / 8);
      EXPECT_EQ(atlas.opacity[i], k < 3 ? 1.0f : 0.0f);
      if (k == 3) continue;
      EXPECT_EQ(atlas.front.albedo[i], glm::vec3(0.1f * static_cast<float>(k + 1)));
      EXPECT_EQ(atlas.back.relief_mm[i], static_cast<float>(8 * (y % 8) + x % 8));
    }
  leaves[1].mm_per_texel = 1.0f;
  EXPECT_THROW(tileLeaves(leaves, 2), Error);
  EXPECT_THROW(tileLeaves({}, 2), Error);
}

/// Four leaves of one size, each of its own seed and colours, with a margin around them.
std::vector<LeafSet> fourLeaves() {
  std::vector<LeafSet> leaves;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
    LeafGrowOptions options;
    options.size = 128;
    options.seed = seed;
    options.age = 0.2f * static_cast<float>(seed);
    leaves.push_back(growLeaf(options));
    leaves.back().mm_per_texel = leaves.front().mm_per_texel;
    leaves.back().optics = leaves.front().optics;
  }
  return leaves;
}

/// A sheet of a whole atlas, shrunk to the size of one tile, with that tile on it.
Plant tileOf(Plant plant, int column, int row, int columns) {
  const float size = 1.0f / static_cast<float>(columns);
  for (Mesh& mesh : plant.meshes)
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const glm::vec2 own = mesh.uvs[v];
      mesh.uvs[v] = (own + glm::vec2(static_cast<float>(column), static_cast<float>(row))) * size;
      mesh.positions[v] *= glm::vec3(size, size, 1.0f);
    }
  return plant;
}

TEST_F(LeafShading, AnAtlasShowsEachLeafAsItselfAlone) {
  const std::vector<LeafSet> leaves = fourLeaves();
  const LeafSet atlas = tileLeaves(leaves, 2);
  LeafPlantOptions flat;
  flat.segments = 2;
  const Plant together = leafPlant(atlas, bakeLeafTranslucency(atlas), flat);
  View view = smallView(128, 128);
  const float height = 1e-3f * leaves[0].mm_per_texel * 128.0f;
  view.camera = {{0, 0.5f * height, 0.3f}, {0, 0.5f * height, 0}, 2.0f * std::atan(height / 0.6f)};
  view.terms = presetTerms("habel");
  view.terms.shadow = false;
  view.background = glm::vec3(0.0f);
  std::vector<HdrImage> seen;
  for (const bool behind : {false, true}) {
    setSun(view, glm::normalize(glm::vec3(0.4f, 0.3f, behind ? -0.8f : 0.8f)), {0.9f, 0.8f, 0.6f});
    setFurnace(view, {0.1f, 0.2f, 0.3f});
    for (int k = 0; k < 4; ++k) {
      const Plant tile = tileOf(together, k % 2, k / 2, 2);
      setItem(tile, nullptr);
      const HdrImage in_atlas = renderer().render(view).hdr;
      const LeafSet& set = leaves[static_cast<std::size_t>(k)];
      const Plant alone = leafPlant(set, bakeLeafTranslucency(set), flat);
      setItem(alone, nullptr);
      const HdrImage single = renderer().render(view).hdr;
      // Pixels are texels; at the outline they are partly covered.
      int inside = 0, different = 0;
      for (int y = 1; y < 127; ++y)
        for (int x = 1; x < 127; ++x) {
          bool leaf = true;
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              leaf = leaf && set.opacity[static_cast<std::size_t>(128 * (y + dy) + x + dx)] > 0.99f;
          if (!leaf) continue;
          ++inside;
          const float a = luminanceAt(in_atlas, x, y), b = luminanceAt(single, x, y);
          different += std::abs(a - b) > 0.04f * b ? 1 : 0;
        }
      SCOPED_TRACE(k);
      EXPECT_GT(inside, 3000);
      // The coefficients' bytes have another range in the atlas.
      EXPECT_LT(different, inside / 100) << (behind ? "behind" : "in front");
      if (behind) seen.push_back(single);
    }
  }
  // No two of them look alike.
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT(countDifferent(seen[a], seen[b], 0.04f), 2000);
}

TEST_F(LeafShading, ACurvedLeafIsLitAsAFlatOneWhereTheyFaceTheSameWay) {
  LeafGrowOptions grow;
  grow.size = 128;
  const LeafSet set = growLeaf(grow);
  const LeafTranslucency light = bakeLeafTranslucency(set);
  const float height = 1e-3f * set.mm_per_texel * 128.0f;
  View view = smallView(96, 96);
  view.terms = presetTerms("habel");
  view.terms.shadow = false;
  view.background = glm::vec3(0.0f);
  // A strip across the leaf's middle, two texels high.
  view.height = 2;
  view.camera = {
      {0, 0.5f * height, 0.3f}, {0, 0.5f * height, 0}, 2.0f * std::atan(height / 128.0f / 0.3f)};
  LeafPlantOptions curved;
  curved.segments = 64;
  curved.bend_deg = 80.0f;
  Plant bent = leafPlant(set, light, curved);
  // The middle of its rib in the middle of the flat one's, and upright there.
  const float angle = 0.5f * glm::radians(curved.bend_deg);
  const glm::vec3 middle =
      glm::vec3(0.0f, std::sin(angle), std::cos(angle) - 1.0f) * (0.5f * height / angle);
  const glm::mat4 upright = glm::translate(glm::mat4(1.0f), glm::vec3(0, 0.5f * height, 0)) *
                            glm::rotate(glm::mat4(1.0f), angle, glm::vec3(1, 0, 0)) *
                            glm::translate(glm::mat4(1.0f), -middle);
  LeafPlantOptions plain;
  plain.segments = 2;
  const Plant flat = leafPlant(set, light, plain);
  for (const float z : {0.8f, -0.8f, 0.15f, -0.15f}) {
    setSun(view, glm::normalize(glm::vec3(0.4f, 0.3f, z)), {0.9f, 0.8f, 0.6f});
    setFurnace(view, {0.1f, 0.2f, 0.3f});
    setItem(flat, nullptr);
    const HdrImage card = renderer().render(view).hdr;
    Scene scene = itemScene(bent, nullptr);
    scene.items[0].world_from_plant = {upright};
    renderer().setScene(scene);
    const HdrImage curve = renderer().render(view).hdr;
    double sum = 0.0, error = 0.0;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 96; ++x) {
        sum += static_cast<double>(luminanceAt(card, x, y));
        error += static_cast<double>(std::abs(luminanceAt(card, x, y) - luminanceAt(curve, x, y)));
      }
    EXPECT_GT(sum, 0.1);
    EXPECT_LT(error / sum, 0.03) << z;
  }
}

}  // namespace
}  // namespace verdure::test
