// figures leaf: what the three coefficients of a leaf miss, as pictures.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "app/figures_leaf.h"
#include "scene/display.h"
#include "shared/color.h"
#include "shared/leaf_basis.h"
#include "shared/tone.h"
#include "verdure/compare.h"
#include "verdure/leaf_reference.h"

namespace verdure::app {
namespace {

constexpr std::array<std::pair<const char*, LeafModel>, 2> kModels{
    {{"ours", LeafModel::kMaps}, {"even", LeafModel::kDiffuse}}};
constexpr float kKey = 0.35f, kWhite = 3.0f;  ///< of pictures against the path tracer's

/// Of a leaf's maps: a square of texels.
struct Part {
  int x = 0, y = 0, side = 1;
};

/// A square of the part's texels, or of every so many.
template <typename Texel>
Image partPicture(const LeafSet& set, const Part& part, int pixels, Texel texel) {
  const int step = std::max(part.side / pixels, 1);
  Image image(part.side / step, part.side / step);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto i =
          static_cast<std::size_t>(part.y + y * step) * static_cast<std::size_t>(set.width) +
          static_cast<std::size_t>(part.x + x * step);
      const glm::vec3 value = set.opacity[i] > 0.5f ? texel(i) : glm::vec3(1.0f);
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = toByte(shared::srgbFromLinear(std::clamp(value[c], 0.0f, 1.0f)));
      image.at(x, y)[3] = 255;
    }
  return image;
}

/// Red above 0, blue below, white at 0; full at `most`.
glm::vec3 signedColor(float value, float most) {
  const float s = std::clamp(value / most, -1.0f, 1.0f);
  const glm::vec3 far = s > 0.0f ? glm::vec3(0.6f, 0.02f, 0.02f) : glm::vec3(0.02f, 0.06f, 0.5f);
  return glm::mix(glm::vec3(0.9f), far, std::abs(s));
}

void drawReconstruction(Page& page, const LeafSubject& subject) {
  const LeafSet& set = subject.set;
  const float elevation = glm::pi<float>() / 8.0f;
  const glm::vec3 w(std::cos(elevation) * 0.8f, std::cos(elevation) * 0.6f, std::sin(elevation));
  const std::vector<float> exact = lightThroughLeaf(set, true, w);
  std::vector<float> found;
  for (const glm::vec3& h : subject.light.front)
    found.push_back(shared::leafTransport(h, {w.x, w.y, -w.z}));
  double sum = 0.0, error = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.texelCount(); ++i) {
    if (set.opacity[i] < 0.5f) continue;
    sum += double{exact[i]};
    error += double{std::abs(found[i] - exact[i])};
    ++count;
  }
  const auto mean = static_cast<float>(sum / static_cast<double>(count));
  page.heading("Figure 3.20: light through the leaf and what three coefficients make of it");
  page.paragraph(fmt::format(
      "The front, the sun 22.5 degrees above the plane of the back, to the right and "
      "above: L of (3.16) for this very direction, L_rec of (3.23), and their difference, "
      "full colour at half of the mean light. Mean of its size: {:.3f} of the mean light.",
      error / sum));
  const int side = std::min(set.width, set.height), part = std::min(side, 256);
  const std::array<std::pair<const char*, Part>, 2> parts{
      {{"", {0, 0, side}},
       {"part-", {(set.width + part / 4) / 2 - part / 8, (set.height - part) / 2, part}}}};
  for (const auto& [name, square] : parts) {
    const auto shown = [&](const std::vector<float>& light) {
      return partPicture(set, square, 512, [&](std::size_t i) {
        return set.front.translucency[i] * (0.5f * light[i] / mean);
      });
    };
    page.beginRow();
    page.picture(fmt::format("figure3-20-{}exact", name), shown(exact), "L");
    page.picture(fmt::format("figure3-20-{}found", name), shown(found), "L_rec");
    page.picture(
        fmt::format("figure3-20-{}difference", name),
        partPicture(set, square, 512,
                    [&](std::size_t i) { return signedColor(found[i] - exact[i], 0.5f * mean); }),
        "L_rec - L: red too light, blue too dark");
    page.endRow();
  }
}

/// How far a picture is from the traced one, over the leaf's pixels.
struct Distance {
  double light = 0.0;  ///< over the traced picture's
  double rms = 0.0;    ///< over the traced picture's mean, without its noise
  double noise = 0.0;  ///< of a pixel, over the same
};

Distance distanceTo(const ReferencePicture& truth, const HdrImage& drawn,
                    const std::vector<bool>& inside) {
  double light = 0.0, found = 0.0, squares = 0.0, noise = 0.0, count = 0.0;
  for (std::size_t i = 0; i < drawn.rgb.size(); ++i) {
    if (!inside[i]) continue;
    const double a = double{shared::luminanceOf(truth.image.rgb[i])};
    const double b = double{shared::luminanceOf(drawn.rgb[i])};
    light += a;
    found += b;
    squares += (a - b) * (a - b);
    noise += std::pow(double{truth.standard_error[i]}, 2.0);
    count += 1.0;
  }
  return {found / light, std::sqrt(std::max(squares - noise, 0.0) * count) / light,
          std::sqrt(noise * count) / light};
}

float meanLuminance(const HdrImage& image, const std::vector<bool>& inside) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    if (inside[i]) {
      sum += double{shared::luminanceOf(image.rgb[i])};
      count += 1.0;
    }
  return static_cast<float>(sum / std::max(count, 1.0));
}

/// A leaf in that shape, traced and drawn in turn.
class TracedLeaf {
 public:
  TracedLeaf(FigureSet& figures, const LeafSubject& subject, const LeafPlantOptions& shape,
             int samples)
      : figures_(figures),
        subject_(subject),
        shape_(shape),
        before_(figures.view()),
        plant_(leafPlant(subject.set, subject.light, shape)) {
    // The traced leaf has no gloss.
    plant_.materials[0].leaf->front_roughness = plant_.materials[0].leaf->back_roughness = 0.0f;
    Scene scene;
    scene.items.push_back({&plant_, nullptr});
    scene.ground = false;
    figures.show(scene, 0.0f, 0.0f);
    View& view = figures.view();
    view.width = std::max(view.width / 2, 16);
    view.height = std::max(view.height / 2, 16);
    view.hdr = true;
    options_.samples = samples;
  }
  ~TracedLeaf() { figures_.view() = before_; }
  TracedLeaf(const TracedLeaf&) = delete;
  TracedLeaf& operator=(const TracedLeaf&) = delete;

  View& view() { return figures_.view(); }

  /// A row of the page, under the view's light: traced, then each model and its FLIP, exposed for
  /// the traced picture. Returns the numbers as text, noise first.
  std::vector<std::string> compare(const std::string& name, const std::string& caption,
                                   std::size_t models, bool shadow) {
    options_.width = view().width;
    options_.height = view().height;
    options_.camera = view().camera;
    ReferencePicture truth =
        renderLeafReference(subject_.set, shape_, {}, view().daylight, options_);
    std::array<HdrImage, kModels.size()> drawn;
    drawn.fill(HdrImage(view().width, view().height));
    for (std::size_t m = 0; m < models; ++m) {
      view().terms = leafTerms(kModels[m].second);
      view().terms.shadow = shadow;
      drawn[m] = figures_.renderer().render(view()).hdr;
    }
    // Beside the leaf the traced picture may show the sun.
    const std::vector<bool> inside = leafPixels();
    for (std::size_t i = 0; i < inside.size(); ++i)
      if (!inside[i]) truth.image.rgb[i] = drawn[0].rgb[i] = drawn[1].rgb[i] = glm::vec3(0.0f);
    const float average = meanLuminance(truth.image, inside);
    const auto show = [&](const HdrImage& image) {
      return displayed(image, average, kKey, kWhite);
    };
    Page& page = figures_.page();
    page.beginRow();
    const Image shown_truth = show(truth.image);
    page.picture(name + "-traced", shown_truth, caption);
    std::vector<std::string> numbers;
    for (std::size_t m = 0; m < models; ++m) {
      const char* const model = kModels[m].first;
      const Image shown = show(drawn[m]);
      const Distance distance = distanceTo(truth, drawn[m], inside);
      const ErrorMap map = flip(shown_truth, shown);
      page.picture(fmt::format("{}-{}", name, model), shown,
                   fmt::format("{}: light {:.3f} of it, RMS {:.3f}, FLIP {:.3f}", model,
                               distance.light, distance.rms, map.mean()));
      page.picture(fmt::format("{}-{}-flip", name, model), heatmap(map),
                   fmt::format("FLIP of {}", model));
      if (m == 0) numbers.push_back(fmt::format("{:.3f}", distance.noise));
      for (const double value : {distance.light, distance.rms, map.mean()})
        numbers.push_back(fmt::format("{:.3f}", value));
    }
    page.endRow();
    return numbers;
  }

 private:
  /// Those that the leaf fills, with all their neighbours.
  std::vector<bool> leafPixels() {
    View even = view();
    even.daylight.sky = uniformSky(glm::vec3(1.0f), glm::vec3(1.0f));
    even.daylight.sun.luminance = glm::vec3(0.0f);
    even.terms = presetTerms("standard");
    const HdrImage image = figures_.renderer().render(even).hdr;
    std::vector<bool> inside(image.rgb.size(), false);
    for (int y = 1; y + 1 < image.height; ++y)
      for (int x = 1; x + 1 < image.width; ++x) {
        bool filled = true;
        for (int k = 0; k < 9; ++k)
          filled = filled && image.at(x + k % 3 - 1, y + k / 3 - 1) != glm::vec3(0.0f);
        inside[static_cast<std::size_t>(y * image.width + x)] = filled;
      }
    return inside;
  }

  FigureSet& figures_;
  const LeafSubject& subject_;
  LeafPlantOptions shape_;
  View before_;
  Plant plant_;
  ReferenceOptions options_;
};

void drawCloseUp(FigureSet& figures, const LeafSubject& subject, int samples) {
  Page& page = figures.page();
  page.heading("A leaf close up against the path tracer");
  page.paragraph(fmt::format(
      "A flat leaf with the sun behind it. Traced: {} paths a pixel through the leaf by the "
      "multipole's T(r, d), entry points sampled, light there found by rays past the relief: no "
      "coefficients, no horizons. Ours: (3.23). Even: (3.24). Each row has the exposure of its "
      "traced picture.",
      samples));
  TracedLeaf leaf(figures, subject, {}, samples);
  // A part right of the midrib, a fifth of the leaf high, from afar.
  const float height = 1e-3f * subject.set.mm_per_texel * static_cast<float>(subject.set.height);
  const glm::vec3 target(0.12f * height, 0.5f * height, 0.0f);
  leaf.view().camera = {target + glm::vec3(0, 0, 10.0f * height), target,
                        2.0f * std::atan(0.1f * height / (10.0f * height))};
  std::vector<std::vector<std::string>> rows{{"sun above the plane, degrees", "noise a pixel",
                                              "ours: light", "RMS", "FLIP", "even: light", "RMS",
                                              "FLIP"}};
  // At 90 degrees half of the sun's disk would be below the horizon.
  for (const float degrees : {89.0f, 45.0f, 22.5f, 8.0f}) {
    lightLeaf(figures, glm::radians(degrees), true);
    rows.push_back(leaf.compare(
        fmt::format("close-up-{:g}", degrees),
        fmt::format("traced, sun {:g} degrees above the plane of the back", degrees), 2, false));
    rows.back().insert(rows.back().begin(), fmt::format("{:g}", degrees));
  }
  page.table(rows);
}

void drawGrazing(FigureSet& figures, const LeafSubject& subject, int samples) {
  Page& page = figures.page();
  page.heading("The sun near the leaf's plane, against the path tracer");
  page.paragraph("A folded leaf without gloss, here with the renderer's shadows.");
  LeafPlantOptions shape;
  shape.fold_deg = kLeafFold_deg;
  TracedLeaf leaf(figures, subject, shape, samples);
  std::vector<std::vector<std::string>> rows{
      {"sun, degrees before the plane", "noise a pixel", "ours: light", "RMS", "FLIP"}};
  for (const float degrees : {-20.0f, -6.0f, 0.0f, 6.0f, 20.0f}) {
    lightLeaf(figures, glm::radians(std::abs(degrees)), degrees < 0.0f);
    rows.push_back(leaf.compare(fmt::format("grazing-{:+g}", degrees),
                                fmt::format("traced, {:+g} degrees", degrees), 1, true));
    rows.back().insert(rows.back().begin(), fmt::format("{:+g}", degrees));
  }
  page.table(rows);
}

}  // namespace

void drawLeafTruth(FigureSet& figures, const LeafSubject& subject, int samples) {
  drawReconstruction(figures.page(), subject);
  drawCloseUp(figures, subject, samples);
  drawGrazing(figures, subject, samples);
}

}  // namespace verdure::app
