#include "shared/style.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <set>

#include "base/random.h"
#include "render/paper.h"
#include "render_fixture.h"
#include "verdure/compare.h"
#include "verdure/levels.h"
#include "verdure/terrain.h"

namespace verdure {
namespace {

using namespace test;

constexpr Style kDrawn[] = {Style::kNormals, Style::kEdges, Style::kToon, Style::kWatercolor};
constexpr StyleNormals kNormals[] = {StyleNormals::kRaw, StyleNormals::kRealigned,
                                     StyleNormals::kScaled};

/// Nine values of a function of x and y around 0.
template <class F>
std::array<float, 9> around(const F& value) {
  std::array<float, 9> v{};
  for (int i = 0; i < 9; ++i)
    v[static_cast<std::size_t>(i)] =
        value(static_cast<float>(i % 3 - 1), static_cast<float>(i / 3 - 1));
  return v;
}

TEST(Lines, DifferencesOfStepsAndCreases) {
  // A step of height 0.7 beside the pixel, on either side, across and down.
  for (const float at : {-0.5f, 0.5f})
    for (const bool across : {true, false}) {
      const auto v = around([&](float x, float y) { return (across ? x : y) > at ? 1.7f : 1.0f; });
      EXPECT_NEAR(shared::firstDifference(v.data()), 0.35f, 1e-6f);
      EXPECT_NEAR(shared::secondDifference(v.data()), 0.7f, 1e-6f);
    }
  // Slopes 0.1 and 0.25 meet at the pixel.
  const auto v = around([](float x, float) { return 2.0f + (x < 0.0f ? 0.1f : 0.25f) * x; });
  EXPECT_NEAR(shared::firstDifference(v.data()), 0.175f, 1e-6f);
  EXPECT_NEAR(shared::secondDifference(v.data()), 0.15f, 1e-6f);
  // The change along the steepest way.
  const auto plane = around([](float x, float y) { return 5.0f + 0.3f * x - 0.4f * y; });
  EXPECT_NEAR(shared::firstDifference(plane.data()), 0.5f, 1e-6f);
}

TEST(Lines, PlanesHaveNoneHoweverTheyAreSeen) {
  Random random(5);
  double bent = 0.0;
  int planes = 0;
  while (planes < 300) {
    // A plane ahead, up to grazing; a picture of 480 lines.
    const glm::vec3 n =
        glm::normalize(glm::vec3(random.vary(1.0f), random.vary(1.0f), random.vary(1.0f)));
    const float offset = random.uniform(0.5f, 40.0f);
    const float px = random.vary(0.3f), py = random.vary(0.3f);
    const auto inverse = around([&](float x, float y) {
      const glm::vec3 ray(px + x / 800.0f, py + y / 800.0f, 1.0f);
      return std::abs(glm::dot(n, ray)) / offset;
    });
    if (*std::min_element(inverse.begin(), inverse.end()) < 3e-4f) continue;  // over the horizon
    const float low = *std::min_element(inverse.begin(), inverse.end());
    const float high = *std::max_element(inverse.begin(), inverse.end());
    if (high > 3.0f * low) continue;  // and near it: it changes its side within the pixels
    ++planes;
    const float first = shared::firstDifference(inverse.data());
    const float second = shared::secondDifference(inverse.data());
    EXPECT_LT(shared::profileStrength(first, second, inverse[4]), 1e-4f);
    // Distances themselves bend.
    std::array<float, 9> distance{};
    for (std::size_t i = 0; i < 9; ++i) distance[i] = 1.0f / inverse[i];
    bent = std::max(bent, double{shared::profileStrength(shared::firstDifference(distance.data()),
                                                         shared::secondDifference(distance.data()),
                                                         distance[4])});
  }
  EXPECT_GT(bent, 0.01);
}

TEST(Lines, AProfileCountsByItsStepWhateverTheSlope) {
  for (const float slope : {0.0f, 0.05f, 0.3f}) {
    const auto v =
        around([&](float x, float y) { return 4.0f + slope * y + (x > 0.5f ? 0.8f : 0.0f); });
    const float first = shared::firstDifference(v.data());
    const float second = shared::secondDifference(v.data());
    EXPECT_NEAR(shared::profileStrength(first, second, v[4]), std::hypot(0.4f, slope) / 4.0f,
                1e-6f);
    EXPECT_GT(shared::creaseStrength(first, second, v[4], 0.01f), 0.5f);
  }
  EXPECT_EQ(shared::creaseStrength(0.2f, 0.0f, 1.0f, 0.01f), 0.0f);
}

TEST(Tones, AreEvenBetweenAntialiasedBorders) {
  const glm::vec2 borders(0.4f, 0.7f);
  const glm::vec3 levels(0.3f, 0.6f, 1.0f);
  const float change = 0.01f;
  float last = 0.0f;
  double sum = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const float tone = static_cast<float>(i) / 1000.0f;
    const float level = shared::evenTone(tone, change, borders, levels);
    EXPECT_GE(level, last);
    for (int b = 0; b < 2; ++b)  // 0.75 pixels on either side of a border
      EXPECT_TRUE(std::abs(tone - borders[b]) > 0.0074f || level > levels[b]);
    EXPECT_TRUE(tone > 0.39f || level == levels.x);
    EXPECT_TRUE(tone < 0.41f || tone > 0.69f || level == levels.y);
    EXPECT_TRUE(tone < 0.71f || level == levels.z);
    last = level;
    sum += double{level} / 1001.0;
  }
  EXPECT_NEAR(sum, 0.4 * 0.3 + 0.3 * 0.6 + 0.3 * 1.0, 1e-3);
  EXPECT_EQ(shared::lightness(2.0f, 2.0f), 1.0f);
  EXPECT_EQ(shared::lightness(0.5f, 2.0f), 0.5f);
}

TEST(Layers, TheBlurredDepthTestIsFairAndEndsWhereDepthsAreApart) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const float a = random.uniform(0.01f, 1.0f), b = random.uniform(0.01f, 1.0f);
    const float share = shared::blurredDepthTest(a, b, 0.1f);
    EXPECT_NEAR(share + shared::blurredDepthTest(b, a, 0.1f), 1.0f, 1e-6f);
    EXPECT_TRUE(a < 1.12f * b || share == 1.0f);  // 1 / distance: larger is nearer
    EXPECT_TRUE(b < 1.12f * a || share == 0.0f);
  }
  EXPECT_EQ(shared::blurredDepthTest(0.3f, 0.3f, 0.05f), 0.5f);
  EXPECT_EQ(shared::blurredDepthTest(0.3f, 0.0f, 0.05f), 1.0f);  // nothing around
}

TEST(Layers, PigmentsMultiply) {
  const glm::vec3 color(0.2f, 0.7f, 1.0f);
  EXPECT_LT(glm::length(shared::throughPigment(color, 1.0f) - color), 1e-6f);
  EXPECT_EQ(shared::throughPigment(color, 0.0f), glm::vec3(1.0f));
  const glm::vec3 twice = shared::throughPigment(color, 0.4f) * shared::throughPigment(color, 1.1f);
  EXPECT_LT(glm::length(twice - shared::throughPigment(color, 1.5f)), 1e-6f);
  for (const float amount : {0.1f, 0.4f})
    EXPECT_NEAR(shared::granulated(0.2f, amount) + shared::granulated(0.8f, amount), 2.0f, 1e-6f);
  EXPECT_GT(shared::granulated(0.1f, 0.3f), shared::granulated(0.9f, 0.3f));  // valleys
  EXPECT_EQ(shared::pigmentAtBorder(0.0f, 3.0f), 1.0f);
  EXPECT_LT(shared::pigmentAtBorder(9.0f, 3.0f), 1e-3f);
}

TEST(Layers, NoiseStaysWhereItIs) {
  for (const glm::ivec3 at : {glm::ivec3(0), glm::ivec3(-3, 5, 900), glm::ivec3(7, -70, 1)})
    EXPECT_EQ(shared::smoothNoise(glm::vec3(at)), shared::latticeNoise(at.x, at.y, at.z));
  Random random(8);
  double sum = 0.0, most = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 p(random.vary(40.0f), random.vary(40.0f), random.vary(40.0f));
    // Across the change of octaves, and in space.
    for (const float size : {0.25f, 0.5f, 4.0f}) {
      const float before = shared::placeNoise(p, size * 0.9999f);
      const float behind = shared::placeNoise(p, size * 1.0001f);
      most = std::max(most, double{std::abs(behind - before)});
    }
    const float step = 0.002f;
    EXPECT_LT(std::abs(shared::placeNoise(p + step, 0.5f) - shared::placeNoise(p, 0.5f)), 0.03f);
    sum += double{shared::placeNoise(p, 0.7f)} / 4000.0;
  }
  EXPECT_LT(most, 1e-3);
  EXPECT_NEAR(sum, 0.5, 0.02);
}

TEST(Paper, RepeatsAndIsEven) {
  const Image paper = makePaper(128);
  EXPECT_EQ(paper.rgba, makePaper(128).rgba);
  for (int c = 0; c < 3; ++c) {
    double mean = 0.0, inside = 0.0, seam = 0.0;
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) {
        mean += paper.at(x, y)[c] / 16384.0;
        const double step = std::abs(paper.at(x, y)[c] - paper.at((x + 1) % 128, y)[c]);
        (x == 127 ? seam : inside) += step / (x == 127 ? 128.0 : 127.0 * 128.0);
      }
    EXPECT_NEAR(mean, 128.0, 25.0) << c;  // broad patches differ
    EXPECT_LT(seam, 1.6 * inside + 1.0) << c;
  }
}

/// Lightness of a pixel, sRGB, 0 to 1.
float valueAt(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return static_cast<float>(p[0] + p[1] + p[2]) / 765.0f;
}

/// Share of the picture that is dark.
double inkShare(const Image& image) {
  double ink = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) ink += valueAt(image, x, y) < 0.5f ? 1.0 : 0.0;
  return ink / (image.width * image.height);
}

class Styles : public RenderTest {
 protected:
  static View styledView(int width, int height, Style style) {
    View view = smallView(width, height);
    view.hdr = false;
    view.style = style;
    return view;
  }
  /// The ball tree in its crown's light.
  struct Tree {
    Plant plant = ballTree(600, 0.3f);
    CrownLight light = ballTreeLight(plant);
    Scene scene(bool ground) const {
      Scene scene = itemScene(plant, &light);
      scene.ground = ground;
      return scene;
    }
  };
  static const Tree& tree() {
    static const Tree instance;
    return instance;
  }
  /// Sets the scene and looks at it.
  static View treeView(Style style, bool ground = false, int size = 160) {
    const Scene scene = tree().scene(ground);
    renderer().setScene(scene);
    View view = styledView(size, size, style);
    view.camera = automaticCamera(scene, 0.6f, 0.1f, 1.0f);
    return view;
  }
};

TEST_F(Styles, AreSilentUnderValidationAndLeaveThePhotoAsItWas) {
  const Tree& t = tree();
  const Plant post = standingTube(0.2f, 0.0f, 2.0f);
  Scene scene = t.scene(true);
  scene.items.push_back({&post, nullptr, {glm::translate(glm::mat4(1), {2.5f, 0, 0})}});
  renderer().setScene(scene);
  View view = styledView(72, 56, Style::kPhoto);
  view.camera = automaticCamera(scene, 0.3f, 0.1f, 72.0f / 56.0f);
  const Image photo = renderer().render(view).image;
  for (const Style style : kDrawn)
    for (const StyleNormals normals : kNormals) {
      view.style = style;
      view.style_normals = normals;
      const Image drawn = renderer().render(view).image;
      EXPECT_EQ(drawn.rgba, renderer().render(view).image.rgba);
      EXPECT_NE(drawn.rgba, photo.rgba);
    }
  for (const Style style : kDrawn) {
    view.style = style;
    view.terms.shadow = false;
    view.background = glm::vec3(0.8f, 0.9f, 1.0f);
    view.exposure.ev = 14.0f;
    renderer().render(view);
    view.terms.shadow_source = ShadowSource::kDepthOrdered;
    view.terms.shadow = true;
    view.last = View::Moment{view.camera, {}, 0.0};
    EXPECT_EQ(renderer().render(view).motion.size(), 72u * 56u);
    View other = view;
    other.width = 31;
    renderer().render(other);
  }
  View again = styledView(72, 56, Style::kPhoto);
  again.camera = view.camera;
  EXPECT_EQ(renderer().render(again).image.rgba, photo.rgba);
  again.hdr = true;
  again.style = Style::kToon;
  EXPECT_THROW(renderer().render(again), Error);
  // Nothing but ground; a terrain instead of it; a sky without a sun.
  again.hdr = false;
  renderer().setScene(Scene{});
  for (const Style style : kDrawn) {
    again.style = style;
    renderer().render(again);
  }
  TerrainGrowOptions rolling;
  rolling.samples = 33;
  const Terrain hills = growTerrain(rolling);
  scene.terrain = &hills;
  renderer().setScene(scene);
  again.daylight = Daylight{uniformSky(glm::vec3(2.0f)), {}};
  for (const Style style : kDrawn) {
    again.style = style;
    renderer().render(again);
  }
}

TEST_F(Styles, NormalsAreShownAsTheyWereBaked) {
  const Plant quad = whiteQuad();
  const glm::vec3 baked = glm::normalize(glm::vec3(0.4f, 0.5f, 0.7f));
  const CrownLight light = uniformLight(quad, baked, 0.5f);
  setItem(quad, &light);
  View view = quadView();
  view.hdr = false;
  view.style = Style::kNormals;
  view.camera.eye.z = 12.0f;
  for (const StyleNormals normals : kNormals) {
    view.style_normals = normals;
    const Image image = renderer().render(view).image;
    // The camera looks along -Z: its axes are the world's.
    const glm::vec3 n = normals == StyleNormals::kRaw         ? glm::vec3(0, 0, 1)
                        : normals == StyleNormals::kRealigned ? baked
                                                              : 0.5f * baked;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image.at(32, 24)[c], 255.0f * (0.5f + 0.5f * n[c]), 1.0f) << c;
    for (int c = 0; c < 3; ++c) EXPECT_EQ(image.at(1, 1)[c], 255);
  }
  // From behind, leaf normals are turned over and the crown's are not.
  view.camera.eye.z = -12.0f;
  view.style_normals = StyleNormals::kRaw;
  EXPECT_NEAR(renderer().render(view).image.at(32, 24)[2], 255, 1);
  view.style_normals = StyleNormals::kRealigned;
  EXPECT_NEAR(renderer().render(view).image.at(32, 24)[2], 255.0f * (0.5f - 0.5f * baked.z), 1.0f);
}

TEST_F(Styles, LinesLieOnTheOutlineAlone) {
  const Plant quad = whiteQuad();
  const CrownLight light = uniformLight(quad, {0, 0, 1}, 1.0f);
  setItem(quad, &light);
  View view = styledView(160, 120, Style::kEdges);
  view.camera = {{0, 0, 5}, {0, 0, 0}, 0.6f};
  view.background = glm::vec3(1.0f);
  const Image image = renderer().render(view).image;
  const glm::ivec2 low = pixelOf(view, {-1, 1, 0}), high = pixelOf(view, {1, -1, 0});
  int lined = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const int to_x = std::min(std::abs(x - low.x), std::abs(x - high.x));
      const int to_y = std::min(std::abs(y - low.y), std::abs(y - high.y));
      const bool within = x > low.x - 4 && x < high.x + 4 && y > low.y - 4 && y < high.y + 4;
      const bool near = within && std::min(to_x, to_y) <= 4;
      if (valueAt(image, x, y) < 0.85f) {
        EXPECT_TRUE(near) << x << " " << y;
        ++lined;
      }
    }
  // Along all of it, one to five pixels wide.
  const int outline = 2 * (high.x - low.x + high.y - low.y);
  EXPECT_GT(lined, outline);
  EXPECT_LT(lined, 5 * outline);
}

TEST_F(Styles, NoLinesOnAPlaneThatIsSeenAtAGrazingAngle) {
  Plant floor = horizontalCard(0.0f, 400.0f);
  floor.meshes[0].kind = PartKind::kWood;
  setItem(floor, nullptr);
  View view = styledView(160, 120, Style::kEdges);
  view.camera = {{0, 1.5f, 0}, {0, 0.9f, -10}, 0.8f};
  view.background = glm::vec3(1.0f);
  const Image image = renderer().render(view).image;
  const int horizon = pixelOf(view, {0, 0, -200}).y;
  EXPECT_GT(horizon, 10);
  for (int y = horizon + 5; y < 120; ++y)
    for (int x = 0; x < 160; ++x) EXPECT_GT(valueAt(image, x, y), 0.9f) << x << " " << y;
}

TEST_F(Styles, RealignedAndScaledNormalsTakeTheClutterOutOfACrown) {
  View view = treeView(Style::kEdges);
  view.background = glm::vec3(1.0f);
  double ink[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    view.style_normals = kNormals[i];
    ink[i] = inkShare(renderer().render(view).image);
  }
  EXPECT_LT(ink[1], 0.9 * ink[0]);
  EXPECT_LT(ink[2], ink[1]);
  EXPECT_GT(ink[2], 0.005);  // the outline stays
}

TEST_F(Styles, ACartoonHasFewTones) {
  // A card whose normal turns from the sun shows three tones, none between them.
  const Plant quad = whiteQuad({0.3f, 0.3f, 0.3f, 1.0f});
  View view = quadView();
  view.hdr = false;
  view.style = Style::kToon;
  view.terms.shadow = false;
  std::set<int> tones;
  for (int i = 0; i < 24; ++i) {
    const float angle = static_cast<float>(i) / 23.0f * 2.4f;
    const CrownLight light =
        uniformLight(quad, glm::vec3(std::sin(angle), 0.0f, std::cos(angle)), 1.0f);
    setItem(quad, &light);
    setSun(view, 0.0f, 0.0f, {0.9f, 0.9f, 0.9f});
    tones.insert(renderer().render(view).image.at(32, 24)[1] / 3);
  }
  // Dithering may tell neighbours apart.
  int groups = 0;
  for (const int tone : tones) groups += tones.contains(tone - 1) ? 0 : 1;
  EXPECT_EQ(groups, 3);
}

TEST_F(Styles, AWatercolourOnlyDarkensItsPaper) {
  View view = treeView(Style::kWatercolor);
  view.background = glm::vec3(1.0f);
  const Image painted = renderer().render(view).image;
  renderer().setScene([] {
    Scene empty;
    empty.ground = false;
    return empty;
  }());
  const Image sheet = renderer().render(view).image;
  double mean = 0.0;
  int painted_pixels = 0;
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 160; ++x) {
      mean += double{valueAt(sheet, x, y)} / (160.0 * 160.0);
      EXPECT_LT(valueAt(painted, x, y), valueAt(sheet, x, y) + 0.06f) << x << " " << y;
      painted_pixels += valueAt(painted, x, y) < valueAt(sheet, x, y) - 0.1f ? 1 : 0;
    }
  EXPECT_GT(mean, 0.9);
  EXPECT_GT(painted_pixels, 3000);
}

TEST_F(Styles, WoodSinksIntoFoliageInsteadOfBeingCutOff) {
  // A post at various depths behind and before a wall of leaves.
  Plant wall = whiteQuad({0.1f, 0.3f, 0.1f, 1.0f});
  wall.meshes[0] = {};
  wall.meshes[0].kind = PartKind::kFoliage;
  addQuad(wall.meshes[0], {0, -2, 0}, {4, 0, 0}, {0, 4, 0});
  Plant post = standingTube(0.3f, -3.0f, 3.0f);
  post.materials[0].base_color = {0.12f, 0.08f, 0.05f, 1.0f};
  View view = styledView(120, 120, Style::kWatercolor);
  view.camera = {{0, 0, 10}, {0, 0, 0}, 0.6f};
  view.background = glm::vec3(1.0f);
  std::vector<float> contrast;
  for (const float z : {-3.0f, -0.5f, -0.35f, -0.25f, -0.15f, -0.05f, 0.3f, 2.0f}) {
    Scene scene = itemScene(wall, nullptr);
    scene.items.push_back({&post, nullptr, {glm::translate(glm::mat4(1), {0, 0, z})}});
    renderer().setScene(scene);
    const Image image = renderer().render(view).image;
    float at_post = 0.0f, beside = 0.0f;
    for (int y = 40; y < 80; ++y) {
      at_post += static_cast<float>(image.at(60, y)[1]) / 40.0f;
      beside += static_cast<float>(image.at(40, y)[1]) / 40.0f;
    }
    contrast.push_back(beside - at_post);
  }
  EXPECT_NEAR(contrast.front(), 0.0f, 8.0f);  // hidden
  EXPECT_GT(contrast.back(), 15.0f);          // in front
  int between = 0;
  for (std::size_t i = 0; i + 1 < contrast.size(); ++i) {
    EXPECT_LT(contrast[i], contrast[i + 1] + 0.4f * contrast.back()) << i;
    between += contrast[i] > 0.1f * contrast.back() && contrast[i] < 0.9f * contrast.back() ? 1 : 0;
  }
  EXPECT_GE(between, 2);
}

TEST_F(Styles, ForestsLookAsTheirTreesDo) {
  const Tree& t = tree();
  Forest forest;
  forest.kinds = {{&t.plant, &t.light}};
  forest.places = {Placement{}};
  Scene scene;
  scene.ground = false;
  scene.forest = &forest;
  PlantLevels levels;
  levels.impostor = bakeImpostor(t.plant, &t.light, {.views = 4, .texels = 64, .samples = 2});
  for (const Style style : kDrawn) {
    SCOPED_TRACE(static_cast<int>(style));
    View view = treeView(style);
    view.shadow_cascades = 1;
    const Image alone = renderer().render(view).image;
    renderer().setScene(scene);
    EXPECT_LT(meanFlip(alone, renderer().render(view).image), 0.03);
    // From afar a card stands for it, of about the same colours in the same place.
    view = styledView(160, 160, style);
    view.camera = treeView(style).camera;
    view.camera.eye += 19.0f * (view.camera.eye - view.camera.target);
    view.camera.vertical_fov /= 5.0f;
    view.background = glm::vec3(1.0f);
    renderer().setScene(t.scene(false));
    const Image mesh = renderer().render(view).image;
    forest.kinds[0].levels = &levels;
    renderer().setScene(scene);
    const Image card = renderer().render(view).image;
    forest.kinds[0].levels = nullptr;
    EXPECT_NE(card.rgba, mesh.rgba);
    double of_mesh = 0.0, of_card = 0.0;
    for (int y = 0; y < 160; ++y)
      for (int x = 0; x < 160; ++x) {
        of_mesh += std::max(0.9 - double{valueAt(mesh, x, y)}, 0.0);
        of_card += std::max(0.9 - double{valueAt(card, x, y)}, 0.0);
      }
    EXPECT_GT(of_card, 0.4 * of_mesh);
    EXPECT_LT(of_card, 1.6 * of_mesh);
  }
}

/// The camera and its target moved together, so that the middle of the scene moves by so many
/// pixels to the left.
View movedBy(View view, float pixels) {
  const glm::vec3 ahead = view.camera.target - view.camera.eye;
  const glm::vec3 right = glm::normalize(glm::cross(ahead, glm::vec3(0, 1, 0)));
  const float pixel_m = 2.0f * glm::length(ahead) * std::tan(0.5f * view.camera.vertical_fov) /
                        static_cast<float>(view.height);
  view.camera.eye += right * (pixels * pixel_m);
  view.camera.target += right * (pixels * pixel_m);
  return view;
}

TEST_F(Styles, NothingPopsWhileTheCameraMoves) {
  for (const Style style : kDrawn) {
    SCOPED_TRACE(static_cast<int>(style));
    const View view = treeView(style, true, 128);
    std::vector<double> steps;
    Image last = renderer().render(view).image;
    for (int i = 1; i <= 8; ++i) {
      const Image next = renderer().render(movedBy(view, 0.25f * static_cast<float>(i))).image;
      steps.push_back(meanFlip(last, next));
      last = next;
    }
    // Each quarter of a pixel changes about as much as any other.
    const double mean = std::accumulate(steps.begin(), steps.end(), 0.0) / 8.0;
    for (const double step : steps) {
      EXPECT_LT(step, 1.6 * mean + 1e-3);
      EXPECT_GT(step, 0.5 * mean - 1e-3);
    }
  }
}

}  // namespace
}  // namespace verdure
