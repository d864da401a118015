#ifndef VERDURE_APP_VIEW_SHOWN_SCENE_H_
#define VERDURE_APP_VIEW_SHOWN_SCENE_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/loaded_scene.h"
#include "verdure/density.h"

namespace verdure::app {

/// A bake of one plant.
struct PlantBake {
  CrownLight light;
  Surface surface;  ///< of the metaball field, else empty
  std::string report;
  float rho = 0.0f, tau = 0.0f, most_tau = 0.0f, d_min = 0.0f;  ///< of the metaball field, else 0
  double seconds = 0.0;
};

/// A loaded scene, and bakes and motions of its plants that were made since. Does not change:
/// another bake makes another one, so that any thread may look at it.
class ShownScene {
 public:
  explicit ShownScene(std::shared_ptr<const LoadedScene> loaded);

  const LoadedScene& loaded() const { return *loaded_; }
  /// With the newest bake of each plant; its pointers live as long as this.
  const Scene& scene() const { return scene_; }
  /// Of a plant; null: as it was loaded.
  const PlantBake* bake(std::size_t plant) const { return bakes_[plant].get(); }
  /// How a plant moves; null: not at all.
  const PlantMotion* motion(std::size_t plant) const;
  /// The same with another bake of a plant, or another motion.
  std::shared_ptr<const ShownScene> with(std::size_t plant,
                                         std::shared_ptr<const PlantBake> bake) const;
  std::shared_ptr<const ShownScene> with(std::size_t plant,
                                         std::shared_ptr<const PlantMotion> motion) const;

 private:
  void link();

  std::shared_ptr<const LoadedScene> loaded_;
  std::vector<std::shared_ptr<const PlantBake>> bakes_;      ///< of each plant, or null
  std::vector<std::shared_ptr<const PlantMotion>> motions_;  ///< of each plant, or null
  Scene scene_;
  Forest forest_;
};

/// Fields of a preview are as coarse as this.
inline constexpr int kPreviewGrid = 40;
/// ... and made of so many of the leaves.
inline constexpr std::size_t kPreviewLeaves = 6000;

/// Bakes a plant, in the field `usual` unless the parameters name one. `preview`: coarser, to be
/// seen while a parameter is dragged. `before` has the leaf visibility, which stays; may be null.
/// Throws Error as the bakes do, and what `progress` throws.
PlantBake bakePlant(const Plant& plant, const CrownLight* before, const BakeParameters& parameters,
                    BakeField usual, bool preview,
                    const std::function<void(const std::string& step, double share)>& progress);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_SHOWN_SCENE_H_
