#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "base/parallel.h"
#include "base/random.h"
#include "reference/sky_sampler.h"
#include "reference/surface_model.h"
#include "shared/gloss.h"
#include "shared/leaf.h"
#include "verdure/error.h"
#include "verdure/reference.h"

namespace verdure {
namespace {

constexpr float kPi = glm::pi<float>();

/// A plant of loose pieces, one mesh and material for each.
class Pieces {
 public:
  /// center +- x +- y, its front towards cross(x, y); uvs over the whole texture.
  Pieces& quad(const glm::vec3& center, const glm::vec3& x, const glm::vec3& y,
               const glm::vec3& color, PartKind kind = PartKind::kWood) {
    Mesh& mesh = addMesh(color, kind);
    mesh.positions = {center - x - y, center + x - y, center + x + y, center - x + y};
    mesh.normals.assign(4, glm::normalize(glm::cross(x, y)));
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return *this;
  }

  /// Few facets, smooth normals.
  Pieces& ball(const glm::vec3& center, float radius, const glm::vec3& color,
               PartKind kind = PartKind::kWood) {
    constexpr std::uint32_t kRings = 5, kSlices = 7;
    Mesh& mesh = addMesh(color, kind);
    for (std::uint32_t r = 0; r <= kRings; ++r)
      for (std::uint32_t s = 0; s <= kSlices; ++s) {
        const float down = kPi * static_cast<float>(r) / kRings;
        const float turn = 2.0f * kPi * static_cast<float>(s % kSlices) / kSlices;
        const glm::vec3 n(std::sin(down) * std::sin(turn), std::cos(down),
                          std::sin(down) * std::cos(turn));
        mesh.positions.push_back(center + radius * n);
        mesh.normals.push_back(n);
      }
    for (std::uint32_t r = 0; r < kRings; ++r)
      for (std::uint32_t s = 0; s < kSlices; ++s) {
        const std::uint32_t a = r * (kSlices + 1) + s, b = a + kSlices + 1;
        if (r > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
        if (r + 1 < kRings) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
      }
    return *this;
  }

  Plant plant;

 private:
  Mesh& addMesh(const glm::vec3& color, PartKind kind) {
    Mesh& mesh = plant.meshes.emplace_back();
    mesh.kind = kind;
    mesh.material = static_cast<std::uint32_t>(plant.materials.size());
    plant.materials.emplace_back().base_color = glm::vec4(color, 1.0f);
    return mesh;
  }
};

Scene sceneOf(const Plant& plant, bool ground = false) {
  Scene scene;
  scene.ground = ground;
  scene.items.push_back({&plant});
  return scene;
}

ReferenceOptions options(const Camera& camera, int width, int height, int samples) {
  ReferenceOptions o;
  o.camera = camera;
  o.width = width;
  o.height = height;
  o.samples = samples;
  o.gloss = false;
  return o;
}

Daylight skyAlone(const glm::vec3& above, const glm::vec3& below = glm::vec3(0.0f)) {
  Daylight light;
  light.sky = uniformSky(above, below);
  return light;
}

Daylight sunAlone(const glm::vec3& direction, float radius = Sun::kAngularRadius) {
  Daylight light;
  light.sun = {glm::normalize(direction), glm::vec3(1000.0f, 800.0f, 500.0f), radius};
  return light;
}

glm::dvec3 meanOf(const HdrImage& image) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& c : image.rgb) sum += glm::dvec3(c);
  return sum / static_cast<double>(image.rgb.size());
}

/// Standard error of the mean luminance of the picture.
double errorOfMean(const ReferencePicture& picture) {
  double sum = 0.0;
  for (const float e : picture.standard_error) sum += double{e} * double{e};
  return std::sqrt(sum) / static_cast<double>(picture.standard_error.size());
}

double luminance(const glm::dvec3& c) {
  return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// A camera of a hair's breadth that sees one point.
Camera towards(const glm::vec3& target, const glm::vec3& eye) {
  return {eye, target, 1e-3f};
}

Plant crowdOfWhite() {
  Pieces pieces;
  pieces.ball({0, 1, 0}, 1.0f, glm::vec3(1.0f));
  pieces.ball({1.2f, 0.5f, 0.8f}, 0.6f, glm::vec3(1.0f));
  Random random(4);
  // leafTransmittance(1 / 2) is 1 / 2 in red and green: such a leaf takes nothing.
  for (int i = 0; i < 30; ++i) {
    const auto r = [&random] { return random.vary(1.0f); };
    const glm::vec3 x(r(), r(), r()), y(r(), r(), r());
    pieces.quad(1.5f * glm::vec3(r(), r() + 1.0f, r()), 0.4f * x, 0.4f * y, glm::vec3(0.5f),
                PartKind::kFoliage);
    // Normals that are not the triangles' own, some of them from the far side.
    for (glm::vec3& n : pieces.plant.meshes.back().normals)
      n = glm::normalize(n + glm::vec3(r(), r(), r()));
  }
  return pieces.plant;
}

void expectNothingInAWhiteFurnace(bool gloss, float tolerance) {
  const Plant plant = crowdOfWhite();
  ReferenceOptions o = options({{0.5f, 2.0f, 5.0f}, {0, 1, 0}, 0.8f}, 24, 18, 256);
  o.bounces = 4096;
  o.gloss = gloss;
  const ReferencePicture picture =
      renderReference(sceneOf(plant), skyAlone(glm::vec3(1.0f), glm::vec3(1.0f)), o);
  for (std::size_t i = 0; i < picture.image.rgb.size(); ++i) {
    const glm::vec3 c = picture.image.rgb[i];
    EXPECT_NEAR(c.x, 1.0f, 6.0f * picture.standard_error[i] + tolerance) << i;
    EXPECT_NEAR(c.y, 1.0f, 6.0f * picture.standard_error[i] + tolerance) << i;
    EXPECT_LE(c.z, 1.0f + 6.0f * picture.standard_error[i] + tolerance) << i;
  }
  const glm::dvec3 mean = meanOf(picture.image);
  EXPECT_NEAR(mean.x, 1.0, 5.0 * errorOfMean(picture) + double{tolerance});
  EXPECT_LT(mean.z, 0.99);  // blue is taken by leaves
}

TEST(Reference, SeesNothingInAWhiteFurnace) {
  expectNothingInAWhiteFurnace(false, 1e-5f);
}

TEST(Reference, SeesNothingInAWhiteFurnaceWithGloss) {
  expectNothingInAWhiteFurnace(true, 3e-4f);  // the table of what is reflected
}

TEST(Reference, GetsNoBrighterThanItsLight) {
  Plant plant = crowdOfWhite();
  for (Material& m : plant.materials) m.base_color *= 0.7f;
  const Scene scene = sceneOf(plant, true);
  ReferenceOptions o = options({{0.5f, 2.0f, 5.0f}, {0, 1, 0}, 0.8f}, 24, 18, 64);
  double last = 0.0;
  for (const int bounces : {1, 2, 3, 32}) {
    o.bounces = bounces;
    const ReferencePicture picture = renderReference(scene, skyAlone(glm::vec3(1.0f)), o);
    for (std::size_t i = 0; i < picture.image.rgb.size(); ++i)
      EXPECT_LE(picture.image.rgb[i].y, 1.0f + 6.0f * picture.standard_error[i] + 1e-4f);
    const double mean = luminance(meanOf(picture.image));
    EXPECT_GT(mean, last);  // every bounce adds light
    last = mean;
  }
}

TEST(Reference, LightsAPlaneAsTheClosedFormDoes) {
  const glm::vec3 color(0.6f, 0.3f, 0.1f);
  const Plant plant = Pieces().quad({0, 0, 0}, {0, 0, 50}, {50, 0, 0}, color).plant;
  const Camera camera = towards({0, 0, 0}, {1, 2, 3});
  // A uniform sky of luminance L: L rho.
  const glm::dvec3 sky = meanOf(
      renderReference(sceneOf(plant), skyAlone({2, 4, 8}), options(camera, 8, 8, 256)).image);
  EXPECT_NEAR(sky.x, 1.2, 0.012);
  EXPECT_NEAR(sky.y, 1.2, 0.012);
  EXPECT_NEAR(sky.z, 0.8, 0.008);
  // The sun: E sin(elevation) rho / pi, with next to no noise.
  for (const float elevation : {0.1f, 0.7f, 1.5f}) {
    const Daylight light = sunAlone({std::cos(elevation), std::sin(elevation), 0.0f});
    const glm::dvec3 lit =
        meanOf(renderReference(sceneOf(plant), light, options(camera, 8, 8, 16)).image);
    const glm::dvec3 expected =
        glm::dvec3(light.sun.illuminance() * color) * double{std::sin(elevation) / kPi};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(lit[c] / expected[c], 1.0, 0.005) << elevation;
  }
}

TEST(Reference, ShinesThroughALeaf) {
  const glm::vec3 color(0.1f, 0.3f, 0.05f);
  const Plant plant =
      Pieces().quad({0, 0, 0}, {0, 0, 5}, {5, 0, 0}, color, PartKind::kFoliage).plant;
  const float elevation = 0.8f;
  const Daylight light = sunAlone({std::cos(elevation), std::sin(elevation), 0.0f});
  const glm::dvec3 arriving =
      glm::dvec3(light.sun.illuminance()) * double{std::sin(elevation) / kPi};
  const auto seenFrom = [&](float y) {
    return meanOf(renderReference(sceneOf(plant), light,
                                  options(towards({0, 0, 0}, {0.5f, y, 0.3f}), 8, 8, 64))
                      .image);
  };
  const glm::dvec3 above = seenFrom(2.0f), below = seenFrom(-2.0f);
  const glm::dvec3 transmittance = glm::dvec3(shared::leafTransmittance(color));
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(above[c] / (arriving[c] * double{color[c]}), 1.0, 0.005);
    EXPECT_NEAR(below[c] / (arriving[c] * transmittance[c]), 1.0, 0.005);
  }
}

/// Light that a point of a white sky's ground keeps below a black square of half side `a`, `h`
/// above it: form factor from a horizontal element below its centre, four times that below a corner
/// (Howell's catalogue B-4).
float keptBelowSquare(float a, float h) {
  const float k = a / h, root = std::sqrt(1.0f + k * k);
  return 1.0f - 4.0f / (2.0f * kPi) * 2.0f * (k / root) * std::atan(k / root);
}

TEST(Reference, LosesTheSkyBehindASquare) {
  const float a = 0.8f, h = 1.0f;
  const Plant plant = Pieces()
                          .quad({0, 0, 0}, {0, 0, 50}, {50, 0, 0}, glm::vec3(0.5f))
                          .quad({0, h, 0}, {0, 0, a}, {a, 0, 0}, glm::vec3(0.0f))
                          .plant;
  const ReferencePicture picture =
      renderReference(sceneOf(plant), skyAlone(glm::vec3(2.0f)),
                      options(towards({0, 0, 0}, {6, 0.4f, 0}), 16, 16, 256));
  EXPECT_NEAR(luminance(meanOf(picture.image)), double{keptBelowSquare(a, h)},
              5.0 * errorOfMean(picture) + 1e-4);
  EXPECT_LT(errorOfMean(picture), 0.004);
}

TEST(Reference, LooksThroughWhatIsNotSeen) {
  // From above, through the square and a smaller one over it, which hides nothing more.
  const float a = 0.8f, h = 1.0f;
  const Plant plane = Pieces().quad({0, 0, 0}, {0, 0, 50}, {50, 0, 0}, glm::vec3(0.5f)).plant;
  const Plant squares = Pieces()
                            .quad({0, h, 0}, {0, 0, a}, {a, 0, 0}, glm::vec3(0.0f))
                            .quad({0, 1.1f * h, 0}, {0, 0, a}, {a, 0, 0}, glm::vec3(0.0f))
                            .plant;
  Scene scene = sceneOf(plane);
  scene.items.push_back({&squares});
  const auto from = [&](const glm::vec3& eye) {
    return renderReference(scene, skyAlone(glm::vec3(2.0f)),
                           options(towards({0, 0, 0}, eye), 16, 16, 256));
  };
  EXPECT_EQ(meanOf(from({0.3f, 9, 0.2f}).image), glm::dvec3(0.0));
  scene.items[1].seen = false;
  const ReferencePicture through = from({0.3f, 9, 0.2f});
  EXPECT_NEAR(luminance(meanOf(through.image)), double{keptBelowSquare(a, h)},
              5.0 * errorOfMean(through) + 1e-4);
  EXPECT_LT(errorOfMean(through), 0.004);
  // What is seen in front of the unseen looks as ever, with the same random numbers to the bit.
  const glm::vec3 below(0.3f, 0.9f, 0.2f);
  const ReferencePicture unseen_above = from(below);
  scene.items[1].seen = true;
  EXPECT_EQ(from(below).image.rgb, unseen_above.image.rgb);
}

TEST(Reference, SeesTheGroundUnderWhatIsNotSeenAndLiesOnIt) {
  const Plant sheet =
      Pieces().quad({0, 0.3f, 0}, {0, 0, 1.1f}, {1.3f, 0, 0}, glm::vec3(0.0f)).plant;
  Scene scene = sceneOf(sheet, true);
  scene.ground_height = 0.3f;
  scene.items[0].seen = false;
  Scene open = scene;
  open.items.clear();
  const ReferenceOptions o = options({{0.3f, 7.1f, 0.4f}, {0.1f, 0.3f, 0}, 0.1f}, 32, 32, 4);
  const Daylight light = skyAlone(glm::vec3(2.0f));
  EXPECT_EQ(renderReference(scene, light, o).image.rgb, renderReference(open, light, o).image.rgb);
}

/// A ball and leaves on the ground under Preetham's sky, the sun made larger so that chance finds
/// it.
struct SmallScene {
  Plant plant;
  Scene scene;
  Daylight light;
  ReferenceOptions o = options({{1, 2, 6}, {0, 0.8f, 0}, 0.6f}, 16, 12, 64);

  SmallScene() : plant(crowdOfWhite()) {
    for (Material& m : plant.materials) m.base_color *= glm::vec4(0.3f, 0.6f, 0.2f, 1.0f);
    scene = sceneOf(plant, true);
    light = preethamDaylight(3.0f, {0.5f, 0.6f, 0.3f});
    light.sun.luminance *= std::pow(Sun::kAngularRadius / 0.2f, 2.0f);
    light.sun.angular_radius = 0.2f;
  }
};

TEST(Reference, ConvergesAsOneOverTheRootOfTheSamples) {
  SmallScene s;
  // The difference of two pictures of other seeds has twice the variance of one.
  std::vector<double> errors, predicted;
  for (const int samples : {8, 32, 128, 512}) {
    s.o.samples = samples;
    s.o.seed = 1;
    const ReferencePicture a = renderReference(s.scene, s.light, s.o);
    s.o.seed = 2;
    const ReferencePicture b = renderReference(s.scene, s.light, s.o);
    double squares = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < a.image.rgb.size(); ++i) {
      const double d = luminance(a.image.rgb[i] - b.image.rgb[i]);
      squares += 0.5 * d * d;
      variance += 0.5 * (std::pow(double{a.standard_error[i]}, 2.0) +
                         std::pow(double{b.standard_error[i]}, 2.0));
    }
    errors.push_back(std::sqrt(squares));
    predicted.push_back(std::sqrt(variance));
  }
  const double slope = std::log(errors.back() / errors.front()) / std::log(512.0 / 8.0);
  EXPECT_NEAR(slope, -0.5, 0.1);
  EXPECT_NEAR(errors.back() / predicted.back(), 1.0, 0.2);  // it knows its own error
}

TEST(Reference, FindsTheSamePictureHoweverItLooksForLight) {
  SmallScene s;
  s.o.samples = 512;
  std::vector<ReferencePicture> pictures;
  for (const LightSearch search :
       {LightSearch::kBoth, LightSearch::kLights, LightSearch::kSurface}) {
    s.o.search = search;
    s.o.seed = 10 + static_cast<std::uint32_t>(pictures.size());
    pictures.push_back(renderReference(s.scene, s.light, s.o));
  }
  for (const ReferencePicture& other : pictures) {
    const double error = std::hypot(errorOfMean(pictures[0]), errorOfMean(other));
    EXPECT_NEAR(luminance(meanOf(other.image)), luminance(meanOf(pictures[0].image)), 4.0 * error);
    EXPECT_LT(error, 0.02 * luminance(meanOf(other.image)));
    // And it pays to look both ways.
    EXPECT_LE(pictures[0].noise, 1.02 * other.noise);
  }
}

TEST(Reference, DependsOnTheSeedAloneNotOnThreads) {
  SmallScene s;
  s.o.samples = 8;
  setThreadCount(1);
  const ReferencePicture one = renderReference(s.scene, s.light, s.o);
  setThreadCount(3);
  const ReferencePicture three = renderReference(s.scene, s.light, s.o);
  setThreadCount(0);
  EXPECT_EQ(one.image.rgb, three.image.rgb);
  EXPECT_EQ(one.standard_error, three.standard_error);
  s.o.seed = 2;
  EXPECT_NE(renderReference(s.scene, s.light, s.o).image.rgb, one.image.rgb);
}

TEST(Reference, StopsAtItsNoiseOrTime) {
  SmallScene s;
  s.o.samples = 100000;
  s.o.noise = 0.2;
  const ReferencePicture quiet = renderReference(s.scene, s.light, s.o);
  EXPECT_LE(quiet.noise, 0.2);
  EXPECT_LT(quiet.samples, 100000);
  s.o.noise = 0.0;
  s.o.seconds = 0.05;
  const ReferencePicture timed = renderReference(s.scene, s.light, s.o);
  EXPECT_LT(timed.samples, 100000);
  // What was stopped is what was asked for in the first place.
  s.o.seconds = 0.0;
  s.o.samples = quiet.samples;
  EXPECT_EQ(renderReference(s.scene, s.light, s.o).image.rgb, quiet.image.rgb);
}

TEST(Reference, SeesThroughWhatIsCut) {
  Pieces pieces;
  pieces.quad({0, 1, 0}, {1, 0, 0}, {0, 1, 0}, glm::vec3(0.0f), PartKind::kFoliage);
  Texture& texture = pieces.plant.textures.emplace_back();
  texture.image = Image(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 8; x < 16; ++x) texture.image.at(x, y)[3] = 255;  // the left half is cut
  texture.clamp_u = texture.clamp_v = true;
  pieces.plant.materials[0].base_color_texture = 0;
  pieces.plant.materials[0].alpha_mode = AlphaMode::kMask;
  const ReferencePicture picture =
      renderReference(sceneOf(pieces.plant), skyAlone(glm::vec3(3.0f), glm::vec3(3.0f)),
                      options({{0, 1, 5}, {0, 1, 0}, 0.3f}, 16, 16, 4));
  EXPECT_EQ(picture.image.at(2, 8), glm::vec3(3.0f));
  EXPECT_EQ(picture.image.at(13, 8), glm::vec3(0.0f));
}

TEST(Reference, DrawsInstancesAsCopies) {
  SmallScene s;
  Scene instanced = s.scene;
  instanced.items[0].world_from_plant = {
      glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(2.0f, 0.0f, -1.0f))};
  Plant moved = s.plant;
  for (Mesh& mesh : moved.meshes)
    for (glm::vec3& p : mesh.positions) p += glm::vec3(2.0f, 0.0f, -1.0f);
  Scene flat = s.scene;
  flat.items.push_back({&moved});
  const ReferencePicture a = renderReference(instanced, s.light, s.o);
  const ReferencePicture b = renderReference(flat, s.light, s.o);
  // The same random numbers: all but the rays whose rounding decides are the same.
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.image.rgb.size(); ++i)
    same += glm::length(a.image.rgb[i] - b.image.rgb[i]) <= 1e-3f * glm::length(a.image.rgb[i]);
  EXPECT_GT(same, a.image.rgb.size() / 2);
  EXPECT_NEAR(luminance(meanOf(a.image)), luminance(meanOf(b.image)), 3.0 * errorOfMean(a));
}

TEST(Reference, HidesDistantGroundInHaze) {
  Scene scene;  // ground alone
  const Daylight light = skyAlone(glm::vec3(1.0f));
  const auto seen = [&](float distance) {
    const Camera camera{{0, 2, 0}, {0, 2.0f * (1.0f - 10.0f / distance), 10.0f}, 1e-3f};
    return luminance(meanOf(renderReference(scene, light, options(camera, 4, 4, 64)).image));
  };
  const double near = seen(10.0f), far = seen(1e5f);
  EXPECT_NEAR(near, luminance(glm::dvec3(0.080, 0.135, 0.032)), 0.08);
  EXPECT_NEAR(far, 1.0, 0.01);
}

TEST(Reference, RefusesBadOptions) {
  const Scene scene;
  ReferenceOptions o;
  o.width = 0;
  EXPECT_THROW(renderReference(scene, {}, o), Error);
  o = {};
  o.samples = 0;
  EXPECT_THROW(renderReference(scene, {}, o), Error);
  o = {};
  o.bounces = 0;
  EXPECT_THROW(renderReference(scene, {}, o), Error);
  Scene empty;
  empty.items.emplace_back();
  EXPECT_THROW(renderReference(empty, {}, ReferenceOptions{}), Error);
}

TEST(Scatterer, LosesAndGainsNothing) {
  Random random(8);
  for (int trial = 0; trial < 6; ++trial) {
    const auto unit = [&random] {
      return glm::normalize(glm::vec3(random.vary(1), random.vary(1), random.vary(1)));
    };
    const Scatterer s{unit(), unit(), glm::vec3(0.7f, 0.5f, 0.2f), glm::vec3(0.3f, 0.1f, 0.2f)};
    // Over the sphere by a Fibonacci lattice.
    constexpr int kPoints = 200000;
    glm::dvec3 out(0.0);
    double density = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const double y = 1.0 - (2.0 * i + 1.0) / kPoints, turn = 2.0 * M_PI * 0.6180339887498949 * i;
      const double ring = std::sqrt(1.0 - y * y);
      const glm::vec3 d(ring * std::cos(turn), y, ring * std::sin(turn));
      out += glm::dvec3(s.value(d)) * (4.0 * M_PI / kPoints);
      density += double{s.density(d)} * (4.0 * M_PI / kPoints);
    }
    EXPECT_NEAR(density, 1.0, 1e-3);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(out[c], double{s.reflectance[c] + s.transmittance[c]}, 1e-3);
    for (int i = 0; i < 1000; ++i) {
      const auto sample = s.sample(random);
      ASSERT_TRUE(sample);
      EXPECT_NEAR(glm::length(sample->direction), 1.0f, 1e-5f);
      const glm::vec3 weight = s.value(sample->direction) / s.density(sample->direction);
      EXPECT_NEAR(glm::length(weight - sample->weight), 0.0f, 1e-3f);
    }
  }
  EXPECT_FALSE(Scatterer{}.sample(random));  // black
}

glm::vec3 onSphere(int i, int count) {  // a Fibonacci lattice
  const double y = 1.0 - (2.0 * i + 1.0) / count, turn = 2.0 * M_PI * 0.6180339887498949 * i;
  const double ring = std::sqrt(1.0 - y * y);
  return {static_cast<float>(ring * std::cos(turn)), static_cast<float>(y),
          static_cast<float>(ring * std::sin(turn))};
}

TEST(Scatterer, GlossTakesWhatItReflects) {
  Random random(9);
  for (const float width : {0.2f, 0.41f, 0.82f}) {
    const Gloss gloss(0.04f, width);
    for (int trial = 0; trial < 8; ++trial) {
      const auto unit = [&random] {
        return glm::normalize(glm::vec3(random.vary(1), random.vary(1), random.vary(1)));
      };
      Scatterer s{unit(), unit(), glm::vec3(0.7f, 0.5f, 0.2f), glm::vec3(0.3f, 0.1f, 0.2f),
                  &gloss, unit()};
      if (glm::dot(s.out, s.side) < 0.0f) s.out = -s.out;
      const bool straight = glm::dot(s.normal, s.out) > 0.0f;
      const double reflected = gloss.reflected(glm::dot(straight ? s.normal : s.side, s.out));
      constexpr int kPoints = 400000;
      glm::dvec3 out(0.0);
      double density = 0.0;
      for (int i = 0; i < kPoints; ++i) {
        const glm::vec3 d = onSphere(i, kPoints);
        out += glm::dvec3(s.value(d)) * (4.0 * M_PI / kPoints);
        density += double{s.density(d)} * (4.0 * M_PI / kPoints);
      }
      EXPECT_LE(density, 1.002);  // what is missing goes into the surface
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(out[c],
                    reflected + (1.0 - reflected) * double{s.reflectance[c] + s.transmittance[c]},
                    3e-3)
            << width;
      // The mean weight is what leaves.
      constexpr int kSamples = 40000;
      glm::dvec3 sum(0.0);
      for (int i = 0; i < kSamples; ++i)
        if (const auto sample = s.sample(random)) sum += glm::dvec3(sample->weight);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / kSamples, out[c], 0.015) << width;
    }
  }
}

TEST(Gloss, IsTheSameBothWaysAndBrightestAtTheMirror) {
  const Gloss gloss(0.04f, 0.41f);
  const glm::vec3 n(0, 1, 0);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const auto above = [&random] {
      glm::vec3 v =
          glm::normalize(glm::vec3(random.vary(1), random.uniform(0.02f, 1), random.vary(1)));
      return v;
    };
    const glm::vec3 a = above(), b = above();
    EXPECT_NEAR(gloss.value(n, a, b) / b.y, gloss.value(n, b, a) / a.y, 1e-3f / (a.y * b.y));
    EXPECT_NEAR(gloss.passed(a.y, b.y), gloss.passed(b.y, a.y), 1e-6f);
  }
  // Squarely: F D / 4, which is k_s / pi of the renderer's highlight.
  EXPECT_NEAR(gloss.value(n, n, n), shared::highlightStrength(0.41f, 0.04f) / kPi, 1e-5f);
  EXPECT_EQ(gloss.value(n, n, -n), 0.0f);
  for (const float width : {0.3f, 0.41f, 0.6f, 0.82f, 1.0f})
    for (const float index : {1.2f, 1.33f, 1.5f, 1.65f}) {
      const float facing = shared::facetReflectance(index);
      const Gloss wide(facing, width), half(facing, width, 0.5f);
      for (float c = 0.02f; c <= 1.0f; c += 0.02f) {
        EXPECT_NEAR(shared::glossReflected(width, facing, c), wide.reflected(c), 0.0175f)
            << width << " " << index << " " << c;
        EXPECT_NEAR(half.reflected(c), 0.5f * wide.reflected(c), 1e-5f);
      }
    }
  // Smooth and looked at squarely it reflects what its facets do.
  EXPECT_NEAR(Gloss(0.04f, 0.05f).reflected(1.0f), 0.04f, 2e-3f);
}

TEST(SkySampler, DrawsWhatItsDensitySays) {
  const Daylight light = preethamDaylight(3.0f, {0.3f, 0.4f, 0.8f});
  const SkySampler sampler(*light.sky);
  Random random(3);
  // The mean of 1 / density is the sphere's solid angle; that of L / density the sky's flux, and it
  // hardly varies.
  double solid = 0.0, flux = 0.0, squares = 0.0, uniform_flux = 0.0;
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    const float u = random.uniform(), v = random.uniform();
    const glm::vec3 d = sampler.sample(u, v);
    ASSERT_NEAR(glm::length(d), 1.0f, 1e-5f);
    const double density = double{sampler.density(d)};
    ASSERT_GT(density, 0.0);
    const double l = luminance(light.sky->luminance(d)) / density;
    solid += 1.0 / density;
    flux += l;
    squares += l * l;
    const float y = random.uniform(), turn = 2.0f * kPi * random.uniform();
    const float ring = std::sqrt(1.0f - y * y);
    uniform_flux +=
        luminance(light.sky->luminance({ring * std::cos(turn), y, ring * std::sin(turn)}));
  }
  flux /= kSamples;
  EXPECT_NEAR(solid / kSamples, 4.0 * M_PI, 0.5);
  EXPECT_NEAR(flux, 2.0 * M_PI * uniform_flux / kSamples, 0.01 * flux);
  EXPECT_LT(std::sqrt(squares / kSamples - flux * flux), 0.25 * flux);
  EXPECT_TRUE(SkySampler(*uniformSky(glm::vec3(0.0f))).empty());
}

}  // namespace
}  // namespace verdure
