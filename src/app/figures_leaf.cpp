// figures leaf: the figures of Habel 2009, chapter 3, from our own leaves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/figures_leaf.h"
#include "base/progress.h"
#include "leaf/multipole.h"
#include "shared/color.h"
#include "verdure/error.h"
#include "verdure/leaf_grow.h"

namespace verdure::app {
namespace {

constexpr int kMapPixels = 384;  ///< of a map's picture

template <typename Texel>
Image mapPicture(const LeafSet& set, Texel texel) {
  const int step = std::max(set.width / kMapPixels, 1);
  Image image(set.width / step, set.height / step);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i = static_cast<std::size_t>(y * step) * static_cast<std::size_t>(set.width) +
                     static_cast<std::size_t>(x * step);
      const glm::vec3 value = set.opacity[i] > 0.5f ? texel(i) : glm::vec3(1.0f);
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = toByte(value[c]);
      image.at(x, y)[3] = 255;
    }
  return image;
}

glm::vec3 shown(const glm::vec3& linear) {
  glm::vec3 out;
  for (int c = 0; c < 3; ++c) out[c] = shared::srgbFromLinear(std::clamp(linear[c], 0.0f, 1.0f));
  return out;
}

void drawDataSet(Page& page, const LeafSet& set) {
  page.heading("Figure 3.9: a data set");
  page.paragraph(fmt::format("{}: {} x {} texels of {:.3f} mm.", set.name, set.width, set.height,
                             set.mm_per_texel));
  float thickest = 0.0f;
  for (std::size_t i = 0; i < set.texelCount(); ++i)
    if (set.opacity[i] > 0.5f) thickest = std::max(thickest, set.thickness_mm[i]);
  for (const bool front : {true, false}) {
    const LeafSide& side = front ? set.front : set.back;
    const std::string prefix = front ? "front" : "back";
    page.beginRow();
    page.picture("figure3-9-" + prefix + "-albedo",
                 mapPicture(set, [&](std::size_t i) { return shown(side.albedo[i]); }),
                 prefix + ": albedo");
    page.picture("figure3-9-" + prefix + "-translucency",
                 mapPicture(set, [&](std::size_t i) { return shown(side.translucency[i]); }),
                 "translucency");
    page.picture("figure3-9-" + prefix + "-normal",
                 mapPicture(set, [&](std::size_t i) { return side.normal[i] * 0.5f + 0.5f; }),
                 "normals");
    page.endRow();
  }
  page.beginRow();
  page.picture(
      "figure3-9-thickness",
      mapPicture(set, [&](std::size_t i) { return glm::vec3(set.thickness_mm[i] / thickest); }),
      fmt::format("thickness, white {:.2f} mm", thickest));
  page.endRow();
}

constexpr std::array<std::pair<const char*, float>, 3> kElevations{
    {{"90", glm::half_pi<float>()}, {"45", 0.25f * glm::pi<float>()}, {"12", 0.21f}}};

void drawShading(FigureSet& figures, LeafSubject& subject) {
  Page& page = figures.page();
  Scene scene;
  scene.items.push_back({&subject.plant, nullptr});
  scene.ground = false;
  const auto row = [&](const std::string& figure, bool behind, LeafModel model, float ev,
                       const std::string& caption) {
    figures.show(scene, 0.0f, 0.0f);
    figures.view().exposure.ev = ev;
    page.beginRow();
    for (const auto& [name, elevation] : kElevations) {
      lightLeaf(figures, elevation, behind);
      figures.draw(fmt::format("{}-{}", figure, name), leafTerms(model),
                   fmt::format("{}, sun {} degrees above the leaf's plane", caption, name));
    }
    page.endRow();
  };
  page.heading("Figure 3.10: reflectance");
  page.paragraph("The front under the sun alone, from steep to grazing.");
  LeafTextures& leaf = *subject.plant.materials[0].leaf;
  const LeafTextures own = leaf;
  // Smoother, the highlight is tens of times as bright as the leaf: white in any exposure.
  leaf.front_roughness = 0.22f;
  leaf.refractive_index = 1.45f;
  row("figure3-10-glossy", false, LeafModel::kMaps, 14.0f, "roughness 0.22, index 1.45");
  leaf.front_roughness = 0.5f;
  leaf.refractive_index = 1.3f;
  row("figure3-10-matt", false, LeafModel::kMaps, 14.0f, "roughness 0.5, index 1.3");
  leaf = own;

  page.heading("Figure 3.11: translucency");
  page.paragraph(
      "The front, with the sun behind the leaf. Above, light through it as it falls on the back's "
      "relief (3.23); below, scattered evenly (3.24). The same exposure.");
  row("figure3-11-ours", true, LeafModel::kMaps, 11.5f, "ours");
  row("figure3-11-even", true, LeafModel::kDiffuse, 11.5f, "even");

  page.heading("Figure 3.17: the sun in the leaf's plane");
  page.paragraph("It lights bumps of both sides; neither way of looking at it has a step.");
  page.beginRow();
  figures.show(scene, 0.0f, 0.0f);
  figures.view().exposure.ev = 10.5f;
  for (const float degrees : {-6.0f, -2.0f, 0.0f, 2.0f, 6.0f}) {
    lightLeaf(figures, glm::radians(std::abs(degrees)), degrees < 0.0f);
    figures.draw(fmt::format("figure3-17-{:+.0f}", degrees), leafTerms(LeafModel::kMaps),
                 fmt::format("{:+.0f} degrees", degrees));
  }
  page.endRow();
}

/// T(r, d) by distance, a curve for each thickness.
std::string transmittancePlot(const LeafOptics& optics) {
  constexpr int kWidth = 560, kHeight = 360, kLeft = 60, kBottom = 320, kTop = 20;
  std::string svg = svgOpen(kWidth, kHeight);
  const auto x_of = [](double r) { return kLeft + r / 1.0 * (kWidth - kLeft - 20); };
  const auto y_of = [](double t) {  // decades 1e-4 to 1e2
    return kBottom - (std::log10(std::max(t, 1e-4)) + 4.0) / 6.0 * (kBottom - kTop);
  };
  for (int decade = -4; decade <= 2; ++decade) {
    const double y = y_of(std::pow(10.0, decade));
    svg += fmt::format(
        "<path d='M{} {:.1f}H{}' stroke='#ddd'/><text x='8' y='{:.1f}' font-size='12'>1e{}</text>",
        kLeft, y, kWidth - 20, y + 4, decade);
  }
  for (int tenth = 0; tenth <= 10; tenth += 2)
    svg += fmt::format("<text x='{:.0f}' y='{}' font-size='12'>{:.1f}</text>",
                       x_of(0.1 * tenth) - 8, kBottom + 18, 0.1 * tenth);
  svg += fmt::format("<text x='{}' y='{}' font-size='12'>r, mm; T, 1/mm&#178;</text>", kWidth / 2,
                     kHeight - 6);
  const std::array<const char*, 5> colors{"#1b7837", "#7fbf7b", "#999", "#af8dc3", "#762a83"};
  const std::array<double, 5> thicknesses{0.15, 0.2, 0.3, 0.5, 1.0};
  const Multipole multipole(optics, 0.05, 3);
  for (std::size_t k = 0; k < thicknesses.size(); ++k) {
    std::string path;
    for (int i = 0; i <= 100; ++i) {
      const double t = multipole.transmittance(0.01 * i, thicknesses[k]);
      if (t < 1e-4) break;
      path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x_of(0.01 * i), y_of(t));
    }
    svg += fmt::format(
        "<path d='{}' fill='none' stroke='{}' stroke-width='2'/><text x='{}' y='{}' "
        "font-size='12' fill='{}'>{} mm</text>",
        path, colors[k], kWidth - 90, kTop + 16 * (static_cast<int>(k) + 1), colors[k],
        thicknesses[k]);
  }
  return svg + "</svg>";
}

/// Shares of texels by L_rec / L - 1, a curve for each elevation of the sun.
std::string errorPlot(const std::vector<LeafErrors>& errors) {
  constexpr int kWidth = 560, kHeight = 360, kLeft = 40, kBottom = 320, kTop = 20;
  double most = 0.0;
  for (const LeafErrors& e : errors)
    for (const double share : e.histogram) most = std::max(most, share);
  std::string svg = svgOpen(kWidth, kHeight);
  const std::array<const char*, 3> colors{"#d62728", "#2ca02c", "#1f77b4"};
  for (int tick = -5; tick <= 5; ++tick) {
    const double x = kLeft + (tick + 5) / 10.0 * (kWidth - kLeft - 20);
    svg += fmt::format(
        "<path d='M{:.1f} {}V{}' stroke='#ddd'/><text x='{:.1f}' y='{}' "
        "font-size='12'>{:.1f}</text>",
        x, kTop, kBottom, x - 10, kBottom + 18, 0.1 * tick);
  }
  for (std::size_t k = 0; k < errors.size(); ++k) {
    std::string path;
    for (int bin = 0; bin < kLeafErrorBins; ++bin)
      path += fmt::format(
          "{}{:.1f} {:.1f}", bin == 0 ? "M" : "L",
          kLeft + (bin + 0.5) / kLeafErrorBins * (kWidth - kLeft - 20),
          kBottom - errors[k].histogram[static_cast<std::size_t>(bin)] / most * (kBottom - kTop));
    svg += fmt::format(
        "<path d='{}' fill='none' stroke='{}' stroke-width='2'/><text x='{}' y='{}' "
        "font-size='12' fill='{}'>sun at {:.1f} degrees</text>",
        path, colors[k % 3], kWidth - 160, kTop + 16 * (static_cast<int>(k) + 1), colors[k % 3],
        glm::degrees(errors[k].elevation));
  }
  return svg + "</svg>";
}

void drawNumbers(Page& page, const LeafSubject& subject) {
  page.heading("Figure 3.13: transmittance");
  page.paragraph(
      "T(r, d) of (3.8) for the leaf's optics, by the distance from where light enters.");
  page.beginRow();
  page.svg("figure3-13", transmittancePlot(subject.set.optics),
           "thin leaves let through most, and "
           "nearly straight");
  page.endRow();

  page.heading("Figure 3.16: normals, relief and the three coefficients");
  const LeafSet& set = subject.set;
  float low = 0.0f, high = 1e-6f, most = 1e-6f;
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    if (set.opacity[i] <= 0.5f) continue;
    low = std::min(low, set.back.relief_mm[i]);
    high = std::max(high, set.back.relief_mm[i]);
    for (int c = 0; c < 3; ++c) most = std::max(most, subject.light.front[i][c]);
  }
  page.beginRow();
  page.picture("figure3-16-normal",
               mapPicture(set, [&](std::size_t i) { return set.back.normal[i] * 0.5f + 0.5f; }),
               "normals of the back");
  page.picture("figure3-16-relief",
               mapPicture(set,
                          [&](std::size_t i) {
                            return glm::vec3((set.back.relief_mm[i] - low) / (high - low));
                          }),
               fmt::format("its relief, {:.2f} to {:.2f} mm", low, high));
  page.picture(
      "figure3-16-light",
      mapPicture(set, [&](std::size_t i) { return glm::max(subject.light.front[i], 0.0f) / most; }),
      fmt::format("coefficients of the light that leaves the front, white {:.3f}", most));
  page.endRow();

  page.heading("Figure 3.19: the error of three coefficients");
  const std::vector<LeafErrors> errors = measureLeafErrors(set, subject.light);
  page.paragraph("L_rec / L - 1 over all texels of both sides and four azimuths.");
  page.beginRow();
  page.svg("figure3-19", errorPlot(errors), "histogram");
  page.endRow();
  std::vector<std::vector<std::string>> rows{
      {"elevation", "mean", "mean of its size", "RMS", "5 % below", "5 % above"}};
  for (const LeafErrors& e : errors)
    rows.push_back({fmt::format("{:.1f}", glm::degrees(e.elevation)),
                    fmt::format("{:+.4f}", e.mean), fmt::format("{:.4f}", e.mean_absolute),
                    fmt::format("{:.4f}", e.rms), fmt::format("{:+.4f}", e.low),
                    fmt::format("{:+.4f}", e.high)});
  page.table(rows);
}

}  // namespace

void lightLeaf(FigureSet& figures, float elevation, bool behind) {
  View& view = figures.view();
  view.daylight = daylightOf({});
  view.daylight.sky = nullptr;
  const float out = behind ? -std::sin(elevation) : std::sin(elevation);
  view.daylight.sun.direction =
      glm::normalize(glm::vec3(std::cos(elevation) * 0.8f, std::cos(elevation) * 0.6f, out));
  view.background = glm::vec3(0.02f);
}

Terms leafTerms(LeafModel model) {
  Terms terms = presetTerms("habel");
  terms.shadow = false;
  terms.leaf = model;
  return terms;
}

void runLeafFigures(const FiguresCommand& command) {
  FigureSet figures(command, "Leaves",
                    "Figures of chapter 3 of Habel (2009), from verdure's leaves on ");
  if (command.samples < 1) throw Error("--samples", "must be at least 1", "32 is a fair start");
  Progress progress("figures leaf");
  progress.show("growing");
  LeafSubject subject;
  LeafGrowOptions grown;
  grown.species = command.species;
  subject.set = growLeaf(grown);
  progress.show("baking");
  subject.light = bakeLeafTranslucency(subject.set);
  LeafPlantOptions sheet;
  sheet.fold_deg = kLeafFold_deg;
  subject.plant = leafPlant(subject.set, subject.light, sheet);
  progress.show("drawing");
  drawCarriers(figures, subject);
  drawDataSet(figures.page(), subject.set);
  drawShading(figures, subject);
  drawNumbers(figures.page(), subject);
  progress.show("tracing");
  drawLeafTruth(figures, subject, command.samples);
  progress.show("growing a tree");
  drawLeafTree(figures, command.species);
  figures.page().write();
  fmt::print("{}\n", (figures.page().folder() / "index.html").string());
}

}  // namespace verdure::app
