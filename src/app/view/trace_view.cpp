#include "app/view/trace_view.h"

#include <algorithm>
#include <utility>

#include "scene/display.h"

namespace verdure::app {

void TraceView::start(const Request& request) {
  job_.cancel();
  picture_.reset();
  samples_ = 0;
  job_.start("path tracer", [request, kept = kept_, this](BackgroundJob::Control& control) {
    trace(request, *kept, *this, control);
  });
}

std::optional<Image> TraceView::takePicture() {
  job_.poll();
  return std::exchange(picture_, std::nullopt);
}

void TraceView::trace(const Request& request, Kept& kept, TraceView& view,
                      BackgroundJob::Control& control) {
  const Wind& wind = request.view.wind;
  const bool same_moment = wind.speed == kept.wind.speed && wind.from == kept.wind.from &&
                           wind.gusts == kept.wind.gusts && request.view.seconds == kept.seconds;
  if (!kept.loaded || kept.scene_number != request.scene_number ||
      (!same_moment && std::max(wind.speed, kept.wind.speed) > 0.0f)) {
    kept.loaded.reset();
    LoadSceneOptions options;
    options.for_reference = true;
    options.progress = [&control](const std::string& step, double share) {
      control.show(step, share);
    };
    kept.loaded = std::make_unique<LoadedScene>(request.settings, options);
    kept.scene_number = request.scene_number;
    kept.wind = wind;
    kept.seconds = request.view.seconds;
  }
  const Scene scene = kept.loaded->scene();
  const View& shown = request.view;
  ReferenceOptions options;
  options.width = shown.width;
  options.height = shown.height;
  options.camera = shown.camera;
  HdrImage sum(shown.width, shown.height);
  int traced = 0;
  // Each round takes as many paths as all before it: the scene is made ready for rays anew each
  // time, and rounds cannot be looked into.
  while (traced < kMostTracedSamples) {
    options.samples = std::clamp(traced, 1, 64);
    options.seed = static_cast<std::uint32_t>(1 + traced);
    options.progress = [&](double share) {
      control.show(std::to_string(traced) + " paths a pixel", share);
    };
    const ReferencePicture picture = renderReference(scene, shown.daylight, options);
    for (std::size_t i = 0; i < sum.rgb.size(); ++i)
      sum.rgb[i] += picture.image.rgb[i] * static_cast<float>(picture.samples);
    traced += picture.samples;
    HdrImage mean = sum;
    for (glm::vec3& value : mean.rgb) value /= static_cast<float>(traced);
    const float average = request.average > 0.0f ? request.average : averageLuminance(mean);
    const float white =
        request.white > 0.0f ? request.white : automaticWhite(mean, average, shown.exposure.key);
    control.handOver([&view, traced, image = displayed(mean, average, shown.exposure.key, white)] {
      view.picture_ = image;
      view.samples_ = traced;
    });
  }
}

}  // namespace verdure::app
