#ifndef VERDURE_APP_VIEW_VIEW_SESSION_H_
#define VERDURE_APP_VIEW_VIEW_SESSION_H_

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "app/video.h"
#include "app/view/background_job.h"
#include "app/view/changes.h"
#include "app/view/screen.h"
#include "app/view/settings_history.h"
#include "app/view/shown_scene.h"
#include "app/view/trace_view.h"
#include "base/progress.h"

namespace verdure::app {

/// What stands beside the picture.
enum class Beside { kNothing, kPreset, kTracer };

/// The viewer without its panels: settings, what was loaded of them, and what is being done. All
/// methods are for the window's thread; what fails ends in `message`, never in an exception.
class ViewSession {
 public:
  ViewSession(Screen& screen, const std::function<void()>& wake);

  /// Panels edit these and then tell changed().
  SceneSettings settings;
  Beside beside = Beside::kNothing;
  std::string beside_light = "standard";  ///< preset
  bool playing = false;                   ///< wind blows on
  int inspected = 0;                      ///< Inspection of render/inspect_pass.h
  bool show_surface = false;              ///< of the first plant's metaball field
  std::string message;                    ///< what failed last

  /// A setting is another. `plant`: whose bake or motion.
  void changed(Change change, std::size_t plant = 0);

  /// Nothing is held any more: what changed since the last call is one step of undo().
  void settle() { history_.settle(settings); }
  bool canUndo() const { return history_.canUndo(); }
  bool canRedo() const { return history_.canRedo(); }
  /// All settings as they were before the last step, or after the next one; the wind pauses, since
  /// its time is one of them. Opening and growing begin anew.
  void undo();
  void redo();
  /// Lets the wind blow, or pauses it.
  void togglePlay();

  /// The preset is another than that of `before`: plants that are baked as it has it are baked
  /// anew.
  void lightChanged(const LookSettings& before);
  /// What no scene file holds is another.
  void refresh() { rebuildView(); }

  /// A scene file, or a plant as a scene of its own.
  void open(const std::filesystem::path& path);
  /// A grown plant as a scene of its own.
  void grow(const GrowOptions& options);
  void saveScene(const std::filesystem::path& path);
  /// With its newest light.
  void savePlant(std::size_t plant, const std::filesystem::path& path);
  /// The picture as it is seen, without panels. Empty path: the first free verdure-NUMBER.png.
  void saveScreenshot(std::filesystem::path path = {});
  /// A film of the settings' size, from the moment that is shown.
  void startClip(const std::filesystem::path& path, int frames, int fps);
  bool clipRuns() const { return clip_.has_value(); }
  void stopClip() { clip_.reset(); }

  const Camera& camera() const { return view_.camera; }
  void moveCamera(const Camera& camera);
  void showAll();  ///< the camera that sees all of the scene
  /// Metres: how large steps of the camera are.
  float reach() const;

  /// What was done in the background is shown from now on.
  void poll();
  /// Time goes on by so many seconds.
  void advance(double seconds);
  /// Draws what is out of date into the screen's pictures, for an area of so many pixels. While
  /// something moves, pictures that take long are drawn smaller, and again when it rests. `held`: a
  /// parameter is being dragged.
  void draw(const glm::ivec2& area, bool held);
  /// Seconds until draw() has something to do without input.
  double rest() const;

  /// Nothing is under way any more: what is seen is what the settings say.
  bool settled() const;
  std::optional<BackgroundJob::Status> status() const;
  const ShownScene* shown() const { return shown_.get(); }
  const View& view() const { return view_; }
  const Frame& frame(int picture) const { return frames_[picture]; }  ///< without image
  double drawSeconds() const { return draw_seconds_; }                ///< of the last picture
  /// Seconds from the last change of a bake's parameter until a bake of it was there to be drawn.
  double bakeLatency() const { return bake_latency_; }
  int tracedSamples() const { return tracer_.samples(); }
  const std::string& name() const { return name_; }
  const std::filesystem::path& scenePath() const { return scene_path_; }
  bool modified() const { return history_.modified(); }

 private:
  struct Clip {
    Clip(const std::string& path, int rate, int count)
        : video(path, rate), fps(rate), frames(count) {}
    Video video;
    int fps, frames, next = 0;
    View view;
  };

  void apply(const SettingsHistory::Edit& edit);
  void restore(const SettingsHistory::Step& step);
  void load(bool new_scene);
  void renew();  ///< bakes and motions that are stale
  // Of renew(), on its thread: hand over what they make, and return it.
  std::shared_ptr<const ShownScene> renewBake(const std::shared_ptr<const ShownScene>& before,
                                              std::size_t p, const PlantSettings& wanted,
                                              BakeField field, bool preview,
                                              BackgroundJob::Control& control);
  std::shared_ptr<const ShownScene> renewMotion(const std::shared_ptr<const ShownScene>& before,
                                                std::size_t p, const PlantSettings& wanted,
                                                BackgroundJob::Control& control);
  void rebuildView();
  View viewWith(const LookSettings& look) const;
  void drawClipFrame();
  bool rests() const;  ///< nothing moves, and what is shown is worth to be drawn in full
  glm::ivec2 pictureSize(const glm::ivec2& area) const;  ///< of each picture in full
  void fail(const std::exception& problem);

  Screen* screen_;
  std::string name_ = "nothing";
  std::filesystem::path scene_path_;
  SettingsHistory history_;

  std::shared_ptr<const ShownScene> shown_;
  int scene_number_ = 0;             ///< of what was loaded
  bool loading_ = false;             ///< what is shown is not what the settings name
  bool loading_new_ = false;         ///< ... and is another scene
  Camera home_;                      ///< sees all of it
  std::optional<Timer> bake_asked_;  ///< since a parameter changed, until a bake of it is shown
  double bake_latency_ = 0.0;
  std::set<std::size_t> stale_bakes_, stale_motions_;  ///< plants

  View view_;
  View beside_view_;                             ///< the same with another light
  std::optional<DaylightSettings> daylight_of_;  ///< view_.daylight is of these
  bool dirty_[Screen::kPictures] = {true, true};
  glm::ivec2 drawn_size_[Screen::kPictures] = {};
  Frame frames_[Screen::kPictures];
  float scale_ = 1.0f;   ///< of pictures while something moves
  bool held_ = false;    ///< as draw() was told
  bool coarse_ = false;  ///< the pictures are drawn smaller than they are shown
  glm::ivec2 area_{0};   ///< that draw() was last called for
  Timer since_change_;   ///< seconds
  double draw_seconds_ = 0.0;
  bool tracing_stale_ = true;
  std::optional<Clip> clip_;

  TraceView tracer_;
  BackgroundJob saves_;  ///< beside it, so that no newer request takes its place
  BackgroundJob job_;    ///< last: its thread uses the others
};

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_VIEW_SESSION_H_
