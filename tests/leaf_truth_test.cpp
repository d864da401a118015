// The reference's leaves with maps: closed forms, furnaces, and the renderer's pictures.
#include <glm/gtc/matrix_transform.hpp>

#include "base/random.h"
#include "even_leaf.h"
#include "leaf/leaf_transport.h"
#include "leaf_sets.h"
#include "reference/surface_model.h"
#include "render_fixture.h"
#include "shared/leaf.h"
#include "shared/leaf_basis.h"
#include "verdure/leaf_grow.h"
#include "verdure/leaf_reference.h"
#include "verdure/reference.h"

namespace verdure::test {
namespace {

constexpr float kPi = glm::pi<float>();

glm::vec3 onSphere(int i, int count) {  // a Fibonacci lattice
  const double y = 1.0 - (2.0 * i + 1.0) / count, turn = 2.0 * M_PI * 0.6180339887498949 * i;
  const double ring = std::sqrt(1.0 - y * y);
  return {static_cast<float>(ring * std::cos(turn)), static_cast<float>(y),
          static_cast<float>(ring * std::sin(turn))};
}

glm::vec3 randomUnit(Random& random) {
  return glm::normalize(glm::vec3(random.vary(1), random.vary(1), random.vary(1)));
}

glm::dvec3 meanOf(const HdrImage& image) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& c : image.rgb) sum += glm::dvec3(c);
  return sum / static_cast<double>(image.rgb.size());
}

double errorOfMean(const ReferencePicture& picture) {
  double sum = 0.0;
  for (const float e : picture.standard_error) sum += double{e} * double{e};
  return std::sqrt(sum) / static_cast<double>(picture.standard_error.size());
}

double luminance(const glm::dvec3& c) {
  return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

TEST(CookTorranceGloss, ReflectsWhatItsTableSays) {
  const glm::vec3 n(0, 1, 0);
  Random random(5);
  for (const float roughness : {0.078f, 0.15f, 0.3f, 0.5f})
    for (const float cosine : {0.1f, 0.35f, 0.8f, 1.0f}) {
      const Gloss gloss = Gloss::cookTorrance(roughness, 1.5f);
      const glm::vec3 out(std::sqrt(1.0f - cosine * cosine), cosine, 0.0f);
      constexpr int kPoints = 1000000;
      double sum = 0.0, density = 0.0;
      for (int i = 0; i < kPoints; ++i) {
        const glm::vec3 in = onSphere(i, kPoints);
        sum += double{gloss.value(n, out, in)} * 4.0 * M_PI / kPoints;
        density += double{gloss.density(n, out, in)} * 4.0 * M_PI / kPoints;
      }
      EXPECT_NEAR(double{gloss.reflected(cosine)}, sum, 0.02 * sum + 5e-4)
          << roughness << " " << cosine;
      EXPECT_LT(density, 1.005);
      // The mean weight of samples is the same.
      double mean = 0.0;
      constexpr int kSamples = 50000;
      for (int i = 0; i < kSamples; ++i) {
        const glm::vec3 in = gloss.sample(n, out, random);
        const float chance = gloss.density(n, out, in);
        if (chance > 0.0f) mean += double{gloss.value(n, out, in) / chance} / kSamples;
      }
      EXPECT_NEAR(mean, sum, 0.03 * sum) << roughness << " " << cosine;
    }
}

TEST(LeafScatterer, SamplesWhatItSays) {
  Random random(8);
  const Gloss near = Gloss::cookTorrance(0.3f, 1.45f), far = Gloss::cookTorrance(0.5f, 1.3f);
  for (int trial = 0; trial < 12; ++trial) {
    Scatterer s;
    s.side = randomUnit(random);
    s.normal = glm::normalize(s.side + 0.5f * randomUnit(random));
    s.out = randomUnit(random);
    if (glm::dot(s.out, s.side) < 0.0f) s.out = -s.out;
    s.reflectance = glm::vec3(0.3f, 0.2f, 0.05f);
    s.transmittance = glm::vec3(1.0f, 0.8f, 0.2f);
    s.through = {0.5f * glm::normalize(0.6f * randomUnit(random) - s.side),
                 trial % 3 == 1 ? &far : nullptr};
    s.gloss = trial % 3 == 2 ? &near : nullptr;
    constexpr int kPoints = 400000;
    glm::dvec3 all(0.0), beyond(0.0);
    double density = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const glm::vec3 d = onSphere(i, kPoints);
      const glm::dvec3 value = glm::dvec3(s.value(d)) * (4.0 * M_PI / kPoints);
      all += value;
      density += double{s.density(d)} * (4.0 * M_PI / kPoints);
      if (glm::dot(d, s.side) > 0.0f) continue;
      beyond += value;
      if (trial % 3 == 0) {
        // (3.23), per unit of irradiance on a plane that faces the light.
        const glm::vec3 expected =
            s.transmittance * std::max(glm::dot(s.through->vector, d), 0.0f) / kPi;
        EXPECT_NEAR(glm::length(s.value(d) - expected), 0.0f, 1e-6f);
      }
    }
    if (s.gloss == nullptr) {
      EXPECT_NEAR(density, 1.0, 1e-3);
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(beyond[c], 0.0);
      // The half space beyond holds a share (1 + cosine) / 2 of a cosine's lobe.
      const double tilt = double{-glm::dot(glm::normalize(s.through->vector), s.side)};
      EXPECT_LE(beyond[c], 0.5 * double{s.transmittance[c]} * 0.5 * (1.0 + tilt) + 1e-3);
      if (trial % 3 == 0) {
        EXPECT_NEAR(beyond[c], 0.5 * double{s.transmittance[c]} * 0.5 * (1.0 + tilt), 1e-3);
      }
      EXPECT_LE(all[c], 1.0);
    }
    constexpr int kSamples = 100000;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kSamples; ++i)
      if (const auto sample = s.sample(random)) {
        sum += glm::dvec3(sample->weight);
        ASSERT_NEAR(glm::length(sample->direction), 1.0f, 1e-5f);
      }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kSamples, all[c], 0.012) << trial;
  }
}

ReferenceOptions directOptions(const View& view, int samples) {
  ReferenceOptions options;
  options.width = view.width;
  options.height = view.height;
  options.camera = view.camera;
  options.samples = samples;
  options.bounces = 1;
  return options;
}

/// Of an even leaf: exactly these coefficients, whatever the texture.
void setLight(Plant& plant, float front, float back) {
  LeafTextures& leaf = *plant.materials[0].leaf;
  leaf.front_scale = leaf.back_scale = 0.0f;
  leaf.front_offset = front;
  leaf.back_offset = back;
}

void fill(Plant& plant, int texture, const glm::ivec3& bytes) {
  Image& image = plant.textures[static_cast<std::size_t>(texture)].image;
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    if (i % 4 != 3) image.rgba[i] = static_cast<std::uint8_t>(bytes[static_cast<int>(i % 4)]);
}

/// A crowd of copies of a leaf.
Scene crowdOf(const Plant& leaf) {
  Scene scene = itemScene(leaf, nullptr);
  scene.items[0].world_from_plant.clear();
  Random random(4);
  for (int i = 0; i < 24; ++i) {
    glm::mat4 place = glm::translate(glm::mat4(1.0f), 1.2f * randomUnit(random));
    place = glm::rotate(place, random.vary(kPi), randomUnit(random));
    scene.items[0].world_from_plant.push_back(
        glm::scale(place, glm::vec3(i % 2 == 0 ? 0.6f : -0.6f, 0.6f, 0.6f)));
  }
  return scene;
}

TEST(LeafReference, TakesNothingInAWhiteFurnace) {
  Plant plant = evenLeaf(glm::vec3(0.2f), glm::vec3(0.2f));
  // It reflects a half and lets a half through.
  const float half = std::sqrt(2.0f * kPi) / 6.0f;
  setLight(plant, half, half);
  LeafTextures& leaf = *plant.materials[0].leaf;
  for (const int texture : {plant.materials[0].base_color_texture, leaf.back_color})
    fill(plant, texture, glm::ivec3(188));
  for (const int texture : {leaf.front_translucency, leaf.back_translucency})
    fill(plant, texture, glm::ivec3(255));
  const Scene scene = crowdOf(plant);
  Daylight light;
  light.sky = uniformSky(glm::vec3(1.0f), glm::vec3(1.0f));
  ReferenceOptions options;
  options.width = 24;
  options.height = 18;
  options.camera = {{0.5f, 2.0f, 5.0f}, {0, 0, 0}, 0.6f};
  options.samples = 256;
  options.bounces = 4096;
  for (const bool glossy : {false, true}) {
    leaf.front_roughness = leaf.back_roughness = glossy ? 0.3f : 0.0f;
    const ReferencePicture picture = renderReference(scene, light, options);
    const float tolerance = glossy ? 3e-3f : 1e-4f;  // the table of what is reflected
    for (std::size_t i = 0; i < picture.image.rgb.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.image.rgb[i][c], 1.0f, 6.0f * picture.standard_error[i] + tolerance);
    EXPECT_NEAR(luminance(meanOf(picture.image)), 1.0,
                5.0 * errorOfMean(picture) + double{tolerance});
  }
  // One side glossy, and maps that hold more light than there is: never more than arrives.
  leaf.back_roughness = 0.0f;
  setLight(plant, 1.5f * half, 2.5f * half);
  const ReferencePicture picture = renderReference(scene, light, options);
  for (std::size_t i = 0; i < picture.image.rgb.size(); ++i)
    EXPECT_LE(picture.image.rgb[i].y, 1.0f + 6.0f * picture.standard_error[i] + 3e-3f);
  EXPECT_LT(luminance(meanOf(picture.image)), 0.999);
}

TEST(LeafReference, AnEvenLeafIsThePlainDiffuseOne) {
  Plant plant = evenLeaf(glm::vec3(0.2f), glm::vec3(0.2f));
  setLight(plant, std::sqrt(2.0f * kPi) / 3.0f, std::sqrt(2.0f * kPi) / 3.0f);
  LeafTextures& leaf = *plant.materials[0].leaf;
  for (const int texture : {plant.materials[0].base_color_texture, leaf.back_color})
    fill(plant, texture, glm::ivec3(255));
  const glm::ivec3 bytes(120, 150, 60);
  glm::vec3 through;
  for (int c = 0; c < 3; ++c)
    through[c] = shared::linearFromSrgb(static_cast<float>(bytes[c]) / 255.0f);
  for (const int texture : {leaf.front_translucency, leaf.back_translucency})
    fill(plant, texture, bytes);
  // The colour of which the rule of thumb makes that.
  plant.materials[0].base_color = glm::vec4(through / glm::vec3(1.05f, 1.15f, 0.55f), 1.0f);
  const Scene scene = crowdOf(plant);
  ReferenceOptions options;
  options.width = 48;
  options.height = 36;
  options.camera = {{0.5f, 2.0f, 5.0f}, {0, 0, 0}, 0.6f};
  options.samples = 32;
  options.gloss = false;
  const Daylight light = preethamDaylight(3.0f, {0.5f, 0.6f, 0.3f});
  const ReferencePicture mapped = renderReference(scene, light, options);
  options.leaf_maps = false;
  const ReferencePicture plain = renderReference(scene, light, options);
  // The same random numbers: only paths that a rounding decides may differ.
  std::size_t same = 0;
  for (std::size_t i = 0; i < plain.image.rgb.size(); ++i)
    same += glm::length(mapped.image.rgb[i] - plain.image.rgb[i]) <=
            1e-3f * glm::length(plain.image.rgb[i]);
  EXPECT_GT(same, plain.image.rgb.size() * 95 / 100);
  EXPECT_NEAR(luminance(meanOf(mapped.image)), luminance(meanOf(plain.image)),
              2.0 * errorOfMean(plain));
}

/// A leaf of birch with the light through it.
struct Birch {
  LeafSet set;
  LeafTranslucency light;

  Birch() {
    LeafGrowOptions options;
    options.species = "silver-birch";
    options.size = 256;
    set = growLeaf(options);
    light = bakeLeafTranslucency(set);
  }
  static const Birch& get() {
    static const Birch birch;
    return birch;
  }
};

TEST(LeafReference, FindsTheSamePictureHoweverItLooksForLight) {
  const Birch& birch = Birch::get();
  LeafPlantOptions shape;
  shape.scale = 20.0f;
  shape.fold_deg = 25.0f;
  Plant leaf = leafPlant(birch.set, birch.light, shape);
  leaf.materials[0].leaf->back_roughness = 0.4f;
  const Scene scene = crowdOf(leaf);
  Daylight light = preethamDaylight(3.0f, {0.5f, 0.6f, 0.3f});
  light.sun.luminance *= std::pow(Sun::kAngularRadius / 0.2f, 2.0f);
  light.sun.angular_radius = 0.2f;
  ReferenceOptions options;
  options.width = 16;
  options.height = 12;
  options.camera = {{0.5f, 2.0f, 5.0f}, {0, 0.3f, 0}, 0.4f};
  options.samples = 1024;
  std::vector<ReferencePicture> pictures;
  for (const LightSearch search :
       {LightSearch::kBoth, LightSearch::kLights, LightSearch::kSurface}) {
    options.search = search;
    options.seed = 10 + static_cast<std::uint32_t>(pictures.size());
    pictures.push_back(renderReference(scene, light, options));
  }
  for (const ReferencePicture& other : pictures) {
    const double error = std::hypot(errorOfMean(pictures[0]), errorOfMean(other));
    EXPECT_NEAR(luminance(meanOf(other.image)), luminance(meanOf(pictures[0].image)), 4.0 * error);
    EXPECT_LT(error, 0.02 * luminance(meanOf(other.image)));
  }
}

/// Looks squarely at the front of a leaf of that many texels, a pixel for each.
ReferenceOptions onTexels(const LeafSet& set, int samples) {
  ReferenceOptions options;
  options.width = set.width;
  options.height = set.height;
  const float half = 5e-4f * set.mm_per_texel * static_cast<float>(set.height);
  options.camera = {{0, half, 1}, {0, half, 0}, 2.0f * std::atan(half)};
  options.samples = samples;
  options.bounces = 1;
  return options;
}

/// Light from behind: `w` in the frame of the back, z out of it.
Daylight fromBehind(const glm::vec3& w) {
  Daylight light;
  light.sun.direction = glm::vec3(w.x, w.y, -w.z);
  light.sun.luminance = glm::vec3(1.0f) / std::pow(std::sin(light.sun.angular_radius), 2.0f);
  return light;
}

TEST(LeafBssrdf, AFlatLeafLetsThroughWhatTheClosedFormSays) {
  for (const float thickness : {0.13f, 0.2f, 0.5f}) {
    // The middle is farther from the outline than light gets.
    LeafSet set = flatLeaf(16, 16, 0.6f, thickness, 0.1f);
    const Multipole multipole(set.optics, insideReflection(1.33));
    const double total = 0.9 * 0.3 * multipole.total(double{thickness});
    ReferenceOptions options = onTexels(set, 1536);
    options.width = options.height = 8;
    options.camera.vertical_fov *= 0.1f;
    const auto expect = [&](const Daylight& light, double expected) {
      const ReferencePicture picture = renderLeafReference(set, {}, {}, light, options);
      const double found = luminance(meanOf(picture.image));
      EXPECT_NEAR(found / expected, 1.0, 0.01) << thickness;
      EXPECT_LT(errorOfMean(picture), 0.003 * expected);
    };
    const glm::vec3 slanting = glm::normalize(glm::vec3(0.6f, 0.5f, 0.7f));
    expect(fromBehind(slanting), double{slanting.z} * total);
    Daylight sky;
    sky.sky = uniformSky(glm::vec3(1.0f), glm::vec3(1.0f));
    expect(sky, total + 0.1);  // and what the front reflects
    // Optics of one's own.
    LeafBakeOptions bake;
    bake.surface_reflection = 0.1f;
    const ReferencePicture other =
        renderLeafReference(set, {}, bake, fromBehind(slanting), options);
    EXPECT_NEAR(luminance(meanOf(other.image)) /
                    (double{slanting.z} * 0.27 *
                     Multipole(set.optics, double{0.1f}).total(double{thickness})),
                1.0, 0.01);
  }
}

TEST(LeafBssrdf, IsTheSumOverTexelsOfTheBake) {
  const LeafSet set = roughLeaf(96, 96, 0.1f);
  LeafTransport transport(set, {});
  transport.makeDirectKernel();
  for (const float elevation : {1.5f, 0.7f, 0.39f}) {
    const glm::vec3 w(std::cos(elevation) * 0.6f, std::cos(elevation) * 0.8f, std::sin(elevation));
    const Plane sum = transport.throughDirectly(
        transport.enteringLight(1, {w}, {glm::vec3(1, 0, 0)})[0], 0, set.height);
    const ReferencePicture picture =
        renderLeafReference(set, {}, {}, fromBehind(w), onTexels(set, 96));
    // By blocks, because single pixels are noisy.
    constexpr int kBlock = 8;
    double squares = 0.0, errors = 0.0, of_sum = 0.0, of_picture = 0.0;
    int blocks = 0;
    for (int y = 0; y < set.height; y += kBlock)
      for (int x = 0; x < set.width; x += kBlock) {
        double a = 0.0, b = 0.0;
        bool inside = true;
        for (int v = y; v < y + kBlock; ++v)
          for (int u = x; u < x + kBlock; ++u) {
            inside = inside && set.opacity[static_cast<std::size_t>(v * set.width + u)] > 0.5f;
            a += 0.3 * double{sum[static_cast<std::size_t>(v) * transport.stride() +
                                  static_cast<std::size_t>(u)]};
            b += double{picture.image.at(u, v).y};
          }
        if (!inside) continue;
        of_sum += a;
        of_picture += b;
        squares += a * a;
        errors += (a - b) * (a - b);
        ++blocks;
      }
    ASSERT_GT(blocks, 50);
    RecordProperty("error", std::to_string(std::sqrt(errors / squares)));
    EXPECT_NEAR(of_picture / of_sum, 1.0, 0.01) << elevation;
    EXPECT_LT(std::sqrt(errors / squares), 0.03) << elevation;
  }
}

class LeafTruth : public RenderTest {};

TEST_F(LeafTruth, AnEvenLeafLooksAsTheRendererDrawsIt) {
  Random random(9);
  for (int trial = 0; trial < 6; ++trial) {
    const Plant plant = evenLeaf(glm::vec3(random.uniform(-0.1f, 0.4f), 0.25f, 0.2f),
                                 glm::vec3(0.3f, random.uniform(0.0f, 0.3f), 0.1f));
    Scene scene = itemScene(plant, nullptr);
    if (trial % 3 == 2)
      scene.items[0].world_from_plant = {glm::scale(glm::mat4(1.0f), glm::vec3(-1, 1, 1))};
    renderer().setScene(scene);
    for (const bool from_front : {true, false}) {
      View view = quadView();
      view.camera.eye = {0, 0, from_front ? 5.0f : -5.0f};
      view.terms = presetTerms("habel");
      view.terms.shadow = view.terms.ambient = false;
      view.daylight.sky = nullptr;
      glm::vec3 l = randomUnit(random);
      if (std::abs(l.z) < 0.3f) l.z = std::copysign(0.4f, l.z);
      if (l.y < 0.0f) l.y = -l.y;
      setSun(view, glm::normalize(l), {0.9f, 0.8f, 0.6f});
      const HdrImage drawn = renderer().render(view).hdr;
      const HdrImage traced = renderReference(scene, view.daylight, directOptions(view, 4)).image;
      for (const glm::ivec2 at : {glm::ivec2(32, 24), glm::ivec2(20, 30)})
        expectPixel(drawn, at.x, at.y, traced.at(at.x, at.y), 0.01f);
    }
  }
}

TEST_F(LeafTruth, AGrownLeafLooksAsTheRendererDrawsIt) {
  const Birch& birch = Birch::get();
  Plant plant = leafPlant(birch.set, birch.light);
  const Scene scene = itemScene(plant, nullptr);
  // The gloss takes light from what is below it, which the renderer does not do here.
  plant.materials[0].leaf->front_roughness = plant.materials[0].leaf->back_roughness = 0.0f;
  renderer().setScene(scene);
  View view = smallView(320, 320);
  view.terms = presetTerms("habel");
  view.terms.shadow = view.terms.ambient = false;
  view.background = glm::vec3(0.0f);
  view.daylight.sky = nullptr;
  for (const bool from_front : {true, false})
    for (const float out : {1.0f, 0.5f, -0.5f, -1.0f}) {
      const float side = from_front ? 1.0f : -1.0f;
      view.camera = automaticCamera(scene, from_front ? 0.0f : kPi, 0.0f, 1.0f);
      setSun(view, glm::normalize(glm::vec3(0.6f, 0.5f, side * out)), {0.9f, 0.8f, 0.6f});
      const HdrImage drawn = renderer().render(view).hdr;
      const HdrImage traced = renderReference(scene, view.daylight, directOptions(view, 16)).image;
      // Away from the outline, of which the renderer knows four samples a pixel.
      const auto inside = [&](int x, int y) {
        for (int v = y - 2; v <= y + 2; ++v)
          for (int u = x - 2; u <= x + 2; ++u)
            if (luminanceAt(traced, u, v) == 0.0f || luminanceAt(drawn, u, v) == 0.0f) return false;
        return true;
      };
      double difference = 0.0, sum = 0.0, signed_difference = 0.0;
      for (int y = 2; y < view.height - 2; ++y)
        for (int x = 2; x < view.width - 2; ++x) {
          if (!inside(x, y)) continue;
          const double truth = double{luminanceAt(traced, x, y)};
          const double error = double{luminanceAt(drawn, x, y)} - truth;
          difference += std::abs(error);
          signed_difference += error;
          sum += truth;
        }
      RecordProperty((from_front ? "front" : "back") + std::to_string(out),
                     std::to_string(difference / sum));
      EXPECT_GT(sum, 0.0);
      EXPECT_LT(difference / sum, 0.03) << from_front << " " << out;
      EXPECT_LT(std::abs(signed_difference) / sum, 0.01) << from_front << " " << out;
    }
}

TEST_F(LeafTruth, ALowSunLightsBumpsAsRaysPastThemDo) {
  const Birch& birch = Birch::get();
  Plant plant = leafPlant(birch.set, birch.light);
  const Scene scene = itemScene(plant, nullptr);
  plant.materials[0].leaf->front_roughness = plant.materials[0].leaf->back_roughness = 0.0f;
  renderer().setScene(scene);
  View view = smallView(128, 128);
  view.terms = presetTerms("habel");
  view.terms.shadow = view.terms.ambient = false;
  view.background = glm::vec3(0.0f);
  view.daylight.sky = nullptr;
  view.camera = automaticCamera(scene, 0.0f, 0.0f, 1.0f);
  for (const float degrees : {-6.0f, -2.0f, 3.0f, 8.0f, 20.0f}) {
    const float elevation = glm::radians(degrees);
    setSun(view, {0.8f * std::cos(elevation), 0.6f * std::cos(elevation), std::sin(elevation)},
           {0.9f, 0.8f, 0.6f});
    ReferenceOptions options = directOptions(view, 64);
    const ReferencePicture traced = renderLeafReference(birch.set, {}, {}, view.daylight, options);
    const double truth = luminance(meanOf(traced.image));
    const double found = luminance(meanOf(renderer().render(view).hdr));
    RecordProperty(
        "at" + std::to_string(static_cast<int>(degrees)),
        std::to_string(found / truth) + " " + std::to_string(errorOfMean(traced) / truth));
    // Within a few degrees of the plane next to no light is left.
    EXPECT_NEAR(found / truth, 1.0, std::abs(degrees) < 5.0f ? 0.35 : 0.1) << degrees;
  }
}

}  // namespace
}  // namespace verdure::test
