// Plants in wind on the GPU.
#include <glm/gtc/matrix_transform.hpp>

#include "motion/motion_tables.h"
#include "render_fixture.h"
#include "verdure/compare.h"
#include "verdure/grow.h"
#include "verdure/motion.h"

namespace verdure {
namespace {

using namespace test;

const Wind kFresh{.speed = 9.0f, .from = 0.7f, .gusts = 0.5f};

/// A small tree with all that moves: three levels of branches, leaves as cards.
Plant smallTree() {
  GrowOptions options;
  options.species = "japanese-maple";
  options.seed = 2;
  options.texture_size = 32;
  options.leaf_form = LeafForm::kCard;
  return grow(options);
}

class WindRender : public testing::Test {
 protected:
  WindRender() : renderer_({.device = "", .validation = true}) {}
  ~WindRender() override { EXPECT_EQ(renderer_.validationMessages(), 0); }

  static const Plant& tree() {
    static const Plant plant = smallTree();
    return plant;
  }
  static const PlantMotion& motion() {
    static const PlantMotion known =
        plantMotion(tree(), {.texture_width = 512, .texture_height = 256});
    return known;
  }
  /// Two of them, one turned, mirrored and larger.
  static std::vector<glm::mat4> places() {
    glm::mat4 other = glm::translate(glm::mat4(1.0f), glm::vec3(2.5f, 0.0f, -1.0f));
    other = glm::rotate(other, 1.1f, glm::vec3(0, 1, 0));
    other = glm::scale(other, glm::vec3(-1.3f, 1.3f, 1.3f));
    return {glm::mat4(1.0f), other};
  }
  static View view() {
    View view = smallView(160, 120);
    view.hdr = false;
    view.camera = {{1.2f, 1.4f, 7.0f}, {1.2f, 1.1f, 0.0f}, 0.6f};
    view.terms = presetTerms("standard");
    view.exposure.ev = 14.0f;
    view.exposure.white = 4.0f;
    view.shadow_cascades = 1;
    return view;
  }
  static Scene movingScene() {
    Scene scene = itemScene(tree(), nullptr);
    scene.items[0].world_from_plant = places();
    scene.items[0].motion = &motion();
    scene.ground = true;
    return scene;
  }
  Image draw(const Scene& scene, const View& view) {
    renderer_.setScene(scene);
    return renderer_.render(view).image;
  }

  Renderer renderer_;
};

TEST_F(WindRender, WithoutWindIsThePictureAtRestToTheBit) {
  View still = view();
  Scene rest = movingScene();
  rest.items[0].motion = nullptr;
  const Image expected = draw(rest, still);
  still.seconds = 123.0;
  EXPECT_EQ(draw(movingScene(), still).rgba, expected.rgba);
}

TEST_F(WindRender, DependsOnTimeAlone) {
  View moving = view();
  moving.wind = kFresh;
  moving.seconds = 4.25;
  const Image first = draw(movingScene(), moving);
  moving.seconds = 99.0;
  const Image other = renderer_.render(moving).image;
  EXPECT_GT(differing(first, other, 8), 1000);
  moving.seconds = 4.25;
  EXPECT_EQ(renderer_.render(moving).image.rgba, first.rgba);
}

// The same picture from a plant that the CPU has moved: colour, shadow and light depth passes agree
// with it and with each other.
TEST_F(WindRender, AllPassesAgreeWithTheCpu) {
  View moving = view();
  moving.wind = kFresh;
  moving.seconds = 17.5;
  // The sun's map lies around all that may move; specks in its corners make it the same for all.
  Plant specks = whiteQuad();
  specks.meshes[0] = {};
  const Bounds box = movedBounds(motion(), moving.wind);
  for (int corner = 0; corner < 8; ++corner)
    addQuad(specks.meshes[0],
            {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
             corner & 4 ? box.max.z : box.min.z},
            {1e-6f, 0, 0}, {0, 1e-6f, 0});
  for (const glm::mat4& place : places()) {
    Plant moved = tree();
    movePlant(motion(), moving.wind, moving.seconds, {place, 0}, moved);
    const auto sceneOf = [&](const Plant& plant, const PlantMotion* motion) {
      Scene scene = itemScene(plant, nullptr);
      scene.items[0].world_from_plant = {place};
      scene.items[0].motion = motion;
      scene.ground = true;
      scene.items.push_back({&specks, nullptr, {place}});
      return scene;
    };
    for (const char* light : {"standard", "depth-maps", "habel"}) {
      View lit = moving;
      lit.terms = presetTerms(light);
      const Image gpu = draw(sceneOf(tree(), &motion()), lit);
      const Image cpu = draw(sceneOf(moved, nullptr), lit);
      const Image still = draw(sceneOf(tree(), nullptr), lit);
      EXPECT_GT(differing(gpu, still, 8), 800) << light;
      EXPECT_LT(meanFlip(gpu, cpu), 0.05 * meanFlip(gpu, still)) << light;
      EXPECT_LT(differing(gpu, cpu, 8), differing(gpu, still, 8) / 20) << light;
    }
  }
}

// Each item and place finds its own among the others': a still one first, then two kinds that
// move, at two places each.
TEST_F(WindRender, ManyItemsMoveAsEachAlone) {
  GrowOptions options;
  options.species = "silver-birch";
  options.seed = 5;
  options.texture_size = 32;
  options.leaf_form = LeafForm::kCard;
  options.set = {{"Levels", "2"}};
  const Plant birch = grow(options);
  MotionOptions small;
  small.texture_width = 512;
  small.texture_height = 256;
  const PlantMotion birch_motion = plantMotion(birch, small);
  const auto placed = [](float x, float z, float turn, float size) {
    return glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(x, 0.0f, z)), turn,
                                  glm::vec3(0, 1, 0)),
                      glm::vec3(size));
  };
  const std::vector<glm::mat4> maples{placed(-2, 0, 0, 1), placed(3, 0, 1, 1)},
      birches{placed(-4, -6, 2, 0.4f), placed(2, -6, 4, 0.4f)};
  View windy = view();
  windy.wind = kFresh;
  windy.seconds = 31.0;
  windy.camera = {{0.0f, 3.0f, 14.0f}, {0.0f, 2.0f, 0.0f}, 0.6f};
  windy.terms.shadow = false;  // maps of the sun lie around what may move
  const Plant post = standingTube(0.2f, 0.0f, 2.0f);
  Scene blown, still;
  for (Scene* scene : {&blown, &still}) {
    scene->ground = true;
    scene->items = {{&post, nullptr}, {&tree(), nullptr, maples}, {&birch, nullptr, birches}};
  }
  blown.items[1].motion = &motion();
  blown.items[2].motion = &birch_motion;
  // By the CPU; the post is the scene's first place, so the others' numbers are 1 to 4.
  const auto movedBy = [&](const std::array<std::uint32_t, 4>& numbers) {
    std::vector<Plant> plants;
    for (std::size_t k = 0; k < 4; ++k) {
      plants.push_back(k < 2 ? tree() : birch);
      movePlant(k < 2 ? motion() : birch_motion, windy.wind, windy.seconds,
                {k < 2 ? maples[k] : birches[k - 2], numbers[k]}, plants.back());
    }
    Scene scene;
    scene.ground = true;
    scene.items = {{&post, nullptr}};
    for (std::size_t k = 0; k < 4; ++k)
      scene.items.push_back({&plants[k], nullptr, {k < 2 ? maples[k] : birches[k - 2]}});
    return draw(scene, windy);
  };
  const Image gpu = draw(blown, windy), rest = draw(still, windy);
  const double off = meanFlip(gpu, movedBy({1, 2, 3, 4}));
  // Edges of leaves that are cut out are drawn by their number in the scene, which differs: so much
  // is off at rest, too.
  windy.wind.speed = 0.0f;
  const double floor = meanFlip(rest, movedBy({1, 2, 3, 4}));
  windy.wind = kFresh;
  EXPECT_LT(off, 1.25 * floor);
  EXPECT_LT(off, 0.2 * meanFlip(gpu, rest));
  EXPECT_LT(off, 0.5 * meanFlip(gpu, movedBy({2, 1, 4, 3})));
}

TEST_F(WindRender, TreesOfOneKindAreNotInUnison) {
  const auto first = branchAmplitudes(motion(), kFresh, 5.0, {glm::mat4(1.0f), 0});
  const auto second = branchAmplitudes(motion(), kFresh, 5.0, {glm::mat4(1.0f), 1});
  double ab = 0, aa = 0, bb = 0;
  glm::dvec2 mean_a(0), mean_b(0);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ab += double{glm::dot(first[i], second[i])};
    aa += double{glm::dot(first[i], first[i])};
    bb += double{glm::dot(second[i], second[i])};
  }
  // What they share is where the wind blows to.
  EXPECT_LT(ab / std::sqrt(aa * bb), 0.8);
}

/// The plant's projected vertices, pixels.
glm::vec2 seenAt(const Camera& camera, const View& view, const glm::vec3& p) {
  const glm::vec4 clip =
      clipFromWorld(camera, float(view.width) / float(view.height)) * glm::vec4(p, 1.0f);
  return (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(view.width, view.height);
}

// A post that bends: what moved where is known from the CPU.
TEST_F(WindRender, MotionVectorsSayWhereThingsCameFrom) {
  Plant post = whiteQuad();
  post.meshes[0] = {};
  post.meshes[0].kind = PartKind::kWood;
  for (int i = 0; i < 40; ++i)
    addQuad(post.meshes[0], {0, 0.05f * float(i), 0}, {0.4f, 0, 0}, {0, 0.05f, 0});
  post.meshes[0].branch_of_vertex.assign(post.meshes[0].positions.size(), 0);
  post.branches = {{.points = {{{0, 0, 0}, 0.05f}, {{0, 2, 0}, 0.02f}}}};
  const PlantMotion bends =
      plantMotion(post, {.flexibility = 100.0f, .texture_width = 512, .texture_height = 256});
  Scene scene = itemScene(post, nullptr);
  scene.items[0].motion = &bends;
  scene.ground = true;
  View now = view();
  now.camera = {{0.1f, 1.0f, 6.0f}, {0.0f, 1.0f, 0.0f}, 0.5f};
  now.wind = kFresh;
  now.seconds = 3.0;
  now.last = {{{0.0f, 1.0f, 6.0f}, {0.0f, 1.0f, 0.0f}, 0.5f}, {.speed = 0.0f}, 2.9};
  renderer_.setScene(scene);
  const Frame frame = renderer_.render(now);
  ASSERT_EQ(frame.motion.size(), frame.image.rgba.size() / 4);
  Plant here = post, there = post;
  movePlant(bends, now.wind, now.seconds, {}, here);
  movePlant(bends, now.last->wind, now.last->seconds, {}, there);
  float longest = 0.0f;
  for (std::size_t v = 0; v < post.meshes[0].positions.size(); v += 4) {
    // The middle of each piece.
    glm::vec3 a(0.0f), b(0.0f);
    for (std::size_t c = 0; c < 4; ++c) {
      a += 0.25f * here.meshes[0].positions[v + c];
      b += 0.25f * there.meshes[0].positions[v + c];
    }
    const glm::vec2 at = seenAt(now.camera, now, a), was = seenAt(now.last->camera, now, b);
    const glm::vec2 got =
        frame.motion[std::size_t(at.y) * std::size_t(now.width) + std::size_t(at.x)];
    // A pixel's centre is up to half a pixel away from the point; neighbours move nearly alike.
    EXPECT_NEAR(got.x, at.x - was.x, 0.15f) << v;
    EXPECT_NEAR(got.y, at.y - was.y, 0.15f) << v;
    longest = std::max(longest, glm::length(at - was));
  }
  EXPECT_GT(longest, 3.0f);
  // The ground stands still: only the camera moved.
  const glm::vec3 spot(0.8f, 0.0f, 2.0f);
  const glm::vec2 at = seenAt(now.camera, now, spot);
  const glm::vec2 way = at - seenAt(now.last->camera, now, spot);
  const glm::vec2 got =
      frame.motion[std::size_t(at.y) * std::size_t(now.width) + std::size_t(at.x)];
  EXPECT_NEAR(got.x, way.x, 0.1f);
  EXPECT_NEAR(got.y, way.y, 0.1f);
}

TEST_F(WindRender, RefusesNonsense) {
  View bad = view();
  renderer_.setScene(movingScene());
  for (const float speed : {-1.0f, 500.0f, std::nanf("")}) {
    bad.wind.speed = speed;
    EXPECT_THROW(renderer_.render(bad), Error);
  }
  bad = view();
  bad.seconds = std::nan("");
  EXPECT_THROW(renderer_.render(bad), Error);
  const Plant quad = whiteQuad();
  Scene other = itemScene(quad, nullptr);
  other.items[0].motion = &motion();
  EXPECT_THROW(renderer_.setScene(other), Error);
}

}  // namespace
}  // namespace verdure
