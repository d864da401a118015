#ifndef VERDURE_APP_LOADED_SCENE_H_
#define VERDURE_APP_LOADED_SCENE_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/scene_settings.h"
#include "verdure/levels.h"
#include "verdure/scene.h"
#include "verdure/transfer.h"

namespace verdure::app {

/// A plant of a scene with all that its look needs.
struct LoadedPlant {
  Plant plant;
  std::optional<CrownLight> light;
  std::optional<PlantTransfer> transfer;
  std::optional<PlantMotion> motion;
  std::optional<PlantLevels> levels;
  bool missing = false;  ///< a marker stands for it
};

struct LoadSceneOptions {
  /// Loads what any look and any wind need, so that views may change (LoadedScene::view()); else
  /// what the settings' own do.
  bool any_look = false;
  /// For the path tracer: no baked light, no levels, plants moved to their moment in the wind.
  bool for_reference = false;
  bool film = false;              ///< wind blows unless it is told otherwise
  bool missing_is_error = false;  ///< else a plant whose file cannot be read becomes a marker
  std::function<void(const std::string& step, double share)> progress;  ///< share < 0: unknown
};

/// What scene settings name, loaded, grown and baked.
class LoadedScene {
 public:
  /// Throws Error: what cannot be read (but see LoadSceneOptions::missing_is_error), more places
  /// than memory has room for.
  explicit LoadedScene(const SceneSettings& settings, const LoadSceneOptions& options = {});
  LoadedScene(const LoadedScene&) = delete;
  LoadedScene& operator=(const LoadedScene&) = delete;

  /// Its pointers live as long as this.
  Scene scene() const;
  /// The settings' view of it. Another look, daylight or camera may be given for a scene that was
  /// loaded for any look; plants, places and ground must be those that were loaded.
  View view() const { return view(settings_); }
  View view(const SceneSettings& settings) const;

  /// Bakes a plant's light anew. Levels of it keep their own until the scene is loaded again.
  void bake(std::size_t plant, const BakeParameters& parameters);

  const SceneSettings& settings() const { return settings_; }
  const std::vector<LoadedPlant>& plants() const { return plants_; }
  const Forest& forest() const { return forest_; }  ///< without places if there is none
  /// One line each; first those of missing plants.
  const std::vector<std::string>& notes() const { return notes_; }
  std::size_t missingPlants() const;
  double bakeSeconds() const { return bake_seconds_; }
  /// "best (baked)": what the settings' light turned out to be.
  std::string lightName() const;

 private:
  void show(const std::string& step, double share = -1.0) const;
  void loadPlants();
  void lightPlants(const View& look);
  void addVisibility(const LoadedPlant& plant, std::optional<CrownLight>& light, const View& look);
  void makeGround();
  void placePlants(const View& look);
  std::vector<Placement> allPlaces();
  std::vector<Placement> scatter(const ScatterSettings& settings,
                                 const std::vector<Placement>& before) const;
  bool bakesTogether(const View& look) const;
  bool standsInGroupOnly(std::size_t plant) const;
  void bakeTogether(const std::vector<Placement>& places, const View& look);
  void makeLevelsOfMany();
  void linkForest();
  void moveInWind(const Wind& wind, double seconds);
  bool hasTransfer() const;
  View withoutMissingTransfer(View view) const;

  SceneSettings settings_;
  LoadSceneOptions options_;
  std::vector<LoadedPlant> plants_;
  std::optional<Terrain> terrain_;
  std::vector<GrassSet> grass_;
  std::vector<std::optional<CoverMap>> covers_;
  /// A plant that is drawn whole.
  struct Single {
    std::size_t plant = 0;
    glm::mat4 world{1.0f};
    std::optional<CrownLight> light;  ///< unset: the plant's
  };
  std::vector<Single> singles_;
  Forest forest_;
  float ground_height_ = 0.0f;
  std::optional<Camera> rest_camera_;  ///< of the reference: found before plants moved
  std::vector<std::string> notes_;
  double bake_seconds_ = 0.0;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_LOADED_SCENE_H_
