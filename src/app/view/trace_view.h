#ifndef VERDURE_APP_VIEW_TRACE_VIEW_H_
#define VERDURE_APP_VIEW_TRACE_VIEW_H_

#include <memory>

#include "app/view/background_job.h"
#include "app/view/shown_scene.h"
#include "verdure/reference.h"

namespace verdure::app {

/// The path tracer running on beside the renderer, round by round.
class TraceView {
 public:
  explicit TraceView(std::function<void()> wake) : job_(std::move(wake)) {}

  /// What is to be traced, as the renderer's view of it. The scene of `settings` is loaded again,
  /// without baked light, when `scene_number`, or the moment in wind, is another than before.
  struct Request {
    SceneSettings settings;
    int scene_number = 0;
    View view;
    float average = 0.0f, white = 0.0f;  ///< exposure of the renderer's picture; 0: its own
  };
  void start(const Request& request);
  void stop() { job_.cancel(); }

  /// The newest picture, once.
  std::optional<Image> takePicture();
  int samples() const { return samples_; }  ///< of that, paths a pixel
  std::optional<BackgroundJob::Status> status() const { return job_.status(); }
  std::optional<std::string> takeError() { return job_.takeError(); }
  bool busy() const { return job_.busy(); }

 private:
  /// What the tracer's thread keeps between requests.
  struct Kept {
    std::unique_ptr<LoadedScene> loaded;
    int scene_number = -1;
    Wind wind;
    double seconds = 0.0;
  };
  static void trace(const Request& request, Kept& kept, TraceView& view,
                    BackgroundJob::Control& control);

  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
  std::optional<Image> picture_;
  int samples_ = 0;
  BackgroundJob job_;  ///< last: its thread uses the others
};

/// Pictures of more and more paths are as good as this many a pixel make them, then it rests.
inline constexpr int kMostTracedSamples = 1024;

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_TRACE_VIEW_H_
