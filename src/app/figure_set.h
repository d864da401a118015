#ifndef VERDURE_APP_FIGURE_SET_H_
#define VERDURE_APP_FIGURE_SET_H_

#include <string>

#include "app/commands.h"
#include "app/page.h"
#include "verdure/density.h"
#include "verdure/grow.h"

namespace verdure::app {

/// A plant and the bake of its density.
struct GrownPlant {
  Plant plant;
  DensityBake bake;
};

inline GrownPlant growBaked(const std::string& species, std::uint32_t seed) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  GrownPlant grown{grow(options), {}};
  grown.bake = bakeDensity(grown.plant);
  return grown;
}

/// The page of a paper's figures, and what draws its pictures.
class FigureSet {
 public:
  /// `introduction` ends in "on " or the like: the device's name follows.
  FigureSet(const FiguresCommand& command, const std::string& title,
            const std::string& introduction)
      : view_(viewOf(command)),
        renderer_(command.device),
        page_(command.output, title, introduction + renderer_.deviceName() + ".") {}

  Renderer& renderer() { return renderer_; }
  Page& page() { return page_; }
  /// Of the next picture.
  View& view() { return view_; }
  float aspect() const {
    return static_cast<float>(view_.width) / static_cast<float>(view_.height);
  }
  /// All of the scene, from an azimuth and an elevation in degrees.
  void show(const Scene& scene, float azimuth_deg, float elevation_deg = 4.0f) {
    view_.camera =
        automaticCamera(scene, glm::radians(azimuth_deg), glm::radians(elevation_deg), aspect());
    renderer_.setScene(scene);
  }
  void draw(const std::string& name, const Terms& terms, const std::string& caption) {
    view_.terms = terms;
    page_.picture(name, renderer_.render(view_).image, caption);
  }

 private:
  static View viewOf(const FiguresCommand& command) {
    View view;
    std::tie(view.width, view.height) = parseSize(command.size);
    view.daylight = daylightOf({});
    return view;
  }

  View view_;
  Renderer renderer_;
  Page page_;  ///< last: what is refused leaves no folder behind
};

}  // namespace verdure::app

#endif  // VERDURE_APP_FIGURE_SET_H_
