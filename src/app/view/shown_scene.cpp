#include "app/view/shown_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/progress.h"

namespace verdure::app {

ShownScene::ShownScene(std::shared_ptr<const LoadedScene> loaded)
    : loaded_(std::move(loaded)), bakes_(loaded_->plants().size()), motions_(bakes_.size()) {
  link();
}

const PlantMotion* ShownScene::motion(std::size_t plant) const {
  if (motions_[plant]) return motions_[plant].get();
  const std::optional<PlantMotion>& loaded = loaded_->plants()[plant].motion;
  return loaded ? &*loaded : nullptr;
}

std::shared_ptr<const ShownScene> ShownScene::with(std::size_t plant,
                                                   std::shared_ptr<const PlantBake> bake) const {
  auto other = std::make_shared<ShownScene>(loaded_);
  other->bakes_ = bakes_;
  other->motions_ = motions_;
  other->bakes_[plant] = std::move(bake);
  other->link();
  return other;
}

std::shared_ptr<const ShownScene> ShownScene::with(
    std::size_t plant, std::shared_ptr<const PlantMotion> motion) const {
  auto other = std::make_shared<ShownScene>(loaded_);
  other->bakes_ = bakes_;
  other->motions_ = motions_;
  other->motions_[plant] = std::move(motion);
  other->link();
  return other;
}

void ShownScene::link() {
  scene_ = loaded_->scene();
  if (scene_.forest != nullptr) {
    forest_ = *scene_.forest;
    scene_.forest = &forest_;
  }
  const std::vector<LoadedPlant>& plants = loaded_->plants();
  const auto relink = [&](std::size_t i, auto& user) {  // a SceneItem or a ForestKind
    if (user.plant != &plants[i].plant) return;
    if (bakes_[i]) user.light = &bakes_[i]->light;
    if (motions_[i] && user.motion != nullptr) user.motion = motions_[i].get();
  };
  for (std::size_t i = 0; i < plants.size(); ++i) {
    for (SceneItem& item : scene_.items) relink(i, item);
    for (ForestKind& kind : forest_.kinds) relink(i, kind);
  }
}

PlantBake bakePlant(const Plant& plant, const CrownLight* before, const BakeParameters& parameters,
                    BakeField usual, bool preview,
                    const std::function<void(const std::string& step, double share)>& progress) {
  const Timer timer;
  PlantBake made;
  const auto report = [&progress](const char* step, double share) { progress(step, share); };
  if (parameters.fieldOr(usual) == BakeField::kMetaball) {
    DensityOptions options = parameters.checked();
    options.progress = report;
    if (preview) {
      options.grid = std::min(options.grid, kPreviewGrid);
      const std::size_t leaves = plant.leaves.size();
      if (leaves > kPreviewLeaves)
        options.fraction = std::min(
            options.fraction, static_cast<float>(kPreviewLeaves) / static_cast<float>(leaves));
    } else if (parameters.fit.value_or(false)) {
      options = fitDensity(plant, options);
      options.progress = report;
    }
    DensityBake bake = bakeDensity(plant, options);
    made.light = std::move(bake.light);
    made.surface = std::move(bake.surface);
    const DensityReport& r = bake.report;
    made.rho = r.rho;
    made.tau = r.tau;
    made.d_min = r.d_min;
    made.most_tau = r.field_max_at_generators;
    made.report = fmt::format(
        "rho {:.3g} m, tau {:.3g} (largest sum {:.3g}), d_min {:.3g}; {} of {} leaves; surface of "
        "{} triangles",
        double{r.rho}, double{r.tau}, double{r.field_max_at_generators}, double{r.d_min},
        r.generators, r.leaves, r.surface_triangles);
  } else {
    DepthOptions options = parameters.checkedDepth();
    options.progress = report;
    if (preview) options.fit = false;
    DepthBake bake = bakeOpticalDepth(plant, options);
    made.light = std::move(bake.light);
    made.report = fmt::format("optical depth {:.3g} to {:.3g}, mean openness {:.2f}",
                              double{bake.report.depth_min}, double{bake.report.depth_max},
                              bake.report.mean_openness);
  }
  if (before != nullptr && before->meshes.size() == made.light.meshes.size())
    for (std::size_t m = 0; m < before->meshes.size(); ++m)
      made.light.meshes[m].visibility = before->meshes[m].visibility;
  made.seconds = timer.seconds();
  return made;
}

}  // namespace verdure::app
