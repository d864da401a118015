#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "app/plant_prep.h"
#include "app/view/background_job.h"
#include "app/view/fly_camera.h"
#include "app/view/orbit_camera.h"
#include "app/view/settings_history.h"
#include "app/view/shown_scene.h"
#include "app/view/surface_overlay.h"
#include "scene/camera.h"
#include "verdure/grow.h"

namespace verdure::app {
namespace {

using namespace std::chrono_literals;

float distanceOf(const Camera& camera) {
  return glm::length(camera.eye - camera.target);
}

/// Where a point lies in the picture: (0, 0) the middle, (1, 1) bottom right.
glm::vec2 inPicture(const Camera& camera, const glm::vec3& p, float aspect = 1.5f) {
  const glm::vec4 clip = clipFromWorld(camera, aspect) * glm::vec4(p, 1.0f);
  return glm::vec2(clip) / clip.w;
}

const Camera kCamera{{3.0f, 2.0f, 7.0f}, {0.5f, 1.5f, -0.5f}, 0.7f};

TEST(OrbitCamera, KeepsTargetAndDistance) {
  for (const float turn : {-2.0f, -0.1f, 0.0f, 0.4f, 3.0f})
    for (const float rise : {-5.0f, -0.3f, 0.0f, 0.2f, 5.0f}) {
      const Camera moved = orbited(kCamera, turn, rise);
      EXPECT_EQ(moved.target, kCamera.target);
      EXPECT_EQ(moved.vertical_fov, kCamera.vertical_fov);
      EXPECT_NEAR(distanceOf(moved), distanceOf(kCamera), 1e-4f);
      const float elevation = std::asin((moved.eye.y - moved.target.y) / distanceOf(moved));
      EXPECT_LE(std::abs(elevation), kMostOrbitElevation + 1e-4f);
      EXPECT_LT(glm::length(inPicture(moved, moved.target)), 1e-4f);
    }
}

TEST(OrbitCamera, WholeTurnsAndReturnsAreNoMove) {
  EXPECT_LT(glm::length(orbited(kCamera, 6.2831853f, 0.0f).eye - kCamera.eye), 1e-4f);
  const Camera back = orbited(orbited(kCamera, 0.7f, 0.2f), -0.7f, -0.2f);
  EXPECT_LT(glm::length(back.eye - kCamera.eye), 1e-4f);
}

TEST(OrbitCamera, TurnsAgainstTheClockSeenFromAbove) {
  const Camera south{{0.0f, 0.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, 0.7f};
  const Camera east = orbited(south, 1.5707963f, 0.0f);
  EXPECT_LT(glm::length(east.eye - glm::vec3(5.0f, 0.0f, 0.0f)), 1e-4f);
  EXPECT_GT(orbited(south, 0.0f, 0.5f).eye.y, 1.0f);
}

TEST(OrbitCamera, WhatIsAtTheTargetFollowsAPan) {
  // A quarter of the picture's height to the right and a tenth down: twice that in [-1, 1].
  const float aspect = 1.5f;
  const Camera moved = panned(kCamera, 0.25f, 0.1f);
  const glm::vec2 at = inPicture(moved, kCamera.target, aspect);
  EXPECT_NEAR(at.x, 2.0f * 0.25f / aspect, 1e-4f);
  EXPECT_NEAR(at.y, 2.0f * 0.1f, 1e-4f);
  EXPECT_NEAR(distanceOf(moved), distanceOf(kCamera), 1e-5f);
}

TEST(OrbitCamera, ZoomKeepsTheDirectionAndItsLimits) {
  const Camera nearer = zoomed(kCamera, 0.5f, 0.1f, 100.0f);
  EXPECT_NEAR(distanceOf(nearer), 0.5f * distanceOf(kCamera), 1e-4f);
  EXPECT_LT(glm::length(glm::normalize(nearer.eye - nearer.target) -
                        glm::normalize(kCamera.eye - kCamera.target)),
            1e-5f);
  EXPECT_NEAR(distanceOf(zoomed(kCamera, 1e-9f, 0.1f, 100.0f)), 0.1f, 1e-4f);
  EXPECT_NEAR(distanceOf(zoomed(kCamera, 1e9f, 0.1f, 100.0f)), 100.0f, 1e-2f);
}

TEST(FlyCamera, LooksAroundWithoutMoving) {
  const Camera turned = lookedAround(kCamera, 0.3f, 0.1f);
  EXPECT_EQ(turned.eye, kCamera.eye);
  EXPECT_NEAR(distanceOf(turned), distanceOf(kCamera), 1e-4f);
  // What was in the middle goes to the left and down.
  const glm::vec2 at = inPicture(turned, kCamera.target);
  EXPECT_LT(at.x, 0.0f);
  EXPECT_GT(at.y, 0.0f);
  EXPECT_LT(glm::length(lookedAround(turned, -0.3f, -0.1f).target - kCamera.target), 1e-4f);
}

TEST(FlyCamera, FliesAlongItsAxes) {
  const Camera moved = flown(kCamera, 1.0f, 2.0f, 3.0f);
  const glm::vec3 step = moved.eye - kCamera.eye;
  EXPECT_LT(glm::length(moved.target - kCamera.target - step), 1e-5f);
  const glm::vec3 forward = glm::normalize(kCamera.target - kCamera.eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  EXPECT_NEAR(glm::dot(step, right), 1.0f, 1e-4f);
  EXPECT_NEAR(glm::dot(step - 2.0f * glm::vec3(0, 1, 0), forward), 3.0f, 1e-4f);
}

/// An octahedron around the origin, counter-clockwise from outside.
Surface octahedron() {
  Surface surface;
  surface.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  surface.normals = surface.positions;
  surface.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return surface;
}

TEST(SurfaceOverlay, ShowsTheSidesThatFaceTheEye) {
  const Camera camera{{0.0f, 0.0f, 5.0f}, {0.0f, 0.0f, 0.0f}, 0.8f};
  const auto triangles = overlayTriangles(octahedron(), glm::mat4(1.0f), camera, 1.0f);
  EXPECT_EQ(triangles.size(), 4u);  // those around +Z
  for (const OverlayTriangle& triangle : triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GT(triangle.corners[c].x, 0.0f);
      EXPECT_LT(triangle.corners[c].x, 1.0f);
      const bool middle = glm::length(triangle.corners[c] - glm::vec2(0.5f)) < 1e-4f;
      EXPECT_NEAR(triangle.facing[c], middle ? 1.0f : 0.0f, 1e-5f);
    }
}

TEST(SurfaceOverlay, LeavesOutWhatIsBehindOrBeside) {
  const Camera away{{0.0f, 0.0f, 5.0f}, {0.0f, 0.0f, 10.0f}, 0.8f};
  EXPECT_TRUE(overlayTriangles(octahedron(), glm::mat4(1.0f), away, 1.0f).empty());
  const Camera beside{{0.0f, 0.0f, 5.0f}, {20.0f, 0.0f, 0.0f}, 0.4f};
  EXPECT_TRUE(overlayTriangles(octahedron(), glm::mat4(1.0f), beside, 1.0f).empty());
}

/// Polls until nothing is under way, at most some seconds.
bool finishes(BackgroundJob& job) {
  for (int i = 0; i < 2000 && job.busy(); ++i) {
    job.poll();
    std::this_thread::sleep_for(2ms);
  }
  return !job.busy();
}

TEST(BackgroundJob, HandsItsResultOverOnTheCallersThread) {
  BackgroundJob job;
  std::thread::id worker, handed;
  job.start("work", [&](BackgroundJob::Control& control) {
    worker = std::this_thread::get_id();
    control.handOver([&] { handed = std::this_thread::get_id(); });
  });
  EXPECT_TRUE(finishes(job));
  EXPECT_EQ(handed, std::this_thread::get_id());
  EXPECT_NE(worker, handed);
}

TEST(BackgroundJob, TheNewestRequestWins) {
  BackgroundJob job;
  std::atomic<bool> go = false, runs = false;
  std::vector<int> done;
  for (int n = 0; n < 5; ++n) {
    job.start("work", [&, n](BackgroundJob::Control& control) {
      runs = true;
      while (!go) std::this_thread::sleep_for(1ms);
      control.handOver([&done, n] { done.push_back(n); });
    });
    if (n == 0)
      while (!runs) std::this_thread::sleep_for(1ms);
  }
  go = true;
  EXPECT_TRUE(finishes(job));
  // The first ran already; of those that waited only the last was done.
  EXPECT_EQ(done, (std::vector<int>{0, 4}));
}

TEST(BackgroundJob, GivesWayOnlyWhereItSaysSo) {
  BackgroundJob job;
  std::atomic<int> stage = 0;
  std::vector<std::string> done;
  job.start("old", [&](BackgroundJob::Control& control) {
    stage = 1;
    while (stage == 1) std::this_thread::sleep_for(1ms);
    control.show("preview", 0.5);  // a newer one waits, but this is to be seen
    control.handOver([&done] { done.emplace_back("preview"); });
    control.show("refining", 0.5, true);
    control.handOver([&done] { done.emplace_back("never"); });
  });
  while (stage != 1) std::this_thread::sleep_for(1ms);
  job.start("new", [&](BackgroundJob::Control& control) {
    control.handOver([&done] { done.emplace_back("new"); });
  });
  stage = 2;
  EXPECT_TRUE(finishes(job));
  EXPECT_EQ(done, (std::vector<std::string>{"preview", "new"}));
  EXPECT_FALSE(job.takeError());
}

TEST(BackgroundJob, ACancelledJobEndsAndItsResultIsDropped) {
  BackgroundJob job;
  std::atomic<bool> handed = false;
  bool seen = false;
  job.start("work", [&](BackgroundJob::Control& control) {
    control.handOver([&seen] { seen = true; });
    handed = true;
    for (;;) {
      control.show("for ever", 0.0);
      std::this_thread::sleep_for(1ms);
    }
  });
  while (!handed) std::this_thread::sleep_for(1ms);
  job.cancel();
  EXPECT_TRUE(finishes(job));
  EXPECT_FALSE(seen);
  EXPECT_FALSE(job.takeError());
  bool next = false;
  job.start("next",
            [&](BackgroundJob::Control& control) { control.handOver([&] { next = true; }); });
  EXPECT_TRUE(finishes(job));
  EXPECT_TRUE(next);
}

TEST(BackgroundJob, SaysWhatFailedOnce) {
  BackgroundJob job;
  job.start("work", [](BackgroundJob::Control&) { throw std::runtime_error("no such plant"); });
  EXPECT_TRUE(finishes(job));
  EXPECT_EQ(job.takeError(), "no such plant");
  EXPECT_FALSE(job.takeError());
  job.start("work", [](BackgroundJob::Control&) { throw std::bad_alloc(); });
  EXPECT_TRUE(finishes(job));
  const auto error = job.takeError();
  ASSERT_TRUE(error);
  EXPECT_NE(error->find("out of memory"), std::string::npos);
}

TEST(BackgroundJob, ShowsHowFarItIs) {
  std::atomic<int> woken = 0;
  BackgroundJob job([&woken] { ++woken; });
  std::atomic<bool> go = false;
  job.start("baking", [&](BackgroundJob::Control& control) {
    control.show("field", 0.25);
    while (!go) std::this_thread::sleep_for(1ms);
  });
  for (int i = 0; i < 2000 && woken == 0; ++i) std::this_thread::sleep_for(1ms);
  const auto status = job.status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->title, "baking");
  EXPECT_EQ(status->step, "field");
  EXPECT_EQ(status->share, 0.25);
  go = true;
  EXPECT_TRUE(finishes(job));
  EXPECT_FALSE(job.status());
}

TEST(BackgroundJob, ClosingWhileItRunsWaitsForItToNotice) {
  std::atomic<bool> runs = false, ended = false;
  struct AtEnd {
    std::atomic<bool>* flag;
    ~AtEnd() { *flag = true; }
  };
  {
    BackgroundJob job;
    job.start("work", [&](BackgroundJob::Control& control) {
      const AtEnd at_end{&ended};
      runs = true;
      for (;;) {
        control.show("for ever", -1.0);
        std::this_thread::sleep_for(1ms);
      }
    });
    while (!runs) std::this_thread::sleep_for(1ms);
    job.start("never", [](BackgroundJob::Control&) { FAIL(); });
  }
  EXPECT_TRUE(ended);
}

TEST(MotionSettings, LevelsAndBranchesBendByTheirFactors) {
  GrowOptions tree;
  tree.set = {{"Levels", "2"}, {"Leaves", "4"}};
  tree.leaf_form = LeafForm::kCard;
  tree.texture_size = 32;
  const Plant plant = grow(tree);
  const PlantMotion usual = motionOf(plant, {});
  MotionSettings settings;
  settings.level_flexibility = {1.0f, 0.0f, 1.0f, 1.0f};
  settings.branches = {{0, 2.5f}, {1000000, 3.0f}};
  const PlantMotion bent = motionOf(plant, settings);
  const Wind wind{.speed = 2.0f};
  const auto amplitudes = branchAmplitudes(bent, wind, 1.5);
  ASSERT_GT(bent.branches.size(), 10u);
  for (std::size_t b = 0; b < bent.branches.size(); ++b) {
    const bool trunk = bent.tree.branches[b].level == 0;
    const float factor = b == 0 ? 2.5f : trunk ? 1.0f : 0.0f;
    EXPECT_FLOAT_EQ(bent.branches[b].mean, factor * usual.branches[b].mean);
    EXPECT_FLOAT_EQ(bent.branches[b].swing, factor * usual.branches[b].swing);
    EXPECT_EQ(glm::length(amplitudes[b]) > 0.0f, trunk) << b;
  }
  // What is left alone stays, to the bit.
  EXPECT_EQ(branchAmplitudes(usual, wind, 1.5), branchAmplitudes(plantMotion(plant), wind, 1.5));
}

TEST(ShownScene, BakingAnewAsItIsChangesNothing) {
  SceneSettings settings;
  GrowOptions& tree = settings.plants.emplace_back().grow;
  tree.set = {{"Levels", "2"}, {"Leaves", "20"}};
  tree.leaf_form = LeafForm::kCard;
  tree.texture_size = 32;
  LoadSceneOptions options;
  options.any_look = true;
  const LoadedScene loaded(settings, options);
  const LoadedPlant& plant = loaded.plants()[0];
  ASSERT_TRUE(plant.light);
  const PlantBake bake = bakePlant(plant.plant, &*plant.light, {}, BakeField::kOpticalDepth, false,
                                   [](const std::string&, double) {});
  ASSERT_EQ(bake.light.meshes.size(), plant.light->meshes.size());
  for (std::size_t m = 0; m < bake.light.meshes.size(); ++m) {
    const MeshLight &now = bake.light.meshes[m], &before = plant.light->meshes[m];
    EXPECT_EQ(now.ambient, before.ambient) << m;
    EXPECT_EQ(now.normals, before.normals) << m;
    EXPECT_EQ(now.visibility, before.visibility) << m;
  }
}

/// A value that tests tell from others.
SceneSettings hazy(double turbidity) {
  SceneSettings settings;
  settings.daylight.turbidity = turbidity;
  return settings;
}

double turbidityOf(const SettingsHistory::Step& step) {
  return step.settings->daylight.turbidity;
}

TEST(SettingsHistory, GoesBackAndForthAlongWhatSettled) {
  SettingsHistory history;
  history.start(hazy(2.0), true);
  EXPECT_FALSE(history.canUndo());
  EXPECT_FALSE(history.canRedo());
  for (const double turbidity : {3.0, 4.0, 5.0}) {
    history.note({Change::kPicture});
    history.settle(hazy(turbidity));
  }
  EXPECT_EQ(turbidityOf(history.undo()), 4.0);
  EXPECT_EQ(turbidityOf(history.undo()), 3.0);
  EXPECT_EQ(turbidityOf(history.redo()), 4.0);
  EXPECT_EQ(turbidityOf(history.undo()), 3.0);
  EXPECT_EQ(turbidityOf(history.undo()), 2.0);
  EXPECT_FALSE(history.canUndo());
  // Another change forgets what was taken back.
  history.note({Change::kPicture});
  history.settle(hazy(9.0));
  EXPECT_FALSE(history.canRedo());
  EXPECT_EQ(turbidityOf(history.undo()), 2.0);
}

TEST(SettingsHistory, ADragIsOneStepAndBackAgainIsNone) {
  SettingsHistory history;
  history.start(hazy(2.0), true);
  for (int i = 0; i < 10; ++i) history.note({Change::kPicture});
  EXPECT_TRUE(history.modified());
  history.settle(hazy(2.0));
  EXPECT_FALSE(history.canUndo());
  EXPECT_FALSE(history.modified());
  for (int i = 0; i < 10; ++i) history.note({Change::kPicture});
  history.settle(hazy(5.0));
  history.settle(hazy(5.0));
  EXPECT_EQ(turbidityOf(history.undo()), 2.0);
  EXPECT_FALSE(history.canUndo());
}

TEST(SettingsHistory, SaysWhatAStepAsksForInBothDirections) {
  SettingsHistory history;
  history.start(hazy(2.0), true);
  history.note({Change::kScene});
  history.note({Change::kBake, 3});
  history.note({Change::kBake, 3});
  history.note({Change::kPicture});
  history.settle(hazy(5.0));
  history.note({Change::kMotion, 1});
  history.settle(hazy(6.0));
  using Edit = SettingsHistory::Edit;
  const std::set<Edit> last{{Change::kMotion, 1}};
  const std::set<Edit> first{{Change::kPicture, 0}, {Change::kBake, 3}, {Change::kScene, 0}};
  EXPECT_EQ(history.undo().edits, last);
  EXPECT_EQ(history.undo().edits, first);
  EXPECT_EQ(history.redo().edits, first);
  EXPECT_EQ(history.redo().edits, last);
  EXPECT_EQ(first.rbegin()->change, Change::kScene);  // which makes the others needless
}

TEST(SettingsHistory, KnowsWhichValueIsInAFile) {
  SettingsHistory history;
  EXPECT_FALSE(history.modified());
  const auto change = [&history](double turbidity) {
    history.note({Change::kPicture});
    history.settle(hazy(turbidity));
  };
  history.start(hazy(2.0), false);  // grown
  EXPECT_TRUE(history.modified());
  change(3.0);
  history.markSaved();
  EXPECT_FALSE(history.modified());
  change(4.0);
  EXPECT_TRUE(history.modified());
  history.undo();
  EXPECT_FALSE(history.modified());
  history.undo();
  EXPECT_TRUE(history.modified());
  // The saved one is forgotten; one in its place is not it.
  change(5.0);
  EXPECT_TRUE(history.modified());
}

TEST(SettingsHistory, ForgetsTheOldest) {
  SettingsHistory history;
  history.start(hazy(0.0), true);
  const int more = static_cast<int>(SettingsHistory::kMostSteps) + 20;
  for (int i = 1; i <= more; ++i) {
    history.note({Change::kPicture});
    history.settle(hazy(i));
  }
  std::size_t steps = 0;
  for (double expected = more - 1; history.canUndo(); --expected, ++steps)
    EXPECT_EQ(turbidityOf(history.undo()), expected);
  EXPECT_EQ(steps, SettingsHistory::kMostSteps);
  EXPECT_TRUE(history.modified());  // the value in the file is no longer known
}

TEST(SettingsHistory, OpeningBeginsAnew) {
  SettingsHistory history;
  history.note({Change::kPicture});
  history.settle(hazy(5.0));
  history.note({Change::kPicture});
  history.start(hazy(7.0), true);
  history.settle(hazy(8.0));  // nothing was noted since
  EXPECT_FALSE(history.canUndo());
  EXPECT_FALSE(history.modified());
}

}  // namespace
}  // namespace verdure::app
