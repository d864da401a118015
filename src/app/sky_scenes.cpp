#include "app/sky_scenes.h"

#include <fmt/format.h>

#include <glm/gtc/constants.hpp>
#include <tuple>

#include "verdure/grow.h"
#include "verdure/transfer.h"

namespace verdure::app {
namespace {

constexpr int kRays = 16;  ///< for each vertex and side: enough for pictures of this size
constexpr float kCamera_deg = 35.0f;
constexpr float kTurbidities[] = {2.5f, 4.0f, 6.0f};  ///< the range that the thesis lights with

struct Hour {
  const char* name;
  float azimuth_deg, elevation_deg;  ///< of the sun
};
constexpr Hour kHours[] = {
    {"morning", 100.0f, 12.0f}, {"midday", 0.0f, 58.0f}, {"sunset", -100.0f, 4.0f}};

Daylight daylightAt(const Hour& hour, float turbidity) {
  return preethamDaylight(
      turbidity, directionOf(glm::radians(hour.azimuth_deg), glm::radians(hour.elevation_deg)));
}

}  // namespace

void addSkyScenes(const FiguresCommand& command, Page& page, Progress& progress,
                  Renderer& renderer) {
  progress.show("growing");
  GrowOptions options;
  options.species = command.species;
  options.seed = 4;
  options.leaf_form = LeafForm::kCard;
  options.texture_size = 256;
  const Plant plant = grow(options);
  progress.show("tracing transfer vectors");
  TransferOptions tracing;
  tracing.rays.rays = kRays;
  tracing.rays.ground_height = 0.0f;
  const PlantTransfer transfer = bakeTransfer(plant, tracing);
  Scene scene;
  scene.items.push_back({&plant});
  scene.items[0].transfer = &transfer;
  renderer.setScene(scene);

  View view;
  std::tie(view.width, view.height) = parseSize(command.size);
  view.terms = presetTerms("transfer");
  const auto look = [&](float azimuth_deg) {
    view.camera = automaticCamera(scene, glm::radians(azimuth_deg), glm::radians(4.0f),
                                  static_cast<float>(view.width) / static_cast<float>(view.height));
  };
  const auto draw = [&](const std::string& name, const std::string& caption) {
    progress.show("drawing " + name);
    page.picture(name, renderer.render(view).image, caption);
  };

  page.heading("Figure 5.6: lit by the sky alone, N = 5, at morning, midday and sunset");
  page.paragraph(fmt::format(
      "Transfer vectors of {} rays a vertex under Preetham's sky, whose turbidity grows "
      "from row to row; the sun itself gives no light. On {}.",
      kRays, renderer.deviceName()));
  look(kCamera_deg);
  for (const float turbidity : kTurbidities) {
    page.beginRow();
    for (const Hour& hour : kHours) {
      view.daylight = daylightAt(hour, turbidity);
      view.daylight.sun.luminance = glm::vec3(0.0f);
      draw(fmt::format("figure56-{}-{:g}", hour.name, turbidity),
           fmt::format("{}, τ = {:g}", hour.name, turbidity));
    }
    page.endRow();
  }

  page.heading("Figure 5.7: with the sun as a directional light, through a filtered shadow map");
  page.paragraph("The same hours at τ = 3, and sunset from other sides.");
  page.beginRow();
  for (const Hour& hour : kHours) {
    view.daylight = daylightAt(hour, 3.0f);
    draw(fmt::format("figure57-{}", hour.name), hour.name);
  }
  page.endRow();
  page.beginRow();
  view.daylight = daylightAt(kHours[2], 3.0f);
  look(kHours[2].azimuth_deg + 20.0f);
  draw("figure57-sun-behind", "sunset, the sun behind the viewer");
  look(kHours[2].azimuth_deg + 165.0f);
  draw("figure57-sun-ahead", "sunset, against the sun");
  page.endRow();
}

}  // namespace verdure::app
