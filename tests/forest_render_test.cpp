// Forests: chosen by the GPU, drawn at several levels.
#include "base/random.h"
#include "rays/ray_scene.h"
#include "render/frame.h"
#include "render_fixture.h"
#include "shared/color.h"
#include "verdure/grow.h"
#include "verdure/levels.h"
#include "verdure/motion.h"
#include "verdure/optical_depth.h"

namespace verdure {
namespace {

using namespace test;

struct Kind {
  Plant plant;
  CrownLight light;
  PlantMotion motion;
  PlantLevels levels;
};

Kind makeMaple(const char* levels) {
  Kind made;
  GrowOptions options;
  options.species = "japanese-maple";
  options.seed = 2;
  options.texture_size = 64;
  options.leaf_form = LeafForm::kCard;
  options.set = {{"Levels", levels}};
  made.plant = grow(options);
  made.motion = plantMotion(made.plant, {.texture_width = 512, .texture_height = 256});
  made.light = bakeOpticalDepth(made.plant).light;
  made.levels = makeLevels(made.plant, &made.light);
  return made;
}

/// A small tree with all that a forest asks of it, made once.
const Kind& maple() {
  static const Kind kind = makeMaple("3");
  return kind;
}

/// With all its leaves.
const Kind& fullMaple() {
  static const Kind kind = makeMaple("4");
  return kind;
}

Placement placeAt(const glm::vec3& position, float angle, std::uint32_t phase) {
  Placement place;
  place.position = position;
  place.angle = angle;
  place.phase = phase;
  return place;
}

Forest forestOf(std::vector<Placement> places, bool levels, bool moving,
                const Kind& kind = maple()) {
  Forest forest;
  forest.kinds = {
      {&kind.plant, nullptr, moving ? &kind.motion : nullptr, levels ? &kind.levels : nullptr}};
  forest.places = std::move(places);
  return forest;
}

Scene sceneOf(const Forest& forest) {
  Scene scene;
  scene.ground = false;
  scene.forest = &forest;
  return scene;
}

class ForestRender : public testing::Test {
 protected:
  ForestRender() : device_("", true), drawer_(device_) {}
  ~ForestRender() override { EXPECT_EQ(device_.validationMessages(), 0); }

  GpuScene packed(const Scene& scene) {
    return GpuScene(device_, packScene(scene), drawer_.sceneLayouts());
  }
  Frame draw(const Scene& scene, const View& view) {
    GpuScene on_gpu = packed(scene);
    drawer_.forgetScene();
    return drawer_.draw(on_gpu, view);
  }
  static View view() {
    View view = smallView(160, 120);
    view.hdr = false;
    view.camera = {{1.2f, 1.4f, 9.0f}, {1.2f, 1.1f, 0.0f}, 0.6f};
    view.terms = presetTerms("standard");
    view.exposure.ev = 14.0f;
    view.exposure.white = 4.0f;
    view.shadow_cascades = 1;
    view.background = glm::vec3(0.2f);
    return view;
  }

  gpu::Device device_;
  FrameDrawer drawer_;
};

TEST_F(ForestRender, WithoutLevelsLooksAsItemsDo) {
  for (const auto& [wind, angle] : {std::pair(false, 0.0f), std::pair(true, 1.3f)}) {
    const std::vector<Placement> places{placeAt({0, 0, 0}, 0.0f, 0),
                                        placeAt({2.5f, 0, -1.0f}, angle, 1),
                                        placeAt({-1.5f, 0.2f, -4.0f}, angle, 2)};
    const Forest forest = forestOf(places, false, true);
    Scene items = itemScene(maple().plant, nullptr);
    items.items[0].motion = &maple().motion;
    items.items[0].world_from_plant.clear();
    for (const Placement& place : places)
      items.items[0].world_from_plant.push_back(matrixOf(place));
    View view = this->view();
    view.terms.shadow = false;  // a forest's maps lie elsewhere
    if (wind) view.wind = {.speed = 9.0f, .from = 0.7f, .gusts = 0.5f};
    view.seconds = 3.5;
    const Image expected = draw(items, view).image, seen = draw(sceneOf(forest), view).image;
    // Sines and cosines of a GPU have fewer digits.
    EXPECT_LE(differing(expected, seen, 1), wind ? 20 : 0);
  }
}

/// Of 255.
double meanDifference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

TEST_F(ForestRender, ShadowsAreThoseOfItems) {
  const std::vector<Placement> places{placeAt({0, 0, 0}, 0.0f, 0), placeAt({2.5f, 0, -1}, 0.0f, 1)};
  for (const ShadowSource source : {ShadowSource::kShadowMap, ShadowSource::kDepthOrdered}) {
    const Forest forest = forestOf(places, false, false);
    Scene trees = sceneOf(forest), items = itemScene(maple().plant, nullptr);
    items.items[0].world_from_plant = {matrixOf(places[0]), matrixOf(places[1])};
    items.ground = trees.ground = true;
    View view = this->view();
    view.shadow_map_size = 2048;
    view.terms.shadow_source = source;
    const Image expected = draw(items, view).image, seen = draw(trees, view).image;
    // Other maps, so other edges of shadows.
    EXPECT_LT(meanDifference(expected, seen), 1.5);
  }
}

/// Trees at random places on a square around the origin.
std::vector<Placement> scattered(int count, float side, std::uint64_t seed) {
  Random random(seed);
  std::vector<Placement> places;
  for (int i = 0; i < count; ++i) {
    Placement place = placeAt({random.uniform(-0.5f, 0.5f) * side, random.uniform(-1.0f, 1.0f),
                               random.uniform(-0.5f, 0.5f) * side},
                              random.uniform(0.0f, 6.28f), static_cast<std::uint32_t>(i));
    place.scale = random.uniform(0.7f, 1.4f);
    places.push_back(place);
  }
  return places;
}

TEST_F(ForestRender, ChoosesWhatBruteForceDoes) {
  const Forest forest = forestOf(scattered(1500, 300.0f, 7), true, false);
  GpuScene scene = packed(sceneOf(forest));
  const PackedForest known = packForest(forest);
  const Bounds box = bounds(maple().plant);
  const glm::vec4 sphere(box.center(), 0.5f * glm::length(box.size()));
  Random random(8);
  for (int i = 0; i < 6; ++i) {
    View view = this->view();
    view.width = 96;
    view.height = 64;
    view.camera.eye = {random.uniform(-150.0f, 150.0f), 3.0f, random.uniform(-150.0f, 150.0f)};
    view.camera.target =
        view.camera.eye + glm::vec3(random.uniform(-1.0f, 1.0f), random.uniform(-0.3f, 0.1f),
                                    random.uniform(-1.0f, 1.0f));
    drawer_.draw(scene, view);
    const auto [meshes, far] = scene.forest()->counts();

    const glm::mat4 clip = clipFromWorld(view.camera, 1.5f);
    const float pixels_per_m = 32.0f / std::tan(0.5f * view.camera.vertical_fov);
    const glm::vec4 reach = levelReach(known.kinds[0], pixels_per_m, 1.0f);
    std::uint32_t near_count = 0, far_count = 0;
    for (const shared::ForestPlace& place : known.places) {
      const glm::vec3 middle = shared::forestMiddle(place, sphere);
      bool seen = true;
      const auto row = [&clip](int r) {
        return glm::vec4(clip[0][r], clip[1][r], clip[2][r], clip[3][r]);
      };
      for (const glm::vec4& plane :
           {row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(3)})
        seen = seen && glm::dot(plane, glm::vec4(middle, 1.0f)) / glm::length(glm::vec3(plane)) >=
                           -sphere.w * place.scale;
      if (!seen) continue;
      const shared::ForestLevel level = shared::forestLevel(
          reach, 3, 1, glm::length(middle - view.camera.eye) / place.scale, 1e30f);
      near_count += level.level < 3 ? 1 : 0;
      near_count += level.next != level.level && level.next < 3 ? 1 : 0;
      far_count += level.level == 3 || level.next == 3 ? 1 : 0;
    }
    EXPECT_NEAR(meshes, near_count, 1.0) << i;  // one that lies on a border may go either way
    EXPECT_NEAR(far, far_count, 1.0) << i;
    EXPECT_GT(far_count + near_count, 10u);
  }
}

/// Of a view of the picture, as look() makes it.
shared::ForestView viewOf(const View& view) {
  shared::ForestView data{};
  data.clip =
      clipFromWorld(view.camera, static_cast<float>(view.width) / static_cast<float>(view.height));
  data.width = static_cast<std::uint32_t>(view.width);
  data.height = static_cast<std::uint32_t>(view.height);
  return data;
}

TEST(DepthTiles, HoldAllThatIsSeenOfACylinder) {
  Random random(11);
  int behind = 0, outside = 0;
  for (int i = 0; i < 400; ++i) {
    View view;
    view.width = 200 + i;
    view.height = 120 + 2 * i % 77;
    view.camera = {{random.uniform(-9.0f, 9.0f), 3.0f, random.uniform(-9.0f, 9.0f)},
                   {0.0f, random.uniform(0.0f, 5.0f), 0.0f},
                   random.uniform(0.2f, 1.5f)};
    const shared::ForestView data = viewOf(view);
    const glm::vec3 middle(random.uniform(-30.0f, 30.0f), random.uniform(-5.0f, 9.0f),
                           random.uniform(-30.0f, 30.0f));
    const float radius = random.uniform(0.1f, 4.0f), height = random.uniform(0.1f, 6.0f);
    const shared::DepthTiles tiles = shared::depthTilesOf(data, middle, height, radius);
    if (tiles.depth > 1.0f) {
      ++behind;
      const glm::vec4 w(data.clip[0][3], data.clip[1][3], data.clip[2][3], data.clip[3][3]);
      EXPECT_LT(glm::dot(w, glm::vec4(middle, 1.0f)), 1.01f * (radius + height));
      continue;
    }
    float nearest = 0.0f;
    for (int k = 0; k < 300; ++k) {
      const float turn = random.uniform(0.0f, 6.2832f);
      const glm::vec3 off(radius * std::cos(turn), height * random.uniform(-1.0f, 1.0f),
                          radius * std::sin(turn));
      const glm::vec4 clip = data.clip * glm::vec4(middle + off, 1.0f);
      nearest = std::max(nearest, clip.z / clip.w);
      const glm::vec2 at =
          (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(data.width, data.height);
      if (at.x < 0.0f || at.y < 0.0f || at.x >= float(data.width) || at.y >= float(data.height)) {
        ++outside;
        continue;
      }
      const auto x = static_cast<std::uint32_t>(at.x) / 8,
                 row = static_cast<std::uint32_t>(at.y) / 8;
      EXPECT_TRUE(x >= tiles.first_x && x < tiles.end_x && row >= tiles.first_y &&
                  row < tiles.end_y);
    }
    EXPECT_LE(nearest, tiles.depth * 1.00001f);
  }
  EXPECT_GT(behind, 20);
  EXPECT_GT(outside, 1000);
}

TEST_F(ForestRender, WhatOthersHideIsLeftOut) {
  const Plant wall = whiteQuad();  // 2 m a side
  Forest forest = forestOf(scattered(700, 90.0f, 12), true, true);
  forest.kinds.push_back({&wall, nullptr, nullptr, nullptr});
  Placement stands = placeAt({0.4f, 1.2f, 48.0f}, 0.0f, 9000);
  stands.plant = 1;
  stands.scale = 1.5f;
  forest.places.push_back(stands);
  GpuScene scene = packed(sceneOf(forest));
  View view = this->view();
  view.camera = {{0.0f, 1.5f, 54.0f}, {0.0f, 1.0f, 0.0f}, 0.7f};
  view.wind = {.speed = 7.0f, .from = 0.4f, .gusts = 0.5f};
  view.seconds = 2.0;
  view.background.reset();
  scene.forest()->tryAll(true);
  const Image all = drawer_.draw(scene, view).image;
  const auto [meshes, far] = scene.forest()->counts();
  scene.forest()->tryAll(false);
  const Image seen = drawer_.draw(scene, view).image;
  const auto [seen_meshes, seen_far] = scene.forest()->counts();
  EXPECT_EQ(all.rgba, seen.rgba);
  EXPECT_LE(seen_meshes, meshes);

  // What lies behind the wall with a tile around is gone; what looks out from behind it is not.
  const shared::ForestView data = viewOf(view);
  const auto corner = [&](float x, float y) {
    const glm::vec4 clip =
        data.clip * glm::vec4(stands.position + 1.5f * glm::vec3(x, y, 0.0f), 1.0f);
    return (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(data.width, data.height) / 8.0f;
  };
  const glm::vec2 low = glm::min(corner(-1, -1), corner(1, 1)),
                  high = glm::max(corner(-1, -1), corner(1, 1));
  const Bounds rest = bounds(maple().plant);
  std::uint32_t hidden = 0;
  for (const Placement& place : forest.places) {
    if (place.plant != 0) continue;
    const shared::DepthTiles tiles = shared::depthTilesOf(
        data, place.position + place.scale * glm::vec3(0.0f, rest.center().y, 0.0f),
        0.6f * place.scale * rest.size().y, 0.8f * place.scale * glm::length(rest.size()));
    hidden += tiles.depth < 1.0f && place.position.z < 40.0f &&
                      float(tiles.first_x) > low.x + 1.0f && float(tiles.first_y) > low.y + 1.0f &&
                      float(tiles.end_x) < high.x - 1.0f && float(tiles.end_y) < high.y - 1.0f
                  ? 1
                  : 0;
  }
  EXPECT_GT(hidden, 20u);
  EXPECT_GE(meshes + far - seen_meshes - seen_far, hidden);
}

TEST_F(ForestRender, HidingChangesNoPicture) {
  const Plant wall = whiteQuad();
  Forest forest = forestOf(scattered(400, 110.0f, 13), true, true);
  forest.kinds.push_back({&wall, nullptr, nullptr, nullptr});
  for (std::size_t i = 0; i < forest.places.size(); i += 10) {
    forest.places[i].plant = 1;
    forest.places[i].scale = 5.0f;
  }
  GpuScene scene = packed(sceneOf(forest));
  Random random(14);
  std::uint32_t hidden = 0;
  for (int i = 0; i < 3; ++i) {
    View view = this->view();
    view.width = 120;
    view.height = 90;
    view.wind = {.speed = 6.0f};
    view.seconds = 1.0 + i;
    view.camera.eye = {random.uniform(-30.0f, 30.0f), random.uniform(1.0f, 4.0f),
                       random.uniform(-30.0f, 30.0f)};
    view.camera.target =
        view.camera.eye + glm::vec3(random.uniform(-1.0f, 1.0f), 0.0f, random.uniform(-1.0f, 1.0f));
    scene.forest()->tryAll(true);
    const Image all = drawer_.draw(scene, view).image;
    const auto [meshes, far] = scene.forest()->counts();
    scene.forest()->tryAll(false);
    EXPECT_EQ(all.rgba, drawer_.draw(scene, view).image.rgba) << i;
    const auto [seen_meshes, seen_far] = scene.forest()->counts();
    hidden += meshes + far - seen_meshes - seen_far;
  }
  EXPECT_GT(hidden, 10u);
}

TEST_F(ForestRender, FarTreesComeFromWhereNearOnesDo) {
  // A flag of a trunk, so that cards, which are flat and bend as trunks do, can be as exact as
  // meshes.
  Plant post = whiteQuad();
  post.meshes[0] = {};
  for (int i = 0; i < 40; ++i)
    addQuad(post.meshes[0], {0, 0.05f * float(i), 0}, {0.4f, 0, 0}, {0, 0.05f, 0});
  post.meshes[0].kind = PartKind::kFoliage;
  post.meshes[0].branch_of_vertex.assign(post.meshes[0].positions.size(), 0);
  post.branches = {{.points = {{{0, 0, 0}, 0.05f}, {{0, 2, 0}, 0.02f}}}};
  const PlantMotion bends =
      plantMotion(post, {.flexibility = 100.0f, .texture_width = 512, .texture_height = 256});
  PlantLevels levels;
  levels.impostor = bakeImpostor(post, nullptr, {.views = 9, .texels = 64, .samples = 4});
  Forest forest;
  forest.kinds = {{&post, nullptr, &bends, &levels}};
  forest.places = {placeAt({0.3f, 0.0f, 0.0f}, 0.0f, 3)};
  View view = this->view();
  view.camera = {{0.0f, 1.0f, 14.0f}, {0.0f, 1.0f, 0.0f}, 0.2f};
  view.last = {
      {{0.05f, 1.02f, 14.0f}, {0.0f, 1.0f, 0.0f}, 0.2f}, {.speed = 5.0f, .from = 0.3f}, 2.0};
  view.wind = {.speed = 9.0f, .from = 1.6f};
  view.seconds = 2.4;
  Frame frames[2];
  for (const int far : {0, 1}) {
    forest.detail = far == 1 ? 0.001f : 100.0f;
    frames[far] = draw(sceneOf(forest), view);
  }
  const std::vector<glm::vec2>&near = frames[0].motion, &far = frames[1].motion;
  int both = 0, one = 0;
  float longest = 0.0f;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const bool in_near = glm::length(near[i] - near[0]) > 0.3f;
    const bool in_far = glm::length(far[i] - far[0]) > 0.3f;
    one += in_near != in_far ? 1 : 0;
    if (!in_near || !in_far) continue;
    ++both;
    // A card bends in four straight pieces, so what leans rises a little otherwise.
    EXPECT_NEAR(near[i].x, far[i].x, 0.25f) << i;
    EXPECT_NEAR(near[i].y, far[i].y, 1.2f) << i;
    longest = std::max(longest, glm::length(near[i] - near[0]));
  }
  EXPECT_GT(both, 500);
  EXPECT_LT(one, both / 5);  // the border, covered in part
  EXPECT_GT(longest, 2.0f);
}

TEST(PackedForest, KnowsHowFarItsTreesAreFew) {
  const Forest forest = forestOf(scattered(5000, 500.0f, 9), true, false);
  const PackedForest packed = packForest(forest);
  std::size_t members = 0;
  for (std::size_t c = 0; c < packed.clusters.size(); ++c)
    for (std::size_t i = c * shared::kForestGroup;
         i < std::min<std::size_t>((c + 1) * shared::kForestGroup, packed.places.size()); ++i) {
      const shared::ForestPlace& p = packed.places[i];
      EXPECT_LE(glm::length(glm::vec3(p.x, p.y, p.z) - glm::vec3(packed.clusters[c])),
                packed.clusters[c].w * 1.0001f + 1e-4f);
      ++members;
    }
  EXPECT_EQ(members, 5000u);
  for (const glm::vec3& eye : {glm::vec3(0.0f), glm::vec3(250.0f, 2.0f, 250.0f)})
    for (const std::uint32_t most : {300u, 1000u, 4000u}) {
      const float reach = distanceOfNearest(packed, eye, most);
      std::uint32_t near = 0;
      for (const Placement& place : forest.places)
        near += glm::length(place.position - eye) < reach ? 1 : 0;
      EXPECT_LE(near, most);
      EXPECT_EQ(near, most);
    }
  EXPECT_GT(distanceOfNearest(packed, glm::vec3(0.0f), 5000), 1e30f);
}

TEST(PackedForest, RefusesWhatIsWrong) {
  Forest forest = forestOf(scattered(3, 10.0f, 1), true, false);
  forest.places[1].plant = 4;
  EXPECT_THROW(packForest(forest), Error);
  forest = forestOf(scattered(3, 10.0f, 1), true, false);
  forest.places[0].scale = 0.0f;
  EXPECT_THROW(packForest(forest), Error);
  forest = forestOf(scattered(3, 10.0f, 1), true, false);
  forest.detail = -1.0f;
  EXPECT_THROW(packForest(forest), Error);
  forest.detail = 1.0f;
  forest.kinds[0].plant = nullptr;
  EXPECT_THROW(packForest(forest), Error);
}

TEST_F(ForestRender, IsTheSameEachTime) {
  const Forest forest = forestOf(scattered(600, 120.0f, 3), true, true);
  View view = this->view();
  view.wind = {.speed = 6.0f};
  view.seconds = 2.0;
  view.background.reset();
  const Image one = draw(sceneOf(forest), view).image, two = draw(sceneOf(forest), view).image;
  EXPECT_EQ(one.rgba, two.rgba);
}

TEST_F(ForestRender, TreesTakeAtMost64BytesEach) {
  const Plant quad = whiteQuad();
  PlantLevels levels;
  levels.impostor = bakeImpostor(quad, nullptr, {.views = 2, .texels = 16, .samples = 1});
  Forest forest;
  for (int k = 0; k < 4; ++k) forest.kinds.push_back({&quad, nullptr, nullptr, &levels});
  forest.places = scattered(100000, 5000.0f, 4);
  for (std::size_t i = 0; i < forest.places.size(); ++i)
    forest.places[i].plant = static_cast<std::uint32_t>(i % 4);
  GpuScene scene = packed(sceneOf(forest));
  EXPECT_LE(scene.forest()->bytes() / forest.places.size(), 64u);
}

/// Square metres (seen at the distance of the trees) that a picture's trees cover. They are drawn
/// black before white.
double coveredShare(const Image& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    sum += 1.0 - double{shared::linearFromSrgb(static_cast<float>(image.rgba[i]) / 255.0f)};
  return sum / static_cast<double>(image.rgba.size() / 4);
}

TEST_F(ForestRender, FarTreesCoverWhatNearOnesDo) {
  // As in a picture 1080 pixels high with a field of view of 34 degrees.
  constexpr float kPixelsPerM = 1745.0f;
  const float height_m = bounds(maple().plant).max.y;
  for (const float distance : {10.0f, 25.0f, 60.0f, 150.0f, 400.0f, 1000.0f}) {
    std::vector<Placement> places;
    const int count = distance < 20.0f ? 1 : distance < 100.0f ? 3 : 24;
    for (int i = 0; i < count; ++i)
      places.push_back(
          placeAt({1.6f * height_m * (static_cast<float>(i) - 0.5f * static_cast<float>(count - 1)),
                   0.0f, -distance},
                  0.7f * static_cast<float>(i), static_cast<std::uint32_t>(i)));
    View view = this->view();
    const float pixels = kPixelsPerM / distance;
    view.height = static_cast<int>(1.3f * height_m * pixels) + 2;
    view.width = static_cast<int>(1.7f * height_m * pixels * static_cast<float>(count)) + 2;
    view.camera.eye = glm::vec3(0.0f, 0.5f * height_m, 0.0f);
    view.camera.target = glm::vec3(0.0f, 0.5f * height_m, -distance);
    view.camera.vertical_fov =
        2.0f * std::atan(0.5f * static_cast<float>(view.height) / kPixelsPerM);
    view.background = glm::vec3(1.0f);
    view.bloom = 0.0f;
    view.terms.ambient = view.terms.diffuse = view.terms.specular = view.terms.shadow = false;
    // Where few pixels see a tree it matters how they lie on it: the mean over that counts.
    const int tries = distance < 300.0f ? 1 : 32;
    const Forest forest = forestOf(places, true, false);
    GpuScene on_gpu = packed(sceneOf(forest));
    drawer_.forgetScene();
    double seen = 0.0;
    for (int i = 0; i < tries; ++i) {
      const glm::vec2 shift =
          glm::fract(glm::vec2(0.754878f, 0.569840f) * static_cast<float>(i)) / pixels;
      view.camera.eye = glm::vec3(shift.x, 0.5f * height_m + shift.y, 0.0f);
      view.camera.target = view.camera.eye - glm::vec3(0.0f, 0.0f, distance);
      seen += coveredShare(drawer_.draw(on_gpu, view).image) / tries;
    }

    Scene truth = itemScene(maple().plant, nullptr);
    truth.items[0].world_from_plant.clear();
    for (const Placement& place : places)
      truth.items[0].world_from_plant.push_back(matrixOf(place));
    const RayScene rays(truth);
    const CameraRays camera =
        cameraRays(view.camera, static_cast<float>(view.width) / static_cast<float>(view.height));
    Random random(5);
    constexpr int kRays = 200000;
    int hits = 0;
    for (int i = 0; i < kRays; ++i) {
      const glm::vec2 at(random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
      Ray ray;
      ray.origin = camera.eye;
      ray.direction = camera.forward + at.x * camera.right + at.y * camera.down;
      hits += rays.occluded(ray) ? 1 : 0;
    }
    const double covered = static_cast<double>(hits) / kRays;
    EXPECT_NEAR(seen / covered, 1.0, 0.03) << distance << " m, " << view.width << "x" << view.height
                                           << ": " << seen << " of " << covered;
  }
}

TEST_F(ForestRender, FarTreesAreAsBrightAsNearOnes) {
  const float height_m = bounds(fullMaple().plant).max.y;
  std::vector<std::unique_ptr<GpuScene>> scenes;  // near, far
  for (const float detail : {100.0f, 0.001f}) {
    Forest forest = forestOf({placeAt({0, 0, 0}, 0.4f, 0)}, true, false, fullMaple());
    forest.kinds[0].light = &fullMaple().light;
    forest.detail = detail;
    scenes.push_back(
        std::make_unique<GpuScene>(device_, packScene(sceneOf(forest)), drawer_.sceneLayouts()));
  }
  for (const char* preset : {"standard", "best"})
    for (const float azimuth : {0.0f, 1.6f, 3.1f}) {
      View view = this->view();
      view.width = view.height = 128;
      view.hdr = true;
      view.terms = presetTerms(preset);
      if (view.terms.ambient_source == AmbientSource::kTransfer)
        view.terms.ambient_source = AmbientSource::kBaked;
      view.background = glm::vec3(0.0f);
      view.shadow_map_size = 1024;
      turnSun(view, azimuth, 0.7f);
      view.camera = {{0.0f, 0.8f * height_m, 3.0f * height_m}, {0.0f, 0.5f * height_m, 0.0f}, 0.4f};
      double light[2] = {};
      for (const std::size_t far : {0u, 1u}) {
        drawer_.forgetScene();
        const Frame frame = drawer_.draw(*scenes[far], view);
        for (int y = 0; y < view.height; ++y)
          for (int x = 0; x < view.width; ++x) light[far] += double{luminanceAt(frame.hdr, x, y)};
      }
      // Light through leaves and their gloss are known on the mean only.
      EXPECT_NEAR(light[1] / light[0], 1.0, std::string(preset) == "best" ? 0.2 : 0.06)
          << preset << ", sun at " << azimuth;
    }
}

}  // namespace
}  // namespace verdure
