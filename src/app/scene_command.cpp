// What commands that take scenes have in common.
#include <fmt/format.h>

#include "app/commands.h"
#include "app/loaded_scene.h"

namespace verdure::app {

SceneSettings SceneCommand::settings() const {
  SceneSettings settings = scene;
  for (PlantSettings& plant : settings.plants) {
    if (!load.foliage.empty()) plant.load.foliage = load.foliage;
    if (!load.wood.empty()) plant.load.wood = load.wood;
    if (bake_again) plant.bake = bake;
  }
  return settings;
}

void SceneCommand::save(const SceneSettings& settings) const {
  if (!save_scene.empty()) writeScene(settings, save_scene);
}

void tellNotes(const LoadedScene& loaded, bool json) {
  for (std::size_t i = 0; i < loaded.notes().size(); ++i) {
    const std::string& note = loaded.notes()[i];
    if (i < loaded.missingPlants())
      fmt::print(stderr, "verdure: {}\n", note);  // even where nobody reads notes
    else if (!json)
      fmt::print("note: {}\n", note);
  }
}

}  // namespace verdure::app
