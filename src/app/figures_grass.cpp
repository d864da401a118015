// figures grass: Figures 2.9 to 2.16 of Habel 2009, from our own grass.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/figure_set.h"
#include "app/grass_commands.h"
#include "base/progress.h"
#include "shared/color.h"
#include "shared/grass.h"
#include "verdure/grow.h"

namespace verdure::app {
namespace {

constexpr int kPatchSlices = 16;  ///< along each side of a patch, as in the thesis
constexpr int kMapColumns = 640;  ///< of a map's picture, at most

/// Grass as the thesis traces it: slices at even distances, each by itself, no level slice.
GrassLayer thesisLayer(const GrassSet& set) {
  GrassLayer layer;
  layer.set = &set;
  layer.turn = 0.0f;
  layer.scatter = 0.0f;
  layer.middle = layer.medium = layer.blades = false;
  layer.variation = 0.0f;
  return layer;
}

Scene sceneOf(const GrassLayer& layer) {
  Scene scene;
  scene.grass.push_back(layer);
  return scene;
}

/// A square of grass around x = z = 0.
CoverMap patchOf(float side_m) {
  CoverMap cover;
  cover.width = cover.height = 512;
  cover.size_m = glm::vec2(2.0f * side_m);
  cover.corner = -0.5f * cover.size_m;
  for (int y = 0; y < cover.height; ++y)
    for (int x = 0; x < cover.width; ++x) {
      const bool inside = std::abs(2 * x + 1 - cover.width) < cover.width / 2 &&
                          std::abs(2 * y + 1 - cover.height) < cover.height / 2;
      cover.values.push_back(inside ? 1.0f : 0.0f);
    }
  return cover;
}

/// What a map shows on white, its first `columns` columns and `rows` rows; at most kMapColumns
/// wide.
Image mapPicture(const GrassMap& map, int columns, int rows) {
  const int step = std::max((columns + kMapColumns - 1) / kMapColumns, 1);
  Image image(columns / step, rows / step);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      glm::vec4 sum(0.0f);
      for (int j = y * step; j < (y + 1) * step; ++j)
        for (int i = x * step; i < (x + 1) * step; ++i)
          sum += map.color[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) +
                           static_cast<std::size_t>(i)];
      sum /= static_cast<float>(step * step);
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = toByte(shared::srgbFromLinear(std::min(sum[c] + 1.0f - sum.a, 1.0f)));
      image.at(x, y)[3] = 255;
    }
  return image;
}

/// Slices that are opaque but for their upper edge, and level ground.
GrassSet gridSet(const GrassSet& like) {
  constexpr int kRows = 64;
  GrassSet set = like;
  set.spacing_m *= 2.0f;
  GrassMap slice;
  slice.width = 4;
  slice.height = kRows;
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < slice.width; ++x) {
      const float height = 1.0f - (static_cast<float>(y) + 0.5f) / kRows;
      const glm::vec3 color =
          glm::mix(glm::vec3(0.1f, 0.08f, 0.05f), glm::vec3(0.3f, 0.5f, 0.12f), height);
      slice.color.push_back(y == 0 ? glm::vec4(0.0f) : glm::vec4(color, 1.0f));
      slice.data.emplace_back(0.0f);
    }
  set.slices.assign(1, slice);
  set.opaque = slice;
  for (int x = 0; x < slice.width; ++x)
    set.opaque.color[static_cast<std::size_t>(x)] = slice.color.back();
  return set;
}

/// From an azimuth and an elevation, at so many of the picture's heights.
void look(FigureSet& figures, float azimuth_deg, float elevation_deg, const glm::vec3& target,
          float height_m) {
  Camera& camera = figures.view().camera;
  camera.target = target;
  camera.eye = target + directionOf(glm::radians(azimuth_deg), glm::radians(elevation_deg)) *
                            (0.5f * height_m / std::tan(0.5f * camera.vertical_fov));
}

Terms grassTerms() {
  Terms terms = presetTerms("best");
  terms.ambient_source = AmbientSource::kBaked;
  return terms;
}

void draw(FigureSet& figures, const Scene& scene, const std::string& name,
          const std::string& caption) {
  figures.renderer().setScene(scene);
  figures.draw(name, grassTerms(), caption);
}

void drawStructure(FigureSet& figures, const GrassSet& set) {
  Page& page = figures.page();
  page.heading("Figure 2.9: structure");
  page.paragraph(
      "A patch whose slices are opaque, at twice their distance. What stands there is one polygon "
      "over the shell; slices, sides and ground are found along the rays of its pixels.");
  const GrassSet grid = gridSet(set);
  const float side = 0.5f * kPatchSlices * grid.spacing_m.x;
  const CoverMap patch = patchOf(side);
  GrassLayer layer = thesisLayer(grid);
  layer.cover = &patch;
  page.beginRow();
  for (const auto& [name, elevation] : {std::pair("above", 60.0f), std::pair("side", 30.0f)}) {
    look(figures, 30.0f, elevation, glm::vec3(0.0f, 0.4f * grid.height_m, 0.0f), 1.5f * side);
    draw(figures, sceneOf(layer), fmt::format("figure2-9-{}", name),
         fmt::format("from {:g} degrees above the ground", elevation));
  }
  page.endRow();
}

void drawDataSet(FigureSet& figures, const GrassSet& set) {
  Page& page = figures.page();
  page.heading("Figure 2.10: a data set");
  page.paragraph(fmt::format(
      "{}: {} slices {:.2f} m high, each of four Wang tiles of {:.2f} m, one every {:.0f} cm along "
      "both axes. Two tiles of what each shows; the pictures in the files hold four, and normals, "
      "light through the blades and ranks besides.",
      set.name, set.slices.size(), set.height_m, set.tile_m, 100.0f * set.spacing_m.x));
  page.beginRow();
  for (std::size_t i = 0; i < std::min<std::size_t>(set.slices.size(), 4); ++i) {
    const GrassMap& slice = set.slices[i];
    page.picture(fmt::format("figure2-10-slice{}", i),
                 mapPicture(slice, slice.width / 2, slice.height), fmt::format("slice {}", i));
  }
  page.picture("figure2-10-opaque", mapPicture(set.opaque, set.opaque.width / 2, set.opaque.height),
               "the opaque slice: all of them one behind the other");
  page.endRow();
  page.beginRow();
  page.picture("figure2-10-ground",
               mapPicture(set.ground, set.ground.width / 2, set.ground.height / 2),
               "the ground, with the lower half of the plants");
  page.picture("figure2-10-middle",
               mapPicture(set.middle, set.middle.width / 2, set.middle.height / 2),
               "the level slice: what grows above half of the height");
  page.endRow();
}

/// A ray through slices across one axis, seen from the side.
std::string rayPicture() {
  constexpr int kWidth = 760, kHeight = 260, kPlanes = 10;
  constexpr float kLeft = 40.0f, kSpacing = 68.0f, kTop = 70.0f, kGround = 210.0f, kSlope = 0.26f;
  std::string svg = svgOpen(kWidth, kHeight);
  svg += fmt::format(
      "<path d='M20 {0}H740' stroke='#7a5' stroke-dasharray='6 4'/>"
      "<path d='M20 {1}H740' stroke='#853' stroke-width='3'/>\n",
      kTop, kGround);
  svg += fmt::format(
      "<text x='744' y='{}' text-anchor='end'>top of the shell</text>"
      "<text x='744' y='{}' text-anchor='end'>ground</text>\n",
      kTop - 8.0f, kGround + 20.0f);
  const float entry = kLeft + 60.0f;
  const auto rayAt = [&](float x) { return kTop + kSlope * (x - entry); };
  int met = 0;
  for (int i = 0; i < kPlanes; ++i) {
    const float x = kLeft + kSpacing * shared::slicePlace(i, 0u, 0.6f, shared::kSliceKindOfU);
    svg +=
        fmt::format("<path d='M{0} {1}V{2}' stroke='#383' stroke-width='2'/>\n", x, kTop, kGround);
    if (x > entry && rayAt(x) < kGround)
      svg += fmt::format(
          "<circle cx='{0}' cy='{1}' r='4' fill='#c33'/><text x='{2}' y='{3}' "
          "fill='#c33'>{4}</text>\n",
          x, rayAt(x), x + 7.0f, rayAt(x) - 6.0f, ++met);
  }
  const float end = entry + (kGround - kTop) / kSlope;
  svg += fmt::format(
      "<path d='M{0} {1}L{2} {3}' stroke='#c33' stroke-width='1.5'/>"
      "<circle cx='{2}' cy='{3}' r='4' fill='#853'/>"
      "<text x='{4}' y='{5}'>e</text></svg>\n",
      entry - 50.0f, rayAt(entry - 50.0f), end, kGround, entry - 4.0f, kTop - 10.0f);
  return svg;
}

double difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / (0.75 * static_cast<double>(a.rgba.size()));
}

void drawIterations(FigureSet& figures, const GrassSet& set) {
  Page& page = figures.page();
  GrassLayer layer = thesisLayer(set);
  layer.turn = 0.5f;
  layer.scatter = 0.6f;
  View& view = figures.view();
  view.camera.eye = {0.0f, 3.0f * set.height_m + 0.3f, 0.0f};
  view.camera.target = view.camera.eye + glm::vec3(0.0f, -0.55f, -1.0f);
  view.terms = grassTerms();
  const auto drawn = [&](int most) {
    layer.most_slices = most;
    figures.renderer().setScene(sceneOf(layer));
    return figures.renderer().render(view);
  };
  constexpr int kAll = 128;
  const Frame all = drawn(kAll);
  std::vector<std::vector<std::string>> table{{set.name + ": most slices",
                                               fmt::format("mean difference from {}, of 255", kAll),
                                               "colour, ms"}};
  page.beginRow();
  for (const int most : {1, 2, 4, 8, 32}) {
    const Frame frame = drawn(most);
    page.picture(fmt::format("figure2-11-{}-{}", set.name, most), frame.image,
                 fmt::format("{}, {} slice{}", set.name, most, most == 1 ? "" : "s"));
    table.push_back({fmt::format("{}", most),
                     fmt::format("{:.2f}", difference(frame.image, all.image)),
                     fmt::format("{:.0f}", frame.times.color_ms)});
  }
  table.push_back({fmt::format("{}", kAll), "0", fmt::format("{:.0f}", all.times.color_ms)});
  page.endRow();
  page.table(table);
}

void drawRays(FigureSet& figures, const GrassSet& set, const GrassSet& lawn) {
  Page& page = figures.page();
  page.heading("Figure 2.11: rays");
  page.paragraph(
      "A ray enters the shell at e and composites what slices show from front to back, to the "
      "ground, or until nothing is seen through them. Here slices are off their even distances, so "
      "that they do not stand in rows; those across the other axis are met in between.");
  page.beginRow();
  page.svg("figure2-11-ray", rayPicture(), "slices across one axis, from the side");
  page.endRow();
  page.paragraph(
      "So many slices at most; what is still open then is filled by the opaque slice, without the "
      "medium of docs/grass.md. The thesis uses 4, which needs short, dense grass.");
  drawIterations(figures, lawn);
  drawIterations(figures, set);
}

void drawPatches(FigureSet& figures, const GrassSet& set) {
  Page& page = figures.page();
  const float side = kPatchSlices * set.spacing_m.x;
  const CoverMap patch = patchOf(side);
  GrassLayer layer = thesisLayer(set);
  layer.cover = &patch;
  const auto row = [&](const std::string& figure, const std::string& caption) {
    page.beginRow();
    for (const float elevation : {86.0f, 50.0f, 20.0f}) {
      look(figures, 0.0f, elevation, glm::vec3(0.0f, 0.8f * set.height_m, 0.0f),
           (elevation > 60.0f ? 1.5f : 1.1f) * side);
      draw(figures, sceneOf(layer), fmt::format("{}-{:g}", figure, elevation),
           fmt::format("{}, from {:g} degrees above the ground", caption, elevation));
    }
    page.endRow();
  };
  page.heading("Figure 2.12: the grid shows from above");
  page.paragraph(
      fmt::format("A patch of {0} x {0} slices at even distances, as in the thesis: "
                  "apparent from above, gone at grazing angles. What is not grass is bare soil.",
                  kPatchSlices));
  row("figure2-12", "without the level slice");
  page.heading("Figure 2.13: the level slice hides it");
  page.paragraph("The same with a level slice at half of the height.");
  layer.middle = true;
  row("figure2-13", "with the level slice");
  page.paragraph("The same with slices off their even distances.");
  layer.scatter = 0.6f;
  row("figure2-13-scattered", "with the level slice, scattered");
}

void drawVisibility(FigureSet& figures, const GrassSet& set, const Plant& trunk) {
  Page& page = figures.page();
  page.heading("Figure 2.14: what stands in grass");
  page.paragraph(
      "The thesis compares a patch whose depth is that of its polygon, which cuts off what stands "
      "in "
      "it, with one whose depth is where its grass covers about half. Here neither is cut off: "
      "rays "
      "end at what stands in the grass, or grass hides it by whole pixels, the thesis's way.");
  Scene scene;
  SceneItem& item = scene.items.emplace_back(SceneItem{&trunk, nullptr});
  item.world_from_plant.clear();
  for (const glm::vec3& place :
       {glm::vec3(-0.9f, 0.0f, 0.0f), glm::vec3(0.3f, 0.0f, -1.1f), glm::vec3(1.0f, 0.0f, 0.5f)}) {
    glm::mat4 world(1.0f);
    world[3] = glm::vec4(place, 1.0f);
    item.world_from_plant.push_back(world);
  }
  GrassLayer layer;
  layer.set = &set;
  layer.blades = false;
  Camera& camera = figures.view().camera;
  const float fov = std::exchange(camera.vertical_fov, 0.35f);
  camera.eye = {-0.3f, 1.1f, 2.2f};
  camera.target = {-0.6f, 0.4f, 0.0f};
  page.beginRow();
  for (const bool ends : {true, false}) {
    layer.ends_at_depth = ends;
    scene.grass.assign(1, layer);
    draw(figures, scene, ends ? "figure2-14-ends" : "figure2-14-pixels",
         ends ? "rays end at what stands in the grass" : "by whole pixels");
  }
  page.endRow();
  camera.vertical_fov = fov;
}

void drawTerrains(FigureSet& figures, const GrassSet& set, const GrassSet& lawn) {
  Page& page = figures.page();
  Terrain terrain =
      growTerrain({.seed = 4, .size_m = glm::vec2(160.0f), .relief_m = 14.0f, .hill_m = 45.0f});
  View& view = figures.view();
  view.wind.speed = 6.0f;
  view.seconds = 2.0;
  const auto row = [&](const std::string& figure, const std::vector<const GrassSet*>& sets) {
    page.beginRow();
    for (const GrassSet* of : sets) {
      Scene scene;
      scene.terrain = &terrain;
      GrassLayer& layer = scene.grass.emplace_back();
      layer.set = of;
      const glm::vec2 from(4.0f, 30.0f);
      view.camera.eye = glm::vec3(from.x, terrain.heightAt(from) + of->height_m + 1.7f, from.y);
      view.camera.target = {0.0f, terrain.heightAt(glm::vec2(0.0f, -10.0f)), -10.0f};
      draw(figures, scene, fmt::format("{}-{}", figure, of->name), of->name);
    }
    page.endRow();
  };
  const GrassSet dry = growGrass(grassSpecies("dry-grass"));
  page.heading("Figure 2.15: grass of moderate density and height on a terrain");
  page.paragraph("In wind of 6 m/s.");
  row("figure2-15", {&set, &dry});
  page.heading("Figure 2.16: short, dense grass on a terrain");
  row("figure2-16", {&lawn});
}

Plant growTrunk() {
  GrowOptions options;
  options.species = "black-oak";
  options.seed = 4;
  options.texture_size = 256;
  options.leaf_form = LeafForm::kCard;
  options.set = {{"Levels", "1"}, {"Leaves", "0"}, {"Scale", "5"}};
  return grow(options);
}

}  // namespace

void runGrassFigures(const FiguresCommand& command) {
  const GrassSpecies species = grassSpecies(command.species);
  FigureSet figures(command, "Grass as a material",
                    "Figures 2.9 to 2.16 of Habel, \"Real-time Rendering and Animation of "
                    "Vegetation\" (2009), from verdure's grass on ");
  figures.view().daylight =
      daylightOf({.sun_deg = glm::vec2(60.0f, 50.0f), .date = {}, .place = {}});
  Progress progress("figures grass");
  progress.show("growing");
  const GrassSet set = growGrass(species);
  GrassGrowOptions finer;
  finer.texels_per_m = 1024.0f;
  const GrassSet lawn = growGrass(grassSpecies("lawn"), finer);
  progress.show("figures 2.9 to 2.11");
  drawStructure(figures, set);
  drawDataSet(figures, set);
  drawRays(figures, set, lawn);
  progress.show("figures 2.12 and 2.13");
  drawPatches(figures, set);
  progress.show("figure 2.14");
  drawVisibility(figures, set, growTrunk());
  progress.show("figures 2.15 and 2.16");
  drawTerrains(figures, set, lawn);
  figures.page().write();
  fmt::print("{}\n", (figures.page().folder() / "index.html").string());
}

}  // namespace verdure::app
