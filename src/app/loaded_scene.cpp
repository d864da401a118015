#include "app/loaded_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/plant_prep.h"
#include "app/style_names.h"
#include "base/progress.h"
#include "scene/place_limit.h"
#include "verdure/error.h"
#include "verdure/layout.h"
#include "verdure/scatter.h"
#include "verdure/terrain.h"

namespace verdure::app {
namespace {

constexpr double kSquareMetresOfHectare = 1e4;
/// Kinds that stand so often get coarser levels; making them takes longer than drawing a few whole.
constexpr std::size_t kManyPlaces = 8;

Terrain terrainOf(const GroundSettings& ground) {
  const glm::vec2 heights = ground.terrain_height_m;
  if (ground.terrain == "hills")
    return growTerrain({.seed = ground.terrain_seed,
                        .size_m = ground.terrain_size_m,
                        .relief_m = heights[1] - heights[0]});
  return readTerrain(ground.terrain, {ground.terrain_size_m, heights[0], heights[1]});
}

GrassSet grassOf(const std::string& name, std::uint64_t seed) {
  const std::vector<std::string>& species = grassSpeciesNames();
  if (std::find(species.begin(), species.end(), name) != species.end())
    return growGrass(grassSpecies(name), {.seed = seed});
  if (!std::filesystem::exists(name))
    throw Error("--grass", fmt::format("'{}' is neither a species nor a folder", name),
                fmt::format("use {}, or what verdure grass grow writes", fmt::join(species, ", ")));
  return loadGrass(name);
}

void checkGround(const GroundSettings& ground) {
  for (const GrassLayerSettings& layer : ground.grass)
    if (!(layer.density >= 0.0f && layer.density <= 1.0f))
      throw Error("--grass-density", fmt::format("{:g} is out of range", layer.density),
                  "choose 0 to 1");
  if (ground.grass_slices < 1 || ground.grass_slices > 256)
    throw Error("--grass-slices", fmt::format("{} is out of range", ground.grass_slices),
                "choose 1 to 256");
}

/// What a plant is called in notes.
std::string labelOf(const PlantSettings& plant) {
  if (!plant.file.empty()) return plant.file;
  return plant.grow.species;
}

/// The same of grown plants, with its parameters.
Plant plantOf(const PlantSettings& plant) {
  return plant.file.empty() ? grow(plant.grow) : loadPlant(plant.file, plant.load);
}

/// The bake that settings ask for.
CrownLight bakedLight(const Plant& plant, const BakeParameters& parameters, BakeField fallback,
                      double& seconds) {
  if (parameters.fieldOr(fallback) == BakeField::kMetaball) {
    DensityBake bake = bakeDensity(plant, parameters.checked());
    seconds += bake.report.seconds_total;
    return std::move(bake.light);
  }
  DepthBake bake = bakeOpticalDepth(plant, parameters.checkedDepth());
  seconds += bake.report.seconds_total;
  return std::move(bake.light);
}

/// The preset `expressive` means the field of its paper.
BakeField usualField(const LookSettings& look) {
  return look.light == "expressive" ? BakeField::kMetaball : BakeField::kOpticalDepth;
}

}  // namespace

LoadedScene::LoadedScene(const SceneSettings& settings, const LoadSceneOptions& options)
    : settings_(settings), options_(options) {
  const View look = viewOf(settings_, options_.film);  // what is wrong is said before long work
  checkGround(settings_.ground);
  for (const PlantSettings& plant : settings_.plants)
    if (plant.bake) {
      plant.bake->fieldOr(BakeField::kOpticalDepth);
      plant.bake->checked();
      plant.bake->checkedDepth();
    }
  loadPlants();
  lightPlants(look);
  makeGround();
  placePlants(look);
  makeLevelsOfMany();
  linkForest();
  if (options_.for_reference) moveInWind(look.wind, look.seconds);
}

void LoadedScene::show(const std::string& step, double share) const {
  if (options_.progress) options_.progress(step, share);
}

void LoadedScene::loadPlants() {
  plants_.resize(settings_.plants.size());
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    const PlantSettings& named = settings_.plants[i];
    show(plants_.size() == 1 ? "loading" : "loading " + labelOf(named),
         plants_.size() == 1 ? -1.0 : static_cast<double>(i) / static_cast<double>(plants_.size()));
    try {
      plants_[i].plant = plantOf(named);
    } catch (const Error& e) {
      if (options_.missing_is_error || named.file.empty()) throw;
      plants_[i].plant = missingPlantMarker();
      plants_[i].missing = true;
      notes_.push_back(fmt::format("plant '{}' is missing, a marker stands for it: {}",
                                   named.name.empty() ? labelOf(named) : named.name, e.what()));
    }
  }
}

void LoadedScene::lightPlants(const View& look) {
  const bool any_look = options_.any_look;
  // Transfer vectors lie beside files. A light that needs them needs one plant that has them.
  const bool wants_transfer = !options_.for_reference &&
                              (any_look || look.terms.ambient_source == AmbientSource::kTransfer);
  if (wants_transfer)
    for (std::size_t i = 0; i < plants_.size(); ++i)
      if (const std::string& file = settings_.plants[i].file; !file.empty() && !plants_[i].missing)
        plants_[i].transfer = loadTransfer(file, plants_[i].plant);
  if (wants_transfer && !hasTransfer() && settings_.look.light != "best" && !plants_.empty() &&
      look.terms.ambient_source == AmbientSource::kTransfer) {
    const std::string& file = settings_.plants[0].file;
    throw Error(labelOf(settings_.plants[0]),
                file.empty() ? "has no transfer vectors"
                             : fmt::format("has no transfer vectors ({} is not there)",
                                           transferPath(file).string()),
                "trace them with verdure bake --transfer 5");
  }
  const View shown = withoutMissingTransfer(look);
  const BakeParameters usual;
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    LoadedPlant& plant = plants_[i];
    if (plant.missing) continue;
    if (!options_.for_reference) {
      // The file's own bake, or one made now; a light without baked terms needs neither.
      if (!settings_.plants[i].bake) plant.light = lightOfFile(plant.plant);
      const bool lacks_transfer =
          shown.terms.ambient_source == AmbientSource::kTransfer && !plant.transfer;
      if (!plant.light && (any_look || needsBake(shown) || lacks_transfer) &&
          !(bakesTogether(shown) && !any_look && standsInGroupOnly(i))) {
        show("baking");
        const std::optional<BakeParameters>& bake = settings_.plants[i].bake;
        plant.light = bakedLight(plant.plant, bake ? *bake : usual, usualField(settings_.look),
                                 bake_seconds_);
      }
      addVisibility(plant, plant.light, shown);
    }
    if (options_.for_reference || any_look || needsLeafNormals(shown))
      restoreLeafNormals(plant.plant);
    if (look.wind.speed > 0.0f || any_look) {
      show("motion");
      plant.motion = motionFor(plant.plant, settings_.plants[i].motion.value_or(MotionSettings{}));
      for (const std::string& note : plant.plant.notes)
        if (note.starts_with("branches: "))
          notes_.push_back(plants_.size() == 1
                               ? note
                               : fmt::format("{}: {}", labelOf(settings_.plants[i]), note));
    }
  }
}

void LoadedScene::addVisibility(const LoadedPlant& plant, std::optional<CrownLight>& light,
                                const View& look) {
  const bool wanted = look.terms.ambient_source == AmbientSource::kLeafVisibility;
  if (!light || !(wanted || options_.any_look)) return;
  // Leaves alone have it; what has none is drawn by its bake.
  if (options_.any_look && plant.plant.leaves.empty()) return;
  std::vector<std::vector<float>> baked;
  if (options_.any_look)
    for (const MeshLight& mesh : light->meshes) baked.push_back(mesh.ambient);
  bake_seconds_ += addLeafVisibility(plant.plant, *light,
                                     [this](double share) { show("leaf visibility", share); });
  // It is beside the bake, whose coefficients other looks show.
  for (std::size_t m = 0; m < baked.size(); ++m) light->meshes[m].ambient = std::move(baked[m]);
}

void LoadedScene::makeGround() {
  const GroundSettings& ground = settings_.ground;
  if (options_.for_reference) {
    if (ground.any())
      notes_.push_back("grass and terrain are left out: the path tracer knows a plain ground");
    return;
  }
  if (!ground.any()) return;
  show("ground");
  if (!ground.terrain.empty()) terrain_ = terrainOf(ground);
  for (const GrassLayerSettings& layer : ground.grass) {
    grass_.push_back(grassOf(layer.grass, ground.grass_seed));
    std::optional<CoverMap>& cover = covers_.emplace_back();
    if (!layer.cover.empty()) cover = readCoverMap(layer.cover, ground.terrain_size_m);
  }
}

void LoadedScene::placePlants(const View& look) {
  const bool placed =
      !settings_.placements.empty() || !settings_.layouts.empty() || !settings_.scatters.empty();
  if (!placed) {  // each as its file has it
    if (!plants_.empty()) ground_height_ = groundHeight(plants_[0].plant);
    for (std::size_t i = 0; i < plants_.size(); ++i) singles_.push_back({i, glm::mat4(1.0f), {}});
  }
  if (terrain_) {  // through the ground at x = z = 0
    const float lift = ground_height_ - terrain_->heightAt(glm::vec2(0.0f));
    for (float& height : terrain_->heights) height += lift;
  }
  if (!placed) return;
  show("placing");
  std::vector<Placement> places = allPlaces();
  std::vector<std::size_t> counts(plants_.size());
  for (const Placement& place : places) ++counts[place.plant];
  std::vector<float> feet;
  for (LoadedPlant& plant : plants_) {
    plant.plant.origin = glm::dvec3(0.0);  // places say where it stands
    feet.push_back(groundHeight(plant.plant));
  }
  // Plants that stand once are drawn whole; tints are for those that stand often.
  for (Placement& place : places) place.position.y -= place.scale * feet[place.plant];
  std::size_t kept = 0, first = 0;
  if (bakesTogether(withoutMissingTransfer(look))) {
    first = settings_.placements.size();
    bakeTogether({places.begin(), places.begin() + static_cast<std::ptrdiff_t>(first)}, look);
  }
  for (std::size_t i = first; i < places.size(); ++i) {
    const Placement& place = places[i];
    if (counts[place.plant] == 1 && place.tint == 0xffffff)
      singles_.push_back({place.plant, matrixOf(place), {}});
    else
      places[kept++] = place;
  }
  places.resize(kept);
  const auto isTinted = [](const Placement& place) { return place.tint != 0xffffff; };
  if (options_.for_reference && std::any_of(places.begin(), places.end(), isTinted))
    notes_.push_back("tints are left out: the path tracer does not know them");
  forest_.places = std::move(places);
  forest_.detail = settings_.detail;
}

bool LoadedScene::standsInGroupOnly(std::size_t plant) const {
  const auto names = [plant](const std::vector<std::uint32_t>& plants) {
    return std::find(plants.begin(), plants.end(), plant) != plants.end();
  };
  for (const LayoutSettings& layout : settings_.layouts)
    if (names(layout.plants)) return false;
  for (const ScatterSettings& scatter : settings_.scatters)
    for (const ScatterSettings::Kind& kind : scatter.kinds)
      if (kind.plant == plant) return false;
  return true;
}

bool LoadedScene::bakesTogether(const View& look) const {
  return settings_.bake_together && !options_.for_reference && !settings_.placements.empty() &&
         (needsBake(look) || options_.any_look);
}

void LoadedScene::bakeTogether(const std::vector<Placement>& places, const View& look) {
  if (places.size() > kMostTogether)
    throw Error("placements", fmt::format("{} are to be baked together", places.size()),
                fmt::format("up to {} are baked in one field", kMostTogether));
  show("baking together");
  std::vector<const Plant*> plants;
  for (const LoadedPlant& plant : plants_) plants.push_back(&plant.plant);
  // Markers have no crown.
  std::vector<Placement> lit;
  for (const Placement& place : places)
    if (!plants_[place.plant].missing) lit.push_back(place);
  const BakeParameters usual;
  const std::optional<BakeParameters>& given = settings_.plants[places[0].plant].bake;
  const BakeParameters& parameters = given ? *given : usual;
  parameters.fieldOr(BakeField::kMetaball);
  DensityOptions density = parameters.checked();
  density.progress = [this](const char* step, double share) { show(step, share); };
  const Timer timer;
  std::vector<DensityBake> bakes;
  if (!lit.empty()) bakes = bakeDensityPopulation(plants, lit, density);
  bake_seconds_ += timer.seconds();
  std::size_t next = 0;
  bool tinted = false;
  for (const Placement& place : places) {
    Single single{place.plant, matrixOf(place), {}};
    if (!plants_[place.plant].missing) single.light = std::move(bakes[next++].light);
    addVisibility(plants_[place.plant], single.light, look);
    tinted = tinted || place.tint != 0xffffff;
    singles_.push_back(std::move(single));
  }
  if (tinted) notes_.push_back("tints of plants that are baked together are left out");
}

std::vector<Placement> LoadedScene::allPlaces() {
  const auto height = [&](const Placement& place) {
    return terrain_ ? terrain_->heightAt({place.position.x, place.position.z}) : 0.0f;
  };
  std::vector<Placement> places = settings_.placements;
  checkPlaceCount(static_cast<double>(places.size()), "placements");
  for (Placement& place : places) place.position.y += height(place);
  for (const LayoutSettings& settings : settings_.layouts) {
    Layout layout = loadLayout(settings.file);
    checkPlaceCount(static_cast<double>(places.size() + layout.places.size()), settings.file);
    for (const std::string& note : layout.notes)
      notes_.push_back(fmt::format("{}: {}", settings.file, note));
    for (Placement& place : layout.places) {
      place.plant = settings.plants.at(place.plant % settings.plants.size());
      if (!settings.heights_of_file) place.position.y = height(place);
      place.scale *= settings.scale;
      places.push_back(place);
    }
  }
  for (const ScatterSettings& settings : settings_.scatters) {
    const std::vector<Placement> scattered = scatter(settings, places);
    checkPlaceCount(static_cast<double>(places.size() + scattered.size()), "scatters");
    places.insert(places.end(), scattered.begin(), scattered.end());
  }
  return places;
}

std::vector<Placement> LoadedScene::scatter(const ScatterSettings& settings,
                                            const std::vector<Placement>& before) const {
  ScatterOptions options;
  for (const ScatterSettings::Kind& kind : settings.kinds)
    options.kinds.push_back({kind.plant, kind.share, kind.radius_m, kind.scale});
  options.seed = settings.seed;
  options.corner = settings.center_m - 0.5f * settings.size_m;
  options.size_m = settings.size_m;
  if (settings.per_ha)
    options.per_m2 = static_cast<float>(double{*settings.per_ha} / kSquareMetresOfHectare);
  std::optional<CoverMap> density;
  if (!settings.density_map.empty()) {
    density = readCoverMap(settings.density_map, settings.size_m);
    density->corner = options.corner;
    options.density = &*density;
  }
  if (terrain_) options.terrain = &*terrain_;
  options.most_slope = glm::radians(settings.most_slope_deg);
  if (settings.height) {
    options.lowest_m = settings.height->x;
    options.highest_m = settings.height->y;
  }
  if (settings.clear_m > 0.0f) {
    for (const Placement& place : before)
      options.taken.push_back({{place.position.x, place.position.z}, settings.clear_m});
    if (const auto& eye = settings_.camera.eye)
      options.taken.push_back({{eye->x, eye->z}, settings.clear_m});
  }
  options.hue_spread = settings.hue_spread;
  options.brightness_spread = settings.brightness_spread;
  return scatterPlants(options);
}

void LoadedScene::makeLevelsOfMany() {
  if (forest_.places.empty()) return;
  std::vector<std::size_t> counts(plants_.size());
  for (const Placement& place : forest_.places) ++counts[place.plant];
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    LoadedPlant& plant = plants_[i];
    if (counts[i] >= kManyPlaces && !plant.missing && !options_.for_reference) {
      show("levels of " + labelOf(settings_.plants[i]));
      plant.levels = makeLevels(plant.plant, plant.light ? &*plant.light : nullptr);
    }
  }
}

void LoadedScene::moveInWind(const Wind& wind, double seconds) {
  // Looked at as the plants at rest are, as the renderer does.
  rest_camera_ = cameraOf(settings_, scene());
  if (!(wind.speed > 0.0f)) return;
  for (std::size_t i = 0; i < plants_.size(); ++i) {
    if (!plants_[i].motion) continue;
    MotionPlace place;
    for (std::size_t s = 0; s < singles_.size(); ++s)
      if (singles_[s].plant == i) place = {singles_[s].world, static_cast<std::uint32_t>(s)};
    movePlant(*plants_[i].motion, wind, seconds, place, plants_[i].plant);
  }
}

void LoadedScene::linkForest() {
  forest_.kinds.clear();
  if (forest_.places.empty()) return;
  for (const LoadedPlant& plant : plants_)
    forest_.kinds.push_back({&plant.plant, plant.light ? &*plant.light : nullptr,
                             plant.motion ? &*plant.motion : nullptr,
                             plant.levels ? &*plant.levels : nullptr});
}

Scene LoadedScene::scene() const {
  Scene scene;
  scene.ground = settings_.ground.shown;
  scene.ground_height = ground_height_;
  for (const Single& single : singles_) {
    const LoadedPlant& plant = plants_[single.plant];
    const std::optional<CrownLight>& light = single.light ? single.light : plant.light;
    SceneItem item{&plant.plant, light ? &*light : nullptr, {single.world}};
    if (plant.transfer && !single.light && glm::mat3(single.world) == glm::mat3(1.0f))
      item.transfer = &*plant.transfer;
    if (plant.motion && !options_.for_reference) item.motion = &*plant.motion;
    scene.items.push_back(std::move(item));
  }
  if (options_.for_reference) {
    std::vector<std::vector<glm::mat4>> worlds(plants_.size());
    for (const Placement& place : forest_.places) worlds[place.plant].push_back(matrixOf(place));
    for (std::size_t i = 0; i < plants_.size(); ++i)
      if (!worlds[i].empty())
        scene.items.push_back({&plants_[i].plant, nullptr, std::move(worlds[i])});
  } else if (!forest_.places.empty()) {
    scene.forest = &forest_;
  }
  if (terrain_) scene.terrain = &*terrain_;
  for (std::size_t i = 0; i < grass_.size(); ++i) {
    GrassLayer layer;
    layer.set = &grass_[i];
    layer.cover = covers_[i] ? &*covers_[i] : nullptr;
    layer.density = settings_.ground.grass[i].density;
    layer.most_slices = settings_.ground.grass_slices;
    scene.grass.push_back(layer);
  }
  return scene;
}

bool LoadedScene::hasTransfer() const {
  return std::any_of(plants_.begin(), plants_.end(),
                     [](const LoadedPlant& plant) { return plant.transfer.has_value(); });
}

View LoadedScene::withoutMissingTransfer(View view) const {
  if (view.terms.ambient_source == AmbientSource::kTransfer && !hasTransfer())
    view.terms.ambient_source = AmbientSource::kBaked;
  return view;
}

View LoadedScene::view(const SceneSettings& settings) const {
  View view = withoutMissingTransfer(viewOf(settings, options_.film));
  view.camera = rest_camera_ ? *rest_camera_ : cameraOf(settings, scene());
  return view;
}

void LoadedScene::bake(std::size_t index, const BakeParameters& parameters) {
  LoadedPlant& plant = plants_.at(index);
  if (plant.missing) return;
  plant.light = bakedLight(plant.plant, parameters, usualField(settings_.look), bake_seconds_);
  addVisibility(plant, plant.light, viewOf(settings_));
  settings_.plants[index].bake = parameters;
  linkForest();
}

std::size_t LoadedScene::missingPlants() const {
  return static_cast<std::size_t>(std::count_if(
      plants_.begin(), plants_.end(), [](const LoadedPlant& plant) { return plant.missing; }));
}

std::string LoadedScene::lightName() const {
  const std::string& light = settings_.look.light;
  if (light != "best") return light;
  return hasTransfer() ? "best (transfer vectors)" : "best (baked)";
}

}  // namespace verdure::app
