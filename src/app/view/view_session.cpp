#include "app/view/view_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "app/plant_prep.h"
#include "app/view/orbit_camera.h"
#include "shared/tone.h"
#include "verdure/error.h"

namespace verdure::app {
namespace {

// Pictures that take longer are drawn smaller while something moves.
constexpr double kSlow_s = 0.1, kFast_s = 0.045, kAim_s = 0.07;
constexpr float kLeastScale = 0.3f;
constexpr int kCoarseShadowMap = 512;
constexpr double kRest_s = 0.25;
constexpr float kLeastHeight = 2e-3f;  // of the eye over the ground, in the scene's reach

bool same(const DaylightSettings& a, const DaylightSettings& b) {
  const bool same_place = a.place.has_value() == b.place.has_value() &&
                          (!a.place || (a.place->latitude_deg == b.place->latitude_deg &&
                                        a.place->longitude_deg == b.place->longitude_deg));
  return a.sky == b.sky && a.sun_deg == b.sun_deg && a.date == b.date && same_place &&
         a.turbidity == b.turbidity;
}

/// The preset `expressive` means the field of its paper.
BakeField fieldOf(const LookSettings& look) {
  return look.light == "expressive" ? BakeField::kMetaball : BakeField::kOpticalDepth;
}

bool bakedInFile(const Plant& plant) {
  return std::any_of(plant.meshes.begin(), plant.meshes.end(),
                     [](const Mesh& mesh) { return !mesh.ambient.empty(); });
}

bool allLit(const Scene& scene) {
  return scene.forest == nullptr &&
         std::all_of(scene.items.begin(), scene.items.end(),
                     [](const SceneItem& item) { return item.light != nullptr; });
}

std::string fileName(const std::filesystem::path& path) {
  return path.filename().string();
}

}  // namespace

ViewSession::ViewSession(Screen& screen, const std::function<void()>& wake)
    : screen_(&screen), tracer_(wake), saves_(wake), job_(wake) {
  rebuildView();
}

void ViewSession::fail(const std::exception& problem) {
  message = problem.what();
}

void ViewSession::changed(Change change, std::size_t plant) {
  if (change == Change::kNothing) return;
  history_.note({change, plant});
  apply({change, plant});
}

void ViewSession::apply(const SettingsHistory::Edit& edit) {
  const auto& [change, plant] = edit;
  if (change == Change::kScene) return load(false);
  if (change < Change::kMotion) return rebuildView();
  // Until the result is there the picture stays as it is, and the processor is the job's.
  (change == Change::kBake ? stale_bakes_ : stale_motions_).insert(plant);
  if (change == Change::kBake && !bake_asked_) bake_asked_.emplace();
  renew();
}

void ViewSession::restore(const SettingsHistory::Step& step) {
  const LookSettings before = settings.look;
  settings = *step.settings;
  playing = false;
  lightChanged(before);
  for (const SettingsHistory::Edit& edit : step.edits) apply(edit);
}

void ViewSession::undo() {
  settle();
  if (canUndo()) restore(history_.undo());
}

void ViewSession::redo() {
  settle();
  if (canRedo()) restore(history_.redo());
}

void ViewSession::togglePlay() {
  playing = !playing;
  if (!playing || view_.wind.speed > 0.0f) return;
  settings.wind.speed = 5.0f;
  changed(Change::kPicture);
}

View ViewSession::viewWith(const LookSettings& look) const {
  SceneSettings wanted = settings;
  wanted.look = look;
  // Another sky takes time, a panorama much: it is made only if it is another.
  const bool same_sky = daylight_of_ && same(*daylight_of_, settings.daylight);
  if (same_sky) wanted.daylight = {};
  wanted.camera.eye = view_.camera.eye;  // not looked for in the scene
  wanted.camera.target = view_.camera.target;
  View view = shown_ ? shown_->loaded().view(wanted) : viewOf(wanted);
  view.camera = view_.camera;
  view.camera.vertical_fov = glm::radians(static_cast<float>(settings.camera.fov_deg));
  if (same_sky) view.daylight = view_.daylight;
  return view;
}

void ViewSession::rebuildView() {
  try {
    view_ = viewWith(settings.look);
    daylight_of_ = settings.daylight;
    if (beside == Beside::kPreset) {
      LookSettings other = settings.look;
      other.light = beside_light;
      other.terms.reset();
      other.shadows.reset();
      beside_view_ = viewWith(other);
    }
    message.clear();
  } catch (const std::exception& e) {
    fail(e);
  }
  dirty_[0] = dirty_[1] = true;
  since_change_.lap();
}

void ViewSession::open(const std::filesystem::path& path) {
  try {
    if (isSceneFile(path)) {
      settings = readScene(path);
      scene_path_ = path;
    } else {
      SceneSettings scene;
      scene.width = settings.width;
      scene.height = settings.height;
      PlantSettings& plant = scene.plants.emplace_back();
      plant.name = path.stem().string();
      plant.file = path.string();
      settings = std::move(scene);
      scene_path_.clear();
    }
  } catch (const std::exception& e) {
    return fail(e);
  }
  name_ = fileName(path);
  history_.start(settings, true);
  load(true);
}

void ViewSession::grow(const GrowOptions& options) {
  SceneSettings scene;
  scene.width = settings.width;
  scene.height = settings.height;
  scene.plants.emplace_back().name = options.species;
  scene.plants.back().grow = options;
  settings = std::move(scene);
  scene_path_.clear();
  name_ = options.species;
  history_.start(settings, false);
  load(true);
}

void ViewSession::load(bool new_scene) {
  message.clear();
  job_.cancel();
  loading_new_ = new_scene || (loading_ && loading_new_);
  loading_ = true;
  job_.start("loading", [this, another = loading_new_,
                         wanted = settings](BackgroundJob::Control& control) {
    LoadSceneOptions options;
    options.any_look = true;
    options.progress = [&control](const std::string& step, double share) {
      control.show(step, share);
    };
    auto shown =
        std::make_shared<const ShownScene>(std::make_shared<const LoadedScene>(wanted, options));
    control.show("packing", -1.0);
    const std::shared_ptr<PackedScene> packed = packedScene(shown->scene());
    SceneSettings all = wanted;
    all.camera.eye.reset();
    const Camera home = cameraOf(all, shown->scene());
    control.handOver([this, another, wanted, shown, packed, home] {
      loading_ = false;
      try {
        screen_->setScene(packed);
      } catch (const std::exception& e) {
        return fail(e);
      }
      shown_ = shown;
      home_ = home;
      ++scene_number_;
      stale_bakes_.clear();
      stale_motions_.clear();
      if (another) {
        view_.camera = home;
        if (wanted.camera.eye)
          view_.camera = {*wanted.camera.eye, wanted.camera.target, home.vertical_fov};
      }
      rebuildView();
      tracing_stale_ = true;
    });
  });
}

void ViewSession::lightChanged(const LookSettings& before) {
  if (!shown_ || fieldOf(before) == fieldOf(settings.look)) return;
  for (std::size_t p = 0; p < settings.plants.size(); ++p)
    if (!settings.plants[p].bake && p < shown_->loaded().plants().size() &&
        !bakedInFile(shown_->loaded().plants()[p].plant))
      stale_bakes_.insert(p);
  if (!stale_bakes_.empty()) renew();
}

void ViewSession::renew() {
  if (loading_) return load(false);  // a load that has begun knows older settings
  if (!shown_) return;
  const std::size_t count = std::min(shown_->loaded().plants().size(), settings.plants.size());
  for (std::set<std::size_t>* stale : {&stale_bakes_, &stale_motions_})
    std::erase_if(*stale, [count](std::size_t plant) { return plant >= count; });
  job_.start(stale_bakes_.empty() ? "motion" : "baking",
             [this, next = shown_, bakes = stale_bakes_, motions = stale_motions_,
              wanted = settings.plants,
              field = fieldOf(settings.look)](BackgroundJob::Control& control) mutable {
               // First as it can be seen at once, then as it is to be.
               for (const std::size_t p : bakes)
                 next = renewBake(next, p, wanted[p], field, true, control);
               for (const std::size_t p : motions) next = renewMotion(next, p, wanted[p], control);
               // The previews are drawn first, with the whole processor.
               for (int i = 0; i < 20 && !bakes.empty(); ++i) {
                 control.show("preview", -1.0, true);
                 std::this_thread::sleep_for(std::chrono::milliseconds(20));
               }
               for (const std::size_t p : bakes)
                 next = renewBake(next, p, wanted[p], field, false, control);
             });
}

std::shared_ptr<const ShownScene> ViewSession::renewBake(
    const std::shared_ptr<const ShownScene>& before, std::size_t p, const PlantSettings& wanted,
    BakeField field, bool preview, BackgroundJob::Control& control) {
  const LoadedPlant& plant = before->loaded().plants()[p];
  auto made = std::make_shared<const PlantBake>(bakePlant(
      plant.plant, plant.light ? &*plant.light : nullptr, wanted.bake.value_or(BakeParameters()),
      field, preview, [&](const std::string& step, double share) {
        control.show((preview ? "preview: " : "") + step, share, !preview);
      }));
  const std::shared_ptr<const ShownScene> next = before->with(p, made);
  const bool whole = !allLit(next->scene());
  const auto light = whole ? nullptr : packedLight(next->scene());
  const auto packed = whole ? packedScene(next->scene()) : nullptr;
  control.handOver([this, next, light, packed, p, preview] {
    if (!shown_ || &shown_->loaded() != &next->loaded()) return;
    try {
      if (!light || !screen_->setLight(*light))
        screen_->setScene(packed ? packed : packedScene(next->scene()));
    } catch (const std::exception& e) {
      return fail(e);
    }
    shown_ = next;
    if (bake_asked_) bake_latency_ = bake_asked_->seconds();
    bake_asked_.reset();
    if (!preview) stale_bakes_.erase(p);
    if (preview) since_change_.lap();  // to be seen soon rather than sharp
    dirty_[0] = dirty_[1] = true;
  });
  return next;
}

std::shared_ptr<const ShownScene> ViewSession::renewMotion(
    const std::shared_ptr<const ShownScene>& before, std::size_t p, const PlantSettings& wanted,
    BackgroundJob::Control& control) {
  control.show("branches in wind", -1.0);
  auto made = std::make_shared<const PlantMotion>(
      motionOf(before->loaded().plants()[p].plant, wanted.motion.value_or(MotionSettings())));
  const std::shared_ptr<const ShownScene> next = before->with(p, made);
  const std::shared_ptr<PackedScene> packed = packedScene(next->scene());
  control.handOver([this, next, packed, p] {
    if (!shown_ || &shown_->loaded() != &next->loaded()) return;
    try {
      screen_->setScene(packed);
    } catch (const std::exception& e) {
      return fail(e);
    }
    shown_ = next;
    stale_motions_.erase(p);
    dirty_[0] = dirty_[1] = true;
  });
  return next;
}

void ViewSession::saveScene(const std::filesystem::path& path) {
  settle();
  try {
    SceneSettings saved = settings;
    saved.camera.eye = view_.camera.eye;
    saved.camera.target = view_.camera.target;
    writeScene(saved, path);
    scene_path_ = path;
    name_ = fileName(path);
    history_.markSaved();
    message.clear();
  } catch (const std::exception& e) {
    fail(e);
  }
}

void ViewSession::savePlant(std::size_t plant, const std::filesystem::path& path) {
  if (!shown_ || plant >= shown_->loaded().plants().size()) return;
  saves_.start("saving", [this, shown = shown_, plant, path](BackgroundJob::Control& control) {
    control.show(fileName(path), -1.0);
    const LoadedPlant& loaded = shown->loaded().plants()[plant];
    const CrownLight* light = loaded.light ? &*loaded.light : nullptr;
    if (const PlantBake* bake = shown->bake(plant)) light = &bake->light;
    verdure::savePlant(loaded.plant, light, path);
    control.handOver([this, path] { message = "saved " + path.string(); });
  });
}

void ViewSession::saveScreenshot(std::filesystem::path path) {
  try {
    for (int n = 1; path.empty() && n < 10000; ++n) {
      const std::filesystem::path next = fmt::format("verdure-{:04}.png", n);
      if (!std::filesystem::exists(next)) path = next;
    }
    View view = view_;
    const glm::ivec2 size = pictureSize(area_);
    if (area_.x > 0) std::tie(view.width, view.height) = std::tie(size.x, size.y);
    writePng(screen_->read(view, static_cast<Inspection>(inspected)).image, path);
    message = "saved " + path.string();
  } catch (const std::exception& e) {
    fail(e);
  }
}

void ViewSession::startClip(const std::filesystem::path& path, int frames, int fps) {
  try {
    clip_.reset();
    clip_.emplace(path.string(), fps, frames);
    clip_->view = view_;
    clip_->view.width = settings.width;
    clip_->view.height = settings.height;
    message.clear();
  } catch (const std::exception& e) {
    clip_.reset();
    fail(e);
  }
}

void ViewSession::drawClipFrame() {
  try {
    Clip& clip = *clip_;
    const Frame frame = screen_->read(clip.view, static_cast<Inspection>(inspected));
    clip.video.add(frame.image, clip.next);
    if (clip.next == 0) {  // lit and exposed as its first
      if (!clip.view.exposure.ev && frame.average_luminance > 0.0f)
        clip.view.exposure.ev = std::log2(frame.average_luminance / shared::meteredLuminance(0.0f));
      clip.view.exposure.white = frame.white;
      clip.view.shadow_cascades = frame.shadow_cascades;
    }
    clip.view.seconds += 1.0 / clip.fps;
    if (++clip.next < clip.frames) return;
    clip.video.finish();
    message = fmt::format("saved a clip of {} frames", clip.frames);
    clip_.reset();
  } catch (const std::exception& e) {
    clip_.reset();
    fail(e);
  }
}

void ViewSession::moveCamera(const Camera& camera) {
  view_.camera = camera;
  // Nothing is seen from below the ground.
  if (const Scene* scene = shown_ ? &shown_->scene() : nullptr) {
    const float above = kLeastHeight * reach();
    if (scene->terrain != nullptr)
      view_.camera =
          raisedTo(camera, scene->terrain->heightAt({camera.eye.x, camera.eye.z}) + above);
    else if (scene->ground)
      view_.camera = raisedTo(camera, scene->ground_height + above);
  }
  dirty_[0] = dirty_[1] = true;
  since_change_.lap();
}

void ViewSession::showAll() {
  const float fov = view_.camera.vertical_fov;
  moveCamera(home_);
  view_.camera.vertical_fov = fov;
}

float ViewSession::reach() const {
  return std::max(glm::length(home_.eye - home_.target), 1e-3f);
}

void ViewSession::poll() {
  job_.poll();
  saves_.poll();
  for (const std::optional<std::string>& error :
       {job_.takeError(), saves_.takeError(), tracer_.takeError()})
    if (error) message = *error;
  if (beside != Beside::kTracer) return;
  if (const std::optional<Image> picture = tracer_.takePicture()) {
    try {
      screen_->setPicture(1, *picture);
    } catch (const std::exception& e) {
      fail(e);
    }
  }
}

void ViewSession::advance(double seconds) {
  if (clip_) return;
  if (!playing) return;
  view_.seconds += seconds;
  settings.wind.seconds = view_.seconds;
  dirty_[0] = dirty_[1] = true;
  since_change_.lap();
}

glm::ivec2 ViewSession::pictureSize(const glm::ivec2& area) const {
  const int columns = beside == Beside::kNothing ? 1 : 2;
  return glm::max(glm::ivec2(area.x / columns, area.y), glm::ivec2(1));
}

bool ViewSession::rests() const {
  // A sharp picture of what is about to be replaced would only keep its successor waiting.
  return since_change_.seconds() >= kRest_s && !held_ && !(coarse_ && job_.busy());
}

void ViewSession::draw(const glm::ivec2& area, bool held) {
  if (clip_) return drawClipFrame();
  const int columns = beside == Beside::kNothing ? 1 : 2;
  const glm::ivec2 full = pictureSize(area);
  if (area != area_) since_change_.lap();
  area_ = area;
  held_ = held;
  const bool moves = !rests();
  const float scale = moves ? scale_ : 1.0f;
  const glm::ivec2 size = glm::max(glm::ivec2(glm::vec2(full) * scale), glm::ivec2(1));
  if (coarse_ && !moves) dirty_[0] = dirty_[1] = true;
  for (int picture = 0; picture < columns; ++picture) {
    const bool traced = picture == 1 && beside == Beside::kTracer;
    // While something moves, a picture of another size that is up to date will do.
    if (!dirty_[picture] && (moves || drawn_size_[picture] == size)) continue;
    if (traced) {
      if (tracer_.busy()) tracer_.stop();
      dirty_[1] = false;
      tracing_stale_ = true;
      drawn_size_[1] = size;
      continue;
    }
    try {
      View view = picture == 0 ? view_ : beside_view_;
      view.camera = view_.camera;
      view.seconds = view_.seconds;
      view.width = size.x;
      view.height = size.y;
      if (scale < 1.0f) {  // the sun's maps cost as much in any size of the picture
        view.shadow_map_size = std::min(view.shadow_map_size, kCoarseShadowMap);
        view.shadow_cascades = 1;
      }
      const Timer timer;
      coarse_ = scale < 1.0f;
      frames_[picture] = screen_->draw(picture, view, static_cast<Inspection>(inspected));
      draw_seconds_ = timer.seconds();
      // Pixels are most of what a picture costs. One in full tells where to begin.
      const bool first = !moves && scale_ == 1.0f;
      if ((moves || first) && (draw_seconds_ > kSlow_s || draw_seconds_ < kFast_s))
        scale_ = std::clamp(scale * static_cast<float>(std::sqrt(kAim_s / draw_seconds_)),
                            kLeastScale, 1.0f);
    } catch (const std::exception& e) {
      fail(e);
    }
    dirty_[picture] = false;
    drawn_size_[picture] = size;
  }
  if (beside != Beside::kTracer) {
    if (tracer_.busy()) tracer_.stop();
    tracing_stale_ = true;
  } else if (tracing_stale_ && !moves && shown_ && !job_.busy()) {
    tracing_stale_ = false;
    View view = view_;
    view.width = full.x;
    view.height = full.y;
    tracer_.start({settings, scene_number_, view, frames_[0].average_luminance, frames_[0].white});
  }
}

double ViewSession::rest() const {
  if (playing || clip_ || dirty_[0]) return 0.0;
  if ((coarse_ || (beside == Beside::kTracer && tracing_stale_)) && !held_ && !job_.busy())
    return std::max(kRest_s - since_change_.seconds(), 1e-3);
  return status() ? 0.25 : 1.0;
}

bool ViewSession::settled() const {
  return !job_.busy() && !saves_.busy() && !clip_ && !coarse_ && !dirty_[0];
}

std::optional<BackgroundJob::Status> ViewSession::status() const {
  if (clip_)
    return BackgroundJob::Status{"clip", fmt::format("frame {} of {}", clip_->next, clip_->frames),
                                 static_cast<double>(clip_->next) / clip_->frames};
  if (auto status = saves_.status()) return status;
  if (auto status = job_.status()) return status;
  return beside == Beside::kTracer ? tracer_.status() : std::nullopt;
}

}  // namespace verdure::app
