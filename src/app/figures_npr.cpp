// figures npr: Figures 7 and 8 of Luft, Balzer, Deussen 2007, from our own plants.
#include <fmt/format.h>

#include "app/figure_set.h"
#include "base/progress.h"

namespace verdure::app {
namespace {

struct Column {
  const char *name, *caption;
  StyleNormals normals;
};
constexpr Column kColumns[] = {
    {"a", "(a) the leaves' own normals", StyleNormals::kRaw},
    {"b", "(b) realigned to the implicit surface", StyleNormals::kRealigned},
    {"c", "(c) realigned, as long as the ambient coefficient", StyleNormals::kScaled}};

void drawStyled(FigureSet& figures, const std::string& name, Style style, StyleNormals normals,
                const std::string& caption) {
  figures.view().style = style;
  figures.view().style_normals = normals;
  figures.draw(name, presetTerms("expressive"), caption);
}

/// A row of pictures, one for each kind of normals.
void drawRow(FigureSet& figures, const std::string& name, Style style) {
  figures.page().beginRow();
  for (const Column& column : kColumns)
    drawStyled(figures, name + column.name, style, column.normals, column.caption);
  figures.page().endRow();
}

void drawFigure7(FigureSet& figures, const GrownPlant& tree) {
  Scene scene;
  scene.ground = false;
  scene.items.push_back({&tree.plant, &tree.bake.light});
  figures.view().background = glm::vec3(1.0f);
  figures.show(scene, 35.0f);
  figures.page().heading("Figure 7: application to non-photorealistic rendering");
  figures.page().paragraph("Top: the normals as colours. Below: lines where they jump.");
  drawRow(figures, "figure7-normals-", Style::kNormals);
  drawRow(figures, "figure7-edges-", Style::kEdges);
  figures.page().heading("The same for cartoons and watercolours");
  drawRow(figures, "toon-", Style::kToon);
  drawRow(figures, "watercolour-", Style::kWatercolor);
}

void drawPlate(FigureSet& figures, const std::string& name, const std::string& caption) {
  figures.page().beginRow();
  drawStyled(figures, "figure8-" + name, Style::kPhoto, StyleNormals::kScaled, caption);
  drawStyled(figures, "figure8-" + name + "-watercolour", Style::kWatercolor, StyleNormals::kScaled,
             "in watercolour");
  drawStyled(figures, "figure8-" + name + "-edges", Style::kEdges, StyleNormals::kScaled,
             "as a line drawing");
  figures.page().endRow();
}

void drawFigure8(FigureSet& figures, const GrownPlant& tree, const std::string& species,
                 Progress& progress) {
  figures.page().heading("Plates in the manner of Figure 8: single plants, and a group");
  figures.view().background.reset();
  std::vector<GrownPlant> others;
  for (const char* const name : {"weeping-willow", "scots-pine", "silver-birch", "hedge"}) {
    progress.show(name);
    others.push_back(growBaked(name, 1));
    Scene scene;
    scene.items.push_back({&others.back().plant, &others.back().bake.light});
    figures.show(scene, 35.0f);
    drawPlate(figures, name, name);
  }
  progress.show("group");
  Scene group;
  const auto stand = [&group](const GrownPlant& lit, const glm::vec3& at) {
    group.items.push_back(
        {&lit.plant,
         &lit.bake.light,
         {glm::mat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, glm::vec4(at, 1.0f))}});
  };
  stand(tree, {0, 0, -3});
  stand(others[2], {-7, 0, 0});
  stand(others[1], {7, 0, -5});
  stand(others[3], {2.5f, 0, 5});
  figures.show(group, 15.0f);
  drawPlate(figures, "group", species + ", silver birch, pine and hedge");
}

}  // namespace

void runNprFigures(const FiguresCommand& command) {
  speciesParameters(command.species);  // throws if there is no such species
  FigureSet figures(
      command, "Foliage in drawn styles",
      "Figures 7 and 8 of Luft, Balzer and Deussen (2007), from verdure's plants on ");
  // Tones are even: finer shadows would not be seen.
  figures.view().shadow_map_size = 1024;
  figures.view().shadow_cascades = 1;
  Progress progress("figures npr");
  progress.show("figure 7");
  const GrownPlant tree = growBaked(command.species, 4);
  drawFigure7(figures, tree);
  drawFigure8(figures, tree, command.species, progress);
  figures.page().write();
  fmt::print("{}\n", (figures.page().folder() / "index.html").string());
}

}  // namespace verdure::app
