// figures gumbau: the figures of Gumbau, Chover, Rebollo, Remolar 2008, from our own plants.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/figure_set.h"
#include "base/progress.h"
#include "base/random.h"
#include "verdure/leaf_visibility.h"

namespace verdure::app {
namespace {

/// A plant with the visibility of its leaves, and with coefficients of its wood.
struct LitPlant {
  Plant plant;
  CrownLight light;
};

/// `looks`: at each leaf, to find its visibility.
LitPlant growLit(const std::string& species, std::uint32_t seed, LeafForm form, int texture_size,
                 int looks) {
  GrowOptions options;
  options.species = species;
  options.seed = seed;
  options.leaf_form = form;
  options.texture_size = texture_size;
  LitPlant lit{grow(options), {}};
  lit.light = bakeOpticalDepth(lit.plant).light;
  LeafVisibilityOptions rays;
  rays.directions = rays.rays = looks;
  setLeafVisibility(lit.plant, leafVisibility(lit.plant, rays), lit.light);
  return lit;
}

Terms ambientTerms(AmbientSource source) {
  Terms terms = presetTerms("depth-maps");
  terms.ambient_source = source;
  terms.diffuse = terms.specular = terms.shadow = terms.scattering = false;
  // Constant light on both sides of a leaf would count what it lets through as light on top.
  terms.transmission = source == AmbientSource::kLeafVisibility;
  return terms;
}

Terms shadowTerms(ShadowSource source) {
  Terms terms = presetTerms("depth-maps");
  terms.shadow_source = source;
  return terms;
}

/// A box of even light around the plant, seen behind it.
void surround(FigureSet& figures, const glm::vec3& color) {
  constexpr float kLuminance = 4.0f;  ///< kcd/m^2, of white
  figures.view().daylight = {uniformSky(kLuminance * color, kLuminance * color), Sun{}};
  figures.view().background = glm::mix(glm::vec3(0.9f), color, 0.5f);
  figures.view().exposure.ev = 12.0f;
}

void drawIndirect(FigureSet& figures, const Scene& scene) {
  const Terms indirect = ambientTerms(AmbientSource::kLeafVisibility);
  figures.show(scene, 35.0f);
  Page& page = figures.page();
  page.heading("Figure 1: indirect light");
  page.paragraph("In a box of even white light, without the sun; the same exposure.");
  surround(figures, glm::vec3(1.0f));
  page.beginRow();
  figures.draw("figure1a", ambientTerms(AmbientSource::kConstant),
               "(a) foliage without illumination: all leaves get the same light. The paper's "
               "crown is as flat");
  figures.draw(
      "figure1b", indirect,
      "(b) indirect light: each leaf face gets as much as it is seen from around, and what "
      "the other face lets through. In the paper, too, the crown darkens inwards");
  page.endRow();

  page.heading("Figure 2: indirect light of other surroundings");
  page.paragraph(
      "The leaves keep their visibility; only the box of light changes its colour. The same "
      "exposure for all. The paper shows white, reddish and yellow light.");
  const std::pair<const char*, glm::vec3> boxes[] = {{"white", {1.0f, 1.0f, 1.0f}},
                                                     {"reddish", {1.0f, 0.5f, 0.42f}},
                                                     {"yellow", {1.0f, 0.87f, 0.35f}}};
  page.beginRow();
  for (const auto& [name, color] : boxes) {
    surround(figures, color);
    figures.draw(fmt::format("figure2-{}", name), indirect, fmt::format("{} light", name));
  }
  page.endRow();
  page.paragraph("The exponent n of (3), in white light: how fast leaves darken inwards.");
  surround(figures, glm::vec3(1.0f));
  page.beginRow();
  for (const float exponent : {0.5f, 1.0f, 2.0f}) {
    figures.view().visibility_exponent = exponent;
    figures.draw(fmt::format("figure2-n{:g}", exponent), indirect,
                 fmt::format("n = {:g}", exponent));
  }
  page.endRow();
  figures.view().visibility_exponent = 1.0f;
}

/// A summer's day; `sky_alone`: exposed for pictures without the sun's light.
void daylight(FigureSet& figures, bool sky_alone = false) {
  figures.view().daylight = daylightOf({});
  figures.view().background.reset();
  figures.view().exposure.ev.reset();
  if (sky_alone) figures.view().exposure.ev = 13.0f;
}

void drawTerms(FigureSet& figures, const Scene& scene) {
  figures.show(scene, 80.0f);
  Page& page = figures.page();
  page.heading("Figure 3: from no illumination to the whole");
  page.paragraph("Under a clear sky. The paper shows (a), (b) and (d).");
  page.beginRow();
  daylight(figures, true);
  figures.draw("figure3a", ambientTerms(AmbientSource::kConstant),
               "(a) foliage without illumination: even light on all");
  figures.draw("figure3b", ambientTerms(AmbientSource::kLeafVisibility),
               "(b) ambient light only, by leaf visibility; exposed as (a)");
  page.endRow();
  daylight(figures);
  Terms direct = presetTerms("depth-maps");
  direct.ambient = false;
  page.beginRow();
  figures.draw("figure3c", direct,
               "(c) direct light only: the sun, scattered in leaves, through the layers of leaves "
               "that the light depth map counts");
  figures.draw("figure3d", presetTerms("depth-maps"),
               "(d) all: direct and indirect light, self-shadowing, shadows on trunk and branches");
  page.endRow();
}

void drawShadows(FigureSet& figures, const Plant& plant) {
  const Bounds crown = bounds(plant, PartKind::kFoliage);
  const glm::vec3 to_sun = figures.view().daylight.sun.direction;
  const glm::vec3 aside = glm::normalize(glm::cross(glm::vec3(0, 1, 0), to_sun));
  const glm::vec3 shadow = crown.center() - to_sun * (crown.center().y / to_sun.y);
  const float size = glm::length(crown.size());
  View& view = figures.view();
  view.shadow_cascades = 1;
  view.exposure.ev = 15.0f;

  Page& page = figures.page();
  page.heading("Figure 4: the shadow of the foliage");
  page.paragraph(fmt::format(
      "The same camera, exposure and one map of {0} x {0} texels over the whole scene for each. "
      "In the paper's figure the shadow is darker where more leaves lie behind each other.",
      view.shadow_map_size));
  view.camera = {shadow + 0.75f * size * aside + glm::vec3(0.0f, 0.45f * size, 0.0f), shadow, 0.6f};
  page.beginRow();
  figures.draw("figure4a", shadowTerms(ShadowSource::kShadowMap),
               "(a) plain shadow map: all or nothing");
  figures.draw("figure4b", shadowTerms(ShadowSource::kDepthLayers),
               "(b) light depth map: the ground gets what all layers of leaves let through, and a "
               "half-shadow as wide as the leaves are high");
  page.endRow();

  page.paragraph(
      "Leaves near by, the sun on the left. Behind a light depth map a leaf gets what the layers "
      "in front of it let through, which is little: the pictures differ in the half-shade inside "
      "the crown.");
  view.exposure.ev = 14.2f;
  const glm::vec3 at = crown.center() + 0.3f * crown.size() * aside;
  view.camera = {at + 0.5f * size * aside, at, 0.35f};
  const std::tuple<const char*, ShadowSource, const char*> sources[] = {
      {"map", ShadowSource::kShadowMap, "plain shadow map"},
      {"paper", ShadowSource::kDepthPaper, "the paper's (4)"},
      {"layers", ShadowSource::kDepthLayers, "layers spread evenly between the first and the last"},
      {"ordered", ShadowSource::kDepthOrdered,
       "the first and the last layer where they are, the others spread evenly"}};
  for (std::size_t i = 0; i < std::size(sources); ++i) {
    if (i % 2 == 0) page.beginRow();
    const auto& [name, source, caption] = sources[i];
    figures.draw(fmt::format("figure4-{}", name), shadowTerms(source), caption);
    if (i % 2 == 1) page.endRow();
  }
  view.shadow_cascades = 0;
  view.exposure.ev.reset();
}

/// Trees of all kinds, scattered evenly.
Scene plantForest(const std::vector<LitPlant>& kinds) {
  constexpr int kTrees = 28;
  constexpr float kHalfWidth = 27.0f, kLeastDistance = 7.0f;  // m
  Random random(2008);
  Scene scene;
  for (const LitPlant& kind : kinds) scene.items.push_back({&kind.plant, &kind.light, {}});
  std::vector<glm::vec2> places;
  while (places.size() < kTrees) {
    const glm::vec2 place(random.vary(kHalfWidth), random.vary(kHalfWidth));
    bool free = true;
    for (const glm::vec2& other : places)
      free = free && glm::distance(place, other) > kLeastDistance;
    if (!free) continue;
    const float turn = random.uniform(0.0f, glm::two_pi<float>());
    const float scale = random.uniform(0.8f, 1.25f);
    const glm::vec3 x = scale * glm::vec3(std::cos(turn), 0.0f, -std::sin(turn));
    const glm::vec3 z = scale * glm::vec3(std::sin(turn), 0.0f, std::cos(turn));
    scene.items[places.size() % kinds.size()].world_from_plant.emplace_back(
        glm::vec4(x, 0.0f), glm::vec4(0.0f, scale, 0.0f, 0.0f), glm::vec4(z, 0.0f),
        glm::vec4(place.x, 0.0f, place.y, 1.0f));
    places.push_back(place);
  }
  return scene;
}

void drawForest(FigureSet& figures, const Scene& forest) {
  figures.renderer().setScene(forest);
  Page& page = figures.page();
  std::size_t trees = 0;
  for (const SceneItem& item : forest.items) trees += item.world_from_plant.size();
  page.heading("Figure 5: a forest");
  page.paragraph(fmt::format(
      "{} trees of {} kinds, turned and scaled, on 54 m x 54 m; the sun's maps are split into "
      "cascades.",
      trees, forest.items.size()));
  const std::pair<const char*, Camera> eyes[] = {
      {"walk", {{8.0f, 1.7f, 40.0f}, {0.0f, 7.0f, 0.0f}, 0.8f}},
      {"above", {{26.0f, 20.0f, 48.0f}, {0.0f, 3.5f, 0.0f}, 0.75f}}};
  for (const auto& [name, camera] : eyes) {
    figures.view().camera = camera;
    page.beginRow();
    figures.draw(fmt::format("figure5-{}-standard", name), presetTerms("standard"),
                 "standard light: constant ambient light, shadow maps");
    figures.draw(
        fmt::format("figure5-{}", name), presetTerms("depth-maps"),
        "leaf visibility, scattering and light depth maps: the shape of the foliage shows, "
        "darker where light hardly gets");
    page.endRow();
  }
}

}  // namespace

void runGumbauFigures(const FiguresCommand& command) {
  speciesParameters(command.species);  // throws if there is no such species
  FigureSet figures(command, "Real-time illumination of foliage using depth maps",
                    "Figures 1 to 5 of Gumbau, Chover, Rebollo and Remolar (2008), from verdure's "
                    "plants on ");
  Progress progress("figures gumbau");
  progress.show("growing");
  {
    const LitPlant tree = growLit(command.species, 4, LeafForm::kMesh, 512, 64);
    Scene scene;
    scene.items.push_back({&tree.plant, &tree.light});
    progress.show("figures 1 and 2");
    Scene alone = scene;
    alone.ground = false;
    drawIndirect(figures, alone);
    progress.show("figure 3");
    drawTerms(figures, scene);
    progress.show("figure 4");
    drawShadows(figures, tree.plant);
  }
  progress.show("growing a forest");
  std::vector<LitPlant> kinds;
  kinds.push_back(growLit(command.species, 4, LeafForm::kCard, 256, 24));
  kinds.push_back(growLit("silver-birch", 2, LeafForm::kCard, 256, 24));
  kinds.push_back(growLit("quaking-aspen", 2, LeafForm::kCard, 256, 24));
  progress.show("figure 5");
  drawForest(figures, plantForest(kinds));
  figures.page().write();
  fmt::print("{}\n", (figures.page().folder() / "index.html").string());
}

}  // namespace verdure::app
