// figures leaf: leaves on other geometries, and on a tree (Habel 2009, figures 3.8, 3.18 and 3.21).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/figures_leaf.h"
#include "verdure/grow.h"
#include "verdure/optical_depth.h"

namespace verdure::app {
namespace {

/// Makes a normal map flat.
void flatten(Plant& plant, int texture) {
  std::vector<std::uint8_t>& texels = plant.textures[static_cast<std::size_t>(texture)].image.rgba;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    texels[i] = texels[i + 1] = 128;
    texels[i + 2] = texels[i + 3] = 255;
  }
}

/// The leaf's front as geometry, without a normal map.
Plant reliefPlant(const LeafSet& set, const LeafTranslucency& light) {
  Plant plant;
  plant.name = set.name;
  Mesh mesh = leafReliefPlant(set).meshes[0];  // a vertex for each texel
  mesh.normals = set.front.normal;
  mesh.material = addLeafMaterial(plant, set, light);
  plant.meshes.push_back(std::move(mesh));
  flatten(plant, plant.materials[0].normal_texture);
  return plant;
}

}  // namespace

void drawCarriers(FigureSet& figures, const LeafSubject& subject) {
  const LeafSet& set = subject.set;
  const LeafTranslucency& light = subject.light;
  Page& page = figures.page();
  page.heading("Figure 3.8: one set of maps on three geometries");
  page.paragraph(
      "A sun that the leaf mirrors to the eye, with highlights as of wax (roughness 0.15, index "
      "1.7). The relief as geometry stands for the paper's scan; the normal map of the others "
      "comes from the same "
      "relief.");
  LeafPlantOptions bent, quad;
  bent.segments = 12;
  bent.fold_deg = 14.0f;
  bent.bend_deg = 40.0f;
  quad.segments = 1;
  const std::tuple<const char*, const char*, Plant> carriers[] = {
      {"geometry", "its relief as geometry, no normal map", reliefPlant(set, light)},
      {"curved", "normal map on a folded and bent sheet", leafPlant(set, light, bent)},
      {"quad", "normal map on a flat sheet", leafPlant(set, light, quad)}};
  page.beginRow();
  for (const auto& [name, caption, carrier] : carriers) {
    Plant plant = carrier;
    plant.materials[0].leaf->front_roughness = 0.15f;
    plant.materials[0].leaf->refractive_index = 1.7f;
    Scene scene;
    scene.items.push_back({&plant, nullptr});
    scene.ground = false;
    figures.show(scene, -25.0f, 0.0f);
    lightLeaf(figures, glm::half_pi<float>(), false);
    figures.view().daylight.sun.direction = directionOf(glm::radians(43.0f), glm::radians(10.0f));
    figures.view().exposure.ev = 14.5f;
    figures.draw(fmt::format("figure3-8-{}", name), leafTerms(LeafModel::kMaps),
                 fmt::format("{}: {} triangles", caption, plant.meshes[0].triangleCount()));
  }
  page.endRow();
}

void drawLeafTree(FigureSet& figures, const std::string& species) {
  GrowOptions options;
  options.species = species;
  options.texture_size = 1024;
  const Plant plant = grow(options);
  const CrownLight light = bakeOpticalDepth(plant).light;
  Scene scene;
  scene.items.push_back({&plant, &light});
  View& view = figures.view();
  view.background.reset();
  view.exposure = {};
  view.daylight = daylightOf({});
  const Terms ours = presetTerms("habel");
  Terms even = ours;
  even.leaf = LeafModel::kDiffuse;

  Page& page = figures.page();
  page.heading("Figure 3.18: a tree with light through its leaves");
  page.paragraph(fmt::format(
      "{} leaves of four sets, against the sun (left), from the side, and with it (right). Each "
      "leaf is shaded by its own maps; light from several surfaces is baked at its vertices.",
      plant.leaves.size()));
  const glm::vec3 sun = view.daylight.sun.direction;
  const float azimuth = glm::degrees(std::atan2(sun.x, sun.z));
  page.beginRow();
  for (const auto& [name, turn] : {std::pair{"against", 180.0f}, {"side", 80.0f}, {"with", 0.0f}}) {
    figures.show(scene, azimuth + turn, 4.0f);
    figures.draw(fmt::format("figure3-18-{}", name), ours, name);
  }
  page.endRow();

  page.heading("Figure 3.21: close to the leaves");
  page.paragraph(
      "The outer twigs against the sun. The standard method has one texture for both sides, "
      "constant ambient light, and lights the far side of a leaf not at all; the second lets the "
      "light through evenly, by the leaf's colour alone.");
  // The crown's edge, which the sun reaches, from the side away from the sun and a little below.
  glm::vec3 low(1e9f), high(-1e9f);
  for (const Leaf& leaf : plant.leaves) {
    low = glm::min(low, leaf.centroid);
    high = glm::max(high, leaf.centroid);
  }
  const glm::vec3 middle = 0.5f * (low + high);
  const glm::vec3 away = -glm::normalize(glm::vec3(sun.x, 0.0f, sun.z));
  const Leaf* outermost = &plant.leaves.front();
  const glm::vec3 aside(away.z, 0.0f, -away.x);
  const auto reach = [&](const Leaf& leaf) {
    const glm::vec3 to = leaf.centroid - middle;
    return glm::dot(to, aside) - std::abs(to.y) - std::abs(glm::dot(to, away));
  };
  for (const Leaf& leaf : plant.leaves)
    if (reach(leaf) > reach(*outermost)) outermost = &leaf;
  const float distance = 8.0f * std::sqrt(outermost->area);
  view.camera = {
      outermost->centroid + distance * glm::normalize(away - glm::vec3(0.0f, 0.3f, 0.0f)),
      outermost->centroid - 0.2f * distance * aside, 0.6f};
  page.beginRow();
  figures.draw("figure3-21-standard", presetTerms("standard"), "standard");
  figures.draw("figure3-21-even", even, "light through the leaf, evenly");
  figures.draw("figure3-21-ours", ours, "ours: normal maps and albedo of both sides, (3.23)");
  page.endRow();
}

}  // namespace verdure::app
